//! A host with devices of its own, each made for one picture.

use super::entry;
use crate::shared::allowed;
use ash::{ext, vk};
use std::ffi::{CStr, c_void};
use std::sync::Mutex;
use stratavox::gpu::{API_VERSION, Caps, Feature, Features, HostDevice};

const LAYER: &CStr = c"VK_LAYER_KHRONOS_validation";

/// An instance, whose layer listens where that is asked for and installed.
pub struct Host {
    pub instance: ash::Instance,
    pub physical_device: vk::PhysicalDevice,
    messenger: Option<(ext::debug_utils::Instance, vk::DebugUtilsMessengerEXT)>,
    messages: Box<Mutex<Vec<String>>>,
}

impl Host {
    /// Without a layer: calls go straight to the driver.
    pub fn new() -> Self {
        Self::with(false)
    }

    /// With the validation layer, where it is installed.
    pub fn listening() -> Self {
        // SAFETY: the loader is loaded.
        let layers = unsafe { entry().enumerate_instance_layer_properties() }.unwrap();
        Self::with(
            layers
                .iter()
                .any(|layer| layer.layer_name_as_c_str() == Ok(LAYER)),
        )
    }

    pub fn is_listening(&self) -> bool {
        self.messenger.is_some()
    }

    fn with(has_layer: bool) -> Self {
        let application = vk::ApplicationInfo::default().api_version(API_VERSION);
        let layers = [LAYER.as_ptr()];
        let extensions = [ext::debug_utils::NAME.as_ptr()];
        let info = vk::InstanceCreateInfo::default()
            .application_info(&application)
            .enabled_extension_names(&extensions)
            .enabled_layer_names(if has_layer { &layers } else { &[] });
        let messages = Box::new(Mutex::new(Vec::new()));
        // SAFETY: plain set-up, every argument of which is right; the messages outlive the messenger.
        unsafe {
            let instance = entry()
                .create_instance(&info, None)
                .expect("a Vulkan driver");
            let messenger = has_layer.then(|| {
                let debug_utils = ext::debug_utils::Instance::new(entry(), &instance);
                let info = vk::DebugUtilsMessengerCreateInfoEXT::default()
                    .message_severity(
                        vk::DebugUtilsMessageSeverityFlagsEXT::ERROR
                            | vk::DebugUtilsMessageSeverityFlagsEXT::WARNING,
                    )
                    .message_type(vk::DebugUtilsMessageTypeFlagsEXT::VALIDATION)
                    .pfn_user_callback(Some(listen))
                    .user_data((&raw const *messages).cast_mut().cast());
                let made = debug_utils.create_debug_utils_messenger(&info, None);
                (debug_utils, made.unwrap())
            });
            let physical_devices = instance.enumerate_physical_devices().unwrap();
            let speaks_1_3 = |&device: &vk::PhysicalDevice| {
                instance.get_physical_device_properties(device).api_version >= API_VERSION
            };
            let found = physical_devices.into_iter().find(speaks_1_3);
            Self {
                physical_device: found.expect("a Vulkan 1.3 device"),
                instance,
                messenger,
                messages,
            }
        }
    }

    /// A device on which `features` are enabled, and nothing else.
    pub fn device(&self, features: Features) -> HostedDevice<'_> {
        let has = |feature: Feature| feature.is_in(&features);
        let core = vk::PhysicalDeviceFeatures::default()
            .robust_buffer_access(has(Feature::RobustBufferAccess));
        let mut features12 = vk::PhysicalDeviceVulkan12Features::default()
            .timeline_semaphore(has(Feature::TimelineSemaphore));
        let mut features13 = vk::PhysicalDeviceVulkan13Features::default()
            .dynamic_rendering(has(Feature::DynamicRendering))
            .synchronization2(has(Feature::Synchronization2))
            .robust_image_access(has(Feature::RobustImageAccess));
        let queues = [vk::DeviceQueueCreateInfo::default()
            .queue_family_index(0)
            .queue_priorities(&[1.0])];
        let info = vk::DeviceCreateInfo::default()
            .queue_create_infos(&queues)
            .enabled_features(&core)
            .push_next(&mut features12)
            .push_next(&mut features13);
        // SAFETY: as above; the features are ones that every device of Vulkan 1.3 has.
        unsafe {
            let device = self
                .instance
                .create_device(self.physical_device, &info, None);
            let device = device.unwrap();
            let info = vk::CommandPoolCreateInfo::default();
            let pool = device.create_command_pool(&info, None).unwrap();
            let info = vk::CommandBufferAllocateInfo::default()
                .command_pool(pool)
                .command_buffer_count(1);
            HostedDevice {
                queue: device.get_device_queue(0, 0),
                cmd: device.allocate_command_buffers(&info).unwrap()[0],
                pool,
                features,
                device,
                host: self,
            }
        }
    }

    /// What the layer has said so far.
    pub fn take_messages(&self) -> Vec<String> {
        std::mem::take(&mut self.messages.lock().unwrap())
    }
}

