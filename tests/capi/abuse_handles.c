/* Handles of what is gone, of other kinds, of other devices, and of nothing at all. */
#include "abuse.h"

static sv_status with_renderer(sv_renderer_desc desc) {
    return sv_renderer_create(device, &desc, &made_handle, &diagnostic);
}

typedef sv_status (*by_handle)(uint64_t);
enum { DEVICE = 1, VOLUME, FUNCTION, RENDERER, SUBMITTER, UPDATE, LINES, GEOMETRY, KINDS };

static sv_status h_announce(uint64_t x) { return sv_device_announce(x, 0, &diagnostic); }
static sv_status h_retire(uint64_t x) { return sv_device_retire(x, 0, &diagnostic); }
static sv_status h_memory(uint64_t x) {
    sv_memory memory = {.struct_size = sizeof memory};
    return sv_device_memory(x, &memory, &diagnostic);
}
static sv_status h_pipelines(uint64_t x) {
    uint32_t count;
    return sv_device_pipelines_made(x, &count, &diagnostic);
}
static sv_status h_cache(uint64_t x) {
    uint64_t bytes = 0;
    return sv_device_pipeline_cache(x, &bytes, NULL, &diagnostic);
}
static sv_status h_budget(uint64_t x) { return sv_device_set_memory_budget(x, 0, &diagnostic); }
static sv_status h_declare_lost(uint64_t x) { return sv_device_declare_lost(x, &diagnostic); }
static sv_status h_plan(uint64_t x) {
    const sv_volume_desc desc = volume_desc();
    sv_plan plan = {.struct_size = sizeof plan};
    return sv_volume_plan(x, &desc, &plan, &diagnostic);
}
static sv_status h_stage(uint64_t x) {
    const sv_update_desc desc = update_desc();
    return sv_volume_stage_update(x, &desc, &made_handle, &diagnostic);
}
static sv_status h_update_into(uint64_t x) { return sv_volume_record_update(x, cmd, staged, &diagnostic); }
static sv_status h_record_update(uint64_t x) { return sv_volume_record_update(volume, cmd, x, &diagnostic); }
static sv_status h_update_destroy(uint64_t x) { return sv_update_destroy(x, &diagnostic); }
static sv_status h_begin_parts(uint64_t x) {
    uint64_t blocks;
    return sv_renderer_begin_parts(x, &SHOT, &blocks, &diagnostic);
}
static sv_status h_record_part(uint64_t x) {
    const sv_target target = whole_target();
    uint64_t left;
    return sv_renderer_record_part_into(x, cmd, 0, 1, &target, &left, &diagnostic);
}
static sv_status h_parts(uint64_t x) {
    const sv_target target = whole_target();
    const sv_submission s = submission();
    uint32_t done;
    return sv_submitter_submit_in_parts(x, renderer, &SHOT, &target, &s, NULL, &done, &diagnostic);
}
static sv_status h_device_destroy(uint64_t x) { return sv_device_destroy(x, &diagnostic); }
static sv_status h_volume_create(uint64_t x) {
    const sv_volume_desc desc = volume_desc();
    return sv_volume_create(x, &desc, &made_handle, &diagnostic);
}
static sv_status h_function_create(uint64_t x) {
    const sv_transfer_function_desc desc = {.struct_size = sizeof desc};
    return sv_transfer_function_create(x, &desc, &made_handle, &diagnostic);
}
static sv_status h_renderer_create(uint64_t x) {
    const sv_renderer_desc desc = renderer_desc();
    return sv_renderer_create(x, &desc, &made_handle, &diagnostic);
}
static sv_status h_submitter_create(uint64_t x) { return sv_submitter_create(x, 1, &made_handle, &diagnostic); }
static sv_status h_upload(uint64_t x) { return sv_volume_record_upload(x, cmd, &diagnostic); }
static sv_status h_range(uint64_t x) {
    double range[2];
    return sv_volume_value_range(x, range, &diagnostic);
}
static sv_status h_volume_destroy(uint64_t x) { return sv_volume_destroy(x, &diagnostic); }
static sv_status h_of_volume(uint64_t x) {
    sv_renderer_desc desc = renderer_desc();
    desc.volume = x;
    return with_renderer(desc);
}
static sv_status h_set_volume(uint64_t x) { return sv_renderer_set_volume(renderer, x, 0, &diagnostic); }
static sv_status h_submit_upload(uint64_t x) {
    const sv_submission s = submission();
    return sv_submitter_upload(submitter, x, 0, &s, &diagnostic);
}
static sv_status h_function_destroy(uint64_t x) { return sv_transfer_function_destroy(x, &diagnostic); }
static sv_status h_of_function(uint64_t x) {
    sv_renderer_desc desc = renderer_desc();
    desc.function = x;
    return with_renderer(desc);
}
static sv_status h_set_function(uint64_t x) { return sv_renderer_set_transfer_function(renderer, x, &diagnostic); }
static sv_status h_resize(uint64_t x) { return sv_renderer_resize(x, WIDTH, HEIGHT, NULL, 0, &diagnostic); }
static sv_status h_function_of(uint64_t x) { return sv_renderer_set_transfer_function(x, 0, &diagnostic); }
static sv_status h_settings_of(uint64_t x) { return sv_renderer_set_settings(x, NULL, &diagnostic); }
static sv_status h_volume_of(uint64_t x) { return sv_renderer_set_volume(x, volume, 0, &diagnostic); }
static sv_status h_record(uint64_t x) { return sv_renderer_record(x, cmd, &SHOT, &diagnostic); }
static sv_status h_draw(uint64_t x) { return sv_renderer_draw(x, cmd, 0, &diagnostic); }
static sv_status h_draw_depth(uint64_t x) { return sv_renderer_draw_depth(x, cmd, 0, &diagnostic); }
static sv_status h_record_into(uint64_t x) {
    const sv_target target = whole_target();
    return sv_renderer_record_into(x, cmd, &SHOT, &target, &diagnostic);
}
static sv_status h_record_pick(uint64_t x) { return sv_renderer_record_pick(x, cmd, 0, 0, 0, &diagnostic); }
static sv_status h_pick(uint64_t x) {
    sv_pick pick = {.struct_size = sizeof pick};
    return sv_renderer_pick(x, 0, 0, 0, &pick, &diagnostic);
}
static sv_status h_traced(uint64_t x) {
    uint32_t paths = 0;
    return sv_renderer_paths_traced(x, &paths, &diagnostic);
}
static sv_status h_noise(uint64_t x) {
    double noise = 0.0;
    return sv_renderer_noise(x, &noise, &diagnostic);
}
static sv_status h_restart(uint64_t x) { return sv_renderer_restart_paths(x, &diagnostic); }
static sv_status h_renderer_destroy(uint64_t x) { return sv_renderer_destroy(x, &diagnostic); }
static sv_status h_submit_of(uint64_t x) {
    const sv_target target = whole_target();
    const sv_submission s = submission();
    return sv_submitter_submit(submitter, x, &SHOT, &target, &s, &diagnostic);
}
static sv_status h_submit(uint64_t x) {
    const sv_target target = whole_target();
    const sv_submission s = submission();
    return sv_submitter_submit(x, renderer, &SHOT, &target, &s, &diagnostic);
}
static sv_status h_upload_by(uint64_t x) {
    const sv_submission s = submission();
    return sv_submitter_upload(x, fresh, 0, &s, &diagnostic);
}
static uint64_t left_over;
static const float STILL[3];
static uint32_t is_over;
static sv_status h_upload_part(uint64_t x) { return sv_volume_record_upload_part(x, cmd, 1, &left_over, &diagnostic); }
static sv_status h_update_part_into(uint64_t x) {
    return sv_volume_record_update_part(x, cmd, staged, 1, &left_over, &diagnostic);
}
static sv_status h_update_part(uint64_t x) {
    return sv_volume_record_update_part(volume, cmd, x, 1, &left_over, &diagnostic);
}
static sv_status upload_by(uint64_t by, uint64_t into) {
    const sv_submission s = submission();
    return sv_submitter_upload_in_parts(by, into, 0, &s, NULL, &is_over, &diagnostic);
}
static sv_status h_upload_parts(uint64_t x) { return upload_by(x, fresh); }
static sv_status h_upload_parts_into(uint64_t x) { return upload_by(submitter, x); }
static sv_status update_by(uint64_t by, uint64_t into, uint64_t of) {
    const sv_submission s = submission();
    return sv_submitter_update_in_parts(by, into, of, 0, &s, NULL, &is_over, &diagnostic);
}
static sv_status h_update_parts(uint64_t x) { return update_by(x, volume, staged); }
static sv_status h_update_parts_into(uint64_t x) { return update_by(submitter, x, staged); }
static sv_status h_update_parts_of(uint64_t x) { return update_by(submitter, volume, x); }
static sv_status h_submitter_destroy(uint64_t x) { return sv_submitter_destroy(x, &diagnostic); }

