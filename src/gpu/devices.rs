//! Devices against the list of requirements: those of this machine, and one that a host has.

use super::{
    API_VERSION, Caps, Error, Feature, Features, Gpu, Identity, Item, Need, PORTABILITY_SUBSET,
    REQUIREMENTS, Requirement, Validation, identity::version_text, instance::Candidate,
    instance::OwnInstance,
};
use ash::vk;
use std::fmt;

/// What one device has of [`REQUIREMENTS`].
#[derive(Clone, Debug)]
pub struct DeviceReport {
    /// Names and numbers.
    pub identity: Identity,
    /// Bytes of the memory heaps that are the device's own.
    pub memory_bytes: u64,
    /// One for each requirement, in their order; the version alone where that is too old to ask for more.
    pub findings: Vec<Finding>,
}

impl DeviceReport {
    /// True where nothing is missing that we cannot do without.
    pub fn is_usable(&self) -> bool {
        self.missing(Need::Required).next().is_none()
    }

    /// What is required, or recommended, and not there.
    pub fn missing(&self, need: Need) -> impl Iterator<Item = &Finding> {
        let findings = self.findings.iter();
        findings.filter(move |finding| finding.requirement.need == need && !finding.is_met)
    }

    /// Refuses a device that lacks what is required.
    pub(super) fn require(&self) -> Result<(), Error> {
        let missing: Vec<_> = self.missing(Need::Required).cloned().collect();
        if missing.is_empty() {
            return Ok(());
        }
        let device = self.identity.name.clone();
        Err(Error::Unfit { device, missing })
    }
}

/// One requirement compared with a device.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// What was asked for.
    pub requirement: Requirement,
    /// What was found: a version, a number, flags, `not enabled`.
    pub found: String,
    /// Whether that is enough.
    pub is_met: bool,
}

/// `maxUniformBufferRange (wanted 16384 or more, found 8192)`.
impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (item, wanted) = (self.requirement.item, self.requirement.item.wanted());
        write!(f, "{item} (wanted {wanted}, found {})", self.found)
    }
}

/// A physical device of a host's, of which it has made a device or is about to.
#[derive(Clone, Copy)]
pub struct HostPhysicalDevice {
    /// The loader's function, or the host's own.
    pub get_instance_proc_addr: vk::PFN_vkGetInstanceProcAddr,
    /// The host's instance.
    pub instance: vk::Instance,
    /// `VkApplicationInfo::apiVersion` of the instance.
    pub api_version: u32,
    /// One of the instance's.
    pub physical_device: vk::PhysicalDevice,
    /// The family of the queues that what we record is submitted to. `None`: the first that will do.
    pub queue_family: Option<u32>,
    /// What the host has enabled. `None`: all that the device supports, which it may still enable.
    pub enabled: Option<Enabled>,
    /// Limits stricter than the device's own, or [`Caps::UNLIMITED`].
    pub caps: Caps,
}

/// What a host has enabled on its instance and its device.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Enabled {
    /// On the device.
    pub features: Features,
    /// `VK_EXT_debug_utils` on the instance.
    pub debug_utils: bool,
}

impl fmt::Debug for HostPhysicalDevice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("HostPhysicalDevice")
            .field("physical_device", &self.physical_device)
            .field("queue_family", &self.queue_family)
            .field("api_version", &version_text(self.api_version))
            .field("enabled", &self.enabled)
            .finish_non_exhaustive()
    }
}

impl Gpu {
    /// Refuses what needs a feature of the list that the host did not enable.
    pub(super) fn require(&self, feature: Feature) -> Result<(), Error> {
        let wanted = |one: &&Requirement| one.item == Item::Feature(feature);
        match REQUIREMENTS.iter().find(wanted) {
            Some(requirement) if !feature.is_in(&self.features()) => Err(Error::Unfit {
                device: self.device_name().into(),
                missing: vec![Finding {
                    requirement: *requirement,
                    found: "not enabled".into(),
                    is_met: false,
                }],
            }),
            _ => Ok(()),
        }
    }
}

