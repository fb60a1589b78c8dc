//! What a host has before it knows of stratavox: instance, validation, surface, device and queue; and the [`Gpu`] that
//! stratavox draws on, made of them.

use crate::error::{Doing, Error};
use crate::words::Layer;
use ash::{ext, khr, vk};
use std::ffi::{CStr, c_void};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use stratavox::gpu::{
    API_VERSION, Caps, DeviceReport, Features, Gpu, HostDevice, HostPhysicalDevice, Need,
    check_device,
};
use winit::raw_window_handle::{HasDisplayHandle, HasWindowHandle};
use winit::window::Window;

const VALIDATION: &CStr = c"VK_LAYER_KHRONOS_validation";

/// All that is stratavox's queue family too: one that draws, computes and shows.
pub struct Host {
    pub device: ash::Device,
    pub queue: vk::Queue,
    pub surface: vk::SurfaceKHR,
    pub surfaces: khr::surface::Instance,
    pub swapchains: khr::swapchain::Device,
    pub physical_device: vk::PhysicalDevice,
    /// Taken by drop alone: what was made on the device goes before it.
    gpu: Option<Arc<Gpu>>,
    messenger: Option<(ext::debug_utils::Instance, vk::DebugUtilsMessengerEXT)>,
    messages: Arc<AtomicUsize>,
    instance: ash::Instance,
    /// Last: the library that all functions are in.
    entry: ash::Entry,
}

/// A device that will do, and the family of its queue.
struct Choice {
    physical_device: vk::PhysicalDevice,
    queue_family: u32,
    report: DeviceReport,
}

impl Host {
    pub fn new(window: &Window, wanted: Option<&str>, layer: Option<Layer>) -> Result<Self, Error> {
        let messages = Arc::new(AtomicUsize::new(0));
        // SAFETY: plain set-up in the order that Vulkan asks for; every structure lives until its call returns.
        unsafe {
            let entry = ash::Entry::load()
                .map_err(|cause| Error::NoDevice(format!("no Vulkan loader: {cause}")))?;
            let instance = instance(&entry, window, layer, &messages)?;
            let messenger = match layer {
                None => None,
                Some(_) => {
                    let functions = ext::debug_utils::Instance::new(&entry, &instance);
                    let made = functions.create_debug_utils_messenger(&listener(&messages), None);
                    Some((functions, made.doing("listen to the validation layer")?))
                }
            };
            let surfaces = khr::surface::Instance::new(&entry, &instance);
            let surface = surface(&entry, &instance, window)?;
            let choice = choose(&entry, &instance, &surfaces, surface, wanted)?;
            let (physical_device, queue_family) = (choice.physical_device, choice.queue_family);

            let queues = [vk::DeviceQueueCreateInfo::default()
                .queue_family_index(queue_family)
                .queue_priorities(&[1.0])];
            // All that stratavox requires, and all that this host uses itself.
            let mut features = vk::PhysicalDeviceVulkan13Features::default()
                .dynamic_rendering(true)
                .synchronization2(true);
            let extensions = [khr::swapchain::NAME.as_ptr()];
            let info = vk::DeviceCreateInfo::default()
                .queue_create_infos(&queues)
                .enabled_extension_names(&extensions)
                .push_next(&mut features);
            let device = instance
                .create_device(physical_device, &info, None)
                .doing("make a device")?;
            let gpu = Gpu::from_host(HostDevice {
                get_instance_proc_addr: entry.static_fn().get_instance_proc_addr,
                instance: instance.handle(),
                physical_device,
                device: device.handle(),
                queue_family,
                api_version: API_VERSION,
                features: Features {
                    dynamic_rendering: true,
                    synchronization2: true,
                    ..Features::default()
                },
                debug_utils: layer.is_some(),
                caps: Caps::UNLIMITED,
                pipeline_cache: &[],
            })?;
            Ok(Self {
                queue: device.get_device_queue(queue_family, 0),
                swapchains: khr::swapchain::Device::new(&instance, &device),
                surface,
                surfaces,
                physical_device,
                gpu: Some(gpu),
                device,
                messenger,
                messages,
                instance,
                entry,
            })
        }
    }

    /// What stratavox draws on.
    pub fn gpu(&self) -> &Arc<Gpu> {
        self.gpu.as_ref().expect("taken by drop alone")
    }

    /// Where the validation layer counts its messages: it lives longer than the device, and so may its messages.
    pub fn messages(&self) -> Arc<AtomicUsize> {
        Arc::clone(&self.messages)
    }