static sv_status h_trace(uint64_t x) {
    const sv_trace_desc desc = {.struct_size = sizeof desc, .dims = {1, 1, 1}, .velocity_count = 3, .velocities = STILL};
    return sv_trace(x, &desc, &made_handle, &diagnostic);
}
static sv_status h_lines_count(uint64_t x) { return sv_lines_count(x, &left_over, &diagnostic); }
static sv_status h_positions(uint64_t x) { return sv_lines_positions(x, 0, NULL, &left_over, &diagnostic); }
static sv_status h_values(uint64_t x) { return sv_lines_values(x, 0, NULL, &left_over, &diagnostic); }
static sv_status h_breaks(uint64_t x) { return sv_lines_breaks(x, 0, NULL, &left_over, &diagnostic); }
static sv_status h_cause(uint64_t x) {
    uint32_t causes[2];
    return sv_lines_cause(x, 0, causes, &diagnostic);
}
static sv_status h_lines_destroy(uint64_t x) { return sv_lines_destroy(x, &diagnostic); }
static const sv_target_class WITH_DEPTH = {.struct_size = sizeof(sv_target_class),
                                           .color_format = FORMAT,
                                           .depth_format = VK_FORMAT_D32_SFLOAT};
static const sv_geometry_desc NO_SHAPE = {.struct_size = sizeof(sv_geometry_desc), .target = &WITH_DEPTH};
static sv_status h_geometry_create(uint64_t x) { return sv_geometry_create(x, &NO_SHAPE, &made_handle, &diagnostic); }
static sv_status h_geometry_upload(uint64_t x) { return sv_geometry_record_upload(x, cmd, &diagnostic); }
static sv_status h_geometry_draw(uint64_t x) { return sv_geometry_draw(x, cmd, &SHOT, WIDTH, HEIGHT, &diagnostic); }
static sv_status h_geometry_destroy(uint64_t x) { return sv_geometry_destroy(x, &diagnostic); }

