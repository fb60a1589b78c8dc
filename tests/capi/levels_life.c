/* What is asked first, budgets, new voxels of a volume that is drawn, frames in parts, a device that the host loses. */
#include "levels.h"

static uint16_t numbers[VOXELS][VOXELS][VOXELS];

static sv_volume_desc described(void) {
    const sv_volume_desc made = {.struct_size = sizeof made,
                                 .dims = {VOXELS, VOXELS, VOXELS},
                                 .voxel_type = SV_VOXEL_U16,
                                 .voxels = numbers,
                                 .voxel_bytes = sizeof numbers,
                                 .slope = 0.001,
                                 .has_value_range = 1,
                                 .value_range = {0.0, 65.0}};
    return made;
}

static void fill(int from, int to, uint16_t number) {
    for (int z = from; z < to; ++z)
        for (int y = from; y < to; ++y)
            for (int x = from; x < to; ++x) numbers[z][y][x] = number;
}

void test_asked(const sv_host_device *ours) {
    static sv_requirement all[64], found[64];
    uint64_t count = 0, again = 64;
    CHECK(sv_requirements(NULL, &count, &diagnostic));
    expect(count > 20 && count <= 64, "requirements are counted");
    CHECK(sv_requirements(all, &count, &diagnostic));
    expect(!strcmp(all[0].name, "apiVersion") && all[0].is_required && !all[0].found[0], "and told without a device");
    sv_host_device before = *ours;
    before.device = NULL;
    CHECK(sv_check_device(&before, found, &again, &diagnostic));
    unsigned met = 0, missing = 0;
    for (uint64_t k = 0; k < again; ++k) {
        met += found[k].is_met;
        missing += found[k].is_required && !found[k].is_met;
    }
    expect(again == count && met > 20 && missing == 0, "and asked of one before it is made");
    before = *ours, before.features = SV_FEATURE_SYNCHRONIZATION2;
    CHECK(sv_check_device(&before, found, &again, &diagnostic));
    for (uint64_t k = missing = 0; k < again; ++k)
        missing += found[k].is_required && !found[k].is_met && !strcmp(found[k].name, "dynamicRendering");
    expect(missing == 1, "and of one without a feature");

    sv_device budgeted = 0;
    CHECK(sv_device_from_host(ours, &budgeted, &diagnostic));
    const sv_volume_desc desc = described();
    sv_plan plan = {.struct_size = sizeof plan};
    sv_volume_desc unread = desc;
    unread.voxels = NULL, unread.voxel_bytes = 0;
    CHECK(sv_volume_plan(budgeted, &unread, &plan, &diagnostic));
    const uint64_t needed = plan.device_bytes + plan.staging_bytes;
    expect(plan.bricks == 1 && plan.staging_bytes == sizeof numbers && plan.device_bytes > sizeof numbers, "a plan");
    CHECK(sv_device_set_memory_budget(budgeted, needed - 1, &diagnostic));
    sv_volume made = 0;
    const sv_status status = sv_volume_create(budgeted, &desc, &made, &diagnostic);
    expect(status == SV_E_LIMIT && diagnostic.wanted == needed && diagnostic.allowed == needed - 1, "a budget refuses");
    CHECK(sv_device_set_memory_budget(budgeted, 0, &diagnostic));
    CHECK(sv_volume_create(budgeted, &desc, &made, &diagnostic));
    sv_memory memory = {.struct_size = sizeof memory};
    CHECK(sv_device_memory(budgeted, &memory, &diagnostic));
    expect(memory.used_bytes >= needed && memory.allocations > 0 && memory.budget_bytes == 0, "memory as planned");

    CHECK(sv_device_declare_lost(budgeted, &diagnostic));
    expect(sv_volume_create(budgeted, &desc, &made, &diagnostic) == SV_E_DEVICE_LOST, "a host says that it is lost");
    CHECK(sv_device_destroy(budgeted, &diagnostic));
}

typedef struct told {
    unsigned calls, most;
    double last;
} told;

static uint32_t tell(void *user, double done) {
    told *t = user;
    t->calls += 1;
    t->most += done > t->last && done < 1.0;
    t->last = done;
    return t->calls == 1000;
}

static uint32_t stop(void *user, double done) { return user == NULL && done > 0.0; }

