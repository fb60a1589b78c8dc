/* What a careless host does: each call is refused, with a sentence, and nothing that was good before is worse for it. */
#include "../../examples/embed_host.h"
#include "stratavox.h"
#include <math.h>
#include <pthread.h>

enum { WIDTH = 40, HEIGHT = 30, VOXELS = 8, BYTES = WIDTH * HEIGHT * 4 };
static const VkFormat FORMAT = VK_FORMAT_R8G8B8A8_UNORM;

static host h;
static sv_host_device ours;
static sv_device device, other_device;
static sv_volume volume, fresh;
static sv_function function;
static sv_renderer renderer, deep;
static sv_submitter submitter;
static VkCommandBuffer cmd;
static uint8_t voxels[VOXELS * VOXELS * VOXELS];
static unsigned refused, failures;
static sv_diagnostic diagnostic = {.struct_size = sizeof(sv_diagnostic)};

static void good(sv_status status, const char *what) {
    if (status == SV_OK) return;
    fprintf(stderr, "%s: status %d: %s\n", what, (int)status, diagnostic.text);
    exit(1);
}
#define GOOD(call) good(call, #call)

/* `wanted` is the status, or SV_OK for any but that. */
static void bad(sv_status status, sv_status wanted, const char *what) {
    const int is_refused = status != SV_OK && (wanted == SV_OK || status == wanted);
    const int is_told = diagnostic.text[0] != 0 && diagnostic.status == status && memchr(diagnostic.text, 0, 256);
    const int is_clean = status != SV_E_INTERNAL;
    if (!is_refused || !is_told || !is_clean) {
        fprintf(stderr, "FAILED: %s: status %d, wanted %d, \"%.256s\"\n", what, (int)status, (int)wanted, diagnostic.text);
        failures += 1;
    } else {
        if (getenv("SV_TOLD")) printf("%3d  %s\n     %s\n", (int)status, what, diagnostic.text);
        refused += 1;
    }
    memset(diagnostic.text, 0, sizeof diagnostic.text);
    diagnostic.status = SV_OK;
}
#define TEXT_OF(line) #line
#define AT(line) "line " TEXT_OF(line) ": "
#define BAD(wanted, call) bad(call, wanted, AT(__LINE__) #call)

/* ---- Structures as they should be ---- */

static sv_volume_desc volume_desc(void) {
    const sv_volume_desc made = {.struct_size = sizeof made,
                                 .dims = {VOXELS, VOXELS, VOXELS},
                                 .voxels = voxels,
                                 .voxel_bytes = sizeof voxels};
    return made;
}

static const sv_target_class CLASS = {.struct_size = sizeof CLASS, .color_format = VK_FORMAT_R8G8B8A8_UNORM};

static sv_renderer_desc renderer_desc(void) {
    const sv_renderer_desc made = {.struct_size = sizeof made,
                                   .volume = volume,
                                   .target = &CLASS,
                                   .width = WIDTH,
                                   .height = HEIGHT,
                                   .frames_in_flight = 2};
    return made;
}

static sv_target whole_target(void) {
    const sv_target made = {.struct_size = sizeof made,
                            .image = (uint64_t)h.image,
                            .view = (uint64_t)h.view,
                            .format = FORMAT,
                            .width = WIDTH,
                            .height = HEIGHT,
                            .is_cleared = 1,
                            .after = {.layout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                                      .stage = VK_PIPELINE_STAGE_2_COPY_BIT,
                                      .access = VK_ACCESS_2_TRANSFER_READ_BIT}};
    return made;
}

static const sv_shot SHOT = {.struct_size = sizeof SHOT};

static sv_submission submission(void) {
    const sv_submission made = {.struct_size = sizeof made, .queue = h.queue};
    return made;
}

/* ---- One call with one argument that may be anything ---- */

static uint64_t made_handle;

