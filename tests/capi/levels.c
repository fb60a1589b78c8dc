/* The three levels draw one picture, several frames in flight, host depth hides, depth and picks come back. */
#include "levels.h"

sv_diagnostic diagnostic = {.struct_size = sizeof(sv_diagnostic)};
host h;
sv_device device;
sv_volume volume;
unsigned failures;
static unsigned locked, unlocked;

void check(sv_status status, const char *what) {
    if (status == SV_OK) return;
    fprintf(stderr, "%s: status %d: %s\n", what, (int)status, diagnostic.text);
    exit(1);
}

void expect(int is_right, const char *what) {
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

sv_target whole_target(void) {
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

/* The host's rendering to its image, and to a depth buffer that is cleared, where there is one. */
void begin_rendering(VkCommandBuffer cmd, VkImageView depth, float depth_value) {
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

void fetch(VkCommandBuffer cmd, uint8_t *texels) {
    host_barrier(cmd, h.image, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                  VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    host_fetch(&h, cmd);
    host_submit_and_wait(&h, cmd);
    host_texels(&h, texels);
}

/* Dense enough that light from behind is halved inside the ball. */
sv_transfer_function make_function(void) {
    const sv_color_point colors[] = {{0.0, {1, 0, 0}}, {8.0, {0, 1, 0}}};
    const sv_opacity_point opacities[] = {{0.0, 0.0}, {8.0, 0.5}};
    const sv_transfer_function_desc described = {.struct_size = sizeof described,
                                        .colors = colors,
                                        .color_count = 2,
                                        .opacities = opacities,
                                        .opacity_count = 2};
    sv_transfer_function made = 0;
    CHECK(sv_transfer_function_create(device, &described, &made, &diagnostic));
    return made;
}

sv_renderer make_renderer(const sv_settings *settings, sv_transfer_function function) {
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

void draw_a(sv_renderer renderer, const sv_camera *camera, uint8_t *texels) {
    const sv_frame_info shot = {.struct_size = sizeof shot, .camera = camera, .frame = 1};
    VkCommandBuffer cmd = host_begin(&h);
    CHECK(sv_renderer_record(renderer, cmd, &shot, &diagnostic));
    host_barrier(cmd, h.image, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
                  VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    begin_rendering(cmd, VK_NULL_HANDLE, 0.0f);
    CHECK(sv_renderer_draw(renderer, cmd, 1, &diagnostic));
    vkCmdEndRendering(cmd);
    fetch(cmd, texels);
}

void draw_b(sv_renderer renderer, uint8_t *texels) {
    const sv_frame_info shot = {.struct_size = sizeof shot};
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
    const sv_frame_info shot = {.struct_size = sizeof shot};
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

unsigned drawn_pixels(const uint8_t *texels) {
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

    sv_transfer_function function = make_function();
    CHECK(sv_device_announce(device, 1, &diagnostic));
    CHECK(sv_renderer_set_transfer_function(renderer, function, &diagnostic));
    CHECK(sv_transfer_function_destroy(function, &diagnostic));
    draw_b(renderer, other);
    expect(memcmp(other, b, BYTES) != 0, "another function is another picture");
    CHECK(sv_renderer_set_transfer_function(renderer, 0, &diagnostic));
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

    for (uint32_t technique = 0; technique < 5; ++technique) {
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

/* A device of stricter limits holds the volume in bricks, and draws the same picture. */
static void test_limits(const sv_host_device *ours) {
    static uint8_t whole[BYTES], bricks[BYTES];
    const sv_limits limits = {.struct_size = sizeof limits, .max_image_dimension_3d = 16};
    const sv_device kept_device = device;
    const sv_volume kept_volume = volume;
    sv_host_device strict = *ours;
    strict.limits = &limits;
    sv_renderer renderer = make_renderer(NULL, 0);
    draw_b(renderer, whole);
    CHECK(sv_renderer_destroy(renderer, &diagnostic));
    CHECK(sv_device_from_host(&strict, &device, &diagnostic));
    volume = make_volume(9.0);
    VkCommandBuffer cmd = host_begin(&h);
    CHECK(sv_volume_record_upload(volume, cmd, &diagnostic));
    host_submit_and_wait(&h, cmd);
    renderer = make_renderer(NULL, 0);
    draw_b(renderer, bricks);
    expect(!memcmp(whole, bricks, BYTES), "stricter limits, the same picture");
    CHECK(sv_device_destroy(device, &diagnostic));
    expect(sv_renderer_destroy(renderer, &diagnostic) == SV_E_ARGUMENT, "a renderer goes with its device");
    device = kept_device, volume = kept_volume;
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
    test_limits(&ours);
    test_levels();
    volume = ball;
    test_passes();
    test_asked(&ours);
    test_life();
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
