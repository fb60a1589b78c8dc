//! Numbers of devices, and versions of drivers.

use crate::conformance::record::DeviceRecord;
use ash::vk;
use serde_json::Value;

/// A driver's version.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Version {
    /// `VkPhysicalDeviceProperties::driverVersion`.
    Packed(u32),
    /// The same, unpacked.
    Parts([u32; 4]),
}

impl Version {
    /// Of a number, or of up to four numbers with dots between.
    pub fn of(value: &Value) -> Option<Self> {
        let Value::String(text) = value else {
            return number(value).map(Self::Packed);
        };
        let mut parts = [0; 4];
        let mut texts = text.split('.');
        for (part, text) in parts.iter_mut().zip(&mut texts) {
            *part = text.parse().ok()?;
        }
        texts.next().is_none().then_some(Self::Parts(parts))
    }

    /// Whether the driver's version lies before this one.
    pub fn is_after(self, device: &DeviceRecord) -> bool {
        let found = device.driver_version;
        match self {
            Self::Packed(version) => found < version,
            Self::Parts(parts) => unpacked(device.driver_id, found) < parts,
        }
    }
}

/// The parts of a driver's version, which two drivers pack in their own way and the others as Vulkan its own.
fn unpacked(driver_id: u32, packed: u32) -> [u32; 4] {
    let [major, minor] = [packed >> 22, (packed >> 12) & 0x3ff];
    match vk::DriverId::from_raw(driver_id as i32) {
        vk::DriverId::NVIDIA_PROPRIETARY => [
            major,
            (packed >> 14) & 0xff,
            (packed >> 6) & 0xff,
            packed & 0x3f,
        ],
        vk::DriverId::INTEL_PROPRIETARY_WINDOWS => [packed >> 14, packed & 0x3fff, 0, 0],
        _ => [major, minor, packed & 0xfff, 0],
    }
}

/// 6880, or "0x1ae0".
pub fn number(value: &Value) -> Option<u32> {
    match value {
        Value::String(text) => u32::from_str_radix(text.strip_prefix("0x")?, 16).ok(),
        value => value.as_u64()?.try_into().ok(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_are_unpacked_as_their_drivers_pack_them() {
        const NVIDIA: u32 = 4;
        const INTEL_ON_WINDOWS: u32 = 5;
        const MESA_RADV: u32 = 3;
        let packed = (535 << 22) | (129 << 14) | (3 << 6) | 1;
        assert_eq!(unpacked(NVIDIA, packed), [535, 129, 3, 1]);
        let packed = (101 << 14) | 5333;
        assert_eq!(unpacked(INTEL_ON_WINDOWS, packed), [101, 5333, 0, 0]);
        let packed = vk::make_api_version(0, 24, 2, 8);
        assert_eq!(unpacked(MESA_RADV, packed), [24, 2, 8, 0]);
    }
}