/// Compares a host's physical device with [`REQUIREMENTS`]. Makes nothing; no device need exist.
///
/// # Safety
/// The handles are valid and belong together.
pub unsafe fn check_device(host: &HostPhysicalDevice) -> DeviceReport {
    let functions = ash::StaticFn {
        get_instance_proc_addr: host.get_instance_proc_addr,
    };
    // SAFETY: the caller's promise.
    unsafe {
        let instance = ash::Instance::load(&functions, host.instance);
        let has_debug_utils = || {
            let entry = ash::Entry::from_static_fn(functions);
            let listed = entry.enumerate_instance_extension_properties(None);
            listed.is_ok_and(|listed| {
                listed
                    .iter()
                    .any(|one| one.extension_name_as_c_str() == Ok(ash::ext::debug_utils::NAME))
            })
        };
        report(
            &instance,
            &Asked {
                api_version: host.api_version,
                physical_device: host.physical_device,
                queue_family: host.queue_family,
                features: host.enabled.map(|enabled| enabled.features),
                debug_utils: host
                    .enabled
                    .map_or_else(has_debug_utils, |enabled| enabled.debug_utils),
                caps: host.caps,
            },
        )
    }
}

/// Every device of this machine in the order of its index: discrete, integrated, virtual, cpu, other.
///
/// Makes an instance for as long as it takes, and no device.
pub fn list_devices() -> Result<Vec<DeviceReport>, Error> {
    let instance = OwnInstance::new(Validation::FromEnvironment.mode()?)?;
    let devices = instance.devices()?.into_iter();
    Ok(devices.map(|device| instance.report(&device)).collect())
}

impl OwnInstance {
    /// What a device of this instance has.
    pub fn report(&self, device: &Candidate) -> DeviceReport {
        // SAFETY: the device was listed by this instance.
        unsafe {
            check_device(&HostPhysicalDevice {
                get_instance_proc_addr: self.entry().static_fn().get_instance_proc_addr,
                instance: self.raw().handle(),
                api_version: API_VERSION,
                physical_device: device.physical_device,
                queue_family: None,
                enabled: None,
                caps: Caps::UNLIMITED,
            })
        }
    }
}

/// As [`HostPhysicalDevice`], with an instance whose functions are loaded.
struct Asked {
    api_version: u32,
    physical_device: vk::PhysicalDevice,
    queue_family: Option<u32>,
    features: Option<Features>,
    debug_utils: bool,
    caps: Caps,
}

/// # Safety
/// The physical device belongs to `instance`, whose version is said truly.
unsafe fn report(instance: &ash::Instance, asked: &Asked) -> DeviceReport {
    let physical_device = asked.physical_device;
    // SAFETY: the caller's promise; all that is asked here is older than Vulkan 1.1.
    let (properties, families, memory) = unsafe {
        (
            instance.get_physical_device_properties(physical_device),
            instance.get_physical_device_queue_family_properties(physical_device),
            instance.get_physical_device_memory_properties(physical_device),
        )
    };
    let local = |heap: &&vk::MemoryHeap| heap.flags.contains(vk::MemoryHeapFlags::DEVICE_LOCAL);
    let heaps = memory.memory_heaps_as_slice().iter().filter(local);
    let spoken = asked.api_version.min(properties.api_version);
    let is_new = spoken >= API_VERSION;
    // SAFETY: as above; an instance older than Vulkan 1.2 is asked for no more than it knows.
    let identity = unsafe { Identity::of(instance, physical_device, asked.api_version) };
    let there = is_new.then(|| {
        let index = asked.queue_family.or_else(|| queue_family(&families));
        // SAFETY: both speak Vulkan 1.3.
        unsafe {
            There {
                instance,
                asked,
                caps: Caps::of(instance, physical_device).clamped_to(&asked.caps),
                supported: supported(instance, physical_device),
                family: index.and_then(|index| families.get(index as usize)),
            }
        }
    });
    let finding = |requirement: &Requirement| {
        let (found, is_met) = match (requirement.item, &there) {
            (Item::ApiVersion(wanted), _) => (version_text(spoken), spoken >= wanted),
            (item, Some(there)) => there.look(item),
            // What cannot be asked is not said to be missing.
            (_, None) => return None,
        };
        Some(Finding {
            requirement: *requirement,
            found,
            is_met,
        })
    };
    DeviceReport {
        identity,
        memory_bytes: heaps.map(|heap| heap.size).sum(),
        findings: REQUIREMENTS.iter().filter_map(finding).collect(),
    }
}

/// What a device of Vulkan 1.3 says of itself.
struct There<'a> {
    instance: &'a ash::Instance,
    asked: &'a Asked,
    caps: Caps,
    supported: Features,
    family: Option<&'a vk::QueueFamilyProperties>,
}

