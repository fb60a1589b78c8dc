//! Devices that have less than all of Vulkan, such as those of MoltenVK. They list `VK_KHR_portability_subset`, which
//! must then be enabled (VUID-VkDeviceCreateInfo-pProperties-04451), and say by its features what they have of the
//! parts that may be missing.
//!
//! Pictures are drawn without any of these parts: no triangle fans, points as polygons, tessellation, vertex
//! attributes, swizzled or reinterpreted views, constant blend factors, events, biased or comparing samplers. Two are
//! asked for by conformance cases.

use super::devices::has_extension;
use ash::vk;

/// The extension's name.
pub const PORTABILITY_SUBSET: &str = "VK_KHR_portability_subset";

/// What a device has of the parts that may be missing. `None`: it does not list the extension and has all of them.
///
/// # Safety
/// `physical_device` belongs to `instance`, and both speak Vulkan 1.1 or later.
pub unsafe fn portability_subset(
    instance: &ash::Instance,
    physical_device: vk::PhysicalDevice,
) -> Option<vk::PhysicalDevicePortabilitySubsetFeaturesKHR<'static>> {
    // SAFETY: the caller's promise.
    if !unsafe { has_extension(instance, physical_device, PORTABILITY_SUBSET) } {
        return None;
    }
    let mut subset = vk::PhysicalDevicePortabilitySubsetFeaturesKHR::default();
    let mut features = vk::PhysicalDeviceFeatures2::default().push_next(&mut subset);
    // SAFETY: as above; the device has the extension of the structure.
    unsafe { instance.get_physical_device_features2(physical_device, &mut features) };
    subset.p_next = std::ptr::null_mut();
    Some(subset)
}
