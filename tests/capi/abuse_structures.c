/* Structures that are too short, too long, of another version, extended, or not there. */
#include "abuse.h"

static sv_status with_renderer(sv_renderer_desc desc) {
    return sv_renderer_create(device, &desc, &made_handle, &diagnostic);
}
static sv_status with_host(sv_host_device wanted) { return sv_device_from_host(&wanted, &made_handle, &diagnostic); }

static sv_status s_device(void *x) { return sv_device_from_host(x, &made_handle, &diagnostic); }
static sv_status s_limits(void *x) {
    sv_host_device wanted = ours;
    wanted.limits = x;
    return with_host(wanted);
}
static sv_status s_memory(void *x) { return sv_device_memory(device, x, &diagnostic); }
static sv_status s_volume(void *x) { return sv_volume_create(device, x, &made_handle, &diagnostic); }
static sv_status s_function(void *x) { return sv_transfer_function_create(device, x, &made_handle, &diagnostic); }
static sv_status s_renderer(void *x) { return sv_renderer_create(device, x, &made_handle, &diagnostic); }
static sv_status s_settings(void *x) {
    sv_renderer_desc desc = renderer_desc();
    desc.settings = x;
    return with_renderer(desc);
}
static sv_status s_paths(void *x) {
    const sv_settings settings = {.struct_size = sizeof settings, .paths = x};
    return s_settings((void *)&settings);
}
static sv_status s_class(void *x) {
    sv_renderer_desc desc = renderer_desc();
    desc.target = x;
    return with_renderer(desc);
}
static sv_status s_shot(void *x) { return sv_renderer_record(renderer, cmd, x, &diagnostic); }
static sv_status s_camera(void *x) {
    const sv_frame_info shot = {.struct_size = sizeof shot, .camera = x};
    return sv_renderer_record(renderer, cmd, &shot, &diagnostic);
}
static sv_status s_target(void *x) { return sv_renderer_record_into(renderer, cmd, &SHOT, x, &diagnostic); }
static sv_status s_pick(void *x) { return sv_renderer_pick(renderer, 0, 0, 0, x, &diagnostic); }
static sv_status s_submission(void *x) {
    const sv_target target = whole_target();
    return sv_submitter_submit(submitter, renderer, &SHOT, &target, x, &diagnostic);
}

static sv_status s_plan(void *x) {
    const sv_volume_desc desc = volume_desc();
    return sv_volume_plan(device, &desc, x, &diagnostic);
}
static sv_status s_planned(void *x) {
    sv_plan plan = {.struct_size = sizeof plan};
    return sv_volume_plan(device, x, &plan, &diagnostic);
}
static sv_status s_update(void *x) { return sv_volume_stage_update(volume, x, &made_handle, &diagnostic); }
static sv_status s_pacing(void *x) {
    const sv_target target = whole_target();
    const sv_submission s = submission();
    uint32_t done;
    return sv_submitter_submit_in_parts(submitter, renderer, &SHOT, &target, &s, x, &done, &diagnostic);
}
static sv_status s_trace(void *x) { return sv_trace(device, x, &made_handle, &diagnostic); }
static sv_status s_geometry(void *x) { return sv_geometry_create(device, x, &made_handle, &diagnostic); }
static sv_status s_checked(void *x) {
    uint64_t count = 0;
    return sv_check_device(x, NULL, &count, &diagnostic);
}

static const struct {
    const char *name;
    sv_status (*call)(void *);
    uint32_t size;
    int may_be_null, is_result;
} BY_STRUCTURE[] = {
    {"sv_host_device", s_device, sizeof(sv_host_device), 0, 0},
    {"sv_limits", s_limits, sizeof(sv_limits), 1, 0},
    {"sv_memory", s_memory, sizeof(sv_memory), 0, 1},
    {"sv_volume_desc", s_volume, sizeof(sv_volume_desc), 0, 0},
    {"sv_transfer_function_desc", s_function, sizeof(sv_transfer_function_desc), 0, 0},
    {"sv_renderer_desc", s_renderer, sizeof(sv_renderer_desc), 0, 0},
    {"sv_settings", s_settings, sizeof(sv_settings), 1, 0},
    {"sv_path_tracing", s_paths, sizeof(sv_path_tracing), 1, 0},
    {"sv_target_class", s_class, sizeof(sv_target_class), 0, 0},
    {"sv_frame_info", s_shot, sizeof(sv_frame_info), 0, 0},
    {"sv_camera", s_camera, sizeof(sv_camera), 1, 0},
    {"sv_target", s_target, sizeof(sv_target), 0, 0},
    {"sv_pick", s_pick, sizeof(sv_pick), 0, 1},
    {"sv_plan", s_plan, sizeof(sv_plan), 0, 1},
    {"sv_volume_desc, planned", s_planned, sizeof(sv_volume_desc), 0, 0},
    {"sv_update_desc", s_update, sizeof(sv_update_desc), 0, 0},
    {"sv_trace_desc", s_trace, sizeof(sv_trace_desc), 0, 0},
    {"sv_geometry_desc", s_geometry, sizeof(sv_geometry_desc), 0, 0},
    {"sv_pacing", s_pacing, sizeof(sv_pacing), 1, 0},
    {"sv_host_device, checked", s_checked, sizeof(sv_host_device), 0, 0},
    {"sv_submission", s_submission, sizeof(sv_submission), 0, 0},
};

void abuse_structures(void) {
    for (size_t k = 0; k < sizeof BY_STRUCTURE / sizeof *BY_STRUCTURE; ++k) {
        const char *name = BY_STRUCTURE[k].name;
        const uint32_t size = BY_STRUCTURE[k].size, wrong[] = {0, 1, 8, 16, size - 1, 4097, 0x80000000u, UINT32_MAX};
        if (!BY_STRUCTURE[k].may_be_null) bad(BY_STRUCTURE[k].call(NULL), SV_E_ARGUMENT, name);
        /* As long as it says, so that the sanitizer sees each byte beyond. */
        for (size_t w = 0; w < sizeof wrong / sizeof *wrong; ++w) {
            uint8_t *bytes = calloc(1, size < 16 ? 16 : size);
            memcpy(bytes, &wrong[w], 4);
            bad(BY_STRUCTURE[k].call(bytes), SV_E_VERSION, name);
            free(bytes);
        }
        uint8_t *bytes = calloc(1, size + 8);
        void *next = bytes;
        memcpy(bytes, &size, 4);
        memcpy(bytes + 8, &next, sizeof next);
        bad(BY_STRUCTURE[k].call(bytes), SV_E_VERSION, name);
        if (!BY_STRUCTURE[k].is_result) {
            const uint32_t longer = size + 8;
            memset(bytes, 0, size + 8);
            memcpy(bytes, &longer, 4);
            bytes[size + 5] = 1;
            bad(BY_STRUCTURE[k].call(bytes), SV_E_VERSION, name);
        }
        free(bytes);
    }
    /* Without a place for a text, the status alone speaks. */
    sv_diagnostic shorter = {.struct_size = 16};
    refused += sv_device_memory(0, NULL, &shorter) == SV_E_VERSION;
    shorter.struct_size = 0;
    refused += sv_device_memory(0, NULL, &shorter) == SV_E_VERSION;
    sv_diagnostic chained = {.struct_size = sizeof chained, .next = &shorter};
    refused += sv_device_memory(0, NULL, &chained) == SV_E_VERSION;
    refused += sv_device_memory(0, NULL, NULL) == SV_E_ARGUMENT;
    refused += sv_volume_destroy(device, NULL) == SV_E_ARGUMENT;
}
