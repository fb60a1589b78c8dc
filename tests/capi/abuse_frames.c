/* Cameras, frames, targets and submissions of numbers that mean nothing. */
#include "abuse.h"

static sv_status with_camera(sv_camera camera) {
    const sv_frame_info shot = {.struct_size = sizeof shot, .camera = &camera};
    return sv_renderer_record(renderer, cmd, &shot, &diagnostic);
}
static sv_status with_target(sv_target target) {
    return sv_renderer_record_into(renderer, cmd, &SHOT, &target, &diagnostic);
}
static sv_status with_submission(sv_submission wanted) {
    const sv_target target = whole_target();
    return sv_submitter_submit(submitter, renderer, &SHOT, &target, &wanted, &diagnostic);
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
    sv_frame_info late = SHOT;
    late.frame = 2;
    BAD(SV_E_ARGUMENT, sv_renderer_record(renderer, cmd, &late, &diagnostic));
    sv_frame_info reserved = SHOT;
    reserved.reserved = 7;
    NAMED(SV_E_ARGUMENT, "sv_frame_info.reserved: wanted 0, found 7", sv_renderer_record(renderer, cmd, &reserved, &diagnostic));
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
    BAD(SV_E_STATE, sv_renderer_pick(renderer, 0, 0, 0, &pick, &diagnostic));
    BAD(SV_E_STATE, sv_renderer_pick(renderer, 0, WIDTH, UINT32_MAX, &pick, &diagnostic));
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
    sv_target later = whole;
    later.before.reserved = 1;
    NAMED(SV_E_ARGUMENT, "sv_target.before.reserved", with(later));
    later = whole;
    later.after = (sv_image_state){.reserved = 1};
    NAMED(SV_E_ARGUMENT, "sv_target.after.reserved", with(later));
#undef with
}

static sv_status inside[3];
static void nothing(void *user) { (void)user; }
static void calls_back(void *user) {
    (void)user;
    inside[0] = sv_renderer_draw(renderer, cmd, 0, &diagnostic);
    inside[1] = with_submission(submission());
    inside[2] = sv_renderer_set_settings(renderer, NULL, &diagnostic);
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
    uint32_t is_done = 0;
    uint64_t left = 0;
    const sv_pacing wrong = {.struct_size = sizeof wrong, .target_ms = -1.0};
    BAD(SV_E_ARGUMENT, sv_submitter_upload_in_parts(submitter, fresh, 99, &start, NULL, &is_done, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_submitter_upload_in_parts(submitter, fresh, 0, &start, &wrong, &is_done, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_submitter_upload_in_parts(submitter, fresh, 0, &start, NULL, NULL, &diagnostic));
    BAD(SV_E_STATE, sv_submitter_upload_in_parts(submitter, volume, 0, &start, NULL, &is_done, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_submitter_update_in_parts(submitter, volume, staged, 99, &start, NULL, &is_done, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_submitter_update_in_parts(submitter, volume, staged, 0, NULL, NULL, &is_done, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_submitter_update_in_parts(submitter, volume, staged, 0, &start, &wrong, &is_done, &diagnostic));
    BAD(SV_E_STATE, sv_submitter_update_in_parts(submitter, fresh, staged, 0, &start, NULL, &is_done, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_volume_record_upload_part(fresh, NULL, 1, &left, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_volume_record_upload_part(fresh, cmd, 1, NULL, &diagnostic));
    BAD(SV_E_STATE, sv_volume_record_upload_part(volume, cmd, 1, &left, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_volume_record_update_part(volume, NULL, staged, 1, &left, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_volume_record_update_part(volume, cmd, staged, 1, NULL, &diagnostic));
    /* One that was staged later. */
    const sv_update_desc desc = update_desc();
    sv_update second = 0;
    GOOD(sv_volume_stage_update(volume, &desc, &second, &diagnostic));
    BAD(SV_E_STATE, sv_volume_record_update(volume, cmd, second, &diagnostic));
    BAD(SV_E_STATE, sv_volume_record_update_part(volume, cmd, second, 1, &left, &diagnostic));
    BAD(SV_E_STATE, sv_submitter_update_in_parts(submitter, volume, second, 0, &start, NULL, &is_done, &diagnostic));
    GOOD(sv_update_destroy(second, &diagnostic));
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

void abuse_frames(void) {
    frames();
    submissions();
}