impl There<'_> {
    /// What there is, and whether it is enough.
    fn look(&self, item: Item) -> (String, bool) {
        let family = |found: &dyn Fn(&vk::QueueFamilyProperties) -> (String, bool)| {
            let none = match self.asked.queue_family {
                Some(index) => format!("no family {index}"),
                None => "no family that has them".into(),
            };
            self.family.map_or((none, false), found)
        };
        let yes_or_no = |is_there, word| match is_there {
            true => (String::from(word), true),
            false => (format!("not {word}"), false),
        };
        match item {
            Item::ApiVersion(_) => unreachable!("asked before all others"),
            Item::Queue(wanted) => family(&|family| {
                let found = family.queue_flags;
                (format!("{found:?}"), found.contains(wanted))
            }),
            Item::Timestamps => family(&|family| {
                let bits = family.timestamp_valid_bits;
                (bits.to_string(), bits > 0)
            }),
            Item::Feature(feature) => match &self.asked.features {
                Some(enabled) => yes_or_no(feature.is_in(enabled), "enabled"),
                None => yes_or_no(feature.is_in(&self.supported), "supported"),
            },
            Item::Limit(limit, least) => {
                let found = limit.of(&self.caps);
                (found.to_string(), found >= least)
            }
            Item::Format(format, wanted) => {
                // SAFETY: the physical device is one of the instance's.
                let found = unsafe {
                    self.instance
                        .get_physical_device_format_properties(self.asked.physical_device, format)
                };
                let mut found = found.optimal_tiling_features;
                if format == vk::Format::R32G32B32A32_SFLOAT && !self.caps.float32_blend {
                    found &= !vk::FormatFeatureFlags::COLOR_ATTACHMENT_BLEND;
                }
                let found = found & wanted;
                let words = match found.is_empty() {
                    true => "none of it".into(),
                    false => format!("{found:?}"),
                };
                (words, found == wanted)
            }
            Item::InstanceExtension(_) => yes_or_no(self.asked.debug_utils, "enabled"),
            Item::PortabilitySubset => match (&self.asked.features, self.supported) {
                (_, supported) if !supported.portability_subset => ("not listed".into(), true),
                (Some(enabled), _) => yes_or_no(enabled.portability_subset, "enabled"),
                (None, _) => ("listed".into(), true),
            },
            Item::DeviceExtension(name) => {
                // SAFETY: the physical device is one of the instance's.
                let has = unsafe { has_extension(self.instance, self.asked.physical_device, name) };
                yes_or_no(has, "supported")
            }
        }
    }
}

/// The features that we use, as far as the device has them.
///
/// # Safety
/// `physical_device` belongs to `instance`, and both speak Vulkan 1.3.
pub(super) unsafe fn supported(
    instance: &ash::Instance,
    physical_device: vk::PhysicalDevice,
) -> Features {
    let mut features12 = vk::PhysicalDeviceVulkan12Features::default();
    let mut features13 = vk::PhysicalDeviceVulkan13Features::default();
    let mut features2 = vk::PhysicalDeviceFeatures2::default()
        .push_next(&mut features12)
        .push_next(&mut features13);
    // SAFETY: the caller's promise.
    unsafe { instance.get_physical_device_features2(physical_device, &mut features2) };
    let core = features2.features;
    Features {
        dynamic_rendering: features13.dynamic_rendering == vk::TRUE,
        synchronization2: features13.synchronization2 == vk::TRUE,
        timeline_semaphore: features12.timeline_semaphore == vk::TRUE,
        robust_buffer_access: core.robust_buffer_access == vk::TRUE,
        robust_image_access: features13.robust_image_access == vk::TRUE,
        // SAFETY: as above.
        portability_subset: unsafe { has_extension(instance, physical_device, PORTABILITY_SUBSET) },
    }
}

/// Whether a device has an extension; one that cannot be asked has none.
///
/// # Safety
/// `physical_device` belongs to `instance`.
pub(super) unsafe fn has_extension(
    instance: &ash::Instance,
    physical_device: vk::PhysicalDevice,
    name: &str,
) -> bool {
    // SAFETY: the caller's promise.
    let all = unsafe { instance.enumerate_device_extension_properties(physical_device) };
    all.unwrap_or_default().iter().any(|extension| {
        let found = extension.extension_name_as_c_str();
        found.is_ok_and(|found| found.to_bytes() == name.as_bytes())
    })
}

/// The first family that our recordings can be submitted to.
pub(super) fn queue_family(families: &[vk::QueueFamilyProperties]) -> Option<u32> {
    let found = families
        .iter()
        .position(|family| family.queue_flags.contains(super::requirements::QUEUE_WORK));
    found.and_then(|index| u32::try_from(index).ok())
}
