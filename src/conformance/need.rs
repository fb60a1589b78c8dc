//! What a case asks of a device, looked up twice: as the library knows the device, and by a query of its own. Of events,
//! which the library does not use, the query alone says.
//!
//! | library | query | said |
//! |---|---|---|
//! | has it | has it | the case runs |
//! | lacks it | lacks it | not_supported |
//! | lacks it | has it, and the limits of the run were lowered | not_supported, and that it was lowered |
//! | otherwise | | internal_error: one of the two is wrong |

use crate::gpu::{Feature, Gpu, Item, Limit, portability_subset};
use ash::vk;
use serde::{Deserialize, Serialize};

/// One need compared with a device.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Found {
    /// The feature, limit or format, by its name in Vulkan.
    pub name: String,
    /// What is wanted of it.
    pub wanted: String,
    /// What the device says to a query of its own.
    pub device_says: String,
    /// Whether the device has it.
    pub device_has: bool,
    /// What the library knows of it: limits of the run are in it.
    pub library_says: String,
    /// Whether the library takes it as there.
    pub library_has: bool,
}

impl Found {
    /// Both ways of asking `gpu` for `item`.
    pub fn of(gpu: &Gpu, item: Item) -> Self {
        let (device_says, device_has) = asked(gpu, item);
        let (library_says, library_has) = known(gpu, item);
        Self {
            name: item.to_string(),
            wanted: item.wanted(),
            device_says,
            device_has,
            library_says,
            library_has,
        }
    }

    /// What the device says of `vkCreateEvent`, which devices with `VK_KHR_portability_subset` may lack.
    pub fn events(gpu: &Gpu) -> Self {
        // SAFETY: the physical device belongs to the instance; both live as long as `gpu`.
        let subset = unsafe { portability_subset(gpu.instance(), gpu.physical_device()) };
        let has = subset.is_none_or(|subset| subset.events == vk::TRUE);
        Self {
            name: "events".to_owned(),
            wanted: "true".to_owned(),
            library_says: has.to_string(),
            device_says: has.to_string(),
            device_has: has,
            library_has: has,
        }
    }
}

/// As the library has it: limits of the run are in it.
fn known(gpu: &Gpu, item: Item) -> (String, bool) {
    match item {
        Item::Feature(feature) => supported(feature.is_in(&gpu.features())),
        Item::Limit(limit, least) => {
            let found = limit.of(gpu.limits());
            (found.to_string(), found >= least)
        }
        Item::Format(format, wanted) => {
            use vk::FormatFeatureFlags as Flags;
            let has = gpu.format_features(format);
            let known = [
                (Flags::SAMPLED_IMAGE, has.sampled),
                (Flags::SAMPLED_IMAGE_FILTER_LINEAR, has.linear),
                (Flags::STORAGE_IMAGE, has.storage),
                (Flags::COLOR_ATTACHMENT, has.color),
                (Flags::COLOR_ATTACHMENT_BLEND, has.blend),
                (Flags::DEPTH_STENCIL_ATTACHMENT, has.depth),
            ];
            let lacking = known.into_iter().filter(|(_, has)| !has);
            let lacking = lacking.fold(Flags::empty(), |all, (flag, _)| all | flag);
            // Of others the library does not ask.
            features(wanted & !lacking, wanted)
        }
        _ => ("not asked".to_owned(), true),
    }
}

fn supported(has: bool) -> (String, bool) {
    let says = if has { "supported" } else { "not supported" };
    (says.to_owned(), has)
}

/// What of `wanted` is `found`.
fn features(found: vk::FormatFeatureFlags, wanted: vk::FormatFeatureFlags) -> (String, bool) {
    let there = found & wanted;
    let says = if there.is_empty() {
        "nothing of it".to_owned()
    } else {
        format!("{there:?}")
    };
    (says, there == wanted)
}

/// By queries of Vulkan alone.
fn asked(gpu: &Gpu, item: Item) -> (String, bool) {
    let (instance, device) = (gpu.instance(), gpu.physical_device());
    match item {
        Item::Format(format, wanted) => {
            let mut found = vk::FormatProperties2::default();
            // SAFETY: the physical device belongs to the instance; both live as long as `gpu`.
            unsafe {
                instance.get_physical_device_format_properties2(device, format, &mut found);
            }
            features(found.format_properties.optimal_tiling_features, wanted)
        }
        Item::Limit(limit, least) => {
            // SAFETY: as above.
            let limits = unsafe { instance.get_physical_device_properties(device) }.limits;
            let found: u64 = match limit {
                Limit::MaxUniformBufferRange => limits.max_uniform_buffer_range,
                Limit::MaxPerStageDescriptorStorageBuffers => {
                    limits.max_per_stage_descriptor_storage_buffers
                }
                Limit::MaxComputeWorkGroupInvocations => limits.max_compute_work_group_invocations,
                Limit::MaxComputeWorkGroupSizeX => limits.max_compute_work_group_size[0],
                Limit::MaxComputeWorkGroupSizeY => limits.max_compute_work_group_size[1],
                Limit::MaxComputeWorkGroupSizeZ => limits.max_compute_work_group_size[2],
                Limit::MaxImageDimension3D => limits.max_image_dimension3_d,
                Limit::MaxImageArrayLayers => limits.max_image_array_layers,
            }
            .into();
            (found.to_string(), found >= least)
        }
        Item::Feature(feature) => {
            let mut features12 = vk::PhysicalDeviceVulkan12Features::default();
            let mut features13 = vk::PhysicalDeviceVulkan13Features::default();
            let mut features = vk::PhysicalDeviceFeatures2::default()
                .push_next(&mut features12)
                .push_next(&mut features13);
            // SAFETY: as above.
            unsafe { instance.get_physical_device_features2(device, &mut features) };
            let core = features.features.robust_buffer_access;
            let has = vk::TRUE
                == match feature {
                    Feature::DynamicRendering => features13.dynamic_rendering,
                    Feature::Synchronization2 => features13.synchronization2,
                    Feature::TimelineSemaphore => features12.timeline_semaphore,
                    Feature::RobustBufferAccess => core,
                    Feature::RobustImageAccess => features13.robust_image_access,
                };
            supported(has)
        }
        _ => ("not asked".to_owned(), true),
    }
}
