/* What the parts of abuse.c share: a host with one of each object, and calls with one wrong argument. */
#ifndef ABUSE_H
#define ABUSE_H

#include "../../examples/embed_host.h"
#include "stratavox.h"
#include <math.h>

enum { WIDTH = 40, HEIGHT = 30, VOXELS = 8, BYTES = WIDTH * HEIGHT * 4 };
#define FORMAT VK_FORMAT_R8G8B8A8_UNORM

extern host h;
extern sv_host_device ours;
extern sv_device device, other_device;
extern sv_volume volume, fresh;
extern sv_transfer_function function;
extern sv_renderer renderer, deep;
extern sv_submitter submitter;
extern sv_update staged;
extern VkCommandBuffer cmd;
extern uint8_t voxels[VOXELS * VOXELS * VOXELS];
extern uint64_t made_handle;
extern unsigned refused, failures;
extern sv_diagnostic diagnostic;

/* Ends the program where the status is not SV_OK. */
void good(sv_status status, const char *what);
#define GOOD(call) good(call, #call)

/* Counts a refusal that is told in words. `wanted` is the status, or SV_OK for any but that. */
void bad(sv_status status, sv_status wanted, const char *what);
#define TEXT_OF(line) #line
#define AT(line) "line " TEXT_OF(line) ": "
#define BAD(wanted, call) bad(call, wanted, AT(__LINE__) #call)

/* The same, and the words name `name`. */
#define NAMED(wanted, name, call)                                                                  \
    do {                                                                                           \
        const sv_status found = call;                                                              \
        const int is_named = strstr(diagnostic.text, name) != NULL;                                \
        if (!is_named) failures += 1, fprintf(stderr, "FAILED: not named: %s\n", AT(__LINE__) name); \
        bad(found, wanted, AT(__LINE__) #call);                                                    \
    } while (0)

/* One call of `with` with one wrong field. */
#define WITH(kind, start, field, value, wanted) \
    do {                                        \
        kind wrong = start;                     \
        wrong.field = value;                    \
        BAD(wanted, with(wrong));               \
    } while (0)

/* Handles of a device that are gone, of another kind, of another device. */
void abuse_handles(void);
/* Structures that are none. */
void abuse_structures(void);
/* Numbers that mean nothing: of devices, volumes and functions, of settings and renderers, of frames. */
void abuse_objects(void);
void abuse_pictures(void);
void abuse_frames(void);
/* Fields and shapes that are none. */
void abuse_geometry(void);

/* Structures as they should be. */

static inline sv_volume_desc volume_desc(void) {
    const sv_volume_desc made = {.struct_size = sizeof made,
                                 .dims = {VOXELS, VOXELS, VOXELS},
                                 .voxels = voxels,
                                 .voxel_bytes = sizeof voxels};
    return made;
}

/* All of it, as it is. */
static inline sv_update_desc update_desc(void) {
    const sv_update_desc made = {.struct_size = sizeof made,
                                 .extent = {VOXELS, VOXELS, VOXELS},
                                 .voxels = voxels,
                                 .voxel_bytes = sizeof voxels};
    return made;
}

static const sv_target_class CLASS = {.struct_size = sizeof(sv_target_class), .color_format = VK_FORMAT_R8G8B8A8_UNORM};

static inline sv_renderer_desc renderer_desc(void) {
    const sv_renderer_desc made = {.struct_size = sizeof made,
                                   .volume = volume,
                                   .target = &CLASS,
                                   .width = WIDTH,
                                   .height = HEIGHT,
                                   .frames_in_flight = 2,
                                   .picks = 1};
    return made;
}

static inline sv_target whole_target(void) {
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

static const sv_frame_info SHOT = {.struct_size = sizeof(sv_frame_info)};

static inline sv_submission submission(void) {
    const sv_submission made = {.struct_size = sizeof made, .queue = h.queue};
    return made;
}

#endif
