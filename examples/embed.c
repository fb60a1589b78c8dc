/* The smallest host in C: a Vulkan device, an image and a command buffer of its own, a volume in it, and a picture.
 *
 *     make capi
 *     cc -Iinclude examples/embed.c -Ltarget/release -lstratavox -lvulkan -lm -o embed
 *     LD_LIBRARY_PATH=target/release ./embed sphere.ppm
 *
 * embed_host.h is plain Vulkan; here is all that has to do with stratavox. The picture is that of examples/embed.
 */
#include "embed_host.h"
#include "stratavox.h"
#include <math.h>

enum { WIDTH = 256, HEIGHT = 256, VOXELS = 64 };
static const VkFormat FORMAT = VK_FORMAT_R8G8B8A8_SRGB;
static const double SIDE = 100.0 / VOXELS;

static float voxels[VOXELS][VOXELS][VOXELS];
static uint8_t texels[HEIGHT][WIDTH][4];
static sv_diagnostic diagnostic = {.struct_size = sizeof(sv_diagnostic)};

static void check(sv_status status) {
    if (status == SV_OK) return;
    fprintf(stderr, "stratavox, status %d: %s\n", (int)status, diagnostic.text);
    exit(1);
}

/* A ball of radius 35 about (4, -6, 5) with an edge of one voxel, in a cube from -50 to 50. */
static void fill_voxels(void) {
    for (int z = 0; z < VOXELS; ++z)
        for (int y = 0; y < VOXELS; ++y)
            for (int x = 0; x < VOXELS; ++x) {
                const double dx = SIDE * (x + 0.5) - 50.0 - 4.0;
                const double dy = SIDE * (y + 0.5) - 50.0 + 6.0;
                const double dz = SIDE * (z + 0.5) - 50.0 - 5.0;
                const double value = 0.5 + (35.0 - sqrt(dx * dx + dy * dy + dz * dz)) / SIDE;
                voxels[z][y][x] = (float)(value < 0.0 ? 0.0 : value > 1.0 ? 1.0 : value);
            }
}

int main(int count, char **arguments) {
    const char *path = count > 1 ? arguments[1] : "sphere.ppm";
    host h;
    host_open(&h, WIDTH, HEIGHT, FORMAT);
    if (sv_abi_version() != SV_ABI_VERSION) return fprintf(stderr, "another version of stratavox\n"), 1;

    /* Once: what stratavox must know of the device. Vulkan cannot be asked what was enabled on it. */
    const sv_host_device ours = {.struct_size = sizeof ours,
                                 .queue_family = HOST_QUEUE_FAMILY,
                                 .instance = h.instance,
                                 .physical_device = h.physical_device,
                                 .device = h.device,
                                 .get_instance_proc_addr = (sv_get_instance_proc_addr)vkGetInstanceProcAddr,
                                 .features = SV_FEATURE_DYNAMIC_RENDERING | SV_FEATURE_SYNCHRONIZATION2};
    sv_device device = 0;
    check(sv_device_from_host(&ours, &device, &diagnostic));

    /* Once for a volume: its voxels, and its upload. */
    fill_voxels();
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

    /* Once for a kind of picture: pipelines, images, descriptor sets. Everything that is left out is zero, the default:
     * a composite by rays of a ramp of greys, all of the volume seen from the front. */
    const sv_target_class class = {.struct_size = sizeof class, .color_format = FORMAT};
    const sv_renderer_desc wanted = {.struct_size = sizeof wanted,
                                     .volume = volume,
                                     .target = &class,
                                     .width = WIDTH,
                                     .height = HEIGHT};
    sv_renderer renderer = 0;
    check(sv_renderer_create(device, &wanted, &renderer, &diagnostic));

    /* Each frame. */
    const sv_frame_info shot = {.struct_size = sizeof shot, .frame = 0};
    const sv_target target = {.struct_size = sizeof target,
                              .image = (uint64_t)h.image,
                              .view = (uint64_t)h.view,
                              .format = FORMAT,
                              .width = WIDTH,
                              .height = HEIGHT,
                              .is_cleared = 1,
                              .clear_color = {0.0f, 0.05f, 0.1f, 1.0f},
                              .after = {.layout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                                        .stage = VK_PIPELINE_STAGE_2_COPY_BIT,
                                        .access = VK_ACCESS_2_TRANSFER_READ_BIT}};
    check(sv_renderer_record_into(renderer, cmd, &shot, &target, &diagnostic));
    host_fetch(&h, cmd);
    host_submit_and_wait(&h, cmd);
    host_texels(&h, &texels[0][0][0]);

    /* The device has finished: everything of ours on it goes, and then it. */
    check(sv_device_destroy(device, &diagnostic));
    const unsigned messages = host_close(&h);

    FILE *file = fopen(path, "wb");
    if (!file) return perror(path), 1;
    fprintf(file, "P6\n%d %d\n255\n", WIDTH, HEIGHT);
    for (int y = 0; y < HEIGHT; ++y)
        for (int x = 0; x < WIDTH; ++x) fwrite(texels[y][x], 1, 3, file);
    return fclose(file) != 0 || messages != 0;
}
