/* Settings and renderers of numbers that mean nothing. */
#include "abuse.h"

static sv_status with_settings(sv_settings settings) {
    sv_renderer_desc desc = renderer_desc();
    desc.settings = &settings;
    return sv_renderer_create(device, &desc, &made_handle, &diagnostic);
}
static sv_status with_renderer(sv_renderer_desc desc) {
    return sv_renderer_create(device, &desc, &made_handle, &diagnostic);
}
static sv_status with_class(sv_target_class class) {
    sv_renderer_desc desc = renderer_desc();
    desc.target = &class;
    return sv_renderer_create(device, &desc, &made_handle, &diagnostic);
}

static void settings(void) {
    const sv_settings start = {.struct_size = sizeof start};
    const double nan = NAN, inf = INFINITY;
#define with with_settings
    WITH(sv_settings, start, technique, 6, SV_E_ARGUMENT);
    WITH(sv_settings, start, technique, SV_TECHNIQUE_SHEAR_WARP, SV_E_UNSUPPORTED);
    WITH(sv_settings, start, technique, SV_TECHNIQUE_PATHTRACE, SV_E_UNSUPPORTED);
    WITH(sv_settings, start, technique, UINT32_MAX, SV_E_ARGUMENT);
    WITH(sv_settings, start, mode, 9, SV_E_ARGUMENT);
    WITH(sv_settings, start, filter, 7, SV_E_ARGUMENT);
    WITH(sv_settings, start, lattice, 4, SV_E_ARGUMENT);
    WITH(sv_settings, start, color_space, 2, SV_E_ARGUMENT);
    WITH(sv_settings, start, samples_per_voxel, -1.0, SV_E_ARGUMENT);
    WITH(sv_settings, start, samples_per_voxel, nan, SV_E_ARGUMENT);
    WITH(sv_settings, start, samples_per_voxel, inf, SV_E_ARGUMENT);
    WITH(sv_settings, start, samples_per_voxel, 1e9, SV_E_ARGUMENT);
    WITH(sv_settings, start, termination, -0.5, SV_E_ARGUMENT);
    WITH(sv_settings, start, termination, 2.0, SV_E_ARGUMENT);
    WITH(sv_settings, start, termination, nan, SV_E_ARGUMENT);
    WITH(sv_settings, start, crop_min[0], 1.0, SV_E_ARGUMENT);
    WITH(sv_settings, start, crop_max[1], 1.0, SV_E_ARGUMENT);
    WITH(sv_settings, start, crop_max[2], nan, SV_E_ARGUMENT);
    WITH(sv_settings, start, crop_min[2], -inf, SV_E_ARGUMENT);
    WITH(sv_settings, start, clip_plane_count, 1, SV_E_ARGUMENT);
    WITH(sv_settings, start, clip_plane_count, UINT64_MAX, SV_E_ARGUMENT);
    WITH(sv_settings, start, level_count, 1, SV_E_ARGUMENT);
    WITH(sv_settings, start, light_count, 3, SV_E_ARGUMENT);
    WITH(sv_settings, start, mode, SV_MODE_ISO, SV_E_LIMIT);
    WITH(sv_settings, start, tone, 3, SV_E_ARGUMENT);
    WITH(sv_settings, start, exposure, 127.0, SV_E_ARGUMENT);
    WITH(sv_settings, start, exposure, NAN, SV_E_ARGUMENT);
    sv_settings toned = start;
    toned.tone = SV_TONE_NEUTRAL;
    WITH(sv_settings, toned, mode, SV_MODE_MIP, SV_E_UNSUPPORTED);
    WITH(sv_settings, toned, color_space, SV_COLOR_SPACE_DISPLAY, SV_E_UNSUPPORTED);
    WITH(sv_settings, start, depth_cue, 0.5, SV_E_UNSUPPORTED);
    WITH(sv_settings, start, depth_cue, 7.0, SV_OK);
    WITH(sv_settings, start, depth_cue, nan, SV_OK);
    WITH(sv_settings, start, has_exact_maximum, 1, SV_E_UNSUPPORTED);
    static const sv_clip_plane planes[] = {
        {{0, 0, 0}, 0}, {{NAN, 0, 1}, 0}, {{0, 0, 1}, INFINITY}, {{1e-200, 0, 0}, 0}, {{1e200, 0, 0}, 0}};
    for (int k = 0; k < 5; ++k) {
        sv_settings wrong = start;
        wrong.clip_planes = &planes[k], wrong.clip_plane_count = 1;
        BAD(SV_E_ARGUMENT, with(wrong));
        wrong.clip_plane_count = UINT64_MAX;
        BAD(SV_E_LIMIT, with(wrong));
    }
    static const sv_isosurface levels[] = {
        {NAN, {0, 0, 0}, 1}, {0, {0, 3, 0}, 1}, {0, {0, 0, NAN}, 1}, {0, {0, 0, 0}, 2}, {INFINITY, {0, 0, 0}, 0}};
    for (int k = 0; k < 5; ++k) {
        sv_settings wrong = start;
        wrong.mode = SV_MODE_ISO, wrong.levels = &levels[k], wrong.level_count = 1;
        BAD(SV_E_ARGUMENT, with(wrong));
        wrong.level_count = 1u << 30;
        BAD(SV_E_LIMIT, with(wrong));
    }
    static const sv_light lights[] = {
        {{0, 0, 0}, {1, 1, 1}}, {{NAN, 0, 0}, {1, 1, 1}}, {{1, 0, 0}, {2, 1, 1}}, {{1, 0, 0}, {NAN, 1, 1}}};
    for (int k = 0; k < 4; ++k) {
        sv_settings wrong = start;
        wrong.is_lit = 1, wrong.lights = &lights[k], wrong.light_count = 1;
        BAD(SV_E_ARGUMENT, with(wrong));
        wrong.light_count = 1000;
        BAD(SV_E_LIMIT, with(wrong));
    }
    sv_settings lit = start;
    lit.is_lit = 1;
    WITH(sv_settings, lit, ambient, -1.0, SV_E_ARGUMENT);
    WITH(sv_settings, lit, diffuse, nan, SV_E_ARGUMENT);
    WITH(sv_settings, lit, specular, inf, SV_E_ARGUMENT);
    WITH(sv_settings, lit, shininess, -3.0, SV_E_ARGUMENT);
    WITH(sv_settings, lit, mode, SV_MODE_MIP, SV_E_UNSUPPORTED);
    sv_settings sliced = start;
    sliced.technique = SV_TECHNIQUE_SLICES_3D;
    WITH(sv_settings, sliced, mode, SV_MODE_MIDA, SV_E_UNSUPPORTED);
    WITH(sv_settings, sliced, mode, SV_MODE_LMIP, SV_E_UNSUPPORTED);
    WITH(sv_settings, sliced, lattice, SV_LATTICE_JITTER, SV_E_UNSUPPORTED);
    WITH(sv_settings, sliced, lattice, SV_LATTICE_BRESENHAM, SV_E_UNSUPPORTED);
    sv_settings mida = start;
    mida.mode = SV_MODE_MIDA;
    WITH(sv_settings, mida, mida_gamma, 2.0, SV_E_ARGUMENT);
    WITH(sv_settings, mida, mida_gamma, nan, SV_E_ARGUMENT);
    WITH(sv_settings, mida, unit_values[0], 3.0, SV_E_ARGUMENT);
    WITH(sv_settings, mida, unit_values[1], inf, SV_E_ARGUMENT);
    mida.mode = SV_MODE_ATTENUATED_MIP;
    WITH(sv_settings, mida, attenuation, -1.0, SV_E_ARGUMENT);
    WITH(sv_settings, mida, attenuation, nan, SV_E_ARGUMENT);
    mida.mode = SV_MODE_LMIP, mida.has_lmip_threshold = 1;
    WITH(sv_settings, mida, lmip_threshold, nan, SV_E_ARGUMENT);
#undef with
    /* The volume's voxels are there, and not what these settings read. */
    sv_settings cubic = start;
    cubic.filter = SV_FILTER_CUBIC;
    sv_renderer_desc desc = renderer_desc();
    desc.settings = &cubic;
    sv_renderer made = 0;
    if (sv_renderer_create(device, &desc, &made, &diagnostic) == SV_OK) {
        BAD(SV_E_STATE, sv_renderer_record(made, cmd, &SHOT, &diagnostic));
        GOOD(sv_renderer_destroy(made, &diagnostic));
    } else {
        refused += 1;
    }
    cubic.filter = 0, cubic.technique = SV_TECHNIQUE_SLICES_2D;
    if (sv_renderer_create(device, &desc, &made, &diagnostic) == SV_OK) {
        BAD(SV_E_STATE, sv_renderer_record(made, cmd, &SHOT, &diagnostic));
        GOOD(sv_renderer_destroy(made, &diagnostic));
    } else {
        refused += 1;
    }
    const sv_settings many = {.struct_size = sizeof many, .samples_per_voxel = 1024.0};
    GOOD(sv_renderer_set_settings(renderer, &many, &diagnostic));
    GOOD(sv_renderer_set_settings(renderer, NULL, &diagnostic));
    BAD(SV_E_STATE, sv_renderer_set_settings(renderer, &sliced, &diagnostic));
    BAD(SV_E_STATE, sv_renderer_set_settings(renderer, &lit, &diagnostic));
}

