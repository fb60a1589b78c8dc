//! What a host hands over: its device, and what it enabled on it.

use super::{Caps, Enabled, HostPhysicalDevice, identity::version_text};
use ash::vk;
use std::fmt;

/// A host's device. Vulkan cannot be asked what was enabled on a device, so the host says it.
#[derive(Clone, Copy)]
pub struct HostDevice<'a> {
    /// The loader's function, or the host's own.
    pub get_instance_proc_addr: vk::PFN_vkGetInstanceProcAddr,
    /// The host's instance.
    pub instance: vk::Instance,
    /// The physical device that `device` was made of.
    pub physical_device: vk::PhysicalDevice,
    /// The host's device.
    pub device: vk::Device,
    /// The family of the queues that what we record is submitted to.
    pub queue_family: u32,
    /// `VkApplicationInfo::apiVersion` of the instance.
    pub api_version: u32,
    /// What the host enabled on the device.
    pub features: Features,
    /// True where the instance has `VK_EXT_debug_utils`: our objects are then named.
    pub debug_utils: bool,
    /// Limits stricter than the device's own, or [`Caps::UNLIMITED`].
    pub caps: Caps,
    /// What [`super::Gpu::pipeline_cache_data`] gave in an earlier run, or nothing. Other bytes are ignored.
    pub pipeline_cache: &'a [u8],
}

impl HostDevice<'_> {
    /// What [`super::check_device`] compares with the requirements.
    pub fn physical(&self) -> HostPhysicalDevice {
        HostPhysicalDevice {
            get_instance_proc_addr: self.get_instance_proc_addr,
            instance: self.instance,
            api_version: self.api_version,
            physical_device: self.physical_device,
            queue_family: Some(self.queue_family),
            enabled: Some(Enabled {
                features: self.features,
                debug_utils: self.debug_utils,
            }),
            caps: self.caps,
        }
    }
}

impl fmt::Debug for HostDevice<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("HostDevice")
            .field("device", &self.device)
            .field("queue_family", &self.queue_family)
            .field("api_version", &version_text(self.api_version))
            .field("features", &self.features)
            .finish_non_exhaustive()
    }
}

/// Features of a device that we use where they are enabled. Names are those of the Vulkan specification.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[allow(
    missing_docs,
    reason = "each is the feature of the Vulkan specification that has this name"
)]
pub struct Features {
    pub dynamic_rendering: bool,
    pub synchronization2: bool,
    /// A host may use fences instead.
    pub timeline_semaphore: bool,
    pub robust_buffer_access: bool,
    pub robust_image_access: bool,
    /// Not a feature but an extension, `VK_KHR_portability_subset`: a device that lists it must have it enabled.
    pub portability_subset: bool,
}
