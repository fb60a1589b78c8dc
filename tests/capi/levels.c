/* The three levels draw one picture, several frames in flight, host depth hides, depth and picks come back. */
#include "../../examples/embed_host.h"
#include "stratavox.h"
#include <math.h>

enum { WIDTH = 64, HEIGHT = 48, VOXELS = 24, BYTES = WIDTH * HEIGHT * 4 };
static const VkFormat FORMAT = VK_FORMAT_R8G8B8A8_UNORM;
static const float BEHIND[4] = {0.25f, 0.0f, 0.5f, 1.0f};

static sv_diagnostic diagnostic = {.struct_size = sizeof(sv_diagnostic)};
static host h;
static sv_device device;
static sv_volume volume;
static unsigned failures, locked, unlocked;

static void check(sv_status status, const char *what) {
    if (status == SV_OK) return;
    fprintf(stderr, "%s: status %d: %s\n", what, (int)status, diagnostic.text);
    exit(1);
}
#define CHECK(call) check(call, #call)

static void expect(int is_right, const char *what) {
    printf("%s: %s\n", is_right ? "ok" : "FAILED", what);
    failures += !is_right;
}

static void lock(void *user) { *(unsigned *)user += 1; }
static void unlock(void *user) { unlocked += *(unsigned *)user; }

static sv_volume make_volume(double radius) {
    static uint16_t voxels[VOXELS][VOXELS][VOXELS];
    for (int z = 0; z < VOXELS; ++z)
        for (int y = 0; y < VOXELS; ++y)
            for (int x = 0; x < VOXELS; ++x) {
                const double dx = x - 11.0, dy = y - 12.5, dz = z - 12.0;
                const double inside = radius - sqrt(dx * dx + dy * dy + dz * dz);
                voxels[z][y][x] = (uint16_t)(inside > 0.0 ? 1000.0 * inside : 0.0);
            }
    const sv_volume_desc described = {.struct_size = sizeof described,
                                      .dims = {VOXELS, VOXELS, VOXELS},
                                      .voxel_type = SV_VOXEL_U16,
                                      .voxels = voxels,
                                      .voxel_bytes = sizeof voxels,
                                      .slope = 0.001};
    sv_volume made = 0;
    CHECK(sv_volume_create(device, &described, &made, &diagnostic));
    return made;
}

static sv_target whole_target(void) {
    const sv_target target = {.struct_size = sizeof target,
                              .image = (uint64_t)h.image,
                              .view = (uint64_t)h.view,
                              .format = FORMAT,
                              .width = WIDTH,
                              .height = HEIGHT,
                              .is_cleared = 1,
                              .clear_color = {BEHIND[0], BEHIND[1], BEHIND[2], BEHIND[3]},
                              .after = {.layout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                                        .stage = VK_PIPELINE_STAGE_2_COPY_BIT,
                                        .access = VK_ACCESS_2_TRANSFER_READ_BIT}};
    return target;
}

static void image_barrier(VkCommandBuffer cmd, VkImage image, VkImageAspectFlags aspect, VkImageLayout from,
                          VkImageLayout to) {
    const VkImageMemoryBarrier2 barrier = {.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
                                           .srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                           .srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT,
                                           .dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                           .dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT,
                                           .oldLayout = from,
                                           .newLayout = to,
                                           .image = image,
                                           .subresourceRange = {aspect, 0, 1, 0, 1}};
    const VkDependencyInfo dependency = {.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                         .imageMemoryBarrierCount = 1,
                                         .pImageMemoryBarriers = &barrier};
    vkCmdPipelineBarrier2(cmd, &dependency);
}

/* The host's rendering to its image, and to a depth buffer that is cleared, where there is one. */
static void begin_rendering(VkCommandBuffer cmd, VkImageView depth, float depth_value) {
    const VkRenderingAttachmentInfo color = {.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                             .imageView = h.view,
                                             .imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                             .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                             .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                             .clearValue = {{{BEHIND[0], BEHIND[1], BEHIND[2], BEHIND[3]}}}};
    const VkRenderingAttachmentInfo tested = {.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                              .imageView = depth,
                                              .imageLayout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
                                              .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                              .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                              .clearValue = {.depthStencil = {depth_value, 0}}};
    const VkRenderingInfo info = {.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                                  .renderArea = {{0, 0}, {WIDTH, HEIGHT}},
                                  .layerCount = 1,
                                  .colorAttachmentCount = 1,
                                  .pColorAttachments = &color,
                                  .pDepthAttachment = depth ? &tested : NULL};
    vkCmdBeginRendering(cmd, &info);
}