/* `is_optional`: 0 is no error there. */
static const struct {
    const char *name;
    by_handle call;
    int kind, is_optional;
} BY_HANDLE[] = {
    {"sv_device_announce", h_announce, DEVICE, 0},
    {"sv_device_retire", h_retire, DEVICE, 0},
    {"sv_device_memory", h_memory, DEVICE, 0},
    {"sv_device_pipelines_made", h_pipelines, DEVICE, 0},
    {"sv_device_pipeline_cache", h_cache, DEVICE, 0},
    {"sv_device_set_memory_budget", h_budget, DEVICE, 0},
    {"sv_device_declare_lost", h_declare_lost, DEVICE, 0},
    {"sv_volume_plan", h_plan, DEVICE, 0},
    {"sv_volume_stage_update", h_stage, VOLUME, 0},
    {"sv_volume_record_update", h_update_into, VOLUME, 0},
    {"sv_volume_record_update, its update", h_record_update, UPDATE, 0},
    {"sv_volume_record_upload_part", h_upload_part, VOLUME, 0},
    {"sv_volume_record_update_part", h_update_part_into, VOLUME, 0},
    {"sv_volume_record_update_part, its update", h_update_part, UPDATE, 0},
    {"sv_submitter_upload_in_parts", h_upload_parts, SUBMITTER, 0},
    {"sv_submitter_upload_in_parts, its volume", h_upload_parts_into, VOLUME, 0},
    {"sv_submitter_update_in_parts", h_update_parts, SUBMITTER, 0},
    {"sv_submitter_update_in_parts, its volume", h_update_parts_into, VOLUME, 0},
    {"sv_submitter_update_in_parts, its update", h_update_parts_of, UPDATE, 0},
    {"sv_update_destroy", h_update_destroy, UPDATE, 0},
    {"sv_renderer_begin_parts", h_begin_parts, RENDERER, 0},
    {"sv_renderer_record_part_into", h_record_part, RENDERER, 0},
    {"sv_submitter_submit_in_parts", h_parts, SUBMITTER, 0},
    {"sv_device_destroy", h_device_destroy, DEVICE, 0},
    {"sv_volume_create", h_volume_create, DEVICE, 0},
    {"sv_transfer_function_create", h_function_create, DEVICE, 0},
    {"sv_renderer_create", h_renderer_create, DEVICE, 0},
    {"sv_submitter_create", h_submitter_create, DEVICE, 0},
    {"sv_volume_record_upload", h_upload, VOLUME, 0},
    {"sv_volume_value_range", h_range, VOLUME, 0},
    {"sv_volume_destroy", h_volume_destroy, VOLUME, 0},
    {"sv_renderer_create, its volume", h_of_volume, VOLUME, 0},
    {"sv_renderer_set_volume, its volume", h_set_volume, VOLUME, 0},
    {"sv_submitter_upload, its volume", h_submit_upload, VOLUME, 0},
    {"sv_transfer_function_destroy", h_function_destroy, FUNCTION, 0},
    {"sv_renderer_create, its function", h_of_function, FUNCTION, 1},
    {"sv_renderer_set_transfer_function, its function", h_set_function, FUNCTION, 1},
    {"sv_renderer_resize", h_resize, RENDERER, 0},
    {"sv_renderer_set_transfer_function", h_function_of, RENDERER, 0},
    {"sv_renderer_set_settings", h_settings_of, RENDERER, 0},
    {"sv_renderer_set_volume", h_volume_of, RENDERER, 0},
    {"sv_renderer_record", h_record, RENDERER, 0},
    {"sv_renderer_draw", h_draw, RENDERER, 0},
    {"sv_renderer_draw_depth", h_draw_depth, RENDERER, 0},
    {"sv_renderer_record_into", h_record_into, RENDERER, 0},
    {"sv_renderer_record_pick", h_record_pick, RENDERER, 0},
    {"sv_renderer_pick", h_pick, RENDERER, 0},
    {"sv_renderer_paths_traced", h_traced, RENDERER, 0},
    {"sv_renderer_noise", h_noise, RENDERER, 0},
    {"sv_renderer_restart_paths", h_restart, RENDERER, 0},
    {"sv_renderer_destroy", h_renderer_destroy, RENDERER, 0},
    {"sv_submitter_submit, its renderer", h_submit_of, RENDERER, 0},
    {"sv_submitter_submit", h_submit, SUBMITTER, 0},
    {"sv_submitter_upload", h_upload_by, SUBMITTER, 0},
    {"sv_submitter_destroy", h_submitter_destroy, SUBMITTER, 0},
    {"sv_trace", h_trace, DEVICE, 0},
    {"sv_lines_count", h_lines_count, LINES, 0},
    {"sv_lines_positions", h_positions, LINES, 0},
    {"sv_lines_values", h_values, LINES, 0},
    {"sv_lines_breaks", h_breaks, LINES, 0},
    {"sv_lines_cause", h_cause, LINES, 0},
    {"sv_lines_destroy", h_lines_destroy, LINES, 0},
    {"sv_geometry_create", h_geometry_create, DEVICE, 0},
    {"sv_geometry_record_upload", h_geometry_upload, GEOMETRY, 0},
    {"sv_geometry_draw", h_geometry_draw, GEOMETRY, 0},
    {"sv_geometry_destroy", h_geometry_destroy, GEOMETRY, 0},
};