    /// Another surface of the window, in the place of one that was lost. Nothing uses that any more.
    pub fn renew_surface(&mut self, window: &Window) -> Result<(), Error> {
        // SAFETY: the caller's promise; the window lives longer than both.
        unsafe {
            self.surfaces.destroy_surface(self.surface, None);
            self.surface = vk::SurfaceKHR::null();
            self.surface = surface(&self.entry, &self.instance, window)?;
            let (device, family) = (self.physical_device, self.gpu().queue_family());
            let shows =
                self.surfaces
                    .get_physical_device_surface_support(device, family, self.surface);
            match shows.doing("ask the device for the window")? {
                true => Ok(()),
                false => Err(Error::SurfaceLost),
            }
        }
    }

    /// Waits until nothing is unfinished. Of a lost device nothing is.
    pub fn finish(&self) {
        // SAFETY: the queue is this thread's alone.
        let _ = unsafe { self.device.device_wait_idle() };
    }
}

impl Drop for Host {
    fn drop(&mut self) {
        self.finish();
        // SAFETY: all is done; the last owners of what stratavox made went before, and the order is that of making,
        // backwards.
        unsafe {
            drop(self.gpu.take());
            self.device.destroy_device(None);
            self.surfaces.destroy_surface(self.surface, None);
            if let Some((functions, messenger)) = &self.messenger {
                functions.destroy_debug_utils_messenger(*messenger, None);
            }
            self.instance.destroy_instance(None);
        }
    }
}

/// With what windows need, and the validation layer where it is wanted.
///
/// # Safety
/// The messages live longer than the instance.
unsafe fn instance(
    entry: &ash::Entry,
    window: &Window,
    layer: Option<Layer>,
    messages: &Arc<AtomicUsize>,
) -> Result<ash::Instance, Error> {
    let display = window
        .display_handle()
        .map_err(|cause| Error::Window(format!("the window has no display: {cause}")))?;
    let needed = ash_window::enumerate_required_extensions(display.as_raw())
        .doing("list what this display needs")?;
    let mut extensions = needed.to_vec();
    let layers: Vec<_> = layer.map(|_| VALIDATION.as_ptr()).into_iter().collect();
    let enables = [vk::ValidationFeatureEnableEXT::SYNCHRONIZATION_VALIDATION];
    let mut checks = vk::ValidationFeaturesEXT::default();
    if layer == Some(Layer::Sync) {
        checks = checks.enabled_validation_features(&enables);
    }
    // Hears what making and destroying the instance itself has to say.
    let mut listener = listener(messages);
    let application = vk::ApplicationInfo::default().api_version(API_VERSION);
    let mut info = vk::InstanceCreateInfo::default()
        .application_info(&application)
        .enabled_layer_names(&layers);
    if layer.is_some() {
        extensions.extend([
            ext::debug_utils::NAME.as_ptr(),
            ext::validation_features::NAME.as_ptr(),
        ]);
        info = info.push_next(&mut checks).push_next(&mut listener);
    }
    info = info.enabled_extension_names(&extensions);
    // SAFETY: every pointer lives until the call returns.
    unsafe { entry.create_instance(&info, None) }.map_err(|cause| match cause {
        vk::Result::ERROR_LAYER_NOT_PRESENT => Error::Arguments(
            "--validation: the layer is not installed (Debian and Ubuntu: vulkan-validationlayers)"
                .into(),
        ),
        vk::Result::ERROR_EXTENSION_NOT_PRESENT => {
            Error::NoDevice("no driver shows pictures on this display".into())
        }
        cause => Error::NoDevice(format!("there is no Vulkan instance: {cause:?}")),
    })
}

/// # Safety
/// The window lives longer than the surface.
unsafe fn surface(
    entry: &ash::Entry,
    instance: &ash::Instance,
    window: &Window,
) -> Result<vk::SurfaceKHR, Error> {
    let gone = |cause| Error::Window(format!("the window is gone: {cause}"));
    let display = window.display_handle().map_err(gone)?.as_raw();
    let handle = window.window_handle().map_err(gone)?.as_raw();
    // SAFETY: the caller's promise; the instance has the extensions of this display.
    unsafe { ash_window::create_surface(entry, instance, display, handle, None) }
        .doing("make a surface of the window")
}

