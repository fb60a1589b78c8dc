//! What a host says of its device: it cannot be asked.

use super::status::{Failure, number};
use super::structure::Versioned;
use crate::gpu::{Caps, Features};
use std::ffi::{c_char, c_void};

/// What any function of Vulkan is cast to.
pub type sv_vk_function = Option<unsafe extern "C" fn()>;

/// `vkGetInstanceProcAddr`, with `VkInstance` as a plain pointer: cast yours to it.
pub type sv_get_instance_proc_addr =
    Option<unsafe extern "C" fn(instance: *mut c_void, name: *const c_char) -> sv_vk_function>;

/// Features of the device, by their names in the Vulkan specification.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum sv_feature {
    /// Required.
    SV_FEATURE_DYNAMIC_RENDERING = 1,
    /// Required.
    SV_FEATURE_SYNCHRONIZATION2 = 2,
    /// Required of `sv_submitter_create` alone.
    SV_FEATURE_TIMELINE_SEMAPHORE = 4,
    /// Of use, no more.
    SV_FEATURE_ROBUST_BUFFER_ACCESS = 8,
    /// Of use, no more.
    SV_FEATURE_ROBUST_IMAGE_ACCESS = 16,
    /// `VK_KHR_portability_subset`, an extension: required where the device lists it.
    SV_FEATURE_PORTABILITY_SUBSET = 32,
}

/// Limits that are stricter than those of the device. 0 is no limit.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct sv_limits {
    /// `sizeof(sv_limits)`.
    pub struct_size: u32,
    /// NULL.
    pub next: *const c_void,
    /// `maxImageDimension2D`.
    pub max_image_dimension_2d: u32,
    /// `maxImageDimension3D`: larger volumes lie in bricks.
    pub max_image_dimension_3d: u32,
    /// `maxImageArrayLayers`.
    pub max_image_array_layers: u32,
    /// `maxStorageBufferRange`.
    pub max_storage_buffer_range: u32,
    /// `maxMemoryAllocationSize`.
    pub max_allocation_bytes: u64,
    /// `maxMemoryAllocationCount`.
    pub max_allocations: u64,
    /// The size of the largest memory heap.
    pub max_heap_bytes: u64,
}

// SAFETY: as the trait wants it.
unsafe impl Versioned for sv_limits {
    const NAME: &'static str = "sv_limits";
}

/// A device of the host's, and what is enabled on it: Vulkan cannot be asked for that.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct sv_host_device {
    /// `sizeof(sv_host_device)`.
    pub struct_size: u32,
    /// NULL.
    pub next: *const c_void,
    /// The `apiVersion` that the instance was made with, 1.3 or later. 0 is 1.3.
    pub api_version: u32,
    /// The family of the queues that recordings are submitted to: with graphics and compute.
    pub queue_family: u32,
    /// `VkInstance`.
    pub instance: *mut c_void,
    /// `VkPhysicalDevice`.
    pub physical_device: *mut c_void,
    /// `VkDevice`. It lives longer than the sv_device.
    pub device: *mut c_void,
    /// Every function of Vulkan is reached through it, and no loader is linked.
    pub get_instance_proc_addr: sv_get_instance_proc_addr,
    /// Bits of sv_feature that are enabled on the device.
    pub features: u32,
    /// Not 0: the instance has `VK_EXT_debug_utils`, and objects get names.
    pub has_debug_utils: u32,
    /// Stricter limits, or NULL.
    pub limits: *const sv_limits,
    /// What sv_device_pipeline_cache gave in an earlier run, or NULL. What another driver made is ignored.
    pub pipeline_cache: *const c_void,
    /// Bytes of it.
    pub pipeline_cache_bytes: u64,
    /// Called once, from the call that notices that the device is lost; or NULL. It may destroy nothing.
    pub device_lost: Option<unsafe extern "C" fn(user: *mut c_void, text: *const c_char)>,
    /// What `device_lost` is called with.
    pub user: *mut c_void,
    /// As sv_device_set_memory_budget. 0: no budget.
    pub memory_budget: u64,
}

// SAFETY: as the trait wants it.
unsafe impl Versioned for sv_host_device {
    const NAME: &'static str = "sv_host_device";
}

/// What the host says is enabled.
pub(super) fn features(bits: u32) -> Result<Features, Failure> {
    use sv_feature::*;
    let has = |feature: sv_feature| bits & feature as u32 != 0;
    let known = (0..64).contains(&bits);
    number(
        "sv_host_device.features",
        "bits of sv_feature",
        bits.into(),
        known,
    )?;
    Ok(Features {
        dynamic_rendering: has(SV_FEATURE_DYNAMIC_RENDERING),
        synchronization2: has(SV_FEATURE_SYNCHRONIZATION2),
        timeline_semaphore: has(SV_FEATURE_TIMELINE_SEMAPHORE),
        robust_buffer_access: has(SV_FEATURE_ROBUST_BUFFER_ACCESS),
        robust_image_access: has(SV_FEATURE_ROBUST_IMAGE_ACCESS),
        portability_subset: has(SV_FEATURE_PORTABILITY_SUBSET),
    })
}

/// The host's stricter limits.
pub(super) fn caps(limits: &sv_limits) -> Caps {
    let short = |limit: u32| if limit == 0 { u32::MAX } else { limit };
    let long = |limit: u64| if limit == 0 { u64::MAX } else { limit };
    Caps {
        max_image_dimension_2d: short(limits.max_image_dimension_2d),
        max_image_dimension_3d: short(limits.max_image_dimension_3d),
        max_image_array_layers: short(limits.max_image_array_layers),
        max_storage_buffer_range: short(limits.max_storage_buffer_range),
        max_allocation_bytes: long(limits.max_allocation_bytes),
        max_allocations: long(limits.max_allocations),
        max_heap_bytes: long(limits.max_heap_bytes),
        ..Caps::UNLIMITED
    }
}