static void fetch(VkCommandBuffer cmd, uint8_t *texels) {
    image_barrier(cmd, h.image, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                  VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    host_fetch(&h, cmd);
    host_submit_and_wait(&h, cmd);
    host_texels(&h, texels);
}

static sv_renderer make_renderer(const sv_settings *settings, sv_function function) {
    const sv_target_class class = {.struct_size = sizeof class, .color_format = FORMAT};
    const sv_renderer_desc wanted = {.struct_size = sizeof wanted,
                                     .volume = volume,
                                     .function = function,
                                     .settings = settings,
                                     .target = &class,
                                     .width = WIDTH,
                                     .height = HEIGHT,
                                     .frames_in_flight = 2};
    sv_renderer made = 0;
    CHECK(sv_renderer_create(device, &wanted, &made, &diagnostic));
    return made;
}

static void draw_a(sv_renderer renderer, const sv_camera *camera, uint8_t *texels) {
    const sv_shot shot = {.struct_size = sizeof shot, .camera = camera, .frame = 1};
    VkCommandBuffer cmd = host_begin(&h);
    CHECK(sv_renderer_record(renderer, cmd, &shot, &diagnostic));
    image_barrier(cmd, h.image, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
                  VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    begin_rendering(cmd, VK_NULL_HANDLE, 0.0f);
    CHECK(sv_renderer_draw(renderer, cmd, 1, &diagnostic));
    vkCmdEndRendering(cmd);
    fetch(cmd, texels);
}

static void draw_b(sv_renderer renderer, uint8_t *texels) {
    const sv_shot shot = {.struct_size = sizeof shot};
    const sv_target target = whole_target();
    VkCommandBuffer cmd = host_begin(&h);
    CHECK(sv_renderer_record_into(renderer, cmd, &shot, &target, &diagnostic));
    host_fetch(&h, cmd);
    host_submit_and_wait(&h, cmd);
    host_texels(&h, texels);
}

static VkSemaphore timeline(void) {
    const VkSemaphoreTypeCreateInfo kind = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO,
                                            .semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE};
    const VkSemaphoreCreateInfo info = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, .pNext = &kind};
    VkSemaphore made = VK_NULL_HANDLE;
    vkCreateSemaphore(h.device, &info, NULL, &made);
    return made;
}

static void draw_c(sv_renderer renderer, uint8_t *texels) {
    VkSemaphore gate = timeline(), done = timeline();
    const sv_timeline_point wait = {(uint64_t)gate, 3}, signal = {(uint64_t)done, 7};
    const sv_submission submission = {.struct_size = sizeof submission,
                                      .queue = h.queue,
                                      .lock = lock,
                                      .unlock = unlock,
                                      .user = &locked,
                                      .waits = &wait,
                                      .wait_count = 1,
                                      .signals = &signal,
                                      .signal_count = 1};
    const sv_shot shot = {.struct_size = sizeof shot};
    const sv_target target = whole_target();
    sv_submitter submitter = 0;
    CHECK(sv_submitter_create(device, 2, &submitter, &diagnostic));
    CHECK(sv_submitter_submit(submitter, renderer, &shot, &target, &submission, &diagnostic));
    uint64_t value = 1;
    vkGetSemaphoreCounterValue(h.device, done, &value);
    expect(value == 0, "a submission waits for the host's value");
    const VkSemaphoreSignalInfo open = {
        .sType = VK_STRUCTURE_TYPE_SEMAPHORE_SIGNAL_INFO, .semaphore = gate, .value = 3};
    vkSignalSemaphore(h.device, &open);
    const uint64_t seven = 7;
    const VkSemaphoreWaitInfo until = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO,
                                       .semaphoreCount = 1,
                                       .pSemaphores = &done,
                                       .pValues = &seven};
    vkWaitSemaphores(h.device, &until, UINT64_MAX);
    VkCommandBuffer cmd = host_begin(&h);
    host_fetch(&h, cmd);
    host_submit_and_wait(&h, cmd);
    host_texels(&h, texels);
    CHECK(sv_submitter_destroy(submitter, &diagnostic));
    vkDestroySemaphore(h.device, gate, NULL);
    vkDestroySemaphore(h.device, done, NULL);
}

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

