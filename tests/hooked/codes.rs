//! What each function may return when it fails: the return codes of the Vulkan 1.3 specification (`errorcodes` of its
//! registry, vk.xml 1.3.239), less those that only come of extensions that nothing here enables.

use ash::vk;
use ash::vk::Result as R;

const HOST: R = R::ERROR_OUT_OF_HOST_MEMORY;
const DEVICE: R = R::ERROR_OUT_OF_DEVICE_MEMORY;
const ADDRESS: R = R::ERROR_INVALID_OPAQUE_CAPTURE_ADDRESS;
const LOST: R = R::ERROR_DEVICE_LOST;

/// The codes of a function of [`super::FALLIBLE`].
pub fn codes(function: &str) -> &'static [vk::Result] {
    match function {
        "vkCreateInstance" => &[
            HOST,
            DEVICE,
            R::ERROR_INITIALIZATION_FAILED,
            R::ERROR_LAYER_NOT_PRESENT,
            R::ERROR_EXTENSION_NOT_PRESENT,
            R::ERROR_INCOMPATIBLE_DRIVER,
        ],
        "vkEnumerateInstanceVersion" => &[HOST],
        "vkEnumerateInstanceExtensionProperties" | "vkEnumerateDeviceExtensionProperties" => {
            &[HOST, DEVICE, R::ERROR_LAYER_NOT_PRESENT]
        }
        "vkEnumeratePhysicalDevices" => &[HOST, DEVICE, R::ERROR_INITIALIZATION_FAILED],
        "vkGetPhysicalDeviceImageFormatProperties2" => {
            &[HOST, DEVICE, R::ERROR_FORMAT_NOT_SUPPORTED]
        }
        "vkCreateDevice" => &[
            HOST,
            DEVICE,
            R::ERROR_INITIALIZATION_FAILED,
            R::ERROR_EXTENSION_NOT_PRESENT,
            R::ERROR_FEATURE_NOT_PRESENT,
            R::ERROR_TOO_MANY_OBJECTS,
            LOST,
        ],
        "vkCreateBuffer" | "vkBindBufferMemory" | "vkCreateImage" | "vkCreateImageView"
        | "vkCreateSampler" => &[HOST, DEVICE, ADDRESS],
        "vkAllocateMemory" => &[HOST, DEVICE, R::ERROR_INVALID_EXTERNAL_HANDLE, ADDRESS],
        "vkMapMemory" => &[HOST, DEVICE, R::ERROR_MEMORY_MAP_FAILED],
        "vkCreateDescriptorPool" => &[HOST, DEVICE, R::ERROR_FRAGMENTATION],
        "vkAllocateDescriptorSets" => &[
            HOST,
            DEVICE,
            R::ERROR_FRAGMENTED_POOL,
            R::ERROR_OUT_OF_POOL_MEMORY,
        ],
        // It returns a code, and has none of a failure.
        "vkFreeDescriptorSets" => &[],
        "vkResetCommandPool" | "vkResetFences" => &[DEVICE],
        "vkGetQueryPoolResults"
        | "vkQueueSubmit"
        | "vkQueueSubmit2"
        | "vkWaitForFences"
        | "vkDeviceWaitIdle" => &[HOST, DEVICE, LOST],
        "vkSetDebugUtilsObjectNameEXT"
        | "vkCreatePipelineCache"
        | "vkGetPipelineCacheData"
        | "vkBindImageMemory"
        | "vkCreateDescriptorSetLayout"
        | "vkCreatePipelineLayout"
        | "vkCreateShaderModule"
        | "vkCreateComputePipelines"
        | "vkCreateGraphicsPipelines"
        | "vkCreateQueryPool"
        | "vkCreateCommandPool"
        | "vkAllocateCommandBuffers"
        | "vkCreateFence"
        | "vkBeginCommandBuffer"
        | "vkEndCommandBuffer" => &[HOST, DEVICE],
        _ => panic!("no codes for {function}"),
    }
}
