/* A Vulkan layer that takes the order out of one barrier, MISSING_BARRIER of them counted from 0: layouts still change,
 * and nothing is waited for. It stands above the validation layer, which then speaks, or does not. When the device goes
 * it says how many barriers there were. */
#include "chain.h"

static long counted;

static int is_missing(void) {
    const char *wanted = getenv("MISSING_BARRIER");
    return counted++ == (wanted ? atol(wanted) : -1);
}

static PFN_vkDestroyDevice next_destroy;
static PFN_vkCmdPipelineBarrier2 next_barrier2;
static PFN_vkCmdPipelineBarrier next_barrier;

static VKAPI_ATTR void VKAPI_CALL destroy_device(VkDevice device, const VkAllocationCallbacks *alloc) {
    fprintf(stderr, "%ld barriers\n", counted);
    next_destroy(device, alloc);
}

/* Layouts and accesses, as Vulkan numbers them. */
static void tell(const VkDependencyInfo *info) {
    for (uint32_t k = 0; k < info->imageMemoryBarrierCount; k++) {
        const VkImageMemoryBarrier2 *b = &info->pImageMemoryBarriers[k];
        fprintf(stderr, "missing: image %d to %d\n", b->oldLayout, b->newLayout);
    }
    for (uint32_t k = 0; k < info->bufferMemoryBarrierCount; k++) {
        const VkBufferMemoryBarrier2 *b = &info->pBufferMemoryBarriers[k];
        fprintf(stderr, "missing: buffer %llx to %llx\n", (unsigned long long)b->srcAccessMask,
                (unsigned long long)b->dstAccessMask);
    }
    for (uint32_t k = 0; k < info->memoryBarrierCount; k++) {
        const VkMemoryBarrier2 *b = &info->pMemoryBarriers[k];
        fprintf(stderr, "missing: memory %llx to %llx\n", (unsigned long long)b->srcAccessMask,
                (unsigned long long)b->dstAccessMask);
    }
}

static VKAPI_ATTR void VKAPI_CALL barrier2(VkCommandBuffer cmd, const VkDependencyInfo *info) {
    if (!is_missing()) {
        next_barrier2(cmd, info);
        return;
    }
    tell(info);
    for (uint32_t k = 0; k < info->imageMemoryBarrierCount; k++) {
        VkImageMemoryBarrier2 barrier = info->pImageMemoryBarriers[k];
        barrier.srcStageMask = barrier.dstStageMask = 0;
        barrier.srcAccessMask = barrier.dstAccessMask = 0;
        VkDependencyInfo one = {.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
        one.imageMemoryBarrierCount = 1;
        one.pImageMemoryBarriers = &barrier;
        next_barrier2(cmd, &one);
    }
}

static VKAPI_ATTR void VKAPI_CALL barrier(VkCommandBuffer cmd, VkPipelineStageFlags before, VkPipelineStageFlags after,
                                          VkDependencyFlags flags, uint32_t memory_count, const VkMemoryBarrier *memory,
                                          uint32_t buffer_count, const VkBufferMemoryBarrier *buffer,
                                          uint32_t image_count, const VkImageMemoryBarrier *image) {
    if (!is_missing()) {
        next_barrier(cmd, before, after, flags, memory_count, memory, buffer_count, buffer, image_count, image);
        return;
    }
    for (uint32_t k = 0; k < image_count; k++) {
        VkImageMemoryBarrier one = image[k];
        one.srcAccessMask = one.dstAccessMask = 0;
        next_barrier(cmd, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, flags, 0, NULL, 0, NULL,
                     1, &one);
    }
}

static PFN_vkVoidFunction of_device(const char *name, PFN_vkVoidFunction next) {
    TAKE("vkDestroyDevice", next_destroy, destroy_device)
    TAKE("vkCmdPipelineBarrier2", next_barrier2, barrier2)
    TAKE("vkCmdPipelineBarrier", next_barrier, barrier)
    return next;
}

static PFN_vkVoidFunction of_instance(const char *name, PFN_vkVoidFunction next) {
    (void)name;
    return next;
}
