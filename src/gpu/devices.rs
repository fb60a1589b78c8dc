//! What each device of this machine can do for us, and why what it lacks matters.

use super::{
    API_VERSION, Error, Features, FormatFeatures, Identity, Validation, instance::Candidate,
    instance::OwnInstance,
};
use ash::vk;

/// One device.
#[derive(Clone, Debug)]
pub struct DeviceReport {
    /// Names and numbers.
    pub identity: Identity,
    /// Bytes of the memory heaps that are the device's own.
    pub memory_bytes: u64,
    /// Each thing that we use, whether it is there or not.
    pub abilities: Vec<Ability>,
}

impl DeviceReport {
    /// True where nothing is missing that we cannot do without.
    pub fn is_usable(&self) -> bool {
        self.abilities
            .iter()
            .all(|ability| ability.is_present || !ability.is_required)
    }
}

/// One thing that we use.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Ability {
    /// Its name, where it has one by the name of the Vulkan specification.
    pub name: &'static str,
    /// Whether the device has it.
    pub is_present: bool,
    /// Whether nothing works without.
    pub is_required: bool,
    /// What lacking it means.
    pub without: &'static str,
}

/// Every device of this machine in the order of its index: discrete, integrated, virtual, cpu, other.
///
/// Makes an instance for as long as it takes, and no device.
pub fn list_devices() -> Result<Vec<DeviceReport>, Error> {
    let instance = OwnInstance::new(Validation::FromEnvironment.mode()?)?;
    let report = |device: Candidate| DeviceReport {
        memory_bytes: memory_bytes(instance.raw(), device.physical_device),
        abilities: abilities(instance.raw(), &device),
        identity: device.identity,
    };
    Ok(instance.devices()?.into_iter().map(report).collect())
}

/// The table: what a device of ours must have, and what we use where it is there.
pub(super) fn abilities(instance: &ash::Instance, device: &Candidate) -> Vec<Ability> {
    let is_new_enough = device.identity.api_version >= super::identity::version(API_VERSION);
    let features = supported(instance, device);
    // SAFETY: the device was listed by this instance.
    let families =
        unsafe { instance.get_physical_device_queue_family_properties(device.physical_device) };
    let family = queue_family(&families);
    let has_timestamps =
        family.is_some_and(|index| families[index as usize].timestamp_valid_bits > 0);
    let format = |format| {
        // SAFETY: the device was listed by this instance.
        unsafe { FormatFeatures::of(instance, device.physical_device, format) }
    };
    let nothing = "nothing works on this device";
    let required = |name, is_present| Ability {
        name,
        is_present,
        is_required: true,
        without: nothing,
    };
    let optional = |name, is_present, without| Ability {
        name,
        is_present,
        is_required: false,
        without,
    };
    vec![
        required("Vulkan 1.3", is_new_enough),
        required("dynamicRendering", features.dynamic_rendering),
        required("synchronization2", features.synchronization2),
        required("timelineSemaphore", features.timeline_semaphore),
        required("a queue family with graphics and compute", family.is_some()),
        optional(
            "R32G32B32A32_SFLOAT blending",
            format(vk::Format::R32G32B32A32_SFLOAT).blend,
            "the slicers cannot blend in 32-bit floats, ray casting can",
        ),
        optional(
            "R16G16B16A16_SFLOAT blending",
            format(vk::Format::R16G16B16A16_SFLOAT).blend,
            "the slicers cannot blend in 16-bit floats, ray casting can",
        ),
        optional(
            "R16_UNORM linear filtering",
            format(vk::Format::R16_UNORM).linear,
            "16-bit volumes are filtered by eight fetches a sample, which is slower",
        ),
        optional(
            "R32_SFLOAT linear filtering",
            format(vk::Format::R32_SFLOAT).linear,
            "float volumes are filtered by eight fetches a sample, which is slower",
        ),
        optional(
            "robustImageAccess",
            features.robust_image_access,
            "a fault in a shader could read beyond an image",
        ),
        optional(
            "timestamps",
            has_timestamps,
            "times of the GPU are not reported",
        ),
    ]
}

/// The features that we use, as far as the device has them.
pub(super) fn supported(instance: &ash::Instance, device: &Candidate) -> Features {
    if device.identity.api_version < super::identity::version(API_VERSION) {
        return Features::default();
    }
    let mut features12 = vk::PhysicalDeviceVulkan12Features::default();
    let mut features13 = vk::PhysicalDeviceVulkan13Features::default();
    let mut features2 = vk::PhysicalDeviceFeatures2::default()
        .push_next(&mut features12)
        .push_next(&mut features13);
    // SAFETY: the device was listed by this instance, and both speak Vulkan 1.3.
    unsafe { instance.get_physical_device_features2(device.physical_device, &mut features2) };
    let core = features2.features;
    Features {
        dynamic_rendering: features13.dynamic_rendering == vk::TRUE,
        synchronization2: features13.synchronization2 == vk::TRUE,
        timeline_semaphore: features12.timeline_semaphore == vk::TRUE,
        robust_buffer_access: core.robust_buffer_access == vk::TRUE,
        robust_image_access: features13.robust_image_access == vk::TRUE,
        shader_storage_image_extended_formats: core.shader_storage_image_extended_formats
            == vk::TRUE,
    }
}

/// The first family that our recordings can be submitted to.
pub(super) fn queue_family(families: &[vk::QueueFamilyProperties]) -> Option<u32> {
    let found = families
        .iter()
        .position(|family| family.queue_flags.contains(super::QUEUE_WORK));
    found.and_then(|index| u32::try_from(index).ok())
}

fn memory_bytes(instance: &ash::Instance, physical_device: vk::PhysicalDevice) -> u64 {
    // SAFETY: the device was listed by this instance.
    let memory = unsafe { instance.get_physical_device_memory_properties(physical_device) };
    let heaps = memory.memory_heaps_as_slice().iter();
    heaps
        .filter(|heap| heap.flags.contains(vk::MemoryHeapFlags::DEVICE_LOCAL))
        .map(|heap| heap.size)
        .sum()
}
