//! What a device must have, and what more we use where it is there: the one list that everything is checked with.
//!
//! Required is what nothing can be drawn without; recommended, what makes more pictures possible, or the same faster.
//! Names are those of the Vulkan specification. Of Vulkan 1.3 itself, what is not listed is not used: shaders declare
//! the capabilities `Shader` and `ImageQuery` alone, and no device extension is enabled but
//! `VK_KHR_portability_subset`, where a device lists it.

use super::{API_VERSION, Caps, Features, PORTABILITY_SUBSET};
use ash::vk;
use std::fmt;

/// One thing that a device has or lacks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Requirement {
    /// What is asked for.
    pub item: Item,
    /// How much depends on it.
    pub need: Need,
    /// What it is for: the pictures, or the speed, that there is no other way to.
    pub unlocks: &'static str,
}

/// How much depends on a requirement.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Need {
    /// A device that lacks it is refused.
    Required,
    /// A device that lacks it draws less, or slower.
    Recommended,
}

/// What can be asked of an instance or a device.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Item {
    /// `apiVersion` of the instance and of the physical device, at least.
    ApiVersion(u32),
    /// A flag of `VkQueueFamilyProperties::queueFlags` of the family that recordings are submitted to.
    Queue(vk::QueueFlags),
    /// `VkQueueFamilyProperties::timestampValidBits` of that family is not 0.
    Timestamps,
    /// A feature, to be enabled when the device is made.
    Feature(Feature),
    /// A limit, and the least that it may be.
    Limit(Limit, u64),
    /// Bits of `VkFormatProperties::optimalTilingFeatures`.
    Format(vk::Format, vk::FormatFeatureFlags),
    /// An extension, to be enabled when the instance is made.
    InstanceExtension(&'static str),
    /// `VK_KHR_portability_subset`, to be enabled when the device is made, where the physical device lists it.
    PortabilitySubset,
    /// An extension that the device has. It need not be enabled: the physical device alone is asked by it.
    DeviceExtension(&'static str),
}

/// A feature that has to be enabled when the device is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs, reason = "each is the feature of that name")]
pub enum Feature {
    DynamicRendering,
    Synchronization2,
    TimelineSemaphore,
    RobustBufferAccess,
    RobustImageAccess,
}

/// A limit of `VkPhysicalDeviceLimits`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs, reason = "each is the limit of that name")]
pub enum Limit {
    MaxUniformBufferRange,
    MaxPerStageDescriptorStorageBuffers,
    MaxComputeWorkGroupInvocations,
    MaxComputeWorkGroupSizeX,
    MaxComputeWorkGroupSizeY,
    MaxComputeWorkGroupSizeZ,
    MaxImageDimension3D,
    MaxImageArrayLayers,
}

const SAMPLED: vk::FormatFeatureFlags = vk::FormatFeatureFlags::SAMPLED_IMAGE;
const LINEAR: vk::FormatFeatureFlags = vk::FormatFeatureFlags::SAMPLED_IMAGE_FILTER_LINEAR;
const STORAGE: vk::FormatFeatureFlags = vk::FormatFeatureFlags::STORAGE_IMAGE;
const COLOR: vk::FormatFeatureFlags = vk::FormatFeatureFlags::COLOR_ATTACHMENT;
const BLEND: vk::FormatFeatureFlags = vk::FormatFeatureFlags::COLOR_ATTACHMENT_BLEND;
const FROM: vk::FormatFeatureFlags = vk::FormatFeatureFlags::TRANSFER_SRC;
const TO: vk::FormatFeatureFlags = vk::FormatFeatureFlags::TRANSFER_DST;

const fn required(item: Item, unlocks: &'static str) -> Requirement {
    Requirement {
        item,
        need: Need::Required,
        unlocks,
    }
}

const fn recommended(item: Item, unlocks: &'static str) -> Requirement {
    Requirement {
        item,
        need: Need::Recommended,
        unlocks,
    }
}

const fn format(format: vk::Format, features: &[vk::FormatFeatureFlags]) -> Item {
    let (mut bits, mut k) = (0, 0);
    while k < features.len() {
        bits |= features[k].as_raw();
        k += 1;
    }
    Item::Format(format, vk::FormatFeatureFlags::from_raw(bits))
}

/// The list. It needs no device: a host reads it before it makes one.
pub const REQUIREMENTS: &[Requirement] = &[
    required(
        Item::ApiVersion(API_VERSION),
        "everything: dynamic rendering and synchronization2 are core there",
    ),
    required(
        Item::Queue(QUEUE_WORK),
        "everything: ray casting is computed, slices and resolves are drawn, in one command buffer",
    ),
    required(
        Item::Feature(Feature::DynamicRendering),
        "drawing into targets of our own, for which no render pass is ever made",
    ),
    required(
        Item::Feature(Feature::Synchronization2),
        "every barrier and timestamp",
    ),
    required(
        Item::Limit(Limit::MaxUniformBufferRange, 16_384),
        "the parameters of a picture",
    ),
    required(
        Item::Limit(Limit::MaxPerStageDescriptorStorageBuffers, 4),
        "transfer functions, patches of slices, distances to what is seen",
    ),
    required(
        Item::Limit(Limit::MaxComputeWorkGroupInvocations, 64),
        "every compute pass",
    ),
    required(
        Item::Limit(Limit::MaxComputeWorkGroupSizeX, 8),
        "every compute pass",
    ),
    required(
        Item::Limit(Limit::MaxComputeWorkGroupSizeY, 8),
        "every compute pass",
    ),
    required(
        Item::Limit(Limit::MaxComputeWorkGroupSizeZ, 4),
        "passes over volumes",
    ),
    required(
        format(
            vk::Format::R32G32B32A32_SFLOAT,
            &[SAMPLED, STORAGE, COLOR, FROM, TO],
        ),
        "accumulation, and the tables of transfer functions",
    ),
    required(
        format(vk::Format::R32_SFLOAT, &[SAMPLED, TO]),
        "voxels of every type, where their own format is not filtered",
    ),
    required(
        Item::PortabilitySubset,
        "a valid device where parts of Vulkan are missing, as with MoltenVK; no picture needs any of these parts",
    ),
    recommended(
        format(vk::Format::R32G32B32A32_SFLOAT, &[BLEND]),
        "slices blended in 32-bit floats; without it compositing slices are merged in batches of 16-bit floats, and \
         projections by slices are refused",
    ),
    recommended(
        format(vk::Format::R16G16B16A16_SFLOAT, &[SAMPLED, COLOR, BLEND]),
        "slices where 32-bit floats are not blended",
    ),
    recommended(
        format(vk::Format::R16G16B16A16_SFLOAT, &[SAMPLED, LINEAR, STORAGE]),
        "gradients that are kept on the device",
    ),
    recommended(
        format(vk::Format::R8_UNORM, &[SAMPLED, LINEAR, TO]),
        "8-bit voxels as they are; without it they take four bytes each",
    ),
    recommended(
        format(vk::Format::R16_UNORM, &[SAMPLED, LINEAR, TO]),
        "16-bit voxels as they are; without it they take four bytes each",
    ),
    recommended(
        format(vk::Format::R16_SFLOAT, &[SAMPLED, LINEAR, TO]),
        "16-bit floats as they are; without it they take four bytes each",
    ),
    recommended(
        format(vk::Format::R32_SFLOAT, &[LINEAR]),
        "32-bit floats filtered by the sampler; without it by eight fetches a sample, which is slower",
    ),
    recommended(
        format(vk::Format::R8_UINT, &[SAMPLED, TO]),
        "volumes in which values are missing",
    ),
    recommended(
        Item::Limit(Limit::MaxImageDimension3D, 2048),
        "volumes of up to so many voxels a side in one texture; larger ones come in bricks",
    ),
    recommended(
        Item::Limit(Limit::MaxImageArrayLayers, 2048),
        "stacks of so many slices in one texture; larger ones come in bricks",
    ),
    recommended(
        Item::Feature(Feature::TimelineSemaphore),
        "submissions of ours that wait for a host's timeline and signal it",
    ),
    recommended(
        Item::Feature(Feature::RobustBufferAccess),
        "a fault in a shader that stays inside of its buffers",
    ),
    recommended(
        Item::Feature(Feature::RobustImageAccess),
        "a fault in a shader that stays inside of its images",
    ),
    recommended(Item::Timestamps, "times of the device in reports"),
    recommended(
        Item::InstanceExtension("VK_EXT_debug_utils"),
        "names of our objects in validation messages and debuggers",
    ),
    recommended(
        Item::DeviceExtension("VK_EXT_memory_budget"),
        "reports of how much memory this process may still use",
    ),
];

/// What the queue of a recording must be able to do.
pub(super) const QUEUE_WORK: vk::QueueFlags =
    vk::QueueFlags::from_raw(vk::QueueFlags::GRAPHICS.as_raw() | vk::QueueFlags::COMPUTE.as_raw());

impl Feature {
    /// Its name in Vulkan.
    pub fn name(self) -> &'static str {
        match self {
            Self::DynamicRendering => "dynamicRendering",
            Self::Synchronization2 => "synchronization2",
            Self::TimelineSemaphore => "timelineSemaphore",
            Self::RobustBufferAccess => "robustBufferAccess",
            Self::RobustImageAccess => "robustImageAccess",
        }
    }

    /// The structure that it is a member of.
    pub fn structure(self) -> &'static str {
        match self {
            Self::RobustBufferAccess => "VkPhysicalDeviceFeatures",
            Self::TimelineSemaphore => "VkPhysicalDeviceVulkan12Features",
            _ => "VkPhysicalDeviceVulkan13Features",
        }
    }

    /// Whether `features` has it.
    pub fn is_in(self, features: &Features) -> bool {
        match self {
            Self::DynamicRendering => features.dynamic_rendering,
            Self::Synchronization2 => features.synchronization2,
            Self::TimelineSemaphore => features.timeline_semaphore,
            Self::RobustBufferAccess => features.robust_buffer_access,
            Self::RobustImageAccess => features.robust_image_access,
        }
    }
}