void abuse_handles(void) {
    /* Of each kind one that is gone, and whose place is taken by another one. */
    uint64_t stale[KINDS] = {0};
    const sv_volume_desc desc = volume_desc();
    const sv_transfer_function_desc points = {.struct_size = sizeof points};
    const sv_renderer_desc wanted = renderer_desc();
    GOOD(sv_device_from_host(&ours, &stale[DEVICE], &diagnostic));
    GOOD(sv_device_destroy(stale[DEVICE], &diagnostic));
    GOOD(sv_volume_create(device, &desc, &stale[VOLUME], &diagnostic));
    GOOD(sv_volume_destroy(stale[VOLUME], &diagnostic));
    GOOD(sv_volume_create(device, &desc, &fresh, &diagnostic));
    GOOD(sv_transfer_function_create(device, &points, &stale[FUNCTION], &diagnostic));
    GOOD(sv_transfer_function_destroy(stale[FUNCTION], &diagnostic));
    GOOD(sv_transfer_function_create(device, &points, &made_handle, &diagnostic));
    GOOD(sv_renderer_create(device, &wanted, &stale[RENDERER], &diagnostic));
    GOOD(sv_renderer_destroy(stale[RENDERER], &diagnostic));
    GOOD(sv_submitter_create(device, 1, &stale[SUBMITTER], &diagnostic));
    GOOD(sv_submitter_destroy(stale[SUBMITTER], &diagnostic));
    const sv_update_desc update = update_desc();
    GOOD(sv_volume_stage_update(volume, &update, &stale[UPDATE], &diagnostic));
    GOOD(sv_update_destroy(stale[UPDATE], &diagnostic));
    const sv_trace_desc still = {.struct_size = sizeof still, .dims = {1, 1, 1}, .velocity_count = 3, .velocities = STILL};
    sv_lines lines = 0;
    GOOD(sv_trace(device, &still, &stale[LINES], &diagnostic));
    GOOD(sv_lines_destroy(stale[LINES], &diagnostic));
    GOOD(sv_trace(device, &still, &lines, &diagnostic));
    sv_geometry geometry = 0;
    GOOD(sv_geometry_create(device, &NO_SHAPE, &stale[GEOMETRY], &diagnostic));
    GOOD(sv_geometry_destroy(stale[GEOMETRY], &diagnostic));
    GOOD(sv_geometry_create(device, &NO_SHAPE, &geometry, &diagnostic));
    const uint64_t live[KINDS] = {0, device, volume, function, renderer, submitter, staged, lines, geometry};
    for (size_t k = 0; k < sizeof BY_HANDLE / sizeof *BY_HANDLE; ++k) {
        const int kind = BY_HANDLE[k].kind;
        const by_handle call = BY_HANDLE[k].call;
        const char *name = BY_HANDLE[k].name;
        if (!BY_HANDLE[k].is_optional) bad(call(0), SV_E_ARGUMENT, name);
        bad(call(1), SV_E_ARGUMENT, name);
        bad(call(UINT64_MAX), SV_E_ARGUMENT, name);
        bad(call((uint64_t)(uintptr_t)&h), SV_E_ARGUMENT, name);
        bad(call(stale[kind]), SV_E_ARGUMENT, name);
        /* Another generation, another place, another device, another kind. */
        bad(call(live[kind] + (1 << 20)), SV_E_ARGUMENT, name);
        bad(call(live[kind] + 1000), SV_E_ARGUMENT, name);
        bad(call(live[kind] + ((uint64_t)77 << 40)), SV_E_ARGUMENT, name);
        bad(call(live[kind] ^ ((uint64_t)15 << 60)), SV_E_ARGUMENT, name);
        for (int other = 1; other < KINDS; ++other)
            if (other != kind) bad(call(live[other]), SV_E_ARGUMENT, name);
    }
    /* Of another device. */
    sv_volume foreign = 0;
    sv_transfer_function foreign_function = 0;
    GOOD(sv_volume_create(other_device, &desc, &foreign, &diagnostic));
    GOOD(sv_transfer_function_create(other_device, &points, &foreign_function, &diagnostic));
    BAD(SV_E_ARGUMENT, h_of_volume(foreign));
    BAD(SV_E_ARGUMENT, h_set_volume(foreign));
    BAD(SV_E_ARGUMENT, h_submit_upload(foreign));
    BAD(SV_E_ARGUMENT, h_of_function(foreign_function));
    BAD(SV_E_ARGUMENT, h_set_function(foreign_function));
    GOOD(sv_volume_destroy(foreign, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_volume_destroy(foreign, &diagnostic));
}
