//! A Vulkan device without hardware: RADV compiles for the chip that `RADV_FORCE_FAMILY` names, and draws nothing.

use ash::vk;
use std::{ffi::CStr, path::PathBuf};

/// Generations of AMD's chips: RDNA 2, RDNA 3, GCN 4.
pub const FAMILIES: [&str; 3] = ["navi21", "gfx1100", "polaris10"];

/// Folders of the loader's manifests.
const FOLDERS: [&str; 3] = [
    "/usr/share/vulkan/icd.d",
    "/etc/vulkan/icd.d",
    "/usr/local/share/vulkan/icd.d",
];

/// RADV's manifest, where it is installed.
pub fn manifest() -> Option<PathBuf> {
    let files = FOLDERS
        .iter()
        .flat_map(|folder| std::fs::read_dir(folder).into_iter().flatten().flatten());
    let is_radv = |path: &PathBuf| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        name.starts_with("radeon_icd") && name.ends_with(".json")
    };
    files.map(|file| file.path()).find(is_radv)
}

/// The one device of a process that has `RADV_FORCE_FAMILY` set.
pub struct NullDevice {
    pub device: ash::Device,
    pub properties: ash::khr::pipeline_executable_properties::Device,
    /// `Mesa 22.3.6`.
    pub driver: String,
    instance: ash::Instance,
    _entry: ash::Entry,
}

impl NullDevice {
    /// Finds and opens it.
    pub fn new() -> Result<Self, String> {
        let told = |doing: &str, result: vk::Result| format!("{doing}: {result}");
        // SAFETY: the loader is Vulkan's; nothing else is asked of the library.
        let entry = unsafe { ash::Entry::load() }.map_err(|e| e.to_string())?;
        let application = vk::ApplicationInfo::default().api_version(vk::API_VERSION_1_3);
        let info = vk::InstanceCreateInfo::default().application_info(&application);
        // SAFETY: no extension is asked for.
        let instance = unsafe { entry.create_instance(&info, None) }
            .map_err(|result| told("make an instance", result))?;
        // SAFETY: the instance is valid.
        let found = unsafe { instance.enumerate_physical_devices() }
            .map_err(|result| told("list devices", result))?;
        let [physical] = found[..] else {
            return Err(format!("wanted one device of RADV, found {}", found.len()));
        };
        let mut of_driver = vk::PhysicalDeviceDriverProperties::default();
        let mut facts = vk::PhysicalDeviceProperties2::default().push_next(&mut of_driver);
        // SAFETY: the device was just listed.
        unsafe { instance.get_physical_device_properties2(physical, &mut facts) };
        let named = facts.properties.device_name_as_c_str().unwrap_or_default();
        if !named.to_string_lossy().starts_with("Null hardware") {
            return Err(format!("wanted RADV's null hardware, found {named:?}"));
        }
        let driver = of_driver.driver_info_as_c_str().unwrap_or_default();
        let driver = driver.to_string_lossy().into_owned();

        let queues = [vk::DeviceQueueCreateInfo::default().queue_priorities(&[1.0])];
        let names: [&CStr; 1] = [ash::khr::pipeline_executable_properties::NAME];
        let names = names.map(CStr::as_ptr);
        let mut executables = vk::PhysicalDevicePipelineExecutablePropertiesFeaturesKHR::default()
            .pipeline_executable_info(true);
        // What stratavox wants of a device, no more.
        let mut core = vk::PhysicalDeviceVulkan13Features::default()
            .dynamic_rendering(true)
            .synchronization2(true);
        let info = vk::DeviceCreateInfo::default()
            .queue_create_infos(&queues)
            .enabled_extension_names(&names)
            .push_next(&mut executables)
            .push_next(&mut core);
        // SAFETY: features and extension are ones that a device lacks by an error, which is returned.
        let device = unsafe { instance.create_device(physical, &info, None) }
            .map_err(|result| told("open RADV's null device", result))?;
        let properties = ash::khr::pipeline_executable_properties::Device::new(&instance, &device);
        Ok(Self {
            device,
            properties,
            driver,
            instance,
            _entry: entry,
        })
    }
}

impl Drop for NullDevice {
    fn drop(&mut self) {
        // SAFETY: what was made on the device has been destroyed by those who made it.
        unsafe {
            self.device.destroy_device(None);
            self.instance.destroy_instance(None);
        }
    }
}
