//! An instance of our own, and the devices that it offers.

use super::{
    API_VERSION, DeviceKind, Error, Identity,
    error::Doing,
    identity::version_text,
    validation::{LAYER, Messages, ValidationMode},
};
use ash::{ext, khr, vk};
use std::{ffi::CStr, fmt, sync::Arc};

/// An instance that we made, destroyed when dropped. Everything made with it must be gone by then.
pub(super) struct OwnInstance {
    instance: ash::Instance,
    messenger: Option<(ext::debug_utils::Instance, vk::DebugUtilsMessengerEXT)>,
    /// Outlives the instance, whose destruction may have complaints too.
    messages: Option<Arc<Messages>>,
    /// Keeps the loader in memory. Last, because fields are dropped in this order.
    entry: ash::Entry,
}

impl OwnInstance {
    /// Through the loader of this machine.
    pub fn new(mode: Option<ValidationMode>) -> Result<Self, Error> {
        // SAFETY: this loads the system's Vulkan loader, whose initializers are harmless.
        let entry = unsafe { ash::Entry::load() }.map_err(|cause| Error::NoLoader { cause })?;
        Self::through(entry, mode)
    }

    /// Through this loader.
    pub fn through(entry: ash::Entry, mode: Option<ValidationMode>) -> Result<Self, Error> {
        check_loader(&entry)?;
        let mut layers = Vec::new();
        let mut extensions = Vec::new();
        let mut flags = vk::InstanceCreateFlags::empty();
        if is_listed(&entry, None, khr::portability_enumeration::NAME)? {
            extensions.push(khr::portability_enumeration::NAME.as_ptr());
            flags |= vk::InstanceCreateFlags::ENUMERATE_PORTABILITY_KHR;
        }
        if let Some(mode) = mode {
            check_layer(&entry, mode)?;
            layers.push(LAYER.as_ptr());
            extensions.push(ext::debug_utils::NAME.as_ptr());
            if !mode.enables().is_empty() {
                extensions.push(ext::validation_features::NAME.as_ptr());
            }
        }
        let messages = mode.map(Messages::new);
        let application = vk::ApplicationInfo::default()
            .application_name(c"stratavox")
            .engine_name(c"stratavox")
            .api_version(API_VERSION);
        let mut features = vk::ValidationFeaturesEXT::default();
        // Hears of the making and the end of the instance, when no messenger can exist.
        let mut early_messenger = messages.as_ref().map(Messages::messenger);
        let mut info = vk::InstanceCreateInfo::default()
            .flags(flags)
            .application_info(&application)
            .enabled_layer_names(&layers)
            .enabled_extension_names(&extensions);
        if let Some(messenger) = &mut early_messenger {
            info = info.push_next(messenger);
        }
        let enables = mode.map_or(&[][..], ValidationMode::enables);
        if !enables.is_empty() {
            features = features.enabled_validation_features(enables);
            info = info.push_next(&mut features);
        }
        // SAFETY: layers and extensions were found listed; the messages outlive the instance.
        let instance =
            unsafe { entry.create_instance(&info, None) }.map_err(|result| match result {
                vk::Result::ERROR_INCOMPATIBLE_DRIVER => Error::NoDriver,
                result => Error::vulkan("make a Vulkan instance", result),
            })?;
        let mut own = Self {
            instance,
            messenger: None,
            messages,
            entry,
        };
        own.listen()?;
        Ok(own)
    }

    fn listen(&mut self) -> Result<(), Error> {
        let Some(messages) = &self.messages else {
            return Ok(());
        };
        let debug_utils = ext::debug_utils::Instance::new(&self.entry, &self.instance);
        // SAFETY: the extension is enabled, and the messages outlive the messenger.
        let messenger =
            unsafe { debug_utils.create_debug_utils_messenger(&messages.messenger(), None) }
                .doing(|| "listen to the validation layer".into())?;
        self.messenger = Some((debug_utils, messenger));
        Ok(())
    }

    /// The instance's functions.
    pub fn raw(&self) -> &ash::Instance {
        &self.instance
    }

    pub fn entry(&self) -> &ash::Entry {
        &self.entry
    }