impl Limit {
    /// Its name in Vulkan.
    pub fn name(self) -> &'static str {
        match self {
            Self::MaxUniformBufferRange => "maxUniformBufferRange",
            Self::MaxPerStageDescriptorStorageBuffers => "maxPerStageDescriptorStorageBuffers",
            Self::MaxComputeWorkGroupInvocations => "maxComputeWorkGroupInvocations",
            Self::MaxComputeWorkGroupSizeX => "maxComputeWorkGroupSize[0]",
            Self::MaxComputeWorkGroupSizeY => "maxComputeWorkGroupSize[1]",
            Self::MaxComputeWorkGroupSizeZ => "maxComputeWorkGroupSize[2]",
            Self::MaxImageDimension3D => "maxImageDimension3D",
            Self::MaxImageArrayLayers => "maxImageArrayLayers",
        }
    }

    /// What `caps` allow.
    pub fn of(self, caps: &Caps) -> u64 {
        let allowed = match self {
            Self::MaxUniformBufferRange => caps.max_uniform_buffer_range,
            Self::MaxPerStageDescriptorStorageBuffers => caps.max_storage_buffers_per_stage,
            Self::MaxComputeWorkGroupInvocations => caps.max_workgroup_invocations,
            Self::MaxComputeWorkGroupSizeX => caps.max_workgroup_size[0],
            Self::MaxComputeWorkGroupSizeY => caps.max_workgroup_size[1],
            Self::MaxComputeWorkGroupSizeZ => caps.max_workgroup_size[2],
            Self::MaxImageDimension3D => caps.max_image_dimension_3d,
            Self::MaxImageArrayLayers => caps.max_image_array_layers,
        };
        allowed.into()
    }
}

