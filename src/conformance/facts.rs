//! What a package says of a device.

use super::record::DeviceRecord;
use crate::gpu::{Gpu, PORTABILITY_SUBSET};
use ash::vk;
use std::collections::BTreeMap;

impl DeviceRecord {
    /// Of a device in use.
    pub fn of(gpu: &Gpu) -> Self {
        let identity = gpu.identity();
        let hex = |bytes: &[u8]| bytes.iter().map(|b| format!("{b:02x}")).collect();
        let [major, minor, patch] = identity.api_version;
        Self {
            name: identity.name.clone(),
            kind: identity.kind.name().to_owned(),
            driver: identity.driver_name.clone(),
            driver_id: identity.driver_id.as_raw() as u32,
            driver_info: identity.driver_info.clone(),
            driver_version: identity.driver_version,
            vulkan: format!("{major}.{minor}.{patch}"),
            vendor_id: identity.vendor_id,
            device_id: identity.device_id,
            uuid: hex(&identity.uuid),
            limits: limits(gpu),
            features: features(gpu),
            // All else that is used is in Vulkan 1.3.
            extensions_enabled: match gpu.features().portability_subset {
                true => vec![PORTABILITY_SUBSET.to_owned()],
                false => Vec::new(),
            },
            extensions_available: extensions(gpu),
        }
    }
}

/// Those that the library compares before its calls, as lowered for the run, and those that cases look up themselves.
fn limits(gpu: &Gpu) -> BTreeMap<String, u64> {
    let lowered = gpu.limits();
    let mut properties12 = vk::PhysicalDeviceVulkan12Properties::default();
    let mut properties = vk::PhysicalDeviceProperties2::default().push_next(&mut properties12);
    // SAFETY: the physical device belongs to the instance; both live as long as `gpu`.
    unsafe {
        let instance = gpu.instance();
        instance.get_physical_device_properties2(gpu.physical_device(), &mut properties);
    }
    let own = properties.properties.limits;
    let named: [(&str, u64); 16] = [
        ("maxBufferSize", lowered.max_buffer_bytes),
        (
            "maxComputeWorkGroupInvocations",
            lowered.max_workgroup_invocations.into(),
        ),
        ("maxFramebufferHeight", lowered.max_framebuffer[1].into()),
        ("maxFramebufferWidth", lowered.max_framebuffer[0].into()),
        ("maxImageArrayLayers", lowered.max_image_array_layers.into()),
        ("maxImageDimension2D", lowered.max_image_dimension_2d.into()),
        ("maxImageDimension3D", lowered.max_image_dimension_3d.into()),
        ("maxMemoryAllocationCount", lowered.max_allocations),
        ("maxMemoryAllocationSize", lowered.max_allocation_bytes),
        (
            "maxPerStageDescriptorStorageBuffers",
            lowered.max_storage_buffers_per_stage.into(),
        ),
        (
            "maxStorageBufferRange",
            lowered.max_storage_buffer_range.into(),
        ),
        (
            "maxTimelineSemaphoreValueDifference",
            properties12.max_timeline_semaphore_value_difference,
        ),
        (
            "maxUniformBufferRange",
            lowered.max_uniform_buffer_range.into(),
        ),
        (
            "minUniformBufferOffsetAlignment",
            lowered.min_uniform_offset_alignment,
        ),
        ("subPixelPrecisionBits", own.sub_pixel_precision_bits.into()),
        ("subTexelPrecisionBits", lowered.subtexel_bits.into()),
    ];
    let mut limits: BTreeMap<String, u64> = named.map(|(name, n)| (name.to_owned(), n)).into();
    let lists: [(&str, &[u32]); 3] = [
        ("maxComputeWorkGroupCount", &lowered.max_workgroup_count),
        ("maxComputeWorkGroupSize", &lowered.max_workgroup_size),
        ("maxViewportDimensions", &lowered.max_viewport),
    ];
    for (name, numbers) in lists {
        let each = numbers.iter().enumerate();
        limits.extend(each.map(|(i, &n)| (format!("{name}[{i}]"), n.into())));
    }
    // SAFETY: as above.
    let memory = unsafe {
        gpu.instance()
            .get_physical_device_memory_properties(gpu.physical_device())
    };
    let heaps = memory.memory_heaps_as_slice().iter().enumerate();
    limits.extend(heaps.map(|(i, heap)| (format!("memoryHeaps[{i}].size"), heap.size)));
    limits
}

fn features(gpu: &Gpu) -> BTreeMap<String, bool> {
    let enabled = gpu.features();
    let named = [
        ("dynamicRendering", enabled.dynamic_rendering),
        // No feature of its own: without it the limit is 1.
        ("largePoints", gpu.limits().max_point_pixels > 1),
        ("robustBufferAccess", enabled.robust_buffer_access),
        ("robustImageAccess", enabled.robust_image_access),
        ("synchronization2", enabled.synchronization2),
        ("timelineSemaphore", enabled.timeline_semaphore),
    ];
    named.map(|(name, is)| (name.to_owned(), is)).into()
}

/// None where the device does not say: the record is of the cases, not of this query.
fn extensions(gpu: &Gpu) -> Vec<String> {
    // SAFETY: the physical device belongs to the instance; both live as long as `gpu`.
    let found = unsafe {
        gpu.instance()
            .enumerate_device_extension_properties(gpu.physical_device())
    };
    let name = |found: &vk::ExtensionProperties| {
        let name = found.extension_name_as_c_str().ok()?;
        Some(name.to_string_lossy().into_owned())
    };
    let mut names: Vec<String> = found.unwrap_or_default().iter().filter_map(name).collect();
    names.sort();
    names
}
