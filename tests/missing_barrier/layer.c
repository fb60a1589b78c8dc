/* A Vulkan layer that takes the order out of one barrier, MISSING_BARRIER of them counted from 0: layouts still change,
 * and nothing is waited for. It stands above the validation layer, which then speaks, or does not. When the device goes
 * it says how many barriers there were. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <vulkan/vk_layer.h>
#include <vulkan/vulkan.h>

static PFN_vkGetInstanceProcAddr next_instance_proc;
static PFN_vkGetDeviceProcAddr next_device_proc;
static VkInstance the_instance;
static long counted;

static int is_missing(void) {
    const char *wanted = getenv("MISSING_BARRIER");
    return counted++ == (wanted ? atol(wanted) : -1);
}

static VKAPI_ATTR VkResult VKAPI_CALL create_instance(const VkInstanceCreateInfo *info, const VkAllocationCallbacks *alloc,
                                                      VkInstance *instance) {
    VkLayerInstanceCreateInfo *link = (VkLayerInstanceCreateInfo *)info->pNext;
    while (link->sType != VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO || link->function != VK_LAYER_LINK_INFO)
        link = (VkLayerInstanceCreateInfo *)link->pNext;
    next_instance_proc = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    PFN_vkCreateInstance create = (PFN_vkCreateInstance)next_instance_proc(NULL, "vkCreateInstance");
    VkResult result = create(info, alloc, instance);
    the_instance = *instance;
    return result;
}

static VKAPI_ATTR VkResult VKAPI_CALL create_device(VkPhysicalDevice physical, const VkDeviceCreateInfo *info,
                                                    const VkAllocationCallbacks *alloc, VkDevice *device) {
    VkLayerDeviceCreateInfo *link = (VkLayerDeviceCreateInfo *)info->pNext;
    while (link->sType != VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO || link->function != VK_LAYER_LINK_INFO)
        link = (VkLayerDeviceCreateInfo *)link->pNext;
    next_device_proc = link->u.pLayerInfo->pfnNextGetDeviceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    PFN_vkCreateDevice create = (PFN_vkCreateDevice)next_instance_proc(the_instance, "vkCreateDevice");
    return create(physical, info, alloc, device);
}

static VKAPI_ATTR void VKAPI_CALL destroy_device(VkDevice device, const VkAllocationCallbacks *alloc) {
    fprintf(stderr, "%ld barriers\n", counted);
    ((PFN_vkDestroyDevice)next_device_proc(device, "vkDestroyDevice"))(device, alloc);
}

static PFN_vkCmdPipelineBarrier2 next_barrier2;
static PFN_vkCmdPipelineBarrier next_barrier;

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

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL device_proc(VkDevice device, const char *name) {
    PFN_vkVoidFunction next = next_device_proc(device, name);
    if (!strcmp(name, "vkGetDeviceProcAddr"))
        return (PFN_vkVoidFunction)device_proc;
    if (!strcmp(name, "vkDestroyDevice"))
        return (PFN_vkVoidFunction)destroy_device;
    if (!strcmp(name, "vkCmdPipelineBarrier2") && next) {
        next_barrier2 = (PFN_vkCmdPipelineBarrier2)next;
        return (PFN_vkVoidFunction)barrier2;
    }
    if (!strcmp(name, "vkCmdPipelineBarrier")) {
        next_barrier = (PFN_vkCmdPipelineBarrier)next;
        return (PFN_vkVoidFunction)barrier;
    }
    return next;
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL instance_proc(VkInstance instance, const char *name) {
    if (!strcmp(name, "vkGetInstanceProcAddr"))
        return (PFN_vkVoidFunction)instance_proc;
    if (!strcmp(name, "vkCreateInstance"))
        return (PFN_vkVoidFunction)create_instance;
    if (!strcmp(name, "vkCreateDevice"))
        return (PFN_vkVoidFunction)create_device;
    if (!strcmp(name, "vkGetDeviceProcAddr"))
        return (PFN_vkVoidFunction)device_proc;
    return instance ? next_instance_proc(instance, name) : NULL;
}

VKAPI_ATTR VkResult VKAPI_CALL vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface *versions) {
    versions->pfnGetInstanceProcAddr = instance_proc;
    versions->pfnGetDeviceProcAddr = device_proc;
    versions->pfnGetPhysicalDeviceProcAddr = NULL;
    return VK_SUCCESS;
}