static sv_status with_camera(sv_camera camera) {
    const sv_shot shot = {.struct_size = sizeof shot, .camera = &camera};
    return sv_renderer_record(renderer, cmd, &shot, &diagnostic);
}
static sv_status with_settings(sv_settings settings) {
    sv_renderer_desc desc = renderer_desc();
    desc.settings = &settings;
    return sv_renderer_create(device, &desc, &made_handle, &diagnostic);
}
static sv_status with_volume(sv_volume_desc desc) {
    return sv_volume_create(device, &desc, &made_handle, &diagnostic);
}
static sv_status with_renderer(sv_renderer_desc desc) {
    return sv_renderer_create(device, &desc, &made_handle, &diagnostic);
}
static sv_status with_class(sv_target_class class) {
    sv_renderer_desc desc = renderer_desc();
    desc.target = &class;
    return sv_renderer_create(device, &desc, &made_handle, &diagnostic);
}
static sv_status with_target(sv_target target) {
    return sv_renderer_record_into(renderer, cmd, &SHOT, &target, &diagnostic);
}
static sv_status with_submission(sv_submission wanted) {
    const sv_target target = whole_target();
    return sv_submitter_submit(submitter, renderer, &SHOT, &target, &wanted, &diagnostic);
}
static sv_status with_function(sv_function_desc desc) {
    return sv_function_create(device, &desc, &made_handle, &diagnostic);
}
static sv_status with_host(sv_host_device wanted) { return sv_device_from_host(&wanted, &made_handle, &diagnostic); }

/* ---- Handles ---- */

typedef sv_status (*by_handle)(uint64_t);
enum { DEVICE = 1, VOLUME, FUNCTION, RENDERER, SUBMITTER };

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
static sv_status h_device_destroy(uint64_t x) { return sv_device_destroy(x, &diagnostic); }
static sv_status h_volume_create(uint64_t x) {
    const sv_volume_desc desc = volume_desc();
    return sv_volume_create(x, &desc, &made_handle, &diagnostic);
}
static sv_status h_function_create(uint64_t x) {
    const sv_function_desc desc = {.struct_size = sizeof desc};
    return sv_function_create(x, &desc, &made_handle, &diagnostic);
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
static sv_status h_function_destroy(uint64_t x) { return sv_function_destroy(x, &diagnostic); }
static sv_status h_of_function(uint64_t x) {
    sv_renderer_desc desc = renderer_desc();
    desc.function = x;
    return with_renderer(desc);
}
static sv_status h_set_function(uint64_t x) { return sv_renderer_set_function(renderer, x, &diagnostic); }
static sv_status h_resize(uint64_t x) { return sv_renderer_resize(x, WIDTH, HEIGHT, NULL, 0, &diagnostic); }
static sv_status h_function_of(uint64_t x) { return sv_renderer_set_function(x, 0, &diagnostic); }
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
static sv_status h_submitter_destroy(uint64_t x) { return sv_submitter_destroy(x, &diagnostic); }

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
    {"sv_device_destroy", h_device_destroy, DEVICE, 0},
    {"sv_volume_create", h_volume_create, DEVICE, 0},
    {"sv_function_create", h_function_create, DEVICE, 0},
    {"sv_renderer_create", h_renderer_create, DEVICE, 0},
    {"sv_submitter_create", h_submitter_create, DEVICE, 0},
    {"sv_volume_record_upload", h_upload, VOLUME, 0},
    {"sv_volume_value_range", h_range, VOLUME, 0},
    {"sv_volume_destroy", h_volume_destroy, VOLUME, 0},
    {"sv_renderer_create, its volume", h_of_volume, VOLUME, 0},
    {"sv_renderer_set_volume, its volume", h_set_volume, VOLUME, 0},
    {"sv_submitter_upload, its volume", h_submit_upload, VOLUME, 0},
    {"sv_function_destroy", h_function_destroy, FUNCTION, 0},
    {"sv_renderer_create, its function", h_of_function, FUNCTION, 1},
    {"sv_renderer_set_function, its function", h_set_function, FUNCTION, 1},
    {"sv_renderer_resize", h_resize, RENDERER, 0},
    {"sv_renderer_set_function", h_function_of, RENDERER, 0},
    {"sv_renderer_set_settings", h_settings_of, RENDERER, 0},
    {"sv_renderer_set_volume", h_volume_of, RENDERER, 0},
    {"sv_renderer_record", h_record, RENDERER, 0},
    {"sv_renderer_draw", h_draw, RENDERER, 0},
    {"sv_renderer_draw_depth", h_draw_depth, RENDERER, 0},
    {"sv_renderer_record_into", h_record_into, RENDERER, 0},
    {"sv_renderer_record_pick", h_record_pick, RENDERER, 0},
    {"sv_renderer_pick", h_pick, RENDERER, 0},
    {"sv_renderer_destroy", h_renderer_destroy, RENDERER, 0},
    {"sv_submitter_submit, its renderer", h_submit_of, RENDERER, 0},
    {"sv_submitter_submit", h_submit, SUBMITTER, 0},
    {"sv_submitter_upload", h_upload_by, SUBMITTER, 0},
    {"sv_submitter_destroy", h_submitter_destroy, SUBMITTER, 0},
};