/* A depth buffer of the host's, cleared to one depth. */
typedef struct depth_image {
    VkImage image;
    VkImageView view;
    VkDeviceMemory memory;
} depth_image;

static depth_image make_depth(void) {
    depth_image d;
    const VkImageCreateInfo image = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
        .imageType = VK_IMAGE_TYPE_2D,
        .format = VK_FORMAT_D32_SFLOAT,
        .extent = {WIDTH, HEIGHT, 1},
        .mipLevels = 1,
        .arrayLayers = 1,
        .samples = VK_SAMPLE_COUNT_1_BIT,
        .usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                 VK_IMAGE_USAGE_TRANSFER_DST_BIT};
    vkCreateImage(h.device, &image, NULL, &d.image);
    VkMemoryRequirements wanted;
    vkGetImageMemoryRequirements(h.device, d.image, &wanted);
    d.memory = host_allocate(&h, wanted, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    vkBindImageMemory(h.device, d.image, d.memory, 0);
    const VkImageViewCreateInfo view = {.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                        .image = d.image,
                                        .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                        .format = VK_FORMAT_D32_SFLOAT,
                                        .subresourceRange = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 1, 0, 1}};
    vkCreateImageView(h.device, &view, NULL, &d.view);
    return d;
}

static void clear_depth(VkCommandBuffer cmd, const depth_image *d, float depth) {
    const VkClearDepthStencilValue value = {depth, 0};
    const VkImageSubresourceRange range = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 1, 0, 1};
    image_barrier(cmd, d->image, VK_IMAGE_ASPECT_DEPTH_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
                  VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    vkCmdClearDepthStencilImage(cmd, d->image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &value, 1, &range);
    image_barrier(cmd, d->image, VK_IMAGE_ASPECT_DEPTH_BIT, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                  VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL);
}

static unsigned drawn_pixels(const uint8_t *texels) {
    unsigned drawn = 0;
    for (int k = 0; k < BYTES; k += 4) drawn += texels[k + 1] != 0;
    return drawn;
}

