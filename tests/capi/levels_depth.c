/* Depth of the host in, depth of the volume and picks out. */
#include "levels.h"

/* From the front, as the default is, but by matrices. */
static sv_camera matrices(double distance, int is_reversed) {
    const double near = 1.0, far = 100.0, f = 3.0, a = is_reversed ? near / (far - near) : far / (near - far);
    const double b = is_reversed ? far * near / (far - near) : far * near / (near - far);
    const sv_camera camera = {
        .struct_size = sizeof camera,
        .kind = SV_CAMERA_MATRICES,
        .is_reversed = (uint32_t)is_reversed,
        .view_from_world = {-1, 0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 12, -12, -12 - distance, 1},
        .clip_from_view = {f * HEIGHT / WIDTH, 0, 0, 0, 0, -f, 0, 0, 0, 0, a, -1, 0, 0, b, 0}};
    return camera;
}

static void clear_depth(VkCommandBuffer cmd, const host_depth *d, float depth) {
    const VkClearDepthStencilValue value = {depth, 0};
    const VkImageSubresourceRange range = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 1, 0, 1};
    host_barrier(cmd, d->image, VK_IMAGE_ASPECT_DEPTH_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
                  VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    vkCmdClearDepthStencilImage(cmd, d->image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &value, 1, &range);
    host_barrier(cmd, d->image, VK_IMAGE_ASPECT_DEPTH_BIT, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                  VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL);
}

void test_depth(int is_reversed) {
    static uint8_t alone[BYTES], far[BYTES], near[BYTES];
    const float far_depth = is_reversed ? 0.0f : 1.0f, near_depth = is_reversed ? 0.999f : 0.001f;
    const sv_camera camera = matrices(60.0, is_reversed);
    sv_transfer_function function = make_function();
    sv_renderer plain = make_renderer(NULL, function);
    draw_a(plain, &camera, alone);
    expect(drawn_pixels(alone) > 200, "a camera of matrices shows something");

    host_depth read = host_make_depth(&h), attached = host_make_depth(&h);
    const sv_depth_image image = {(uint64_t)read.view, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL, WIDTH, HEIGHT, 0};
    const sv_target_class class = {.struct_size = sizeof class,
                                   .color_format = FORMAT,
                                   .depth_format = VK_FORMAT_D32_SFLOAT,
                                   .is_depth_reversed = (uint32_t)is_reversed};
    const sv_renderer_desc wanted = {.struct_size = sizeof wanted,
                                     .volume = volume,
                                     .function = function,
                                     .target = &class,
                                     .width = WIDTH,
                                     .height = HEIGHT,
                                     .has_host_depth = 1,
                                     .gives_depth = 1,
                                     .depth_images = &image,
                                     .depth_image_count = 1};
    sv_renderer renderer = 0;
    CHECK(sv_renderer_create(device, &wanted, &renderer, &diagnostic));
    for (int is_near = 0; is_near < 2; ++is_near) {
        const sv_frame_info shot = {.struct_size = sizeof shot, .camera = &camera};
        VkCommandBuffer cmd = host_begin(&h);
        clear_depth(cmd, &read, is_near ? near_depth : far_depth);
        CHECK(sv_renderer_record(renderer, cmd, &shot, &diagnostic));
        CHECK(sv_renderer_record_pick(renderer, cmd, 0, WIDTH / 2, HEIGHT / 2, &diagnostic));
        host_barrier(cmd, attached.image, VK_IMAGE_ASPECT_DEPTH_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
                      VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL);
        host_barrier(cmd, h.image, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
                      VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
        begin_rendering(cmd, attached.view, far_depth);
        CHECK(sv_renderer_draw(renderer, cmd, 0, &diagnostic));
        CHECK(sv_renderer_draw_depth(renderer, cmd, 0, &diagnostic));
        vkCmdEndRendering(cmd);
        fetch(cmd, is_near ? near : far);
        sv_pick pick = {.struct_size = sizeof pick};
        CHECK(sv_renderer_pick(renderer, 0, WIDTH / 2, HEIGHT / 2, &pick, &diagnostic));
        /* The centre of voxels is at + 0.5; the ball is about (11.5, 13, 12.5), and the front is at larger y. */
        const int is_there = pick.is_hit && pick.has_color && pick.has_value && fabs(pick.position[0] - 12.0) < 0.5 &&
                             pick.position[1] > 5.0 && pick.position[1] < 21.0 && fabs(pick.position[2] - 12.0) < 0.5;
        if (pick.is_hit) printf("    %g, %g, %g\n", pick.position[0], pick.position[1], pick.position[2]);
        expect(is_near ? !pick.is_hit : is_there, is_near ? "nothing to pick behind the host" : "a pick lies in the ball");
    }
    expect(!memcmp(far, alone, BYTES), "nothing of the host's before it: the picture alone");
    expect(drawn_pixels(near) == 0, "all of it behind the host: nothing of it");
    CHECK(sv_renderer_destroy(renderer, &diagnostic));
    CHECK(sv_renderer_destroy(plain, &diagnostic));
    CHECK(sv_transfer_function_destroy(function, &diagnostic));
    host_free_depth(&h, read);
    host_free_depth(&h, attached);
}
