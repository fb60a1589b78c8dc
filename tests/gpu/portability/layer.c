/* A Vulkan layer under which each device is one of a subset: it lists VK_KHR_portability_subset, and lacks every part of
 * Vulkan that such a device may lack. It stands below the validation layer, which speaks where a program uses such a
 * part. With SUBSET unset it lists nothing. When a device is made it says whether the extension is enabled. */
#define VK_ENABLE_BETA_EXTENSIONS
#define BEFORE_DEVICE tell
#include <stdio.h>
#include <string.h>
#include <vulkan/vulkan.h>

#define SUBSET VK_KHR_PORTABILITY_SUBSET_EXTENSION_NAME

/* The driver is not asked for it: the loader leaves out what a driver does not list. */
static void tell(const VkDeviceCreateInfo *info) {
    int is_enabled = 0;
    for (uint32_t k = 0; k < info->enabledExtensionCount; k++)
        is_enabled |= !strcmp(info->ppEnabledExtensionNames[k], SUBSET);
    fprintf(stderr, "portability subset: %s\n", is_enabled ? "enabled" : "not enabled");
}

#include "chain.h"

static PFN_vkEnumerateDeviceExtensionProperties next_extensions;
static PFN_vkGetPhysicalDeviceFeatures2 next_features;

static VKAPI_ATTR VkResult VKAPI_CALL extensions(VkPhysicalDevice physical, const char *layer, uint32_t *count,
                                                 VkExtensionProperties *all) {
    if (layer || !getenv("SUBSET")) return next_extensions(physical, layer, count, all);
    if (!all) {
        VkResult counted = next_extensions(physical, NULL, count, NULL);
        ++*count;
        return counted;
    }
    uint32_t room = *count, own = room - 1;
    VkResult listed = next_extensions(physical, NULL, &own, all);
    if (listed != VK_SUCCESS || room == 0) return listed;
    memset(&all[own], 0, sizeof all[own]);
    strcpy(all[own].extensionName, SUBSET);
    all[own].specVersion = 1;
    *count = own + 1;
    return VK_SUCCESS;
}

static VKAPI_ATTR void VKAPI_CALL features(VkPhysicalDevice physical, VkPhysicalDeviceFeatures2 *out) {
    next_features(physical, out);
    for (VkBaseOutStructure *one = out->pNext; one; one = one->pNext) {
        if (one->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PORTABILITY_SUBSET_FEATURES_KHR) {
            VkBaseOutStructure *next = one->pNext;
            memset(one, 0, sizeof(VkPhysicalDevicePortabilitySubsetFeaturesKHR));
            one->sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PORTABILITY_SUBSET_FEATURES_KHR;
            one->pNext = next;
        }
    }
}

static PFN_vkVoidFunction of_instance(const char *name, PFN_vkVoidFunction next) {
    TAKE("vkEnumerateDeviceExtensionProperties", next_extensions, extensions)
    TAKE("vkGetPhysicalDeviceFeatures2", next_features, features)
    return next;
}

static PFN_vkVoidFunction of_device(const char *name, PFN_vkVoidFunction next) {
    (void)name;
    return next;
}
