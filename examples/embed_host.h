/* Plain Vulkan, without stratavox: a device, an image to draw into and a buffer to read it from. For embed.c and tests.
 *
 * Built with the headers and the loader of Vulkan (Debian: libvulkan-dev). What goes wrong ends the program. With
 * STRATAVOX_VALIDATION=core or =sync in the environment, the validation layer listens, and host_close counts what it said.
 */
#ifndef EMBED_HOST_H
#define EMBED_HOST_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <vulkan/vulkan.h>

typedef struct host {
    VkInstance instance;
    VkPhysicalDevice physical_device;
    VkDevice device;
    VkQueue queue;
    VkCommandPool pool;
    VkImage image;
    VkImageView view;
    VkBuffer readback;
    VkDeviceMemory memory[2];
    VkDebugUtilsMessengerEXT messenger;
    uint32_t width, height;
    unsigned messages;
} host;

/* Of every device that draws, the first family has graphics and compute. */
enum { HOST_QUEUE_FAMILY = 0 };

static const VkImageSubresourceRange HOST_WHOLE = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};

static inline void host_check(int is_right, const char *what) {
    if (is_right) return;
    fprintf(stderr, "the host cannot %s\n", what);
    exit(2);
}

static inline VKAPI_ATTR VkBool32 VKAPI_CALL host_listen(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                                  VkDebugUtilsMessageTypeFlagsEXT type,
                                                  const VkDebugUtilsMessengerCallbackDataEXT *data, void *user) {
    (void)severity, (void)type;
    fprintf(stderr, "validation: %s\n", data->pMessage);
    ((host *)user)->messages += 1;
    return VK_FALSE;
}

static inline void host_make_instance(host *h) {
    const char *mode = getenv("STRATAVOX_VALIDATION");
    const int listens = mode && strcmp(mode, "off");
    const VkValidationFeatureEnableEXT sync = VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
    const VkValidationFeaturesEXT features = {.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT,
                                              .enabledValidationFeatureCount = mode && !strcmp(mode, "sync"),
                                              .pEnabledValidationFeatures = &sync};
    const char *layers[] = {"VK_LAYER_KHRONOS_validation"};
    const char *extensions[] = {VK_EXT_DEBUG_UTILS_EXTENSION_NAME, VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME};
    const VkApplicationInfo application = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                           .apiVersion = VK_API_VERSION_1_3};
    const VkInstanceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                       .pNext = listens ? &features : NULL,
                                       .pApplicationInfo = &application,
                                       .enabledLayerCount = listens,
                                       .ppEnabledLayerNames = layers,
                                       .enabledExtensionCount = listens ? 2 : 0,
                                       .ppEnabledExtensionNames = extensions};
    host_check(vkCreateInstance(&info, NULL, &h->instance) == VK_SUCCESS, "make an instance of Vulkan 1.3");
    if (!listens) return;
    const VkDebugUtilsMessengerCreateInfoEXT messenger = {
        .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
        .messageSeverity =
            VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT,
        .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT,
        .pfnUserCallback = host_listen,
        .pUserData = h};
    PFN_vkCreateDebugUtilsMessengerEXT create =
        (PFN_vkCreateDebugUtilsMessengerEXT)vkGetInstanceProcAddr(h->instance, "vkCreateDebugUtilsMessengerEXT");
    host_check(create && create(h->instance, &messenger, NULL, &h->messenger) == VK_SUCCESS, "listen");
}

/* The first device, with the two features that stratavox requires, and timelines for what it is to submit. */
static inline void host_make_device(host *h) {
    uint32_t count = 1;
    const VkResult found = vkEnumeratePhysicalDevices(h->instance, &count, &h->physical_device);
    host_check((found == VK_SUCCESS || found == VK_INCOMPLETE) && count, "find a device");
    VkPhysicalDeviceVulkan13Features features13 = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES,
                                                   .synchronization2 = VK_TRUE,
                                                   .dynamicRendering = VK_TRUE};
    VkPhysicalDeviceVulkan12Features features12 = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES,
                                                   .pNext = &features13,
                                                   .timelineSemaphore = VK_TRUE};
    const float priority = 1.0f;
    const VkDeviceQueueCreateInfo queue = {.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                           .queueFamilyIndex = HOST_QUEUE_FAMILY,
                                           .queueCount = 1,
                                           .pQueuePriorities = &priority};
    const VkDeviceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                     .pNext = &features12,
                                     .queueCreateInfoCount = 1,
                                     .pQueueCreateInfos = &queue};
    host_check(vkCreateDevice(h->physical_device, &info, NULL, &h->device) == VK_SUCCESS, "make a device");
    vkGetDeviceQueue(h->device, HOST_QUEUE_FAMILY, 0, &h->queue);
    const VkCommandPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                          .queueFamilyIndex = HOST_QUEUE_FAMILY};
    host_check(vkCreateCommandPool(h->device, &pool, NULL, &h->pool) == VK_SUCCESS, "make a command pool");
}