impl Drop for Host {
    fn drop(&mut self) {
        // SAFETY: every device borrows the host, so none is left.
        unsafe {
            if let Some((debug_utils, messenger)) = &self.messenger {
                debug_utils.destroy_debug_utils_messenger(*messenger, None);
            }
            self.instance.destroy_instance(None);
        }
    }
}

unsafe extern "system" fn listen(
    _: vk::DebugUtilsMessageSeverityFlagsEXT,
    _: vk::DebugUtilsMessageTypeFlagsEXT,
    data: *const vk::DebugUtilsMessengerCallbackDataEXT<'_>,
    messages: *mut c_void,
) -> vk::Bool32 {
    // SAFETY: the layer's data is valid during the call; the messages live in the box of the host.
    let (text, messages) = unsafe {
        let text = CStr::from_ptr((*data).p_message).to_string_lossy();
        (text.into_owned(), &*messages.cast::<Mutex<Vec<String>>>())
    };
    messages.lock().unwrap().push(text);
    vk::FALSE
}

/// A device, a queue and commands of the host's.
pub struct HostedDevice<'h> {
    pub device: ash::Device,
    pub features: Features,
    pub queue: vk::Queue,
    pool: vk::CommandPool,
    cmd: vk::CommandBuffer,
    host: &'h Host,
}

impl HostedDevice<'_> {
    /// What stratavox is told, with Vulkan as `get_instance_proc_addr` gives it.
    pub fn handles(
        &self,
        get_instance_proc_addr: vk::PFN_vkGetInstanceProcAddr,
    ) -> HostDevice<'static> {
        HostDevice {
            get_instance_proc_addr,
            instance: self.host.instance.handle(),
            physical_device: self.host.physical_device,
            device: self.device.handle(),
            queue_family: 0,
            api_version: API_VERSION,
            features: self.features,
            debug_utils: true,
            caps: allowed(Caps::UNLIMITED),
            pipeline_cache: &[],
        }
    }

    /// The one command buffer, being recorded from its beginning.
    pub fn begin(&self) -> vk::CommandBuffer {
        let (info, flags) = (Default::default(), Default::default());
        // SAFETY: every submission was waited for.
        unsafe {
            self.device.reset_command_pool(self.pool, flags).unwrap();
            self.device.begin_command_buffer(self.cmd, &info).unwrap();
        }
        self.cmd
    }

    pub fn submit_and_wait(&self, cmd: vk::CommandBuffer) {
        let cmds = [cmd];
        let submit = [vk::SubmitInfo::default().command_buffers(&cmds)];
        // SAFETY: the command buffer is recording, outside rendering; the queue is ours alone.
        unsafe {
            self.device.end_command_buffer(cmd).unwrap();
            let fence = vk::Fence::null();
            self.device
                .queue_submit(self.queue, &submit, fence)
                .unwrap();
            self.device.queue_wait_idle(self.queue).unwrap();
        }
    }
}

impl Drop for HostedDevice<'_> {
    fn drop(&mut self) {
        // SAFETY: the device has finished, and the tests drop everything else made on it first.
        unsafe {
            self.device.destroy_command_pool(self.pool, None);
            self.device.destroy_device(None);
        }
    }
}