static void renderers(void) {
    const sv_renderer_desc start = renderer_desc();
    const sv_depth_image image = {1, VK_IMAGE_LAYOUT_GENERAL, WIDTH, HEIGHT, 0};
#define with with_renderer
    WITH(sv_renderer_desc, start, target, NULL, SV_E_ARGUMENT);
    WITH(sv_renderer_desc, start, width, 0, SV_E_ARGUMENT);
    WITH(sv_renderer_desc, start, height, 0, SV_E_ARGUMENT);
    WITH(sv_renderer_desc, start, width, UINT32_MAX, SV_E_LIMIT);
    WITH(sv_renderer_desc, start, height, 1u << 20, SV_E_LIMIT);
    WITH(sv_renderer_desc, start, frames_in_flight, 65, SV_E_LIMIT);
    WITH(sv_renderer_desc, start, frames_in_flight, UINT32_MAX, SV_E_LIMIT);
    WITH(sv_renderer_desc, start, blends_slices_in_target, 1, SV_E_UNSUPPORTED);
    WITH(sv_renderer_desc, start, has_host_depth, 1, SV_E_ARGUMENT);
    WITH(sv_renderer_desc, start, gives_depth, 1, SV_E_ARGUMENT);
    WITH(sv_renderer_desc, start, depth_image_count, 1, SV_E_ARGUMENT);
    WITH(sv_renderer_desc, start, depth_image_count, UINT64_MAX, SV_E_ARGUMENT);
    sv_renderer_desc hidden = start;
    hidden.has_host_depth = 1, hidden.depth_images = &image;
    WITH(sv_renderer_desc, hidden, depth_image_count, 3, SV_OK);
    WITH(sv_renderer_desc, hidden, depth_image_count, 65, SV_E_LIMIT);
    hidden.depth_image_count = 1;
    const sv_depth_image wrong_images[] = {{0, VK_IMAGE_LAYOUT_GENERAL, WIDTH, HEIGHT, 0},
                                           {1, VK_IMAGE_LAYOUT_UNDEFINED, WIDTH, HEIGHT, 0},
                                           {1, 12345, WIDTH, HEIGHT, 0},
                                           {1, VK_IMAGE_LAYOUT_GENERAL, WIDTH - 1, HEIGHT, 0},
                                           {1, VK_IMAGE_LAYOUT_GENERAL, WIDTH, 0, 0}};
    for (int k = 0; k < 5; ++k) WITH(sv_renderer_desc, hidden, depth_images, &wrong_images[k], SV_E_ARGUMENT);
    const sv_depth_image later = {1, VK_IMAGE_LAYOUT_GENERAL, WIDTH, HEIGHT, 3};
    hidden.depth_images = &later;
    NAMED(SV_E_ARGUMENT, "sv_depth_image.reserved: wanted 0, found 3", with(hidden));
    sv_renderer_desc unhidden = start;
    unhidden.depth_image_count = 1;
    WITH(sv_renderer_desc, unhidden, depth_images, &image, SV_E_ARGUMENT);
#undef with
#define with with_class
    WITH(sv_target_class, CLASS, color_format, 0, SV_E_ARGUMENT);
    WITH(sv_target_class, CLASS, color_format, 185, SV_E_ARGUMENT);
    WITH(sv_target_class, CLASS, color_format, UINT32_MAX, SV_E_ARGUMENT);
    WITH(sv_target_class, CLASS, color_format, 1000156000u, SV_E_ARGUMENT);
    WITH(sv_target_class, CLASS, color_format, VK_FORMAT_D32_SFLOAT, SV_E_UNSUPPORTED);
    WITH(sv_target_class, CLASS, color_format, VK_FORMAT_R8G8B8A8_UINT, SV_E_UNSUPPORTED);
    WITH(sv_target_class, CLASS, color_format, VK_FORMAT_ASTC_4x4_UNORM_BLOCK, SV_E_UNSUPPORTED);
    WITH(sv_target_class, CLASS, samples, 3, SV_E_ARGUMENT);
    WITH(sv_target_class, CLASS, samples, 128, SV_E_ARGUMENT);
    WITH(sv_target_class, CLASS, samples, UINT32_MAX, SV_E_ARGUMENT);
    WITH(sv_target_class, CLASS, depth_format, VK_FORMAT_R8G8B8A8_UNORM, SV_E_ARGUMENT);
    WITH(sv_target_class, CLASS, depth_format, VK_FORMAT_S8_UINT, SV_E_ARGUMENT);
    WITH(sv_target_class, CLASS, depth_format, UINT32_MAX, SV_E_ARGUMENT);
#undef with
    BAD(SV_E_ARGUMENT, sv_renderer_resize(renderer, 0, 10, NULL, 0, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_renderer_resize(renderer, 10, 0, NULL, 0, &diagnostic));
    BAD(SV_E_LIMIT, sv_renderer_resize(renderer, UINT32_MAX, UINT32_MAX, NULL, 0, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_renderer_resize(renderer, 10, 10, NULL, 1, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_renderer_resize(renderer, WIDTH, HEIGHT, &image, 1, &diagnostic));
}

void abuse_pictures(void) {
    settings();
    renderers();
}