static inline VkDeviceMemory host_allocate(const host *h, VkMemoryRequirements wanted, VkMemoryPropertyFlags properties) {
    VkPhysicalDeviceMemoryProperties types;
    vkGetPhysicalDeviceMemoryProperties(h->physical_device, &types);
    VkMemoryAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, .allocationSize = wanted.size};
    while (info.memoryTypeIndex < types.memoryTypeCount &&
           (!(wanted.memoryTypeBits >> info.memoryTypeIndex & 1) ||
            (types.memoryTypes[info.memoryTypeIndex].propertyFlags & properties) != properties))
        info.memoryTypeIndex += 1;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    host_check(vkAllocateMemory(h->device, &info, NULL, &memory) == VK_SUCCESS, "allocate memory");
    return memory;
}

/* `h` stays where it is: the layer speaks to it. */
static inline void host_open(host *h, uint32_t width, uint32_t height, VkFormat format) {
    memset(h, 0, sizeof *h);
    h->width = width, h->height = height;
    host_make_instance(h);
    host_make_device(h);
    const VkImageCreateInfo image = {.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                                     .imageType = VK_IMAGE_TYPE_2D,
                                     .format = format,
                                     .extent = {h->width, h->height, 1},
                                     .mipLevels = 1,
                                     .arrayLayers = 1,
                                     .samples = VK_SAMPLE_COUNT_1_BIT,
                                     .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT};
    host_check(vkCreateImage(h->device, &image, NULL, &h->image) == VK_SUCCESS, "make an image");
    const VkBufferCreateInfo buffer = {.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                                       .size = (VkDeviceSize)h->width * h->height * 4,
                                       .usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT};
    host_check(vkCreateBuffer(h->device, &buffer, NULL, &h->readback) == VK_SUCCESS, "make a buffer");
    VkMemoryRequirements wanted;
    vkGetImageMemoryRequirements(h->device, h->image, &wanted);
    h->memory[0] = host_allocate(h, wanted, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    vkGetBufferMemoryRequirements(h->device, h->readback, &wanted);
    h->memory[1] = host_allocate(h, wanted, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
    host_check(vkBindImageMemory(h->device, h->image, h->memory[0], 0) == VK_SUCCESS &&
                   vkBindBufferMemory(h->device, h->readback, h->memory[1], 0) == VK_SUCCESS,
               "bind memory");
    const VkImageViewCreateInfo view = {.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                        .image = h->image,
                                        .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                        .format = format,
                                        .subresourceRange = HOST_WHOLE};
    host_check(vkCreateImageView(h->device, &view, NULL, &h->view) == VK_SUCCESS, "make a view");
}

/* A command buffer that is being recorded. */
static inline VkCommandBuffer host_begin(const host *h) {
    VkCommandBuffer cmd = VK_NULL_HANDLE;
    const VkCommandBufferAllocateInfo allocate = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                                  .commandPool = h->pool,
                                                  .commandBufferCount = 1};
    const VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    host_check(vkAllocateCommandBuffers(h->device, &allocate, &cmd) == VK_SUCCESS &&
                   vkBeginCommandBuffer(cmd, &begin) == VK_SUCCESS,
               "begin a command buffer");
    return cmd;
}

/* Copies the image, which is in VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to where the CPU reads it. */
static inline void host_fetch(const host *h, VkCommandBuffer cmd) {
    const VkBufferImageCopy copy = {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                    .imageExtent = {h->width, h->height, 1}};
    const VkMemoryBarrier2 copied = {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                     .srcStageMask = VK_PIPELINE_STAGE_2_COPY_BIT,
                                     .srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                     .dstStageMask = VK_PIPELINE_STAGE_2_HOST_BIT,
                                     .dstAccessMask = VK_ACCESS_2_HOST_READ_BIT};
    const VkDependencyInfo dependency = {.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                         .memoryBarrierCount = 1,
                                         .pMemoryBarriers = &copied};
    vkCmdCopyImageToBuffer(cmd, h->image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, h->readback, 1, &copy);
    vkCmdPipelineBarrier2(cmd, &dependency);
}

/* Hosts with frames in flight do not wait here. */
static inline void host_submit_and_wait(const host *h, VkCommandBuffer cmd) {
    const VkSubmitInfo submit = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                                 .commandBufferCount = 1,
                                 .pCommandBuffers = &cmd};
    host_check(vkEndCommandBuffer(cmd) == VK_SUCCESS, "end a command buffer");
    host_check(vkQueueSubmit(h->queue, 1, &submit, VK_NULL_HANDLE) == VK_SUCCESS, "submit");
    host_check(vkQueueWaitIdle(h->queue) == VK_SUCCESS, "wait");
}