/* Frames in parts, by levels B and C. */
static void test_parts(sv_renderer renderer, const uint8_t *wanted) {
    static uint8_t texels[BYTES];
    const sv_frame_info shot = {.struct_size = sizeof shot, .frame = 1};
    const sv_target target = whole_target();
    uint64_t blocks = 0, left = 9;
    CHECK(sv_renderer_begin_parts(renderer, &shot, &blocks, &diagnostic));
    expect(blocks == 1, "one block of 64 x 48 pixels");
    VkCommandBuffer cmd = host_begin(&h);
    CHECK(sv_renderer_record_part_into(renderer, cmd, 1, 1, &target, &left, &diagnostic));
    expect(left == 0 && sv_renderer_record_part_into(renderer, cmd, 1, 1, &target, &left, &diagnostic) == SV_E_STATE,
           "no part after the last");
    host_fetch(&h, cmd);
    host_submit_and_wait(&h, cmd);
    host_texels(&h, texels);
    expect(!memcmp(texels, wanted, BYTES), "parts draw what level B draws");

    sv_submitter submitter = 0;
    CHECK(sv_submitter_create(device, 1, &submitter, &diagnostic));
    const sv_submission submission = {.struct_size = sizeof submission, .queue = h.queue};
    const sv_frame_info first = {.struct_size = sizeof first};
    told heard = {0, 0, 0.0};
    const sv_pacing pacing = {.struct_size = sizeof pacing, .target_ms = 1e-6, .tell = tell, .user = &heard};
    uint32_t is_done = 9;
    CHECK(sv_submitter_submit_in_parts(submitter, renderer, &first, &target, &submission, &pacing, &is_done, &diagnostic));
    vkQueueWaitIdle(h.queue);
    expect(is_done == 1 && heard.calls == 0, "the last part tells nothing");
    cmd = host_begin(&h);
    host_fetch(&h, cmd);
    host_submit_and_wait(&h, cmd);
    host_texels(&h, texels);
    expect(!memcmp(texels, wanted, BYTES), "and level C in parts");

    /* Twice as large: of four blocks, each a submission. */
    CHECK(sv_renderer_resize(renderer, 128, 128, NULL, 0, &diagnostic));
    CHECK(sv_renderer_begin_parts(renderer, &shot, &blocks, &diagnostic));
    expect(blocks == 4, "four blocks");
    sv_target large = target;
    large.width = large.height = 128;
    const sv_pacing stopped = {.struct_size = sizeof stopped, .target_ms = 1e-6, .tell = stop};
    CHECK(sv_submitter_submit_in_parts(submitter, renderer, &first, &large, &submission, &stopped, &is_done, &diagnostic));
    expect(is_done == 0, "a host ends a frame before its target is touched");
    CHECK(sv_renderer_resize(renderer, WIDTH, HEIGHT, NULL, 0, &diagnostic));
    CHECK(sv_submitter_destroy(submitter, &diagnostic));
}

/* Of two updates the second is recorded after the first alone. `cmd` is submitted later. */
static void test_order(const sv_update_desc *changed, VkCommandBuffer cmd) {
    sv_update first = 0, second = 0;
    CHECK(sv_volume_stage_update(volume, changed, &first, &diagnostic));
    CHECK(sv_volume_stage_update(volume, changed, &second, &diagnostic));
    expect(sv_volume_record_update(volume, cmd, second, &diagnostic) == SV_E_STATE, "updates come in their order");
    CHECK(sv_volume_record_update(volume, cmd, first, &diagnostic));
    CHECK(sv_volume_record_update(volume, cmd, second, &diagnostic));
    CHECK(sv_volume_stage_update(volume, changed, &first, &diagnostic));
    CHECK(sv_volume_stage_update(volume, changed, &second, &diagnostic));
    CHECK(sv_update_destroy(first, &diagnostic));
    expect(sv_volume_record_update(volume, cmd, second, &diagnostic) == SV_E_STATE, "and not after one that is gone");
    CHECK(sv_update_destroy(second, &diagnostic));
}