static void test_levels(void) {
    static uint8_t a[BYTES], b[BYTES], c[BYTES], other[BYTES];
    sv_renderer renderer = make_renderer(NULL, 0);
    uint32_t before = 0, after = 0;
    CHECK(sv_device_pipelines_made(device, &before, &diagnostic));
    draw_a(renderer, NULL, a);
    draw_b(renderer, b);
    draw_c(renderer, c);
    expect(drawn_pixels(b) > 200, "the picture shows something");
    expect(!memcmp(a, b, BYTES), "level A draws what level B draws");
    expect(!memcmp(c, b, BYTES), "level C draws what level B draws");
    expect(locked == 1 && unlocked == 1, "the queue was locked and unlocked once");

    const sv_color_point colors[] = {{0.0, {1, 0, 0}}, {8.0, {0, 1, 0}}};
    const sv_opacity_point opacities[] = {{0.0, 0.0}, {8.0, 0.5}};
    const sv_function_desc described = {.struct_size = sizeof described,
                                        .colors = colors,
                                        .color_count = 2,
                                        .opacities = opacities,
                                        .opacity_count = 2};
    sv_function function = 0;
    CHECK(sv_function_create(device, &described, &function, &diagnostic));
    CHECK(sv_device_announce(device, 1, &diagnostic));
    CHECK(sv_renderer_set_function(renderer, function, &diagnostic));
    CHECK(sv_function_destroy(function, &diagnostic));
    draw_b(renderer, other);
    expect(memcmp(other, b, BYTES) != 0, "another function is another picture");
    CHECK(sv_renderer_set_function(renderer, 0, &diagnostic));
    draw_b(renderer, other);
    expect(!memcmp(other, b, BYTES), "and 0 is the ramp of greys again");
    CHECK(sv_device_retire(device, 1, &diagnostic));
    CHECK(sv_device_pipelines_made(device, &after, &diagnostic));
    expect(before == after, "no frame and no function made a pipeline");

    const sv_settings cropped = {.struct_size = sizeof cropped, .crop_max = {12, 24, 24}};
    CHECK(sv_renderer_set_settings(renderer, &cropped, &diagnostic));
    draw_b(renderer, other);
    expect(drawn_pixels(other) < drawn_pixels(b), "a crop leaves less");
    const sv_settings mip = {.struct_size = sizeof mip, .mode = SV_MODE_MIP};
    expect(sv_renderer_set_settings(renderer, &mip, &diagnostic) == SV_E_STATE, "another mode is another renderer");
    CHECK(sv_renderer_set_settings(renderer, NULL, &diagnostic));

    sv_volume next = make_volume(5.0);
    VkCommandBuffer cmd = host_begin(&h);
    CHECK(sv_volume_record_upload(next, cmd, &diagnostic));
    CHECK(sv_renderer_set_volume(renderer, next, 0, &diagnostic));
    host_submit_and_wait(&h, cmd);
    CHECK(sv_volume_destroy(next, &diagnostic));
    draw_b(renderer, other);
    expect(drawn_pixels(other) < drawn_pixels(b) && drawn_pixels(other) > 20, "the next time of a series");
    CHECK(sv_renderer_destroy(renderer, &diagnostic));

    for (uint32_t technique = 0; technique < 3; ++technique) {
        const sv_settings settings = {.struct_size = sizeof settings, .technique = technique};
        static uint8_t voxel = 200;
        const sv_volume_desc one = {.struct_size = sizeof one,
                                    .dims = {1, 1, 1},
                                    .voxels = &voxel,
                                    .voxel_bytes = 1,
                                    .settings = &settings};
        CHECK(sv_volume_create(device, &one, &volume, &diagnostic));
        cmd = host_begin(&h);
        CHECK(sv_volume_record_upload(volume, cmd, &diagnostic));
        host_submit_and_wait(&h, cmd);
        renderer = make_renderer(&settings, 0);
        draw_a(renderer, NULL, a);
        draw_b(renderer, b);
        expect(drawn_pixels(a) > 20 && !memcmp(a, b, BYTES), "each technique draws a volume of one voxel");
        CHECK(sv_renderer_destroy(renderer, &diagnostic));
        CHECK(sv_volume_destroy(volume, &diagnostic));
    }
}