static void handles(void) {
    /* Of each kind one that is gone, and whose place is taken by another one. */
    uint64_t stale[6] = {0};
    const sv_volume_desc desc = volume_desc();
    const sv_function_desc points = {.struct_size = sizeof points};
    const sv_renderer_desc wanted = renderer_desc();
    GOOD(sv_device_from_host(&ours, &stale[DEVICE], &diagnostic));
    GOOD(sv_device_destroy(stale[DEVICE], &diagnostic));
    GOOD(sv_volume_create(device, &desc, &stale[VOLUME], &diagnostic));
    GOOD(sv_volume_destroy(stale[VOLUME], &diagnostic));
    GOOD(sv_volume_create(device, &desc, &fresh, &diagnostic));
    GOOD(sv_function_create(device, &points, &stale[FUNCTION], &diagnostic));
    GOOD(sv_function_destroy(stale[FUNCTION], &diagnostic));
    GOOD(sv_function_create(device, &points, &made_handle, &diagnostic));
    GOOD(sv_renderer_create(device, &wanted, &stale[RENDERER], &diagnostic));
    GOOD(sv_renderer_destroy(stale[RENDERER], &diagnostic));
    GOOD(sv_submitter_create(device, 1, &stale[SUBMITTER], &diagnostic));
    GOOD(sv_submitter_destroy(stale[SUBMITTER], &diagnostic));
    const uint64_t live[] = {0, device, volume, function, renderer, submitter};
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
        for (int other = 1; other < 6; ++other)
            if (other != kind) bad(call(live[other]), SV_E_ARGUMENT, name);
    }
    /* Of another device. */
    sv_volume foreign = 0;
    sv_function foreign_function = 0;
    GOOD(sv_volume_create(other_device, &desc, &foreign, &diagnostic));
    GOOD(sv_function_create(other_device, &points, &foreign_function, &diagnostic));
    BAD(SV_E_ARGUMENT, h_of_volume(foreign));
    BAD(SV_E_ARGUMENT, h_set_volume(foreign));
    BAD(SV_E_ARGUMENT, h_submit_upload(foreign));
    BAD(SV_E_ARGUMENT, h_of_function(foreign_function));
    BAD(SV_E_ARGUMENT, h_set_function(foreign_function));
    GOOD(sv_volume_destroy(foreign, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_volume_destroy(foreign, &diagnostic));
}

/* ---- Structures that are none ---- */

static sv_status s_device(void *x) { return sv_device_from_host(x, &made_handle, &diagnostic); }
static sv_status s_limits(void *x) {
    sv_host_device wanted = ours;
    wanted.limits = x;
    return with_host(wanted);
}
static sv_status s_memory(void *x) { return sv_device_memory(device, x, &diagnostic); }
static sv_status s_volume(void *x) { return sv_volume_create(device, x, &made_handle, &diagnostic); }
static sv_status s_function(void *x) { return sv_function_create(device, x, &made_handle, &diagnostic); }
static sv_status s_renderer(void *x) { return sv_renderer_create(device, x, &made_handle, &diagnostic); }
static sv_status s_settings(void *x) {
    sv_renderer_desc desc = renderer_desc();
    desc.settings = x;
    return with_renderer(desc);
}
static sv_status s_class(void *x) {
    sv_renderer_desc desc = renderer_desc();
    desc.target = x;
    return with_renderer(desc);
}
static sv_status s_shot(void *x) { return sv_renderer_record(renderer, cmd, x, &diagnostic); }
static sv_status s_camera(void *x) {
    const sv_shot shot = {.struct_size = sizeof shot, .camera = x};
    return sv_renderer_record(renderer, cmd, &shot, &diagnostic);
}
static sv_status s_target(void *x) { return sv_renderer_record_into(renderer, cmd, &SHOT, x, &diagnostic); }
static sv_status s_pick(void *x) { return sv_renderer_pick(renderer, 0, 0, 0, x, &diagnostic); }
static sv_status s_submission(void *x) {
    const sv_target target = whole_target();
    return sv_submitter_submit(submitter, renderer, &SHOT, &target, x, &diagnostic);
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
    {"sv_function_desc", s_function, sizeof(sv_function_desc), 0, 0},
    {"sv_renderer_desc", s_renderer, sizeof(sv_renderer_desc), 0, 0},
    {"sv_settings", s_settings, sizeof(sv_settings), 1, 0},
    {"sv_target_class", s_class, sizeof(sv_target_class), 0, 0},
    {"sv_shot", s_shot, sizeof(sv_shot), 0, 0},
    {"sv_camera", s_camera, sizeof(sv_camera), 1, 0},
    {"sv_target", s_target, sizeof(sv_target), 0, 0},
    {"sv_pick", s_pick, sizeof(sv_pick), 0, 1},
    {"sv_submission", s_submission, sizeof(sv_submission), 0, 0},
};