/* Half an update is not drawn, and the rest of it may be submitted by the library. */
static void test_half(const sv_update_desc *changed, sv_renderer renderer, const uint8_t *wanted) {
    static uint8_t texels[BYTES];
    sv_update update = 0;
    uint64_t left = 0;
    uint32_t is_done = 9;
    sv_submitter submitter = 0;
    CHECK(sv_submitter_create(device, 1, &submitter, &diagnostic));
    CHECK(sv_volume_stage_update(volume, changed, &update, &diagnostic));
    VkCommandBuffer cmd = host_begin(&h);
    CHECK(sv_volume_record_update_part(volume, cmd, update, 1, &left, &diagnostic));
    const sv_frame_info shot = {.struct_size = sizeof shot};
    /* Where a device finds cells by itself there is another piece; on all there are more than one, of corners or cells. */
    expect(left > 0 && sv_renderer_record(renderer, cmd, &shot, &diagnostic) == SV_E_STATE, "half an update");
    host_submit_and_wait(&h, cmd);
    const sv_submission submission = {.struct_size = sizeof submission, .queue = h.queue};
    const sv_pacing stopped = {.struct_size = sizeof stopped, .target_ms = 1e-6, .tell = stop};
    while (left > 1) {
        CHECK(sv_submitter_update_in_parts(submitter, volume, update, 0, &submission, &stopped, &is_done, &diagnostic));
        expect(is_done == 0, "a host ends an update");
        left -= 1;
    }
    CHECK(sv_submitter_update_in_parts(submitter, volume, update, 0, &submission, NULL, &is_done, &diagnostic));
    vkQueueWaitIdle(h.queue);
    expect(is_done == 1 && sv_update_destroy(update, &diagnostic) == SV_E_ARGUMENT, "and uses it up with the last part");
    draw_b(renderer, texels);
    expect(!memcmp(texels, wanted, BYTES), "then all is drawn");

    const sv_volume_desc desc = described();
    sv_volume made = 0;
    CHECK(sv_volume_create(device, &desc, &made, &diagnostic));
    CHECK(sv_submitter_upload_in_parts(submitter, made, 0, &submission, NULL, &is_done, &diagnostic));
    vkQueueWaitIdle(h.queue);
    expect(is_done == 1 && sv_renderer_set_volume(renderer, made, 0, &diagnostic) == SV_OK, "an upload in parts");
    memset(texels, 0, sizeof texels);
    draw_b(renderer, texels);
    expect(!memcmp(texels, wanted, BYTES), "is one");
    CHECK(sv_volume_destroy(made, &diagnostic));
    CHECK(sv_submitter_destroy(submitter, &diagnostic));
}

void test_life(void) {
    static uint8_t before[BYTES], after[BYTES], wanted[BYTES];
    fill(0, VOXELS, 0), fill(4, 12, 40000);
    sv_volume_desc desc = described();
    CHECK(sv_volume_create(device, &desc, &volume, &diagnostic));
    VkCommandBuffer cmd = host_begin(&h);
    CHECK(sv_volume_record_upload(volume, cmd, &diagnostic));
    host_submit_and_wait(&h, cmd);
    sv_renderer renderer = make_renderer(NULL, 0);
    draw_b(renderer, before);
    test_parts(renderer, before);

    fill(10, 20, 65000);
    const sv_update_desc changed = {.struct_size = sizeof changed,
                                    .origin = {10, 10, 10},
                                    .extent = {10, 10, 10},
                                    .voxels = numbers,
                                    .voxel_bytes = sizeof numbers};
    sv_update update = 0;
    CHECK(sv_volume_stage_update(volume, &changed, &update, &diagnostic));
    CHECK(sv_device_announce(device, 50, &diagnostic));
    cmd = host_begin(&h);
    CHECK(sv_volume_record_update(volume, cmd, update, &diagnostic));
    expect(sv_volume_record_update(volume, cmd, update, &diagnostic) == SV_E_ARGUMENT, "an update is used up");
    test_order(&changed, cmd);
    host_submit_and_wait(&h, cmd);
    CHECK(sv_device_retire(device, 50, &diagnostic));
    draw_b(renderer, after);
    CHECK(sv_volume_stage_update(volume, &changed, &update, &diagnostic));
    CHECK(sv_update_destroy(update, &diagnostic));
    test_half(&changed, renderer, after);
    CHECK(sv_renderer_destroy(renderer, &diagnostic));
    CHECK(sv_volume_destroy(volume, &diagnostic));

    CHECK(sv_volume_create(device, &desc, &volume, &diagnostic));
    cmd = host_begin(&h);
    uint64_t left = 9;
    CHECK(sv_volume_record_upload_part(volume, cmd, 1, &left, &diagnostic));
    expect(left == 0 && sv_volume_record_upload_part(volume, cmd, 1, &left, &diagnostic) == SV_E_STATE,
           "an upload of one piece");
    host_submit_and_wait(&h, cmd);
    renderer = make_renderer(NULL, 0);
    draw_b(renderer, wanted);
    expect(memcmp(before, wanted, BYTES) && !memcmp(after, wanted, BYTES), "an updated volume is drawn as a new one");
    CHECK(sv_renderer_destroy(renderer, &diagnostic));
    CHECK(sv_volume_destroy(volume, &diagnostic));
}