    pub fn messages(&self) -> Option<&Arc<Messages>> {
        self.messages.as_ref()
    }

    /// All devices, the preferred kind first, within a kind as the loader lists them.
    pub fn devices(&self) -> Result<Vec<Candidate>, Error> {
        // SAFETY: the instance is valid.
        let found = match unsafe { self.instance.enumerate_physical_devices() } {
            // What some loaders answer where every driver failed.
            Err(vk::Result::ERROR_INITIALIZATION_FAILED) => return Err(Error::NoDriver),
            found => found.doing(|| "list the Vulkan devices".into())?,
        };
        let mut devices: Vec<_> = found
            .into_iter()
            .map(|physical_device| {
                // SAFETY: the device was just listed by this instance, which speaks Vulkan 1.3.
                let identity =
                    unsafe { Identity::of(&self.instance, physical_device, API_VERSION) };
                Candidate {
                    physical_device,
                    identity,
                }
            })
            .collect();
        if devices.is_empty() {
            return Err(Error::NoDriver);
        }
        devices.sort_by_key(|device| device.identity.kind);
        Ok(devices)
    }
}

/// A device that one could use.
#[derive(Debug)]
pub(super) struct Candidate {
    pub physical_device: vk::PhysicalDevice,
    pub identity: Identity,
}

impl Candidate {
    /// `llvmpipe (cpu)`.
    pub fn title(&self) -> String {
        format!("{} ({})", self.identity.name, self.identity.kind.name())
    }

    pub fn is_cpu(&self) -> bool {
        self.identity.kind == DeviceKind::Cpu
    }
}

fn check_loader(entry: &ash::Entry) -> Result<(), Error> {
    // SAFETY: the loader is loaded.
    let found = unsafe { entry.try_enumerate_instance_version() }
        .doing(|| "ask the Vulkan loader for its version".into())?
        .unwrap_or(vk::API_VERSION_1_0);
    if found >= API_VERSION {
        return Ok(());
    }
    let (wanted, found) = (version_text(API_VERSION), version_text(found));
    Err(Error::ApiVersion {
        what: "the Vulkan loader".into(),
        wanted,
        found,
    })
}

fn check_layer(entry: &ash::Entry, mode: ValidationMode) -> Result<(), Error> {
    let missing = |missing| Error::NoValidation {
        mode: mode.word(),
        missing,
    };
    // SAFETY: the loader is loaded.
    let layers = unsafe { entry.enumerate_instance_layer_properties() }
        .doing(|| "list the Vulkan layers".into())?;
    if !layers
        .iter()
        .any(|layer| layer.layer_name_as_c_str() == Ok(LAYER))
    {
        return Err(missing("VK_LAYER_KHRONOS_validation"));
    }
    let has = |name| Ok(is_listed(entry, Some(LAYER), name)? || is_listed(entry, None, name)?);
    if !has(ext::debug_utils::NAME)? {
        return Err(missing("VK_EXT_debug_utils"));
    }
    if !mode.enables().is_empty() && !has(ext::validation_features::NAME)? {
        return Err(missing("VK_EXT_validation_features"));
    }
    Ok(())
}

fn is_listed(entry: &ash::Entry, layer: Option<&CStr>, name: &CStr) -> Result<bool, Error> {
    // SAFETY: the loader is loaded, and the layer, if any, is installed.
    let listed = unsafe { entry.enumerate_instance_extension_properties(layer) }
        .doing(|| "list the Vulkan instance extensions".into())?;
    Ok(listed
        .iter()
        .any(|extension| extension.extension_name_as_c_str() == Ok(name)))
}

impl fmt::Debug for OwnInstance {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("OwnInstance")
            .field("messages", &self.messages)
            .finish_non_exhaustive()
    }
}

impl Drop for OwnInstance {
    fn drop(&mut self) {
        // SAFETY: we made both, and everything made with them is gone.
        unsafe {
            if let Some((debug_utils, messenger)) = &self.messenger {
                debug_utils.destroy_debug_utils_messenger(*messenger, None);
            }
            self.instance.destroy_instance(None);
        }
    }
}
