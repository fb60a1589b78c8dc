/* Devices, volumes and functions of numbers that mean nothing. */
#include "abuse.h"

static sv_status with_host(sv_host_device wanted) { return sv_device_from_host(&wanted, &made_handle, &diagnostic); }
static sv_status with_volume(sv_volume_desc desc) {
    return sv_volume_create(device, &desc, &made_handle, &diagnostic);
}
static sv_status with_function(sv_transfer_function_desc desc) {
    return sv_transfer_function_create(device, &desc, &made_handle, &diagnostic);
}
static sv_status h_of_volume(uint64_t x) {
    sv_renderer_desc desc = renderer_desc();
    desc.volume = x;
    return sv_renderer_create(device, &desc, &made_handle, &diagnostic);
}

static void null_pointers(void) {
    const sv_volume_desc desc = volume_desc();
    const sv_renderer_desc wanted = renderer_desc();
    const sv_transfer_function_desc points = {.struct_size = sizeof points};
    const sv_target target = whole_target();
    const sv_submission s = submission();
    BAD(SV_E_ARGUMENT, sv_device_from_host(&ours, NULL, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_volume_create(device, &desc, NULL, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_transfer_function_create(device, &points, NULL, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_renderer_create(device, &wanted, NULL, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_submitter_create(device, 1, NULL, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_device_pipelines_made(device, NULL, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_device_pipeline_cache(device, NULL, NULL, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_volume_value_range(volume, NULL, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_volume_record_upload(fresh, NULL, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_renderer_record(renderer, NULL, &SHOT, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_renderer_draw(renderer, NULL, 0, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_renderer_draw_depth(renderer, NULL, 0, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_renderer_record_into(renderer, NULL, &SHOT, &target, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_renderer_record_pick(renderer, NULL, 0, 0, 0, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_submitter_submit(submitter, renderer, NULL, &target, &s, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_submitter_submit(submitter, renderer, &SHOT, NULL, &s, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_submitter_upload(submitter, fresh, 0, NULL, &diagnostic));
    uint64_t room = 1;
    uint8_t byte;
    BAD(SV_E_LIMIT, sv_device_pipeline_cache(device, &room, &byte, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_volume_create(device, &desc, (sv_volume *)((char *)&made_handle + 1), &diagnostic));
}

static void devices(void) {
#define with with_host
    WITH(sv_host_device, ours, instance, NULL, SV_E_ARGUMENT);
    WITH(sv_host_device, ours, physical_device, NULL, SV_E_ARGUMENT);
    WITH(sv_host_device, ours, device, NULL, SV_E_ARGUMENT);
    WITH(sv_host_device, ours, get_instance_proc_addr, NULL, SV_E_ARGUMENT);
    WITH(sv_host_device, ours, features, 0, SV_E_UNSUPPORTED);
    WITH(sv_host_device, ours, features, SV_FEATURE_DYNAMIC_RENDERING, SV_E_UNSUPPORTED);
    WITH(sv_host_device, ours, features, SV_FEATURE_SYNCHRONIZATION2, SV_E_UNSUPPORTED);
    WITH(sv_host_device, ours, features, 64, SV_E_ARGUMENT);
    WITH(sv_host_device, ours, features, UINT32_MAX, SV_E_ARGUMENT);
    WITH(sv_host_device, ours, api_version, VK_API_VERSION_1_2, SV_E_UNSUPPORTED);
    WITH(sv_host_device, ours, api_version, 1, SV_E_UNSUPPORTED);
    WITH(sv_host_device, ours, queue_family, 99, SV_E_UNSUPPORTED);
    WITH(sv_host_device, ours, queue_family, UINT32_MAX, SV_E_UNSUPPORTED);
    WITH(sv_host_device, ours, pipeline_cache_bytes, 5, SV_E_ARGUMENT);
    WITH(sv_host_device, ours, pipeline_cache_bytes, UINT64_MAX, SV_E_ARGUMENT);
#undef with
    BAD(SV_E_ARGUMENT, sv_device_retire(device, 1000, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_device_retire(device, UINT64_MAX, &diagnostic));
    GOOD(sv_device_announce(device, 5, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_device_announce(device, 4, &diagnostic));
    /* Without the feature, nothing is submitted. */
    sv_host_device plain = ours;
    plain.features = SV_FEATURE_DYNAMIC_RENDERING | SV_FEATURE_SYNCHRONIZATION2;
    sv_device without = 0;
    GOOD(sv_device_from_host(&plain, &without, &diagnostic));
    BAD(SV_E_UNSUPPORTED, sv_submitter_create(without, 1, &made_handle, &diagnostic));
    GOOD(sv_device_destroy(without, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_device_destroy(without, &diagnostic));
    BAD(SV_E_LIMIT, sv_submitter_create(device, 65, &made_handle, &diagnostic));
    BAD(SV_E_LIMIT, sv_submitter_create(device, UINT32_MAX, &made_handle, &diagnostic));
}

static void volumes(void) {
    const sv_volume_desc start = volume_desc();
#define with with_volume
    for (int axis = 0; axis < 3; ++axis) {
        WITH(sv_volume_desc, start, dims[axis], 0, SV_E_ARGUMENT);
        WITH(sv_volume_desc, start, dims[axis], 9, SV_E_ARGUMENT);
        WITH(sv_volume_desc, start, dims[axis], UINT32_MAX, SV_OK);
    }
    sv_volume_desc huge = start;
    huge.dims[0] = huge.dims[1] = huge.dims[2] = UINT32_MAX;
    BAD(SV_E_LIMIT, with(huge));
    huge.voxel_bytes = UINT64_MAX;
    BAD(SV_E_LIMIT, with(huge));
    huge.dims[0] = huge.dims[1] = 1u << 31, huge.dims[2] = 4, huge.voxel_bytes = 0;
    BAD(SV_E_LIMIT, with(huge));
    WITH(sv_volume_desc, start, voxel_type, 9, SV_E_ARGUMENT);
    WITH(sv_volume_desc, start, voxel_type, UINT32_MAX, SV_E_ARGUMENT);
    WITH(sv_volume_desc, start, voxel_type, SV_VOXEL_F32, SV_E_ARGUMENT);
    WITH(sv_volume_desc, start, voxels, NULL, SV_E_ARGUMENT);
    WITH(sv_volume_desc, start, voxel_bytes, 0, SV_E_ARGUMENT);
    WITH(sv_volume_desc, start, voxel_bytes, sizeof voxels - 1, SV_E_ARGUMENT);
    WITH(sv_volume_desc, start, voxel_bytes, UINT64_MAX, SV_E_ARGUMENT);
    WITH(sv_volume_desc, start, slope, (double)NAN, SV_E_ARGUMENT);
    WITH(sv_volume_desc, start, slope, (double)INFINITY, SV_E_ARGUMENT);
    WITH(sv_volume_desc, start, slope, 1e-310, SV_E_ARGUMENT);
    WITH(sv_volume_desc, start, intercept, (double)NAN, SV_E_ARGUMENT);
    WITH(sv_volume_desc, start, intercept, -(double)INFINITY, SV_E_ARGUMENT);
    WITH(sv_volume_desc, start, slope, 1.7e308, SV_E_ARGUMENT);
    /* A matrix of one number, of numbers that are none, of a last row that is none. */
    WITH(sv_volume_desc, start, world_from_voxel[0], 1.0, SV_E_ARGUMENT);
    WITH(sv_volume_desc, start, world_from_voxel[15], 1.0, SV_E_ARGUMENT);
    WITH(sv_volume_desc, start, world_from_voxel[5], (double)NAN, SV_E_ARGUMENT);
    sv_volume_desc placed = start;
    placed.world_from_voxel[0] = placed.world_from_voxel[5] = placed.world_from_voxel[10] = 1.0;
    placed.world_from_voxel[15] = 1.0;
    WITH(sv_volume_desc, placed, world_from_voxel[3], 0.5, SV_E_ARGUMENT);
    WITH(sv_volume_desc, placed, world_from_voxel[10], 0.0, SV_E_ARGUMENT);
    WITH(sv_volume_desc, placed, world_from_voxel[12], (double)INFINITY, SV_E_ARGUMENT);
    WITH(sv_volume_desc, placed, world_from_voxel[15], 2.0, SV_E_ARGUMENT);
    const sv_settings unknown = {.struct_size = sizeof unknown, .filter = 70};
    WITH(sv_volume_desc, start, settings, &unknown, SV_E_ARGUMENT);
#undef with
    BAD(SV_E_STATE, sv_volume_record_upload(volume, cmd, &diagnostic));
    BAD(SV_E_STATE, h_of_volume(fresh));
    BAD(SV_E_STATE, sv_renderer_set_volume(renderer, fresh, 0, &diagnostic));
    const sv_submission s = submission();
    BAD(SV_E_STATE, sv_submitter_upload(submitter, volume, 0, &s, &diagnostic));
}

static sv_status with_update(sv_update_desc desc) {
    return sv_volume_stage_update(volume, &desc, &made_handle, &diagnostic);
}

static void updates(void) {
    const sv_update_desc start = update_desc();
#define with with_update
    for (int axis = 0; axis < 3; ++axis) {
        WITH(sv_update_desc, start, extent[axis], 0, SV_E_ARGUMENT);
        WITH(sv_update_desc, start, extent[axis], VOXELS + 1, SV_E_ARGUMENT);
        WITH(sv_update_desc, start, extent[axis], UINT32_MAX, SV_E_ARGUMENT);
        WITH(sv_update_desc, start, origin[axis], 1, SV_E_ARGUMENT);
        WITH(sv_update_desc, start, origin[axis], UINT32_MAX, SV_E_ARGUMENT);
    }
    WITH(sv_update_desc, start, voxels, NULL, SV_E_ARGUMENT);
    WITH(sv_update_desc, start, voxel_bytes, 0, SV_E_ARGUMENT);
    WITH(sv_update_desc, start, voxel_bytes, sizeof voxels - 1, SV_E_ARGUMENT);
    WITH(sv_update_desc, start, voxel_bytes, UINT64_MAX, SV_E_ARGUMENT);
#undef with
    BAD(SV_E_ARGUMENT, sv_volume_stage_update(volume, &start, NULL, &diagnostic));
    BAD(SV_E_STATE, sv_volume_stage_update(fresh, &start, &made_handle, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_volume_record_update(volume, NULL, staged, &diagnostic));
    /* Ranges that hold not all values, or are none. */
    sv_volume_desc ranged = volume_desc();
    ranged.has_value_range = 1;
#define with with_volume
    WITH(sv_volume_desc, ranged, value_range[1], 10.0, SV_E_ARGUMENT);
    ranged.value_range[1] = 255.0;
    WITH(sv_volume_desc, ranged, value_range[0], 3.0, SV_E_ARGUMENT);
    WITH(sv_volume_desc, ranged, value_range[0], (double)NAN, SV_E_ARGUMENT);
    WITH(sv_volume_desc, ranged, value_range[1], (double)INFINITY, SV_E_ARGUMENT);
    WITH(sv_volume_desc, ranged, reserved, 1, SV_E_ARGUMENT);
#undef with
}

static void plans_and_requirements(void) {
    sv_plan plan = {.struct_size = sizeof plan};
    sv_volume_desc desc = volume_desc();
    desc.dims[1] = 0;
    BAD(SV_E_ARGUMENT, sv_volume_plan(device, &desc, &plan, &diagnostic));
    /* More bricks than there is memory for their list. */
    for (unsigned most = 1u << 22; most; most = most == UINT32_MAX ? 0 : UINT32_MAX) {
        desc.dims[0] = desc.dims[1] = desc.dims[2] = most;
        BAD(SV_E_ARGUMENT, sv_volume_plan(device, &desc, &plan, &diagnostic));
    }
    desc.dims[1] = 8, desc.voxel_type = 77;
    BAD(SV_E_ARGUMENT, sv_volume_plan(device, &desc, &plan, &diagnostic));
    uint64_t count = 3;
    sv_requirement few[3];
    BAD(SV_E_LIMIT, sv_requirements(few, &count, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_requirements(few, NULL, &diagnostic));
    count = 3;
    BAD(SV_E_LIMIT, sv_check_device(&ours, few, &count, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_check_device(&ours, few, NULL, &diagnostic));
    sv_host_device wrong = ours;
    wrong.instance = NULL;
    BAD(SV_E_ARGUMENT, sv_check_device(&wrong, few, &count, &diagnostic));
    wrong = ours, wrong.physical_device = NULL;
    BAD(SV_E_ARGUMENT, sv_check_device(&wrong, few, &count, &diagnostic));
    wrong = ours, wrong.get_instance_proc_addr = NULL;
    BAD(SV_E_ARGUMENT, sv_check_device(&wrong, few, &count, &diagnostic));
    wrong = ours, wrong.features = 64;
    BAD(SV_E_ARGUMENT, sv_check_device(&wrong, few, &count, &diagnostic));
}

static void parts(void) {
    const sv_target target = whole_target();
    const sv_submission s = submission();
    uint64_t blocks = 0;
    uint32_t done = 0;
    BAD(SV_E_ARGUMENT, sv_renderer_begin_parts(renderer, &SHOT, NULL, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_renderer_begin_parts(renderer, NULL, &blocks, &diagnostic));
    BAD(SV_E_STATE, sv_renderer_record_part_into(renderer, cmd, 0, 1, &target, &blocks, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_renderer_record_part_into(renderer, cmd, 7, 1, &target, &blocks, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_renderer_record_part_into(renderer, cmd, 0, 1, &target, NULL, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_renderer_record_part_into(renderer, NULL, 0, 1, &target, &blocks, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_submitter_submit_in_parts(submitter, renderer, &SHOT, &target, &s, NULL, NULL, &diagnostic));
    const double wrong[] = {-1.0, (double)NAN, (double)INFINITY};
    for (int k = 0; k < 3; ++k) {
        const sv_pacing pacing = {.struct_size = sizeof pacing, .target_ms = wrong[k]};
        BAD(SV_E_ARGUMENT,
            sv_submitter_submit_in_parts(submitter, renderer, &SHOT, &target, &s, &pacing, &done, &diagnostic));
    }
    sv_target kept = target;
    kept.is_cleared = 0;
    BAD(SV_E_ARGUMENT, sv_submitter_submit_in_parts(submitter, renderer, &SHOT, &kept, &s, NULL, &done, &diagnostic));
}

static void functions(void) {
    static const sv_color_point colors[] = {{0, {0, 0, 0}}, {1, {1, 1, 1}}};
    static const sv_opacity_point opacities[] = {{0, 0}, {1, 1}};
    const sv_transfer_function_desc start = {.struct_size = sizeof start,
                                    .colors = colors,
                                    .color_count = 2,
                                    .opacities = opacities,
                                    .opacity_count = 2};
#define with with_function
    WITH(sv_transfer_function_desc, start, colors, NULL, SV_E_ARGUMENT);
    WITH(sv_transfer_function_desc, start, opacities, NULL, SV_E_ARGUMENT);
    WITH(sv_transfer_function_desc, start, color_count, 4097, SV_E_LIMIT);
    WITH(sv_transfer_function_desc, start, color_count, UINT64_MAX, SV_E_LIMIT);
    WITH(sv_transfer_function_desc, start, opacity_count, UINT64_MAX / 16, SV_E_LIMIT);
    WITH(sv_transfer_function_desc, start, reference_length, -1.0, SV_E_ARGUMENT);
    WITH(sv_transfer_function_desc, start, reference_length, (double)NAN, SV_E_ARGUMENT);
    WITH(sv_transfer_function_desc, start, reference_length, (double)INFINITY, SV_E_ARGUMENT);
    WITH(sv_transfer_function_desc, start, colors, (const sv_color_point *)((const char *)colors + 1), SV_E_ARGUMENT);
    static const sv_medium_point matter[] = {{0, {0, 0, 0}}, {1, {1, 0.5, 0.25}}};
    sv_transfer_function_desc medium = start;
    medium.opacities = NULL;
    medium.opacity_count = 0;
    medium.extinctions = medium.albedos = medium.emissions = matter;
    medium.extinction_count = medium.albedo_count = medium.emission_count = 2;
    GOOD(with_function(medium));
    GOOD(sv_transfer_function_destroy(made_handle, &diagnostic));
    WITH(sv_transfer_function_desc, medium, extinctions, NULL, SV_E_ARGUMENT);
    WITH(sv_transfer_function_desc, medium, albedos, NULL, SV_E_ARGUMENT);
    WITH(sv_transfer_function_desc, medium, emissions, NULL, SV_E_ARGUMENT);
    WITH(sv_transfer_function_desc, medium, extinction_count, 4097, SV_E_LIMIT);
    WITH(sv_transfer_function_desc, medium, emission_count, UINT64_MAX, SV_E_LIMIT);
    sv_transfer_function_desc both = medium;
    both.opacities = opacities;
    both.opacity_count = 2;
    BAD(SV_E_ARGUMENT, with_function(both));
    static const sv_medium_point wrong_matter[][2] = {{{1, {0, 0, 0}}, {0, {0, 0, 0}}},
                                                      {{0, {0, 0, 0}}, {1, {0, -1, 0}}},
                                                      {{0, {0, 0, 0}}, {1, {0, 0, NAN}}},
                                                      {{0, {0, INFINITY, 0}}, {1, {0, 0, 0}}}};
    for (size_t k = 0; k < sizeof wrong_matter / sizeof *wrong_matter; ++k) {
        WITH(sv_transfer_function_desc, medium, extinctions, wrong_matter[k], SV_E_ARGUMENT);
        WITH(sv_transfer_function_desc, medium, albedos, wrong_matter[k], SV_E_ARGUMENT);
        WITH(sv_transfer_function_desc, medium, emissions, wrong_matter[k], SV_E_ARGUMENT);
    }
    static const sv_medium_point too_bright[] = {{0, {0, 0, 0}}, {1, {0, 1.5, 0}}};
    WITH(sv_transfer_function_desc, medium, albedos, too_bright, SV_E_ARGUMENT);
    static const sv_color_point wrong_colors[][2] = {{{1, {0, 0, 0}}, {0, {0, 0, 0}}},
                                                     {{0, {0, 0, 0}}, {NAN, {0, 0, 0}}},
                                                     {{0, {0, 0, 0}}, {INFINITY, {0, 0, 0}}},
                                                     {{0, {0, 0, 0}}, {1, {0, 2, 0}}},
                                                     {{0, {0, 0, 0}}, {1, {-0.1, 0, 0}}},
                                                     {{0, {0, NAN, 0}}, {1, {0, 0, 0}}}};
    for (int k = 0; k < 6; ++k) WITH(sv_transfer_function_desc, start, colors, wrong_colors[k], SV_E_ARGUMENT);
    static const sv_opacity_point wrong_opacities[][2] = {
        {{1, 0}, {0, 0}}, {{0, 0}, {NAN, 0}}, {{0, 0}, {1, 1.5}}, {{0, 0}, {1, -1}}, {{0, NAN}, {1, 0}}};
    for (int k = 0; k < 5; ++k) WITH(sv_transfer_function_desc, start, opacities, wrong_opacities[k], SV_E_ARGUMENT);
#undef with
}

void abuse_objects(void) {
    null_pointers();
    devices();
    volumes();
    updates();
    plans_and_requirements();
    parts();
    functions();
}