/// `dynamicRendering`, `maxUniformBufferRange`, `VK_FORMAT_R32_SFLOAT`: the name, without what is wanted of it.
impl fmt::Display for Item {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::ApiVersion(_) => write!(f, "apiVersion"),
            Self::Queue(_) => write!(f, "queueFlags of the queue family"),
            Self::Timestamps => write!(f, "timestampValidBits of the queue family"),
            Self::Feature(feature) => write!(f, "{}", feature.name()),
            Self::Limit(limit, _) => write!(f, "{}", limit.name()),
            Self::Format(format, _) => write!(f, "VK_FORMAT_{format:?}"),
            Self::PortabilitySubset => write!(f, "{PORTABILITY_SUBSET}"),
            Self::InstanceExtension(name) | Self::DeviceExtension(name) => write!(f, "{name}"),
        }
    }
}

impl Item {
    /// What is wanted of it: `1.3.0 or later`, `enabled`, `16384 or more`, `SAMPLED_IMAGE | TRANSFER_DST`.
    pub fn wanted(&self) -> String {
        match *self {
            Self::ApiVersion(version) => {
                format!("{} or later", super::identity::version_text(version))
            }
            Self::Queue(flags) => format!("{flags:?}"),
            Self::Timestamps => "1 or more".into(),
            Self::Feature(_) | Self::InstanceExtension(_) => "enabled".into(),
            Self::PortabilitySubset => "enabled where the device lists it".into(),
            Self::DeviceExtension(_) => "supported".into(),
            Self::Limit(_, least) => format!("{least} or more"),
            Self::Format(_, features) => format!("{features:?}"),
        }
    }
}
