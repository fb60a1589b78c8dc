/* Level A in a render pass of the host's and in a rendering of several samples; level B with a queue family that is named;
 * frames of paths, which add up. */
#include "levels.h"

static sv_renderer renderer_for(const sv_target_class *target) {
    const sv_renderer_desc wanted = {.struct_size = sizeof wanted,
                                     .volume = volume,
                                     .target = target,
                                     .width = WIDTH,
                                     .height = HEIGHT};
    sv_renderer made = 0;
    CHECK(sv_renderer_create(device, &wanted, &made, &diagnostic));
    return made;
}

static void in_a_render_pass(const uint8_t *wanted) {
    static uint8_t texels[BYTES];
    const VkAttachmentDescription attachment = {.format = FORMAT,
                                                .samples = VK_SAMPLE_COUNT_1_BIT,
                                                .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                                .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                                .initialLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                                .finalLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    const VkAttachmentReference color = {0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    const VkSubpassDescription subpass = {.colorAttachmentCount = 1, .pColorAttachments = &color};
    const VkRenderPassCreateInfo info = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
                                         .attachmentCount = 1,
                                         .pAttachments = &attachment,
                                         .subpassCount = 1,
                                         .pSubpasses = &subpass};
    VkRenderPass pass = VK_NULL_HANDLE;
    host_check(vkCreateRenderPass(h.device, &info, NULL, &pass) == VK_SUCCESS, "make a render pass");
    const VkFramebufferCreateInfo frame = {.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
                                           .renderPass = pass,
                                           .attachmentCount = 1,
                                           .pAttachments = &h.view,
                                           .width = WIDTH,
                                           .height = HEIGHT,
                                           .layers = 1};
    VkFramebuffer framebuffer = VK_NULL_HANDLE;
    host_check(vkCreateFramebuffer(h.device, &frame, NULL, &framebuffer) == VK_SUCCESS, "make a framebuffer");
    const sv_target_class target = {
        .struct_size = sizeof target, .color_format = FORMAT, .render_pass = (uint64_t)pass};
    sv_renderer renderer = renderer_for(&target);
    const sv_frame_info shot = {.struct_size = sizeof shot};
    VkCommandBuffer cmd = host_begin(&h);
    CHECK(sv_renderer_record(renderer, cmd, &shot, &diagnostic));
    host_barrier(cmd, h.image, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
                  VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    const VkClearValue clear = {{{BEHIND[0], BEHIND[1], BEHIND[2], BEHIND[3]}}};
    const VkRenderPassBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
                                         .renderPass = pass,
                                         .framebuffer = framebuffer,
                                         .renderArea = {{0, 0}, {WIDTH, HEIGHT}},
                                         .clearValueCount = 1,
                                         .pClearValues = &clear};
    vkCmdBeginRenderPass(cmd, &begin, VK_SUBPASS_CONTENTS_INLINE);
    CHECK(sv_renderer_draw(renderer, cmd, 0, &diagnostic));
    vkCmdEndRenderPass(cmd);
    fetch(cmd, texels);
    expect(!memcmp(texels, wanted, BYTES), "a render pass of the host's shows the same picture");
    CHECK(sv_renderer_destroy(renderer, &diagnostic));
    vkDestroyFramebuffer(h.device, framebuffer, NULL);
    vkDestroyRenderPass(h.device, pass, NULL);
}

static void of_several_samples(const uint8_t *wanted) {
    static uint8_t texels[BYTES];
    const VkImageCreateInfo info = {.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                                    .imageType = VK_IMAGE_TYPE_2D,
                                    .format = FORMAT,
                                    .extent = {WIDTH, HEIGHT, 1},
                                    .mipLevels = 1,
                                    .arrayLayers = 1,
                                    .samples = VK_SAMPLE_COUNT_4_BIT,
                                    .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT};
    VkImage image = VK_NULL_HANDLE;
    host_check(vkCreateImage(h.device, &info, NULL, &image) == VK_SUCCESS, "make an image of four samples");
    VkMemoryRequirements needed;
    vkGetImageMemoryRequirements(h.device, image, &needed);
    VkDeviceMemory memory = host_allocate(&h, needed, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    host_check(vkBindImageMemory(h.device, image, memory, 0) == VK_SUCCESS, "bind memory");
    const VkImageViewCreateInfo seen = {.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                        .image = image,
                                        .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                        .format = FORMAT,
                                        .subresourceRange = HOST_WHOLE};
    VkImageView view = VK_NULL_HANDLE;
    host_check(vkCreateImageView(h.device, &seen, NULL, &view) == VK_SUCCESS, "make a view");
    const sv_target_class target = {.struct_size = sizeof target, .color_format = FORMAT, .samples = 4};
    sv_renderer renderer = renderer_for(&target);
    const sv_frame_info shot = {.struct_size = sizeof shot};
    VkCommandBuffer cmd = host_begin(&h);
    CHECK(sv_renderer_record(renderer, cmd, &shot, &diagnostic));
    host_barrier(cmd, h.image, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
                  VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    host_barrier(cmd, image, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
                  VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    const VkRenderingAttachmentInfo color = {.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                             .imageView = view,
                                             .imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                             .resolveMode = VK_RESOLVE_MODE_AVERAGE_BIT,
                                             .resolveImageView = h.view,
                                             .resolveImageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                             .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                             .storeOp = VK_ATTACHMENT_STORE_OP_DONT_CARE,
                                             .clearValue = {{{BEHIND[0], BEHIND[1], BEHIND[2], BEHIND[3]}}}};
    const VkRenderingInfo rendering = {.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                                       .renderArea = {{0, 0}, {WIDTH, HEIGHT}},
                                       .layerCount = 1,
                                       .colorAttachmentCount = 1,
                                       .pColorAttachments = &color};
    vkCmdBeginRendering(cmd, &rendering);
    CHECK(sv_renderer_draw(renderer, cmd, 0, &diagnostic));
    vkCmdEndRendering(cmd);
    fetch(cmd, texels);
    expect(!memcmp(texels, wanted, BYTES), "four samples that are alike are one");
    CHECK(sv_renderer_destroy(renderer, &diagnostic));
    vkDestroyImageView(h.device, view, NULL);
    vkDestroyImage(h.device, image, NULL);
    vkFreeMemory(h.device, memory, NULL);
}

static void of_a_family(const uint8_t *wanted) {
    static uint8_t texels[BYTES];
    const sv_target_class class = {.struct_size = sizeof class, .color_format = FORMAT};
    sv_renderer renderer = renderer_for(&class);
    const sv_frame_info shot = {.struct_size = sizeof shot};
    sv_target target = whole_target();
    target.before.has_queue_family = target.after.has_queue_family = 1;
    target.before.queue_family = target.after.queue_family = HOST_QUEUE_FAMILY;
    VkCommandBuffer cmd = host_begin(&h);
    CHECK(sv_renderer_record_into(renderer, cmd, &shot, &target, &diagnostic));
    host_fetch(&h, cmd);
    host_submit_and_wait(&h, cmd);
    host_texels(&h, texels);
    expect(!memcmp(texels, wanted, BYTES), "a family that is ours is no transfer");
    CHECK(sv_renderer_destroy(renderer, &diagnostic));
}

/* The host has drawn no green: that of the picture alone is there. */
static void of_tone(const uint8_t *plain) {
    static uint8_t texels[BYTES], curved[BYTES];
    sv_settings settings = {.struct_size = sizeof settings};
    sv_renderer renderer = make_renderer(&settings, 0);
    draw_a(renderer, NULL, texels);
    expect(!memcmp(texels, plain, BYTES), "a tone of zeros is none");
    settings.exposure = -1.0;
    CHECK(sv_renderer_set_settings(renderer, &settings, &diagnostic));
    draw_a(renderer, NULL, texels);
    unsigned wrong = 0;
    /* Both are rounded to half a code. */
    for (int k = 1; k < BYTES; k += 4) wrong += abs(2 * texels[k] - plain[k]) > 2;
    expect(!wrong && drawn_pixels(texels) > 20, "a stop less is half of the light");
    settings.tone = SV_TONE_FILMIC;
    CHECK(sv_renderer_set_settings(renderer, &settings, &diagnostic));
    draw_a(renderer, NULL, curved);
    expect(memcmp(texels, curved, BYTES) != 0, "a curve bends it");
    CHECK(sv_renderer_destroy(renderer, &diagnostic));
}

static uint32_t traced(sv_renderer renderer) {
    uint32_t paths = 0;
    CHECK(sv_renderer_paths_traced(renderer, &paths, &diagnostic));
    return paths;
}

static void of_paths(void) {
    static uint8_t first[BYTES], more[BYTES], whole[BYTES];
    sv_path_tracing paths = {.struct_size = sizeof paths, .samples = 5, .samples_per_frame = 2, .mean_cosine = 0.3};
    const sv_settings settings = {
        .struct_size = sizeof settings, .technique = SV_TECHNIQUE_PATHTRACE, .paths = &paths};
    sv_renderer renderer = make_renderer(&settings, 0);
    draw_a(renderer, NULL, first);
    expect(drawn_pixels(first) > 20, "paths show the volume by the light of the eye");
    for (uint32_t wanted = 2; wanted <= 5; wanted += wanted == 4 ? 1 : 2) {
        expect(traced(renderer) == wanted, "each frame has two paths more, up to five");
        draw_a(renderer, NULL, more);
    }
    expect(traced(renderer) == 5, "there are no more paths than were asked for");
    double noise = 0.0;
    CHECK(sv_renderer_noise(renderer, &noise, &diagnostic));
    expect(noise > 0.01 && noise < 2.0, "paths tell how noisy their picture is");
    expect(memcmp(first, more, BYTES) != 0, "more paths show another picture");
    CHECK(sv_renderer_restart_paths(renderer, &diagnostic));
    expect(sv_renderer_noise(renderer, &noise, &diagnostic) == SV_E_STATE, "nothing is known of what begins anew");
    draw_a(renderer, NULL, more);
    expect(traced(renderer) == 2 && !memcmp(first, more, BYTES), "the first paths are the same again");
    CHECK(sv_renderer_destroy(renderer, &diagnostic));
    paths.samples_per_frame = 5;
    renderer = make_renderer(&settings, 0);
    draw_a(renderer, NULL, whole);
    expect(traced(renderer) <= 5 && drawn_pixels(whole) > 20, "a frame has as many as it may");
    CHECK(sv_renderer_destroy(renderer, &diagnostic));
}

void test_passes(void) {
    static uint8_t wanted[BYTES];
    sv_renderer renderer = make_renderer(NULL, 0);
    draw_a(renderer, NULL, wanted);
    CHECK(sv_renderer_destroy(renderer, &diagnostic));
    in_a_render_pass(wanted);
    of_several_samples(wanted);
    of_a_family(wanted);
    of_tone(wanted);
    of_paths();
}