static void structures(void) {
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

/* ---- Numbers that mean nothing ---- */

#define WITH(kind, start, field, value, wanted) \
    do {                                        \
        kind wrong = start;                     \
        wrong.field = value;                    \
        BAD(wanted, with(wrong));               \
    } while (0)

static void null_pointers(void) {
    const sv_volume_desc desc = volume_desc();
    const sv_renderer_desc wanted = renderer_desc();
    const sv_function_desc points = {.struct_size = sizeof points};
    const sv_target target = whole_target();
    const sv_submission s = submission();
    BAD(SV_E_ARGUMENT, sv_device_from_host(&ours, NULL, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_volume_create(device, &desc, NULL, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_function_create(device, &points, NULL, &diagnostic));
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
    BAD(SV_E_STATE, h_set_volume(fresh));
    BAD(SV_E_STATE, h_submit_upload(volume));
}

static void functions(void) {
    static const sv_color_point colors[] = {{0, {0, 0, 0}}, {1, {1, 1, 1}}};
    static const sv_opacity_point opacities[] = {{0, 0}, {1, 1}};
    const sv_function_desc start = {.struct_size = sizeof start,
                                    .colors = colors,
                                    .color_count = 2,
                                    .opacities = opacities,
                                    .opacity_count = 2};
#define with with_function
    WITH(sv_function_desc, start, colors, NULL, SV_E_ARGUMENT);
    WITH(sv_function_desc, start, opacities, NULL, SV_E_ARGUMENT);
    WITH(sv_function_desc, start, color_count, 4097, SV_E_LIMIT);
    WITH(sv_function_desc, start, color_count, UINT64_MAX, SV_E_LIMIT);
    WITH(sv_function_desc, start, opacity_count, UINT64_MAX / 16, SV_E_LIMIT);
    WITH(sv_function_desc, start, reference_length, -1.0, SV_E_ARGUMENT);
    WITH(sv_function_desc, start, reference_length, (double)NAN, SV_E_ARGUMENT);
    WITH(sv_function_desc, start, reference_length, (double)INFINITY, SV_E_ARGUMENT);
    WITH(sv_function_desc, start, colors, (const sv_color_point *)((const char *)colors + 1), SV_E_ARGUMENT);
    static const sv_color_point wrong_colors[][2] = {{{1, {0, 0, 0}}, {0, {0, 0, 0}}},
                                                     {{0, {0, 0, 0}}, {NAN, {0, 0, 0}}},
                                                     {{0, {0, 0, 0}}, {INFINITY, {0, 0, 0}}},
                                                     {{0, {0, 0, 0}}, {1, {0, 2, 0}}},
                                                     {{0, {0, 0, 0}}, {1, {-0.1, 0, 0}}},
                                                     {{0, {0, NAN, 0}}, {1, {0, 0, 0}}}};
    for (int k = 0; k < 6; ++k) WITH(sv_function_desc, start, colors, wrong_colors[k], SV_E_ARGUMENT);
    static const sv_opacity_point wrong_opacities[][2] = {
        {{1, 0}, {0, 0}}, {{0, 0}, {NAN, 0}}, {{0, 0}, {1, 1.5}}, {{0, 0}, {1, -1}}, {{0, NAN}, {1, 0}}};
    for (int k = 0; k < 5; ++k) WITH(sv_function_desc, start, opacities, wrong_opacities[k], SV_E_ARGUMENT);
#undef with
}

static void settings(void) {
    const sv_settings start = {.struct_size = sizeof start};
    const double nan = NAN, inf = INFINITY;
#define with with_settings
    WITH(sv_settings, start, technique, 3, SV_E_ARGUMENT);
    WITH(sv_settings, start, technique, UINT32_MAX, SV_E_ARGUMENT);
    WITH(sv_settings, start, mode, 9, SV_E_ARGUMENT);
    WITH(sv_settings, start, filter, 7, SV_E_ARGUMENT);
    WITH(sv_settings, start, lattice, 3, SV_E_ARGUMENT);
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
    static const sv_level levels[] = {
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
    WITH(sv_settings, lit, is_preintegrated, 1, SV_E_UNSUPPORTED);
    sv_settings sliced = start;
    sliced.technique = SV_TECHNIQUE_SLICES_3D;
    WITH(sv_settings, sliced, mode, SV_MODE_MIDA, SV_E_UNSUPPORTED);
    WITH(sv_settings, sliced, mode, SV_MODE_LMIP, SV_E_UNSUPPORTED);
    WITH(sv_settings, sliced, lattice, SV_LATTICE_JITTER, SV_E_UNSUPPORTED);
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
    WITH(sv_renderer_desc, start, reserved, 1, SV_E_ARGUMENT);
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

static void frames(void) {
    const sv_camera look = {.struct_size = sizeof look,
                            .kind = SV_CAMERA_LOOK_AT,
                            .eye = {4, -30, 4},
                            .target = {4, 4, 4}};
    const double nan = NAN, inf = INFINITY;
#define with with_camera
    WITH(sv_camera, look, kind, 3, SV_E_ARGUMENT);
    WITH(sv_camera, look, kind, UINT32_MAX, SV_E_ARGUMENT);
    WITH(sv_camera, look, kind, SV_CAMERA_MATRICES, SV_E_ARGUMENT);
    for (int axis = 0; axis < 3; ++axis) {
        WITH(sv_camera, look, eye[axis], nan, SV_E_ARGUMENT);
        WITH(sv_camera, look, target[axis], inf, SV_E_ARGUMENT);
        WITH(sv_camera, look, up[axis], nan, SV_E_ARGUMENT);
    }
    WITH(sv_camera, look, eye[1], 4.0, SV_E_ARGUMENT);
    WITH(sv_camera, look, up[1], 1.0, SV_E_ARGUMENT);
    WITH(sv_camera, look, fov_degrees, 180.0, SV_E_ARGUMENT);
    WITH(sv_camera, look, fov_degrees, -1.0, SV_E_ARGUMENT);
    WITH(sv_camera, look, fov_degrees, nan, SV_E_ARGUMENT);
    WITH(sv_camera, look, view_height, -1.0, SV_E_ARGUMENT);
    WITH(sv_camera, look, view_height, nan, SV_E_ARGUMENT);
    WITH(sv_camera, look, view_height, inf, SV_E_ARGUMENT);
    WITH(sv_camera, look, zoom, -2.0, SV_E_ARGUMENT);
    WITH(sv_camera, look, zoom, nan, SV_E_ARGUMENT);
    sv_camera matrices = {.struct_size = sizeof matrices, .kind = SV_CAMERA_MATRICES};
    for (int k = 0; k < 4; ++k) matrices.view_from_world[5 * k] = 1.0;
    BAD(SV_E_ARGUMENT, with(matrices));
    for (int k = 0; k < 4; ++k) matrices.clip_from_view[5 * k] = 1.0;
    WITH(sv_camera, matrices, view_from_world[0], 2.0, SV_E_ARGUMENT);
    WITH(sv_camera, matrices, view_from_world[3], 1.0, SV_E_ARGUMENT);
    WITH(sv_camera, matrices, view_from_world[7], nan, SV_E_ARGUMENT);
    WITH(sv_camera, matrices, clip_from_view[0], 0.0, SV_E_ARGUMENT);
    WITH(sv_camera, matrices, clip_from_view[0], nan, SV_E_ARGUMENT);
    WITH(sv_camera, matrices, clip_from_view[1], 0.3, SV_E_ARGUMENT);
    WITH(sv_camera, matrices, clip_from_view[15], 0.0, SV_E_ARGUMENT);
    WITH(sv_camera, matrices, clip_from_view[3], 1.0, SV_E_ARGUMENT);
#undef with
    sv_shot late = SHOT;
    late.frame = 2;
    BAD(SV_E_ARGUMENT, sv_renderer_record(renderer, cmd, &late, &diagnostic));
    late.frame = UINT32_MAX;
    BAD(SV_E_ARGUMENT, sv_renderer_record(renderer, cmd, &late, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_renderer_draw(renderer, cmd, 2, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_renderer_draw(renderer, cmd, UINT32_MAX, &diagnostic));
    BAD(SV_E_STATE, sv_renderer_draw(renderer, cmd, 1, &diagnostic));
    BAD(SV_E_STATE, sv_renderer_draw_depth(renderer, cmd, 1, &diagnostic));
    BAD(SV_E_UNSUPPORTED, sv_renderer_draw_depth(renderer, cmd, 0, &diagnostic));
    BAD(SV_E_STATE, sv_renderer_record_pick(renderer, cmd, 1, 0, 0, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_renderer_record_pick(renderer, cmd, 0, WIDTH, 0, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_renderer_record_pick(renderer, cmd, 0, 0, UINT32_MAX, &diagnostic));
    sv_pick pick = {.struct_size = sizeof pick};
    BAD(SV_E_ARGUMENT, sv_renderer_pick(renderer, 7, 0, 0, &pick, &diagnostic));
    BAD(SV_E_STATE, sv_renderer_pick(renderer, 1, 0, 0, &pick, &diagnostic));
    /* Depths want matrices, and an image in their own class. */
    BAD(SV_E_ARGUMENT, sv_renderer_record(deep, cmd, &SHOT, &diagnostic));
    const sv_target whole = whole_target();
    BAD(SV_OK, sv_renderer_record_into(deep, cmd, &SHOT, &whole, &diagnostic));
#define with with_target
    WITH(sv_target, whole, image, 0, SV_E_ARGUMENT);
    WITH(sv_target, whole, view, 0, SV_E_ARGUMENT);
    WITH(sv_target, whole, format, 0, SV_E_ARGUMENT);
    WITH(sv_target, whole, format, UINT32_MAX, SV_E_ARGUMENT);
    WITH(sv_target, whole, format, VK_FORMAT_R8G8B8A8_SRGB, SV_E_STATE);
    WITH(sv_target, whole, width, WIDTH + 1, SV_E_STATE);
    WITH(sv_target, whole, height, 0, SV_E_STATE);
    WITH(sv_target, whole, is_cleared, 0, SV_E_ARGUMENT);
    WITH(sv_target, whole, clear_color[2], NAN, SV_E_ARGUMENT);
    WITH(sv_target, whole, before.layout, 9, SV_E_ARGUMENT);
    WITH(sv_target, whole, before.layout, UINT32_MAX, SV_E_ARGUMENT);
    WITH(sv_target, whole, after.layout, 77, SV_E_ARGUMENT);
    WITH(sv_target, whole, after.layout, VK_IMAGE_LAYOUT_UNDEFINED, SV_E_ARGUMENT);
    WITH(sv_target, whole, after.layout, VK_IMAGE_LAYOUT_PREINITIALIZED, SV_E_ARGUMENT);
#undef with
}

static sv_status inside[3];
static void nothing(void *user) { (void)user; }
static void calls_back(void *user) {
    (void)user;
    inside[0] = h_draw(renderer);
    inside[1] = h_submit(submitter);
    inside[2] = h_settings_of(renderer);
}

static void submissions(void) {
    const sv_submission start = submission();
    static const sv_timeline_point none = {0, 1};
#define with with_submission
    WITH(sv_submission, start, queue, NULL, SV_E_ARGUMENT);
    WITH(sv_submission, start, lock, nothing, SV_E_ARGUMENT);
    WITH(sv_submission, start, unlock, nothing, SV_E_ARGUMENT);
    WITH(sv_submission, start, wait_count, 1, SV_E_ARGUMENT);
    WITH(sv_submission, start, signal_count, UINT64_MAX, SV_E_ARGUMENT);
    sv_submission pointed = start;
    pointed.waits = pointed.signals = &none;
    WITH(sv_submission, pointed, wait_count, 1, SV_E_ARGUMENT);
    WITH(sv_submission, pointed, signal_count, 1, SV_E_ARGUMENT);
    WITH(sv_submission, pointed, wait_count, 257, SV_E_LIMIT);
    WITH(sv_submission, pointed, signal_count, UINT64_MAX, SV_E_LIMIT);
#undef with
    BAD(SV_E_ARGUMENT, sv_submitter_upload(submitter, fresh, 99, &start, &diagnostic));
    /* From a callback, what is in use says so. */
    sv_submission reentrant = start;
    reentrant.lock = calls_back, reentrant.unlock = nothing;
    const sv_target target = whole_target();
    GOOD(sv_submitter_submit(submitter, renderer, &SHOT, &target, &reentrant, &diagnostic));
    vkQueueWaitIdle(h.queue);
    for (int k = 0; k < 3; ++k) {
        refused += inside[k] == SV_E_STATE;
        if (inside[k] != SV_E_STATE) failures += 1, fprintf(stderr, "FAILED: a call of a callback: %d\n", (int)inside[k]);
    }
    memset(diagnostic.text, 0, sizeof diagnostic.text);
}

/* ---- A device that is lost ---- */

static unsigned heard;
static void lost(void *user, const char *text) { heard += user == &heard && text[0] != 0; }

static VKAPI_ATTR VkResult VKAPI_CALL submit_lost(VkQueue queue, uint32_t count, const VkSubmitInfo2 *infos,
                                                  VkFence fence) {
    (void)queue, (void)count, (void)infos, (void)fence;
    return VK_ERROR_DEVICE_LOST;
}
static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL device_function(VkDevice from, const char *name) {
    if (!strcmp(name, "vkQueueSubmit2")) return (PFN_vkVoidFunction)submit_lost;
    return vkGetDeviceProcAddr(from, name);
}
static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL instance_function(VkInstance from, const char *name) {
    if (!strcmp(name, "vkGetDeviceProcAddr")) return (PFN_vkVoidFunction)device_function;
    return vkGetInstanceProcAddr(from, name);
}

static void device_loss(void) {
    sv_host_device failing = ours;
    failing.get_instance_proc_addr = (sv_get_instance_proc_addr)instance_function;
    failing.device_lost = lost, failing.user = &heard;
    const sv_device kept[] = {device, volume, renderer, submitter};
    GOOD(sv_device_from_host(&failing, &device, &diagnostic));
    const sv_volume_desc desc = volume_desc();
    GOOD(sv_volume_create(device, &desc, &volume, &diagnostic));
    GOOD(sv_submitter_create(device, 1, &submitter, &diagnostic));
    const sv_submission s = submission();
    BAD(SV_E_DEVICE_LOST, sv_submitter_upload(submitter, volume, 0, &s, &diagnostic));
    BAD(SV_E_DEVICE_LOST, sv_submitter_upload(submitter, volume, 0, &s, &diagnostic));
    BAD(SV_E_DEVICE_LOST, h_volume_create(device));
    BAD(SV_E_DEVICE_LOST, h_renderer_create(device));
    BAD(SV_E_DEVICE_LOST, h_submitter_create(device));
    BAD(SV_E_DEVICE_LOST, h_upload(volume));
    BAD(SV_E_DEVICE_LOST, h_cache(device));
    if (heard != 1) failures += 1, fprintf(stderr, "FAILED: the loss was told %u times\n", heard);
    GOOD(sv_submitter_destroy(submitter, &diagnostic));
    GOOD(sv_device_destroy(device, &diagnostic));
    BAD(SV_E_ARGUMENT, h_upload(volume));
    device = kept[0], volume = kept[1], renderer = kept[2], submitter = kept[3];
}

/* ---- Threads ---- */

static sv_function shared_function;
static int destroyed[4];

static void *many_functions(void *number) {
    const sv_function_desc desc = {.struct_size = sizeof desc};
    sv_diagnostic own = {.struct_size = sizeof own};
    for (int k = 0; k < 500; ++k) {
        sv_function made = 0;
        if (sv_function_create(device, &desc, &made, &own) != SV_OK) return "create";
        if (sv_function_destroy(made, &own) != SV_OK) return "destroy";
        if (sv_function_destroy(made, &own) != SV_E_ARGUMENT) return "destroy again";
    }
    destroyed[*(int *)number] = sv_function_destroy(shared_function, &own) == SV_OK;
    return NULL;
}

static void threads(void) {
    const sv_function_desc desc = {.struct_size = sizeof desc};
    GOOD(sv_function_create(device, &desc, &shared_function, &diagnostic));
    pthread_t all[4];
    int numbers[4] = {0, 1, 2, 3};
    for (int k = 0; k < 4; ++k) host_check(!pthread_create(&all[k], NULL, many_functions, &numbers[k]), "start");
    for (int k = 0; k < 4; ++k) {
        void *failed = NULL;
        pthread_join(all[k], &failed);
        if (failed) failures += 1, fprintf(stderr, "FAILED: threads %s\n", (char *)failed);
    }
    const int count = destroyed[0] + destroyed[1] + destroyed[2] + destroyed[3];
    if (count != 1) failures += 1, fprintf(stderr, "FAILED: destroyed %d times\n", count);
}

static void draw(uint8_t *texels) {
    const sv_target target = whole_target();
    VkCommandBuffer drawn = host_begin(&h);
    GOOD(sv_renderer_record_into(renderer, drawn, &SHOT, &target, &diagnostic));
    host_fetch(&h, drawn);
    host_submit_and_wait(&h, drawn);
    host_texels(&h, texels);
}

int main(void) {
    static uint8_t before[BYTES], after[BYTES];
    host_open(&h, WIDTH, HEIGHT, FORMAT);
    for (size_t k = 0; k < sizeof voxels; ++k) voxels[k] = (uint8_t)(k * 37 % 256);
    ours.struct_size = sizeof ours;
    ours.instance = h.instance, ours.physical_device = h.physical_device, ours.device = h.device;
    ours.get_instance_proc_addr = (sv_get_instance_proc_addr)vkGetInstanceProcAddr;
    ours.features = SV_FEATURE_DYNAMIC_RENDERING | SV_FEATURE_SYNCHRONIZATION2 | SV_FEATURE_TIMELINE_SEMAPHORE;
    GOOD(sv_device_from_host(&ours, &device, &diagnostic));
    GOOD(sv_device_from_host(&ours, &other_device, &diagnostic));
    const sv_volume_desc desc = volume_desc();
    const sv_function_desc points = {.struct_size = sizeof points};
    sv_renderer_desc wanted = renderer_desc();
    GOOD(sv_volume_create(device, &desc, &volume, &diagnostic));
    GOOD(sv_function_create(device, &points, &function, &diagnostic));
    GOOD(sv_submitter_create(device, 2, &submitter, &diagnostic));
    cmd = host_begin(&h);
    GOOD(sv_volume_record_upload(volume, cmd, &diagnostic));
    host_submit_and_wait(&h, cmd);
    wanted.volume = volume;
    GOOD(sv_renderer_create(device, &wanted, &renderer, &diagnostic));
    const sv_target_class with_depth = {
        .struct_size = sizeof with_depth, .color_format = FORMAT, .depth_format = VK_FORMAT_D32_SFLOAT};
    wanted.target = &with_depth, wanted.gives_depth = 1;
    GOOD(sv_renderer_create(device, &wanted, &deep, &diagnostic));
    draw(before);

    /* What is refused is never recorded: this command buffer stays empty and is never submitted. */
    cmd = host_begin(&h);
    handles();
    structures();
    null_pointers();
    devices();
    volumes();
    functions();
    settings();
    renderers();
    frames();
    submissions();
    device_loss();
    threads();
    draw(after);
    if (memcmp(before, after, BYTES)) failures += 1, fprintf(stderr, "FAILED: another picture than before\n");

    GOOD(sv_device_destroy(other_device, &diagnostic));
    GOOD(sv_device_destroy(device, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_device_destroy(device, &diagnostic));
    const unsigned messages = host_close(&h);
    printf("%u calls refused, %u failures, %u messages\n", refused, failures, messages);
    return failures != 0 || messages != 0;
}
