/* A Vulkan layer in which one call fails: FAILING_CALL names it, FAILING_AT counts its calls from 1, FAILING_WITH is the
 * VkResult. Of vkGetPhysicalDeviceSurfaceCapabilitiesKHR the call succeeds and says that the window has no size, as that of a
 * minimized one. The call does not reach the driver. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <vulkan/vk_layer.h>
#include <vulkan/vulkan.h>

static PFN_vkGetInstanceProcAddr next_instance_proc;
static PFN_vkGetDeviceProcAddr next_device_proc;
static VkInstance the_instance;

static int fails(const char *name) {
    static long counted;
    const char *wanted = getenv("FAILING_CALL"), *at = getenv("FAILING_AT");
    if (!wanted || !at || strcmp(name, wanted) || ++counted != atol(at)) return 0;
    fprintf(stderr, "failing: %s\n", name);
    return 1;
}

static VkResult result(void) { return (VkResult)atol(getenv("FAILING_WITH")); }

static VKAPI_ATTR VkResult VKAPI_CALL create_instance(const VkInstanceCreateInfo *info, const VkAllocationCallbacks *alloc,
                                                      VkInstance *instance) {
    VkLayerInstanceCreateInfo *link = (VkLayerInstanceCreateInfo *)info->pNext;
    while (link->sType != VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO || link->function != VK_LAYER_LINK_INFO)
        link = (VkLayerInstanceCreateInfo *)link->pNext;
    next_instance_proc = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    PFN_vkCreateInstance create = (PFN_vkCreateInstance)next_instance_proc(NULL, "vkCreateInstance");
    VkResult made = create(info, alloc, instance);
    the_instance = *instance;
    return made;
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

static PFN_vkAcquireNextImageKHR next_acquire;
static PFN_vkQueuePresentKHR next_present;
static PFN_vkQueueSubmit2 next_submit;
static PFN_vkCreateSwapchainKHR next_swapchain;

static VKAPI_ATTR VkResult VKAPI_CALL acquire(VkDevice device, VkSwapchainKHR swapchain, uint64_t timeout,
                                              VkSemaphore semaphore, VkFence fence, uint32_t *image) {
    if (fails("vkAcquireNextImageKHR")) return result();
    return next_acquire(device, swapchain, timeout, semaphore, fence, image);
}

static VKAPI_ATTR VkResult VKAPI_CALL present(VkQueue queue, const VkPresentInfoKHR *info) {
    /* What is failed here was presented all the same, or its semaphore would stay. */
    const VkResult shown = next_present(queue, info);
    return fails("vkQueuePresentKHR") ? result() : shown;
}

static VKAPI_ATTR VkResult VKAPI_CALL submit(VkQueue queue, uint32_t count, const VkSubmitInfo2 *infos, VkFence fence) {
    if (fails("vkQueueSubmit2")) return result();
    return next_submit(queue, count, infos, fence);
}

static VKAPI_ATTR VkResult VKAPI_CALL create_swapchain(VkDevice device, const VkSwapchainCreateInfoKHR *info,
                                                       const VkAllocationCallbacks *alloc, VkSwapchainKHR *swapchain) {
    if (fails("vkCreateSwapchainKHR")) return result();
    return next_swapchain(device, info, alloc, swapchain);
}

static VKAPI_ATTR VkResult VKAPI_CALL capabilities(VkPhysicalDevice physical, VkSurfaceKHR surface,
                                                   VkSurfaceCapabilitiesKHR *found) {
    PFN_vkGetPhysicalDeviceSurfaceCapabilitiesKHR next =
        (PFN_vkGetPhysicalDeviceSurfaceCapabilitiesKHR)next_instance_proc(the_instance,
                                                                          "vkGetPhysicalDeviceSurfaceCapabilitiesKHR");
    const VkResult asked = next(physical, surface, found);
    if (fails("vkGetPhysicalDeviceSurfaceCapabilitiesKHR")) {
        if (result() != VK_SUCCESS) return result();
        found->currentExtent.width = found->currentExtent.height = 0;
    }
    return asked;
}

#define TAKEN(wanted, kept, ours)                  \
    if (!strcmp(name, wanted) && next) {           \
        kept = (__typeof__(kept))next;             \
        return (PFN_vkVoidFunction)ours;           \
    }

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL device_proc(VkDevice device, const char *name) {
    PFN_vkVoidFunction next = next_device_proc(device, name);
    if (!strcmp(name, "vkGetDeviceProcAddr")) return (PFN_vkVoidFunction)device_proc;
    TAKEN("vkAcquireNextImageKHR", next_acquire, acquire)
    TAKEN("vkQueuePresentKHR", next_present, present)
    TAKEN("vkQueueSubmit2", next_submit, submit)
    TAKEN("vkCreateSwapchainKHR", next_swapchain, create_swapchain)
    return next;
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL instance_proc(VkInstance instance, const char *name) {
    if (!strcmp(name, "vkGetInstanceProcAddr")) return (PFN_vkVoidFunction)instance_proc;
    if (!strcmp(name, "vkCreateInstance")) return (PFN_vkVoidFunction)create_instance;
    if (!strcmp(name, "vkCreateDevice")) return (PFN_vkVoidFunction)create_device;
    if (!strcmp(name, "vkGetDeviceProcAddr")) return (PFN_vkVoidFunction)device_proc;
    if (!strcmp(name, "vkGetPhysicalDeviceSurfaceCapabilitiesKHR")) return (PFN_vkVoidFunction)capabilities;
    return instance ? next_instance_proc(instance, name) : NULL;
}

VKAPI_ATTR VkResult VKAPI_CALL vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface *versions) {
    versions->pfnGetInstanceProcAddr = instance_proc;
    versions->pfnGetDeviceProcAddr = device_proc;
    versions->pfnGetPhysicalDeviceProcAddr = NULL;
    return VK_SUCCESS;
}
