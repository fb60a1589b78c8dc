/* Fields that are none, lines that are not there, shapes and marks that cannot be drawn. */
#include "abuse.h"

enum { SIDE = 4 };
static float velocities[SIDE * SIDE * SIDE * 3];
static const double SEEDS[] = {2, 2, 2, 9, 9, 9};

static sv_trace_desc trace_desc(void) {
    const sv_trace_desc made = {.struct_size = sizeof made,
                                .dims = {SIDE, SIDE, SIDE},
                                .velocities = velocities,
                                .velocity_count = SIDE * SIDE * SIDE * 3,
                                .seeds = SEEDS,
                                .seed_count = 2};
    return made;
}
static sv_status with_trace(sv_trace_desc desc) { return sv_trace(device, &desc, &made_handle, &diagnostic); }

/* Particles of dx/dt = 1 + t: x = t + t^2 / 2 from where they are let go. */
static double way(double from, double to) { return to - from + (to * to - from * from) / 2; }

static void paths(void) {
    static float numbers[2 * SIDE * SIDE * SIDE * 3];
    static const double TIMES[] = {0, 2}, BACK[] = {2, 0}, FROM[] = {0.25, 2, 2};
    for (int k = 0; k < SIDE * SIDE * SIDE; ++k) numbers[3 * k] = 1, numbers[3 * (SIDE * SIDE * SIDE + k)] = 3;
    sv_trace_desc start = trace_desc();
    start.velocities = numbers, start.velocity_count *= 2, start.times = TIMES, start.time_count = 2;
    start.seeds = FROM, start.seed_count = 1, start.kind = SV_LINE_KIND_PATH, start.direction = SV_DIRECTION_FORWARD;
#define with with_trace
    WITH(sv_trace_desc, start, kind, 3, SV_E_ARGUMENT);
    WITH(sv_trace_desc, start, time_count, 1, SV_E_ARGUMENT);
    WITH(sv_trace_desc, start, time_count, UINT32_MAX, SV_E_ARGUMENT);
    WITH(sv_trace_desc, start, times, NULL, SV_E_ARGUMENT);
    WITH(sv_trace_desc, start, times, BACK, SV_E_ARGUMENT);
    WITH(sv_trace_desc, start, start, 2.5, SV_E_ARGUMENT);
    WITH(sv_trace_desc, start, seeds, NULL, SV_E_ARGUMENT);
    sv_trace_desc still = trace_desc();
    WITH(sv_trace_desc, still, kind, SV_LINE_KIND_STREAK, SV_E_ARGUMENT);
    sv_trace_desc smoke = start;
    smoke.kind = SV_LINE_KIND_STREAK, smoke.end = 1;
    WITH(sv_trace_desc, smoke, end, NAN, SV_E_ARGUMENT);
    WITH(sv_trace_desc, smoke, end, 2.5, SV_E_ARGUMENT);
#undef with
    for (int k = 0; k < 2; ++k) {
        sv_lines found = 0;
        double places[3 * 64], values[2 * 64];
        uint64_t count = 64, breaks = 64;
        GOOD(sv_trace(device, k ? &smoke : &start, &found, &diagnostic));
        GOOD(sv_lines_positions(found, 0, places, &count, &diagnostic));
        GOOD(sv_lines_values(found, 0, values, &count, &diagnostic));
        GOOD(sv_lines_breaks(found, 0, NULL, &breaks, &diagnostic));
        /* A path goes on to the face; the oldest particle of a streak comes first. */
        int is_right = count > 3 && breaks == 0 && (k ? values[0] == 0 : places[3 * (count - 1)] > 3.99);
        for (uint64_t i = 0; i < count; ++i) {
            const double t = values[2 * i], wanted = 0.25 + (k ? way(t, 1) : way(0, t));
            is_right &= fabs(places[3 * i] - wanted) < 1e-9 && places[3 * i + 1] == 2;
        }
        if (!is_right) failures += 1, fprintf(stderr, "FAILED: other particles\n");
        GOOD(sv_lines_destroy(found, &diagnostic));
    }
}

