/* Stream lines through a volume: a field of velocities is followed, its lines become tubes, and the volume ends at them. A title, a
 * bar of colours and a scale lie over the picture.
 *
 *     make capi
 *     cc -Iinclude examples/lines.c -Ltarget/release -lstratavox -lvulkan -lm -o lines
 *     LD_LIBRARY_PATH=target/release ./lines lines.ppm
 *
 * embed_host.h is plain Vulkan; embed.c is the beginning, which this goes on from.
 */
#include "embed_host.h"
#include "stratavox.h"
#include <math.h>

enum { WIDTH = 320, HEIGHT = 240, VOXELS = 48 };
static const VkFormat FORMAT = VK_FORMAT_R8G8B8A8_SRGB;
static const double SIDE = 100.0 / VOXELS;

static float voxels[VOXELS][VOXELS][VOXELS];
static float velocities[VOXELS][VOXELS][VOXELS][3];
static uint8_t texels[HEIGHT][WIDTH][4];
static sv_diagnostic diagnostic = {.struct_size = sizeof(sv_diagnostic)};

static void check(sv_status status) {
    if (status == SV_OK) return;
    fprintf(stderr, "stratavox, status %d: %s\n", (int)status, diagnostic.text);
    exit(1);
}

/* A ball of radius 25 in a cube from -50 to 50, and a field that turns around the z axis while it rises. */
static void fill(void) {
    for (int z = 0; z < VOXELS; ++z)
        for (int y = 0; y < VOXELS; ++y)
            for (int x = 0; x < VOXELS; ++x) {
                const double p[3] = {SIDE * (x + 0.5) - 50.0, SIDE * (y + 0.5) - 50.0, SIDE * (z + 0.5) - 50.0};
                const double value = 0.5 + (25.0 - sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2])) / SIDE;
                voxels[z][y][x] = (float)(value < 0.0 ? 0.0 : value > 1.0 ? 1.0 : value);
                velocities[z][y][x][0] = (float)-p[1];
                velocities[z][y][x][1] = (float)p[0];
                velocities[z][y][x][2] = 3.0f;
            }
}

/* Follows the field from five seeds, and makes a tube of each line, from blue to orange by the time. */
static sv_geometry make_tubes(sv_device device, const sv_target_class *class, const double world_from_voxel[16]) {
    static const double seeds[][3] = {{15, 0, 0}, {30, 0, 0}, {40, 0, -20}, {40, 0, 0}, {40, 0, 20}};
    sv_trace_desc field = {.struct_size = sizeof field,
                           .dims = {VOXELS, VOXELS, VOXELS},
                           .velocities = &velocities[0][0][0][0],
                           .velocity_count = sizeof velocities / sizeof(float),
                           .seeds = &seeds[0][0],
                           .seed_count = sizeof seeds / sizeof seeds[0]};
    memcpy(field.world_from_voxel, world_from_voxel, sizeof field.world_from_voxel);
    sv_lines lines = 0;
    uint64_t count = 0, cone_count = 0;
    check(sv_trace(device, &field, &lines, &diagnostic));
    check(sv_lines_count(lines, &count, &diagnostic));
    sv_round_cone *cones = NULL;
    for (uint64_t line = 0; line < count; ++line) {
        uint64_t vertices = 0;
        uint32_t causes[2];
        check(sv_lines_positions(lines, line, NULL, &vertices, &diagnostic));
        double(*places)[3] = malloc(vertices * sizeof *places), (*values)[2] = malloc(vertices * sizeof *values);
        check(sv_lines_positions(lines, line, places[0], &vertices, &diagnostic));
        check(sv_lines_values(lines, line, values[0], &vertices, &diagnostic));
        check(sv_lines_cause(lines, line, causes, &diagnostic));
        printf("line %d: %d vertices, causes %u and %u\n", (int)line, (int)vertices, causes[0], causes[1]);
        cones = realloc(cones, (cone_count + vertices) * sizeof *cones);
        for (uint64_t k = 0; k + 1 < vertices; ++k) {
            const float part = (float)((values[k][0] - values[0][0]) / (values[vertices - 1][0] - values[0][0]));
            sv_round_cone cone = {.first_radius = 1.2, .second_radius = 1.2};
            memcpy(cone.first, places[k], sizeof cone.first);
            memcpy(cone.second, places[k + 1], sizeof cone.second);
            const float color[3] = {part, 0.3f, 1.0f - part};
            memcpy(cone.first_color, color, sizeof color);
            memcpy(cone.second_color, color, sizeof color);
            cones[cone_count++] = cone;
        }
        free(places), free(values);
    }
    check(sv_lines_destroy(lines, &diagnostic));
    const sv_geometry_desc desc = {
        .struct_size = sizeof desc, .target = class, .cones = cones, .cone_count = cone_count};
    sv_geometry geometry = 0;
    check(sv_geometry_create(device, &desc, &geometry, &diagnostic));
    free(cones);
    return geometry;
}

