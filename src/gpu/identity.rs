//! Which device this is: what a report, an error and the name of a cache file say about it.

use ash::vk;
use std::ffi::CStr;

/// Names and numbers of a device and its driver.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Identity {
    /// The name that the driver gives.
    pub name: String,
    /// Discrete, integrated, ...
    pub kind: DeviceKind,
    /// The version of Vulkan that the device speaks: major, minor, patch.
    pub api_version: [u32; 3],
    /// PCI vendor, or a Khronos number.
    pub vendor_id: u32,
    /// The vendor's number for the device.
    pub device_id: u32,
    /// Which driver it is, from the Khronos list.
    pub driver_id: vk::DriverId,
    /// The driver's name.
    pub driver_name: String,
    /// The driver's version in its own words.
    pub driver_info: String,
    /// The driver's version as the number it reports.
    pub driver_version: u32,
    /// Names the device on every run and in every process.
    pub uuid: [u8; 16],
    /// Changes whenever a pipeline cache of this device becomes useless.
    pub pipeline_cache_uuid: [u8; 16],
}

/// Where a device sits. The order is that of preference.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum DeviceKind {
    /// A card of its own.
    Discrete,
    /// Part of the processor.
    Integrated,
    /// A part of a device lent to a virtual machine.
    Virtual,
    /// A driver that computes on the CPU.
    Cpu,
    /// Something else.
    Other,
}

impl DeviceKind {
    /// The word of reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Discrete => "discrete",
            Self::Integrated => "integrated",
            Self::Virtual => "virtual",
            Self::Cpu => "cpu",
            Self::Other => "other",
        }
    }
}

impl Identity {
    /// UUID and driver stay empty where instance or device are older than Vulkan 1.2 and cannot be asked.
    ///
    /// # Safety
    /// `physical_device` belongs to `instance`, which speaks Vulkan `instance_version`.
    pub(super) unsafe fn of(
        instance: &ash::Instance,
        physical_device: vk::PhysicalDevice,
        instance_version: u32,
    ) -> Self {
        let mut properties11 = vk::PhysicalDeviceVulkan11Properties::default();
        let mut properties12 = vk::PhysicalDeviceVulkan12Properties::default();
        // SAFETY: the caller's promise, here and below.
        let properties = unsafe { instance.get_physical_device_properties(physical_device) };
        if properties.api_version.min(instance_version) >= vk::API_VERSION_1_2 {
            let mut properties2 = vk::PhysicalDeviceProperties2::default()
                .push_next(&mut properties11)
                .push_next(&mut properties12);
            // SAFETY: as above.
            unsafe { instance.get_physical_device_properties2(physical_device, &mut properties2) };
        }
        Self {
            name: text(properties.device_name_as_c_str()),
            kind: match properties.device_type {
                vk::PhysicalDeviceType::DISCRETE_GPU => DeviceKind::Discrete,
                vk::PhysicalDeviceType::INTEGRATED_GPU => DeviceKind::Integrated,
                vk::PhysicalDeviceType::VIRTUAL_GPU => DeviceKind::Virtual,
                vk::PhysicalDeviceType::CPU => DeviceKind::Cpu,
                _ => DeviceKind::Other,
            },
            api_version: version(properties.api_version),
            vendor_id: properties.vendor_id,
            device_id: properties.device_id,
            driver_id: properties12.driver_id,
            driver_name: text(properties12.driver_name_as_c_str()),
            driver_info: text(properties12.driver_info_as_c_str()),
            driver_version: properties.driver_version,
            uuid: properties11.device_uuid,
            pipeline_cache_uuid: properties.pipeline_cache_uuid,
        }
    }
}

impl Identity {
    /// Whether this is llvmpipe of Mesa 24 or later, which converts floats with saturation: 22.3 and 23.2 do not.
    pub(crate) fn saturates_conversions(&self) -> bool {
        self.driver_id == vk::DriverId::MESA_LLVMPIPE
            && mesa_major(&self.driver_info).is_some_and(|major| major >= 24)
    }
}

/// The first number of Mesa's version. Only the text has it: lavapipe reports 1 as the version of the driver.
fn mesa_major(driver_info: &str) -> Option<u32> {
    let (major, _) = driver_info.strip_prefix("Mesa ")?.split_once('.')?;
    major.parse().ok()
}

/// A driver's text, whatever bytes it holds; empty where it does not end.
pub(super) fn text<E>(text: Result<&CStr, E>) -> String {
    text.map(|text| text.to_string_lossy().into_owned())
        .unwrap_or_default()
}

/// Major, minor, patch of a packed version.
pub(super) fn version(packed: u32) -> [u32; 3] {
    [
        vk::api_version_major(packed),
        vk::api_version_minor(packed),
        vk::api_version_patch(packed),
    ]
}

/// `1.3.230`.
pub(super) fn version_text(packed: u32) -> String {
    let [major, minor, patch] = version(packed);
    format!("{major}.{minor}.{patch}")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn identity(driver_id: vk::DriverId, driver_info: &str) -> Identity {
        Identity {
            name: String::new(),
            kind: DeviceKind::Cpu,
            api_version: [1, 2, 0],
            vendor_id: 0,
            device_id: 0,
            driver_id,
            driver_name: String::new(),
            driver_info: driver_info.into(),
            driver_version: 1,
            uuid: [0; 16],
            pipeline_cache_uuid: [0; 16],
        }
    }

    #[test]
    fn llvmpipe_saturates_from_mesa_24_on() {
        let saturates = |info| identity(vk::DriverId::MESA_LLVMPIPE, info).saturates_conversions();
        for newer in [
            "Mesa 25.0.7-2~bpo12+1 (LLVM 15.0.6)",
            "Mesa 24.0.0 (LLVM 17.0.6)",
            "Mesa 26.1.0-devel (git-0123456789) (LLVM 20.1.0)",
            "Mesa 100.0.1",
        ] {
            assert!(saturates(newer), "{newer}");
        }
        for older_or_unknown in [
            "Mesa 22.3.6 (LLVM 15.0.6)",
            "Mesa 23.3.6 (LLVM 15.0.6)",
            "Mesa",
            "",
            "25.0.7",
        ] {
            assert!(!saturates(older_or_unknown), "{older_or_unknown}");
        }
        let radv = identity(vk::DriverId::MESA_RADV, "Mesa 25.0.7");
        assert!(!radv.saturates_conversions());
    }
}