static void lines(void) {
    for (int k = 0; k < SIDE * SIDE * SIDE; ++k) velocities[3 * k] = 2.0f;
    const sv_trace_desc start = trace_desc();
    const double nan = NAN;
#define with with_trace
    WITH(sv_trace_desc, start, dims[1], 0, SV_E_ARGUMENT);
    WITH(sv_trace_desc, start, dims[1], 5, SV_E_ARGUMENT);
    WITH(sv_trace_desc, start, dims[2], UINT32_MAX, SV_E_ARGUMENT);
    WITH(sv_trace_desc, start, direction, 3, SV_E_ARGUMENT);
    WITH(sv_trace_desc, start, velocities, NULL, SV_E_ARGUMENT);
    WITH(sv_trace_desc, start, velocity_count, 0, SV_E_ARGUMENT);
    WITH(sv_trace_desc, start, velocity_count, UINT64_MAX, SV_E_ARGUMENT);
    WITH(sv_trace_desc, start, world_from_voxel[0], 1.0, SV_E_ARGUMENT);
    WITH(sv_trace_desc, start, world_from_voxel[15], nan, SV_E_ARGUMENT);
    WITH(sv_trace_desc, start, seed_count, UINT64_MAX, SV_E_LIMIT);
    WITH(sv_trace_desc, start, length, -1.0, SV_E_ARGUMENT);
    WITH(sv_trace_desc, start, duration, nan, SV_E_ARGUMENT);
    WITH(sv_trace_desc, start, tolerance, INFINITY, SV_E_ARGUMENT);
    sv_trace_desc even = start;
    even.seeds = NULL;
    WITH(sv_trace_desc, even, seed_count, 2, SV_E_ARGUMENT);
    even.seed_count = 0;
    WITH(sv_trace_desc, even, spacing, -1.0, SV_E_ARGUMENT);
    static const double no_place[] = {1, NAN, 1};
    sv_trace_desc nowhere = start;
    nowhere.seeds = no_place, nowhere.seed_count = 1;
    NAMED(SV_E_ARGUMENT, "sv_trace_desc.seeds", with(nowhere));
#undef with
    BAD(SV_E_ARGUMENT, sv_trace(device, &start, NULL, &diagnostic));
    sv_lines found = 0;
    uint64_t count = 0;
    uint32_t causes[2];
    double places[3 * 64];
    GOOD(sv_trace(device, &start, &found, &diagnostic));
    GOOD(sv_lines_count(found, &count, &diagnostic));
    /* Along x from face to face; nothing where the second seed is. */
    GOOD(sv_lines_cause(found, 0, causes, &diagnostic));
    uint64_t vertices[2];
    for (int line = 0; line < 2; ++line) GOOD(sv_lines_positions(found, line, NULL, &vertices[line], &diagnostic));
    const int is_right = count == 2 && causes[0] == SV_CAUSE_DOMAIN && causes[1] == SV_CAUSE_DOMAIN &&
                         vertices[0] > 3 && vertices[0] < 64 && vertices[1] == 0;
    if (!is_right) failures += 1, fprintf(stderr, "FAILED: other lines than wanted\n");
    uint64_t room = vertices[0];
    GOOD(sv_lines_positions(found, 0, places, &room, &diagnostic));
    const double *last = &places[3 * (room - 1)];
    if (places[0] > 0.01 || last[0] < 3.99 || last[1] != 2.0) failures += 1, fprintf(stderr, "FAILED: other places\n");
    room = vertices[0] - 1;
    BAD(SV_E_LIMIT, sv_lines_positions(found, 0, places, &room, &diagnostic));
    BAD(SV_E_LIMIT, sv_lines_values(found, 0, places, &room, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_lines_positions(found, 0, places, NULL, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_lines_positions(found, 2, places, &room, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_lines_values(found, UINT64_MAX, places, &room, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_lines_cause(found, 2, causes, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_lines_cause(found, 0, NULL, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_lines_count(found, NULL, &diagnostic));
    GOOD(sv_lines_destroy(found, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_lines_count(found, &count, &diagnostic));
}

static const sv_target_class WITH_DEPTH = {.struct_size = sizeof(sv_target_class),
                                           .color_format = FORMAT,
                                           .depth_format = VK_FORMAT_D32_SFLOAT};
static const sv_round_cone CONE = {.second = {1, 0, 0}, .first_radius = 1, .second_radius = 1};
static const sv_triangle TRIANGLE = {.corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};

static sv_geometry_desc geometry_desc(void) {
    const sv_geometry_desc made = {.struct_size = sizeof made,
                                   .target = &WITH_DEPTH,
                                   .cones = &CONE,
                                   .cone_count = 1,
                                   .triangles = &TRIANGLE,
                                   .triangle_count = 1};
    return made;
}
static sv_status with_geometry(sv_geometry_desc desc) {
    return sv_geometry_create(device, &desc, &made_handle, &diagnostic);
}
static sv_status with_cone(sv_round_cone cone) {
    sv_geometry_desc desc = geometry_desc();
    desc.cones = &cone;
    return with_geometry(desc);
}
static sv_status with_triangle(sv_triangle triangle) {
    sv_geometry_desc desc = geometry_desc();
    desc.triangles = &triangle;
    return with_geometry(desc);
}

static void shapes(void) {
    const sv_geometry_desc start = geometry_desc();
#define with with_geometry
    WITH(sv_geometry_desc, start, target, NULL, SV_E_ARGUMENT);
    WITH(sv_geometry_desc, start, target, &CLASS, SV_E_ARGUMENT);
    WITH(sv_geometry_desc, start, color_space, 2, SV_E_ARGUMENT);
    WITH(sv_geometry_desc, start, frames_in_flight, 65, SV_E_LIMIT);
    WITH(sv_geometry_desc, start, cones, NULL, SV_E_ARGUMENT);
    WITH(sv_geometry_desc, start, cone_count, UINT64_MAX, SV_E_LIMIT);
    WITH(sv_geometry_desc, start, triangles, NULL, SV_E_ARGUMENT);
    WITH(sv_geometry_desc, start, triangle_count, UINT64_MAX, SV_E_LIMIT);
#undef with
#define with with_cone
    WITH(sv_round_cone, CONE, first_radius, 0, SV_E_ARGUMENT);
    WITH(sv_round_cone, CONE, second_radius, -1, SV_E_ARGUMENT);
    WITH(sv_round_cone, CONE, second_radius, NAN, SV_E_ARGUMENT);
    WITH(sv_round_cone, CONE, first_radius, 1e-60, SV_E_ARGUMENT);
    WITH(sv_round_cone, CONE, first[2], NAN, SV_E_ARGUMENT);
    WITH(sv_round_cone, CONE, second[0], 1e300, SV_E_ARGUMENT);
    WITH(sv_round_cone, CONE, first_color[1], NAN, SV_E_ARGUMENT);
#undef with
#define with with_triangle
    WITH(sv_triangle, TRIANGLE, corners[1][1], INFINITY, SV_E_ARGUMENT);
    WITH(sv_triangle, TRIANGLE, colors[2][0], NAN, SV_E_ARGUMENT);
    WITH(sv_triangle, TRIANGLE, reserved, 7, SV_E_ARGUMENT);
#undef with
    BAD(SV_E_ARGUMENT, sv_geometry_create(device, &start, NULL, &diagnostic));
    sv_geometry made = 0;
    GOOD(sv_geometry_create(device, &start, &made, &diagnostic));
    sv_camera camera = {.struct_size = sizeof camera, .kind = SV_CAMERA_LOOK_AT};
    sv_frame_info shot = {.struct_size = sizeof shot, .camera = &camera};
    NAMED(SV_E_ARGUMENT, "SV_CAMERA_MATRICES", sv_geometry_draw(made, cmd, &shot, WIDTH, HEIGHT, &diagnostic));
    camera.kind = SV_CAMERA_MATRICES;
    BAD(SV_E_ARGUMENT, sv_geometry_draw(made, cmd, &shot, WIDTH, HEIGHT, &diagnostic));
    camera.view_from_world[0] = camera.view_from_world[5] = camera.view_from_world[10] = camera.view_from_world[15] = 1.0;
    camera.clip_from_view[0] = camera.clip_from_view[5] = 1.0, camera.clip_from_view[10] = -1.01;
    camera.clip_from_view[11] = -1.0, camera.clip_from_view[14] = -1.0;
    BAD(SV_E_STATE, sv_geometry_draw(made, cmd, &shot, WIDTH, HEIGHT, &diagnostic));
    VkCommandBuffer uploads = host_begin(&h);
    GOOD(sv_geometry_record_upload(made, uploads, &diagnostic));
    BAD(SV_E_STATE, sv_geometry_record_upload(made, uploads, &diagnostic));
    host_submit_and_wait(&h, uploads);
    BAD(SV_E_ARGUMENT, sv_geometry_record_upload(made, NULL, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_geometry_draw(made, NULL, &shot, WIDTH, HEIGHT, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_geometry_draw(made, cmd, NULL, WIDTH, HEIGHT, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_geometry_draw(made, cmd, &shot, 0, HEIGHT, &diagnostic));
    BAD(SV_E_LIMIT, sv_geometry_draw(made, cmd, &shot, WIDTH, UINT32_MAX, &diagnostic));
    shot.frame = 1;
    BAD(SV_E_ARGUMENT, sv_geometry_draw(made, cmd, &shot, WIDTH, HEIGHT, &diagnostic));
    shot.frame = 0, camera.is_reversed = 1;
    BAD(SV_E_ARGUMENT, sv_geometry_draw(made, cmd, &shot, WIDTH, HEIGHT, &diagnostic));
    GOOD(sv_geometry_destroy(made, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_geometry_draw(made, cmd, &shot, WIDTH, HEIGHT, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_geometry_destroy(made, &diagnostic));
}

enum { ACROSS = 160, DOWN = 120, NUMBERS = ACROSS * DOWN * 4 };
static float marks[NUMBERS];

static sv_overlay_desc overlay_desc(sv_transfer_function colors) {
    const sv_overlay_desc made = {.struct_size = sizeof made,
                                  .width = ACROSS,
                                  .height = DOWN,
                                  .marks = "bar,time,scale,axes,box,title=Storm",
                                  .dims = {VOXELS, VOXELS, VOXELS},
                                  .function = colors,
                                  .caption = "Vapour",
                                  .unit = "g kg-1",
                                  .time = "2005-08-28T12:00:00",
                                  .length_metres = 1000.0};
    return made;
}
static sv_status with_overlay(sv_overlay_desc desc) { return sv_overlay_rgba(device, &desc, marks, NUMBERS, &diagnostic); }

/* How many pixels are covered; -1 where one is no colour. */
static int covered(void) {
    int found = 0;
    for (int k = 0; k < NUMBERS; k += 4) {
        const float a = marks[k + 3];
        for (int c = 0; c < 4; ++c)
            if (!(marks[k + c] >= 0.0f && marks[k + c] <= a + 1e-6f && a <= 1.0f)) return -1;
        found += a > 0.5f;
    }
    return found;
}
static void is_covered(int least, int most, const char *what) {
    const int found = covered();
    if (found < least || found > most) failures += 1, fprintf(stderr, "FAILED: %s covers %d pixels\n", what, found);
}

static void overlay(void) {
    const sv_color_point colors[] = {{0.0, {0.0, 0.2, 1.0}}, {2.0, {1.0, 0.4, 0.0}}};
    const sv_opacity_point opacities[] = {{0.0, 0.0}, {2.0, 0.5}};
    const sv_transfer_function_desc points = {.struct_size = sizeof points,
                                              .colors = colors,
                                              .color_count = 2,
                                              .opacities = opacities,
                                              .opacity_count = 2};
    sv_transfer_function ramp = 0;
    GOOD(sv_transfer_function_create(device, &points, &ramp, &diagnostic));
    const sv_overlay_desc start = overlay_desc(ramp);
    static float light[NUMBERS];
    for (int k = 0; k < NUMBERS; ++k) light[k] = 1.0f;
#define with with_overlay
    WITH(sv_overlay_desc, start, width, 0, SV_E_ARGUMENT);
    WITH(sv_overlay_desc, start, width, 16385, SV_E_LIMIT);
    WITH(sv_overlay_desc, start, height, DOWN - 1, SV_E_ARGUMENT);
    WITH(sv_overlay_desc, start, height, UINT32_MAX, SV_E_LIMIT);
    WITH(sv_overlay_desc, start, dims[1], 0, SV_E_ARGUMENT);
    WITH(sv_overlay_desc, start, world_from_voxel[5], NAN, SV_E_ARGUMENT);
    WITH(sv_overlay_desc, start, length_metres, -1.0, SV_E_ARGUMENT);
    WITH(sv_overlay_desc, start, height_factor, INFINITY, SV_E_ARGUMENT);
    WITH(sv_overlay_desc, start, text_pixels, NAN, SV_E_ARGUMENT);
    WITH(sv_overlay_desc, start, text_pixels, 1e9, SV_E_ARGUMENT);
    WITH(sv_overlay_desc, start, color[1], 1.5, SV_E_ARGUMENT);
    WITH(sv_overlay_desc, start, reserved, 1, SV_E_ARGUMENT);
    WITH(sv_overlay_desc, start, under_count, NUMBERS, SV_E_ARGUMENT);
    WITH(sv_overlay_desc, start, function, 77, SV_E_ARGUMENT);
    WITH(sv_overlay_desc, start, caption, "\xff", SV_E_ARGUMENT);
    WITH(sv_overlay_desc, start, is_logarithmic, 1, SV_E_ARGUMENT);
    sv_overlay_desc wrong = start;
    wrong.under = light, wrong.under_count = NUMBERS - 4;
    NAMED(SV_E_ARGUMENT, "under_count", with(wrong));
    wrong = start, wrong.marks = "barr";
    NAMED(SV_E_ARGUMENT, "sv_overlay_desc.marks", with(wrong));
    wrong = start, wrong.marks = "title=\xd0\x96";
    NAMED(SV_E_ARGUMENT, "no letter", with(wrong));
    BAD(SV_E_ARGUMENT, sv_overlay_rgba(device, &start, NULL, NUMBERS, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_overlay_rgba(device, NULL, marks, NUMBERS, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_overlay_rgba(0, &start, marks, NUMBERS, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_overlay_rgba(device, &start, marks, NUMBERS - 1, &diagnostic));
    GOOD(with(start));
    is_covered(800, NUMBERS / 8, "all marks");
    /* Ink on the dark is light, with a dark halo around it, and on the light it is dark with a light one. */
    sv_overlay_desc title = start;
    title.marks = "title=Storm";
    float rim[2] = {0.0f, 0.0f};
    for (int k = 0; k < 2; ++k) {
        title.under = k ? light : NULL, title.under_count = k ? NUMBERS : 0;
        GOOD(with(title));
        is_covered(100, 2000, "a title");
        /* Where a row meets the title it meets the halo. */
        float sum = 0.0f, pixels = 0.0f;
        for (int i = 4; i < NUMBERS; i += 4)
            if (marks[i + 3] > 0.1f && marks[i - 1] == 0.0f) sum += marks[i] / marks[i + 3], pixels += 1.0f;
        rim[k] = sum / pixels;
    }
    if (!(rim[0] < 0.1f && rim[1] > 0.9f)) failures += 1, fprintf(stderr, "FAILED: rims of %g and %g\n", rim[0], rim[1]);
    sv_overlay_desc bare = {.struct_size = sizeof bare, .width = ACROSS, .height = DOWN, .dims = {1, 1, 1}};
    GOOD(with(bare));
    bare.function = function;
    GOOD(with(bare));
#undef with
    GOOD(sv_transfer_function_destroy(ramp, &diagnostic));
    BAD(SV_E_ARGUMENT, with_overlay(start));
}

void abuse_geometry(void) {
    lines();
    paths();
    shapes();
    overlay();
}
