/* What a careless host does: each call is refused, with a sentence, and nothing that was good before is worse for it. */
#include "abuse.h"
#include <pthread.h>

host h;
sv_host_device ours;
sv_device device, other_device;
sv_volume volume, fresh;
sv_transfer_function function;
sv_renderer renderer, deep;
sv_submitter submitter;
sv_update staged;
VkCommandBuffer cmd;
uint8_t voxels[VOXELS * VOXELS * VOXELS];
uint64_t made_handle;
unsigned refused, failures;
sv_diagnostic diagnostic = {.struct_size = sizeof(sv_diagnostic)};

void good(sv_status status, const char *what) {
    if (status == SV_OK) return;
    fprintf(stderr, "%s: status %d: %s\n", what, (int)status, diagnostic.text);
    exit(1);
}

void bad(sv_status status, sv_status wanted, const char *what) {
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
    BAD(SV_E_DEVICE_LOST, sv_volume_create(device, &desc, &made_handle, &diagnostic));
    const sv_renderer_desc wanted = renderer_desc();
    BAD(SV_E_DEVICE_LOST, sv_renderer_create(device, &wanted, &made_handle, &diagnostic));
    BAD(SV_E_DEVICE_LOST, sv_submitter_create(device, 1, &made_handle, &diagnostic));
    BAD(SV_E_DEVICE_LOST, sv_volume_record_upload(volume, cmd, &diagnostic));
    uint64_t bytes = 0;
    BAD(SV_E_DEVICE_LOST, sv_device_pipeline_cache(device, &bytes, NULL, &diagnostic));
    if (heard != 1) failures += 1, fprintf(stderr, "FAILED: the loss was told %u times\n", heard);
    GOOD(sv_submitter_destroy(submitter, &diagnostic));
    GOOD(sv_device_destroy(device, &diagnostic));
    BAD(SV_E_ARGUMENT, sv_volume_record_upload(volume, cmd, &diagnostic));
    device = kept[0], volume = kept[1], renderer = kept[2], submitter = kept[3];
}

/* ---- Threads ---- */

static sv_transfer_function shared_function;
static int destroyed[4];

static void *many_functions(void *number) {
    const sv_transfer_function_desc desc = {.struct_size = sizeof desc};
    sv_diagnostic own = {.struct_size = sizeof own};
    for (int k = 0; k < 500; ++k) {
        sv_transfer_function made = 0;
        if (sv_transfer_function_create(device, &desc, &made, &own) != SV_OK) return "create";
        if (sv_transfer_function_destroy(made, &own) != SV_OK) return "destroy";
        if (sv_transfer_function_destroy(made, &own) != SV_E_ARGUMENT) return "destroy again";
    }
    destroyed[*(int *)number] = sv_transfer_function_destroy(shared_function, &own) == SV_OK;
    return NULL;
}

static void threads(void) {
    const sv_transfer_function_desc desc = {.struct_size = sizeof desc};
    GOOD(sv_transfer_function_create(device, &desc, &shared_function, &diagnostic));
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
    const sv_transfer_function_desc points = {.struct_size = sizeof points};
    sv_renderer_desc wanted = renderer_desc();
    GOOD(sv_volume_create(device, &desc, &volume, &diagnostic));
    GOOD(sv_transfer_function_create(device, &points, &function, &diagnostic));
    GOOD(sv_submitter_create(device, 2, &submitter, &diagnostic));
    cmd = host_begin(&h);
    GOOD(sv_volume_record_upload(volume, cmd, &diagnostic));
    host_submit_and_wait(&h, cmd);
    const sv_update_desc update = update_desc();
    GOOD(sv_volume_stage_update(volume, &update, &staged, &diagnostic));
    wanted.volume = volume;
    GOOD(sv_renderer_create(device, &wanted, &renderer, &diagnostic));
    const sv_target_class with_depth = {
        .struct_size = sizeof with_depth, .color_format = FORMAT, .depth_format = VK_FORMAT_D32_SFLOAT};
    wanted.target = &with_depth, wanted.gives_depth = 1;
    GOOD(sv_renderer_create(device, &wanted, &deep, &diagnostic));
    draw(before);

    /* What is refused is never recorded: this command buffer stays empty and is never submitted. */
    cmd = host_begin(&h);
    abuse_handles();
    abuse_structures();
    abuse_objects();
    abuse_pictures();
    abuse_frames();
    abuse_geometry();
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