/// The device to draw on: what is required of it stratavox says, that it shows pictures in the window the host asks.
///
/// # Safety
/// The handles belong together.
unsafe fn choose(
    entry: &ash::Entry,
    instance: &ash::Instance,
    surfaces: &khr::surface::Instance,
    surface: vk::SurfaceKHR,
    wanted: Option<&str>,
) -> Result<Choice, Error> {
    // SAFETY: the caller's promise.
    let all = unsafe { instance.enumerate_physical_devices() }.doing("list devices")?;
    let (mut found, mut refused) = (Vec::new(), Vec::new());
    for physical_device in all {
        // SAFETY: the caller's promise.
        match unsafe { judge(entry, instance, surfaces, surface, physical_device) } {
            Ok(choice) => found.push(choice),
            Err(reason) => refused.push(reason),
        }
    }
    let is_wanted = |choice: &Choice| {
        let name = choice.report.identity.name.to_lowercase();
        wanted.is_none_or(|part| name.contains(&part.to_lowercase()))
    };
    let names = found.iter().map(|c| c.report.identity.name.clone());
    let names: Vec<_> = names.chain(refused).collect();
    // The kinds are in the order of their speed.
    let best = found.into_iter().filter(is_wanted).min_by_key(speed);
    best.ok_or_else(|| {
        let there = match names.is_empty() {
            true => "no driver offers one".to_owned(),
            false => format!("there are {}", names.join("; ")),
        };
        Error::NoDevice(match wanted {
            Some(part) => format!("none is called `{part}`, {there}"),
            None => there,
        })
    })
}

fn speed(choice: &Choice) -> u8 {
    use stratavox::gpu::DeviceKind as Kind;
    match choice.report.identity.kind {
        Kind::Discrete => 0,
        Kind::Integrated => 1,
        Kind::Cpu => 3,
        _ => 2,
    }
}

/// # Safety
/// The handles belong together.
unsafe fn judge(
    entry: &ash::Entry,
    instance: &ash::Instance,
    surfaces: &khr::surface::Instance,
    surface: vk::SurfaceKHR,
    physical_device: vk::PhysicalDevice,
) -> Result<Choice, String> {
    // SAFETY: the caller's promise.
    unsafe {
        let families = instance.get_physical_device_queue_family_properties(physical_device);
        let does_all = |&family: &u32| {
            let flags = families[family as usize].queue_flags;
            let shows =
                surfaces.get_physical_device_surface_support(physical_device, family, surface);
            flags.contains(vk::QueueFlags::GRAPHICS | vk::QueueFlags::COMPUTE) && shows == Ok(true)
        };
        let queue_family = (0..families.len() as u32).find(does_all);
        let report = check_device(&HostPhysicalDevice {
            get_instance_proc_addr: entry.static_fn().get_instance_proc_addr,
            instance: instance.handle(),
            api_version: API_VERSION,
            physical_device,
            queue_family,
            enabled: None,
            caps: Caps::UNLIMITED,
        });
        let name = report.identity.name.clone();
        let missing: Vec<_> = report
            .missing(Need::Required)
            .map(ToString::to_string)
            .collect();
        if !missing.is_empty() {
            return Err(format!("{name}, which lacks {}", missing.join(", ")));
        }
        let queue_family =
            queue_family.ok_or_else(|| format!("{name}, which shows nothing in this window"))?;
        let listed = instance.enumerate_device_extension_properties(physical_device);
        let shows = listed.is_ok_and(|listed| {
            let mut names = listed.iter().map(|one| one.extension_name_as_c_str());
            names.any(|name| name == Ok(khr::swapchain::NAME))
        });
        match shows {
            true => Ok(Choice {
                physical_device,
                queue_family,
                report,
            }),
            false => Err(format!("{name}, which has no {:?}", khr::swapchain::NAME)),
        }
    }
}

fn listener(messages: &Arc<AtomicUsize>) -> vk::DebugUtilsMessengerCreateInfoEXT<'static> {
    use vk::{
        DebugUtilsMessageSeverityFlagsEXT as Severity, DebugUtilsMessageTypeFlagsEXT as Type,
    };
    vk::DebugUtilsMessengerCreateInfoEXT::default()
        .message_severity(Severity::ERROR | Severity::WARNING)
        .message_type(Type::VALIDATION | Type::PERFORMANCE)
        .pfn_user_callback(Some(listen))
        .user_data(Arc::as_ptr(messages).cast_mut().cast())
}

/// # Safety
/// `data` is the layer's, valid during the call; `messages` is what the messenger was made with.
unsafe extern "system" fn listen(
    _: vk::DebugUtilsMessageSeverityFlagsEXT,
    _: vk::DebugUtilsMessageTypeFlagsEXT,
    data: *const vk::DebugUtilsMessengerCallbackDataEXT<'_>,
    messages: *mut c_void,
) -> vk::Bool32 {
    // SAFETY: the caller's promise.
    unsafe {
        let text = (*data).message_as_c_str().unwrap_or_default();
        eprintln!("validation: {}", text.to_string_lossy());
        (*messages.cast::<AtomicUsize>()).fetch_add(1, Ordering::Relaxed);
    }
    vk::FALSE
}