/* What was fetched: red, green, blue and alpha of each pixel. `texels` has room for it. */
static inline void host_texels(const host *h, uint8_t *texels) {
    void *mapped = NULL;
    host_check(vkMapMemory(h->device, h->memory[1], 0, VK_WHOLE_SIZE, 0, &mapped) == VK_SUCCESS, "map memory");
    memcpy(texels, mapped, (size_t)h->width * h->height * 4);
    vkUnmapMemory(h->device, h->memory[1]);
}

/* All that came before, and then all that comes. */
static inline void host_barrier(VkCommandBuffer cmd, VkImage image, VkImageAspectFlags aspect, VkImageLayout from,
                                VkImageLayout to) {
    const VkImageMemoryBarrier2 barrier = {.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
                                           .srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                           .srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT,
                                           .dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                           .dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT,
                                           .oldLayout = from,
                                           .newLayout = to,
                                           .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                           .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                           .image = image,
                                           .subresourceRange = {aspect, 0, 1, 0, 1}};
    const VkDependencyInfo dependency = {.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                         .imageMemoryBarrierCount = 1,
                                         .pImageMemoryBarriers = &barrier};
    vkCmdPipelineBarrier2(cmd, &dependency);
}

/* A depth buffer of the picture's size that shaders may read. */
typedef struct host_depth {
    VkImage image;
    VkImageView view;
    VkDeviceMemory memory;
} host_depth;

static inline host_depth host_make_depth(const host *h) {
    host_depth d;
    const VkImageCreateInfo image = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
        .imageType = VK_IMAGE_TYPE_2D,
        .format = VK_FORMAT_D32_SFLOAT,
        .extent = {h->width, h->height, 1},
        .mipLevels = 1,
        .arrayLayers = 1,
        .samples = VK_SAMPLE_COUNT_1_BIT,
        .usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                 VK_IMAGE_USAGE_TRANSFER_DST_BIT};
    host_check(vkCreateImage(h->device, &image, NULL, &d.image) == VK_SUCCESS, "make a depth buffer");
    VkMemoryRequirements wanted;
    vkGetImageMemoryRequirements(h->device, d.image, &wanted);
    d.memory = host_allocate(h, wanted, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    host_check(vkBindImageMemory(h->device, d.image, d.memory, 0) == VK_SUCCESS, "bind memory");
    const VkImageViewCreateInfo view = {.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                        .image = d.image,
                                        .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                        .format = VK_FORMAT_D32_SFLOAT,
                                        .subresourceRange = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 1, 0, 1}};
    host_check(vkCreateImageView(h->device, &view, NULL, &d.view) == VK_SUCCESS, "make a view");
    return d;
}

static inline void host_free_depth(const host *h, host_depth d) {
    vkDestroyImageView(h->device, d.view, NULL);
    vkDestroyImage(h->device, d.image, NULL);
    vkFreeMemory(h->device, d.memory, NULL);
}

/* Destroys what host_open made. How many messages the validation layer had. */
static inline unsigned host_close(host *h) {
    vkDestroyCommandPool(h->device, h->pool, NULL);
    vkDestroyImageView(h->device, h->view, NULL);
    vkDestroyImage(h->device, h->image, NULL);
    vkDestroyBuffer(h->device, h->readback, NULL);
    vkFreeMemory(h->device, h->memory[0], NULL);
    vkFreeMemory(h->device, h->memory[1], NULL);
    vkDestroyDevice(h->device, NULL);
    if (h->messenger) {
        PFN_vkDestroyDebugUtilsMessengerEXT destroy =
            (PFN_vkDestroyDebugUtilsMessengerEXT)vkGetInstanceProcAddr(h->instance, "vkDestroyDebugUtilsMessengerEXT");
        destroy(h->instance, h->messenger, NULL);
    }
    vkDestroyInstance(h->instance, NULL);
    return h->messages;
}

#endif