/* The host's rendering: of geometry to its picture and its depth, or over the picture alone. */
static void begin_rendering(const host *h, VkCommandBuffer cmd, VkImageView depth) {
    const VkRenderingAttachmentInfo color = {.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                             .imageView = h->view,
                                             .imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                             .loadOp = depth ? VK_ATTACHMENT_LOAD_OP_CLEAR : VK_ATTACHMENT_LOAD_OP_LOAD,
                                             .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                             .clearValue = {.color = {.float32 = {0.0f, 0.02f, 0.04f, 1.0f}}}};
    const VkRenderingAttachmentInfo tested = {.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                              .imageView = depth,
                                              .imageLayout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
                                              .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                              .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                              .clearValue = {.depthStencil = {1.0f, 0}}};
    const VkRenderingInfo info = {.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                                  .renderArea = {.extent = {WIDTH, HEIGHT}},
                                  .layerCount = 1,
                                  .colorAttachmentCount = 1,
                                  .pColorAttachments = &color,
                                  .pDepthAttachment = depth ? &tested : NULL};
    vkCmdBeginRendering(cmd, &info);
}

static double linear_of(uint8_t code) {
    const double c = code / 255.0;
    return c <= 0.04045 ? c / 12.92 : pow((c + 0.055) / 1.055, 2.4);
}
static uint8_t code_of(double c) {
    return (uint8_t)(255.0 * (c <= 0.0031308 ? 12.92 * c : 1.055 * pow(c, 1.0 / 2.4) - 0.055) + 0.5);
}

/* Words and marks over the picture. A host that draws many frames has them in a texture, until the camera moves. */
static void annotate(sv_device device, const sv_camera *camera, const sv_volume_desc *volume, sv_transfer_function function) {
    static float marks[HEIGHT][WIDTH][4];
    sv_overlay_desc words = {.struct_size = sizeof words,
                             .width = WIDTH,
                             .height = HEIGHT,
                             .camera = camera,
                             .marks = "bar,scale,axes,title=Lines in a ball",
                             .dims = {VOXELS, VOXELS, VOXELS},
                             .function = function,
                             .caption = "Fog",
                             .length_metres = 1e-3};
    memcpy(words.world_from_voxel, volume->world_from_voxel, sizeof words.world_from_voxel);
    check(sv_overlay_rgba(device, &words, &marks[0][0][0], sizeof marks / sizeof(float), &diagnostic));
    for (int y = 0; y < HEIGHT; ++y)
        for (int x = 0; x < WIDTH; ++x)
            for (int c = 0; c < 3; ++c) {
                const double under = linear_of(texels[y][x][c]);
                texels[y][x][c] = code_of(marks[y][x][c] + (1.0 - marks[y][x][3]) * under);
            }
}

