/* A Vulkan layer in which one call fails: FAILING_CALL names it, FAILING_AT counts its calls from 1, FAILING_WITH is the
 * VkResult. Of vkGetPhysicalDeviceSurfaceCapabilitiesKHR the call succeeds and says that the window has no size, as that of a
 * minimized one. The call does not reach the driver. */
#include "chain.h"

static int fails(const char *name) {
    static long counted;
    const char *wanted = getenv("FAILING_CALL"), *at = getenv("FAILING_AT");
    if (!wanted || !at || strcmp(name, wanted) || ++counted != atol(at)) return 0;
    fprintf(stderr, "failing: %s\n", name);
    return 1;
}

static VkResult result(void) { return (VkResult)atol(getenv("FAILING_WITH")); }

static PFN_vkAcquireNextImageKHR next_acquire;
static PFN_vkQueuePresentKHR next_present;
static PFN_vkQueueSubmit2 next_submit;
static PFN_vkCreateSwapchainKHR next_swapchain;
static PFN_vkGetPhysicalDeviceSurfaceCapabilitiesKHR next_capabilities;

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
    const VkResult asked = next_capabilities(physical, surface, found);
    if (fails("vkGetPhysicalDeviceSurfaceCapabilitiesKHR")) {
        if (result() != VK_SUCCESS) return result();
        found->currentExtent.width = found->currentExtent.height = 0;
    }
    return asked;
}

static PFN_vkVoidFunction of_device(const char *name, PFN_vkVoidFunction next) {
    TAKE("vkAcquireNextImageKHR", next_acquire, acquire)
    TAKE("vkQueuePresentKHR", next_present, present)
    TAKE("vkQueueSubmit2", next_submit, submit)
    TAKE("vkCreateSwapchainKHR", next_swapchain, create_swapchain)
    return next;
}

static PFN_vkVoidFunction of_instance(const char *name, PFN_vkVoidFunction next) {
    TAKE("vkGetPhysicalDeviceSurfaceCapabilitiesKHR", next_capabilities, capabilities)
    return next;
}