static void test_depth(int is_reversed) {
    static uint8_t alone[BYTES], far[BYTES], near[BYTES];
    const float far_depth = is_reversed ? 0.0f : 1.0f, near_depth = is_reversed ? 0.999f : 0.001f;
    const sv_camera camera = matrices(60.0, is_reversed);
    sv_renderer plain = make_renderer(NULL, 0);
    draw_a(plain, &camera, alone);
    expect(drawn_pixels(alone) > 200, "a camera of matrices shows something");

    depth_image read = make_depth(), attached = make_depth();
    const sv_depth_image image = {(uint64_t)read.view, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL, WIDTH, HEIGHT, 0};
    const sv_target_class class = {.struct_size = sizeof class,
                                   .color_format = FORMAT,
                                   .depth_format = VK_FORMAT_D32_SFLOAT,
                                   .is_depth_reversed = (uint32_t)is_reversed};
    const sv_renderer_desc wanted = {.struct_size = sizeof wanted,
                                     .volume = volume,
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
        const sv_shot shot = {.struct_size = sizeof shot, .camera = &camera};
        VkCommandBuffer cmd = host_begin(&h);
        clear_depth(cmd, &read, is_near ? near_depth : far_depth);
        CHECK(sv_renderer_record(renderer, cmd, &shot, &diagnostic));
        CHECK(sv_renderer_record_pick(renderer, cmd, 0, WIDTH / 2, HEIGHT / 2, &diagnostic));
        image_barrier(cmd, attached.image, VK_IMAGE_ASPECT_DEPTH_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
                      VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL);
        image_barrier(cmd, h.image, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
                      VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
        begin_rendering(cmd, attached.view, far_depth);
        CHECK(sv_renderer_draw(renderer, cmd, 0, &diagnostic));
        CHECK(sv_renderer_draw_depth(renderer, cmd, 0, &diagnostic));
        vkCmdEndRendering(cmd);
        fetch(cmd, is_near ? near : far);
        sv_pick pick = {.struct_size = sizeof pick};
        CHECK(sv_renderer_pick(renderer, 0, WIDTH / 2, HEIGHT / 2, &pick, &diagnostic));
        /* The centre of voxels is at + 0.5; the ball is about (11.5, 13, 12.5), and the front is at larger y. */
        const int is_there = pick.is_hit && pick.has_color && !pick.has_value && fabs(pick.position[0] - 12.0) < 0.5 &&
                             pick.position[1] > 5.0 && pick.position[1] < 21.0 && fabs(pick.position[2] - 12.0) < 0.5;
        if (pick.is_hit) printf("    %g, %g, %g\n", pick.position[0], pick.position[1], pick.position[2]);
        expect(is_near ? !pick.is_hit : is_there, is_near ? "nothing to pick behind the host" : "a pick lies in the ball");
    }
    expect(!memcmp(far, alone, BYTES), "nothing of the host's before it: the picture alone");
    expect(drawn_pixels(near) == 0, "all of it behind the host: nothing of it");
    CHECK(sv_renderer_destroy(renderer, &diagnostic));
    CHECK(sv_renderer_destroy(plain, &diagnostic));
    const depth_image both[] = {read, attached};
    for (int k = 0; k < 2; ++k) {
        vkDestroyImageView(h.device, both[k].view, NULL);
        vkDestroyImage(h.device, both[k].image, NULL);
        vkFreeMemory(h.device, both[k].memory, NULL);
    }
}

int main(void) {
    host_open(&h, WIDTH, HEIGHT, FORMAT);
    const sv_host_device ours = {
        .struct_size = sizeof ours,
        .instance = h.instance,
        .physical_device = h.physical_device,
        .device = h.device,
        .get_instance_proc_addr = (sv_get_instance_proc_addr)vkGetInstanceProcAddr,
        .features = SV_FEATURE_DYNAMIC_RENDERING | SV_FEATURE_SYNCHRONIZATION2 | SV_FEATURE_TIMELINE_SEMAPHORE};
    CHECK(sv_device_from_host(&ours, &device, &diagnostic));
    sv_volume ball = volume = make_volume(9.0);
    double range[2] = {-1.0, -1.0};
    CHECK(sv_volume_value_range(volume, range, &diagnostic));
    expect(range[0] == 0.0 && range[1] > 8.0 && range[1] < 9.0, "the range of values");
    VkCommandBuffer cmd = host_begin(&h);
    CHECK(sv_volume_record_upload(volume, cmd, &diagnostic));
    host_submit_and_wait(&h, cmd);
    test_depth(0);
    test_depth(1);
    test_levels();
    volume = ball;

    uint64_t bytes = 0;
    CHECK(sv_device_pipeline_cache(device, &bytes, NULL, &diagnostic));
    void *cache = malloc(bytes + 1);
    CHECK(sv_device_pipeline_cache(device, &bytes, cache, &diagnostic));
    sv_host_device again = ours;
    again.pipeline_cache = cache, again.pipeline_cache_bytes = bytes;
    sv_device second = 0;
    CHECK(sv_device_from_host(&again, &second, &diagnostic));
    CHECK(sv_device_destroy(second, &diagnostic));
    free(cache);

    sv_memory memory = {.struct_size = sizeof memory};
    CHECK(sv_device_memory(device, &memory, &diagnostic));
    expect(memory.used_bytes > 0 && memory.reserved_bytes >= memory.used_bytes && memory.handles == 1, "memory in use");
    CHECK(sv_device_destroy(device, &diagnostic));
    expect(sv_volume_destroy(ball, &diagnostic) == SV_E_ARGUMENT, "with the device goes what was made on it");
    const unsigned messages = host_close(&h);
    expect(messages == 0, "no message of the validation layer");
    return failures != 0;
}