int main(int count, char **arguments) {
    const char *path = count > 1 ? arguments[1] : "lines.ppm";
    host h;
    host_open(&h, WIDTH, HEIGHT, FORMAT);
    const sv_host_device ours = {.struct_size = sizeof ours,
                                 .queue_family = HOST_QUEUE_FAMILY,
                                 .instance = h.instance,
                                 .physical_device = h.physical_device,
                                 .device = h.device,
                                 .get_instance_proc_addr = (sv_get_instance_proc_addr)vkGetInstanceProcAddr,
                                 .features = SV_FEATURE_DYNAMIC_RENDERING | SV_FEATURE_SYNCHRONIZATION2};
    sv_device device = 0;
    check(sv_device_from_host(&ours, &device, &diagnostic));
    fill();
    const sv_volume_desc described = {.struct_size = sizeof described,
                                      .dims = {VOXELS, VOXELS, VOXELS},
                                      .voxel_type = SV_VOXEL_F32,
                                      .voxels = voxels,
                                      .voxel_bytes = sizeof voxels,
                                      .world_from_voxel = {SIDE, 0, 0, 0, 0, SIDE, 0, 0, 0, 0, SIDE, 0, -50, -50, -50, 1}};
    sv_volume volume = 0;
    check(sv_volume_create(device, &described, &volume, &diagnostic));
    VkCommandBuffer cmd = host_begin(&h);
    check(sv_volume_record_upload(volume, cmd, &diagnostic));

    const host_depth depth = host_make_depth(&h);
    const sv_target_class class = {
        .struct_size = sizeof class, .color_format = FORMAT, .depth_format = VK_FORMAT_D32_SFLOAT};
    const sv_geometry tubes = make_tubes(device, &class, described.world_from_voxel);
    check(sv_geometry_record_upload(tubes, cmd, &diagnostic));

    /* A fog that lets the tubes in it be seen; what the host has drawn hides what lies behind it. */
    const sv_color_point white[] = {{0.0, {0.9, 0.9, 0.9}}};
    const sv_opacity_point opacities[] = {{0.0, 0.0}, {1.0, 0.05}};
    const sv_transfer_function_desc fog = {.struct_size = sizeof fog,
                                           .colors = white,
                                           .color_count = 1,
                                           .opacities = opacities,
                                           .opacity_count = 2};
    sv_transfer_function function = 0;
    check(sv_transfer_function_create(device, &fog, &function, &diagnostic));
    const sv_target_class over = {.struct_size = sizeof over, .color_format = FORMAT};
    const sv_depth_image read = {(uint64_t)depth.view, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL, WIDTH, HEIGHT, 0};
    const sv_renderer_desc wanted = {.struct_size = sizeof wanted,
                                     .volume = volume,
                                     .function = function,
                                     .target = &over,
                                     .width = WIDTH,
                                     .height = HEIGHT,
                                     .has_host_depth = 1,
                                     .depth_images = &read,
                                     .depth_image_count = 1};
    sv_renderer renderer = 0;
    check(sv_renderer_create(device, &wanted, &renderer, &diagnostic));

    /* Each frame, with the host's own matrices: from the front, a little from above. */
    const double near = 50.0, far = 500.0, f = 3.0, c = cos(0.35), s = sin(0.35);
    const sv_camera camera = {
        .struct_size = sizeof camera,
        .kind = SV_CAMERA_MATRICES,
        .view_from_world = {-1, 0, 0, 0, 0, -s, c, 0, 0, c, s, 0, 0, 0, -240, 1},
        .clip_from_view = {f * HEIGHT / WIDTH, 0, 0, 0, 0, -f, 0, 0, 0, 0, far / (near - far), -1, 0, 0,
                           far * near / (near - far), 0}};
    const sv_frame_info shot = {.struct_size = sizeof shot, .camera = &camera};
    host_barrier(cmd, h.image, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
                 VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    host_barrier(cmd, depth.image, VK_IMAGE_ASPECT_DEPTH_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
                 VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL);
    begin_rendering(&h, cmd, depth.view);
    check(sv_geometry_draw(tubes, cmd, &shot, WIDTH, HEIGHT, &diagnostic));
    vkCmdEndRendering(cmd);
    host_barrier(cmd, depth.image, VK_IMAGE_ASPECT_DEPTH_BIT, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
                 VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL);
    check(sv_renderer_record(renderer, cmd, &shot, &diagnostic));
    host_barrier(cmd, h.image, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                 VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    begin_rendering(&h, cmd, VK_NULL_HANDLE);
    check(sv_renderer_draw(renderer, cmd, 0, &diagnostic));
    vkCmdEndRendering(cmd);
    host_barrier(cmd, h.image, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                 VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    host_fetch(&h, cmd);
    host_submit_and_wait(&h, cmd);
    host_texels(&h, &texels[0][0][0]);

    annotate(device, &camera, &described, function);
    check(sv_device_destroy(device, &diagnostic));
    host_free_depth(&h, depth);
    const unsigned messages = host_close(&h);
    FILE *file = fopen(path, "wb");
    if (!file) return perror(path), 1;
    fprintf(file, "P6\n%d %d\n255\n", WIDTH, HEIGHT);
    for (int y = 0; y < HEIGHT; ++y)
        for (int x = 0; x < WIDTH; ++x) fwrite(texels[y][x], 1, 3, file);
    return fclose(file) != 0 || messages != 0;
}
