//! A host: an instance, a device with nothing enabled but what stratavox requires, a queue, and commands of
//! its own. It listens to the validation layer where `STRATAVOX_VALIDATION` is set.
#![allow(dead_code, unused_imports, reason = "each test file uses its part")]

mod depth;
mod expected;
mod eyes;
mod image;
mod loader;
mod pace;
mod scene;
mod settings;

pub use depth::{ATTACHED, DepthImage, READ};
pub use expected::{assert_close, offscreen, offscreen_with, over};
pub use eyes::{Eye, Found, depths, draw, eyes, spheres};
pub use image::HostImage;
pub use pace::Pace;
pub use scene::{OnDevice, Stage};
pub use settings::all_settings;

use crate::shared::allowed;
use ash::{ext, vk};
use std::ffi::{CStr, c_void};
use std::sync::{Arc, Mutex};
use stratavox::gpu::{API_VERSION, Caps, Features, Gpu, HostDevice, Validation, ValidationMode};

/// Dropping it panics on a validation message, and where something of ours outlives it.
pub struct Host {
    pub device: ash::Device,
    pub queue: vk::Queue,
    pub pool: vk::CommandPool,
    pub memory: vk::PhysicalDeviceMemoryProperties,
    pub mode: Option<ValidationMode>,
    /// Taken only by drop.
    gpu: Option<Arc<Gpu>>,
    instance: ash::Instance,
    messenger: Option<(ext::debug_utils::Instance, vk::DebugUtilsMessengerEXT)>,
    messages: Box<Mutex<Vec<String>>>,
}

impl Host {
    /// A host that knows its submissions by fences.
    pub fn new() -> Self {
        // SAFETY: nothing is enabled on the device that is not asked for here.
        unsafe { Self::with(false, Caps::UNLIMITED, loader::guarded) }
    }

    /// The same with stricter limits.
    pub fn with_caps(caps: Caps) -> Self {
        // SAFETY: as above.
        unsafe { Self::with(false, caps, loader::guarded) }
    }

    /// A host with a timeline.
    pub fn with_timeline() -> Self {
        // SAFETY: as above.
        unsafe { Self::with(true, Caps::UNLIMITED, loader::guarded) }
    }

    /// A host that gives away a `vkGetInstanceProcAddr` which is not the loader's.
    ///
    /// # Safety
    /// It gives functions that do what Vulkan says.
    pub unsafe fn through(get_instance_proc_addr: vk::PFN_vkGetInstanceProcAddr) -> Self {
        // SAFETY: the caller's promise.
        unsafe { Self::with(false, Caps::UNLIMITED, get_instance_proc_addr) }
    }

    /// The same, and we may submit to its queue.
    pub fn that_lets_us_submit() -> Self {
        let real = loader::entry().static_fn().get_instance_proc_addr;
        // SAFETY: as above.
        unsafe { Self::with(true, Caps::UNLIMITED, real) }
    }

    unsafe fn with(
        timeline_semaphore: bool,
        caps: Caps,
        get_instance_proc_addr: vk::PFN_vkGetInstanceProcAddr,
    ) -> Self {
        let mode = Validation::default().mode().unwrap();
        // SAFETY: plain Vulkan set-up, every argument of which is right.
        unsafe {
            let entry = loader::entry();
            let messages = Box::new(Mutex::new(Vec::new()));
            let instance = instance(entry, mode);
            let messenger = mode.is_some().then(|| {
                let debug_utils = ext::debug_utils::Instance::new(entry, &instance);
                let info = messenger_info(&messages);
                let messenger = debug_utils.create_debug_utils_messenger(&info, None);
                (debug_utils, messenger.unwrap())
            });
            let physical_devices = instance.enumerate_physical_devices().unwrap();
            let speaks_1_3 = |&device: &vk::PhysicalDevice| {
                instance.get_physical_device_properties(device).api_version >= API_VERSION
            };
            let physical_device = physical_devices.into_iter().find(speaks_1_3);
            let physical_device = physical_device.expect("a Vulkan 1.3 device");
            let mut features12 = vk::PhysicalDeviceVulkan12Features::default()
                .timeline_semaphore(timeline_semaphore);
            let mut features13 = vk::PhysicalDeviceVulkan13Features::default()
                .dynamic_rendering(true)
                .synchronization2(true);
            let queues = [vk::DeviceQueueCreateInfo::default()
                .queue_family_index(0)
                .queue_priorities(&[1.0])];
            let info = vk::DeviceCreateInfo::default()
                .queue_create_infos(&queues)
                .push_next(&mut features12)
                .push_next(&mut features13);
            let device = instance
                .create_device(physical_device, &info, None)
                .unwrap();
            let flags = vk::CommandPoolCreateFlags::RESET_COMMAND_BUFFER;
            let info = vk::CommandPoolCreateInfo::default().flags(flags);
            let pool = device.create_command_pool(&info, None).unwrap();
            let gpu = Gpu::from_host(HostDevice {
                get_instance_proc_addr,
                instance: instance.handle(),
                physical_device,
                device: device.handle(),
                queue_family: 0,
                api_version: API_VERSION,
                features: Features {
                    dynamic_rendering: true,
                    synchronization2: true,
                    timeline_semaphore,
                    ..Features::default()
                },
                debug_utils: mode.is_some(),
                caps: allowed(caps),
                pipeline_cache: &[],
            });
            Self {
                gpu: Some(gpu.unwrap()),
                queue: device.get_device_queue(0, 0),
                pool,
                memory: instance.get_physical_device_memory_properties(physical_device),
                device,
                mode,
                instance,
                messenger,
                messages,
            }
        }
    }

    pub fn gpu(&self) -> &Arc<Gpu> {
        self.gpu.as_ref().expect("taken only by drop")
    }

    /// A command buffer that can be recorded again and again.
    pub fn command_buffer(&self) -> vk::CommandBuffer {
        let info = vk::CommandBufferAllocateInfo::default()
            .command_pool(self.pool)
            .command_buffer_count(1);
        // SAFETY: the pool is ours and goes after its buffers.
        unsafe { self.device.allocate_command_buffers(&info).unwrap()[0] }
    }

    /// Records and ends.
    pub fn record(&self, cmd: vk::CommandBuffer, record: impl FnOnce(vk::CommandBuffer)) {
        let info = vk::CommandBufferBeginInfo::default();
        // SAFETY: no unfinished submission uses the command buffer (the tests wait first).
        unsafe {
            self.device.begin_command_buffer(cmd, &info).unwrap();
            record(cmd);
            self.device.end_command_buffer(cmd).unwrap();
        }
    }

    /// Records, submits, and waits for the fence.
    pub fn run(&self, record: impl FnOnce(vk::CommandBuffer)) {
        let cmds = [self.command_buffer()];
        self.record(cmds[0], record);
        let submit = vk::SubmitInfo::default().command_buffers(&cmds);
        let info = vk::FenceCreateInfo::default();
        // SAFETY: the recording has ended; fence and command buffer are in use until the wait is over.
        unsafe {
            let fence = self.device.create_fence(&info, None).unwrap();
            self.device
                .queue_submit(self.queue, &[submit], fence)
                .unwrap();
            self.device
                .wait_for_fences(&[fence], true, u64::MAX)
                .unwrap();
            self.device.destroy_fence(fence, None);
            self.device.free_command_buffers(self.pool, &cmds);
        }
    }

    /// The host's own rendering to one image of its own.
    ///
    /// # Safety
    /// As `vkCmdBeginRendering`: the view is in layout `COLOR_ATTACHMENT_OPTIMAL`.
    pub unsafe fn begin_rendering(
        &self,
        cmd: vk::CommandBuffer,
        view: vk::ImageView,
        [width, height]: [u32; 2],
        drawn: [f32; 4],
    ) {
        // SAFETY: the caller's promise.
        unsafe { self.begin_rendering_before(cmd, view, [width, height], drawn, None) };
    }

    /// The same with a depth buffer, which is kept.
    ///
    /// # Safety
    /// As `vkCmdBeginRendering`: the depth is [`ATTACHED`].
    pub unsafe fn begin_rendering_before(
        &self,
        cmd: vk::CommandBuffer,
        view: vk::ImageView,
        [width, height]: [u32; 2],
        drawn: [f32; 4],
        depth: Option<&DepthImage>,
    ) {
        let depth = depth.map(|depth| {
            vk::RenderingAttachmentInfo::default()
                .image_view(depth.view)
                .image_layout(ATTACHED.2)
                .load_op(vk::AttachmentLoadOp::LOAD)
                .store_op(vk::AttachmentStoreOp::STORE)
        });
        let attachments = [vk::RenderingAttachmentInfo::default()
            .image_view(view)
            .image_layout(vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL)
            .load_op(vk::AttachmentLoadOp::CLEAR)
            .store_op(vk::AttachmentStoreOp::STORE)
            .clear_value(vk::ClearValue {
                color: vk::ClearColorValue { float32: drawn },
            })];
        let extent = vk::Extent2D { width, height };
        let info = vk::RenderingInfo::default()
            .render_area(extent.into())
            .layer_count(1)
            .color_attachments(&attachments);
        let info = match &depth {
            Some(depth) => info.depth_attachment(depth),
            None => info,
        };
        // SAFETY: the caller's promise.
        unsafe { self.device.cmd_begin_rendering(cmd, &info) };
    }

    /// What the layer has said so far.
    pub fn take_messages(&self) -> Vec<String> {
        std::mem::take(&mut self.messages.lock().unwrap())
    }
}

impl Drop for Host {
    fn drop(&mut self) {
        let gpu = self.gpu.take().expect("taken only here");
        let owners = Arc::strong_count(&gpu);
        if owners > 1 {
            // What outlives the host's device keeps it alive, for the message to be heard.
            std::mem::forget(gpu);
            assert!(
                std::thread::panicking(),
                "{owners} owners of the `Gpu` are left"
            );
            return;
        }
        // SAFETY: nothing of ours is left on the device but what the last owner destroys.
        unsafe {
            self.device.device_wait_idle().unwrap();
            drop(gpu);
            self.device.destroy_command_pool(self.pool, None);
            self.device.destroy_device(None);
            if let Some((debug_utils, messenger)) = &self.messenger {
                debug_utils.destroy_debug_utils_messenger(*messenger, None);
            }
            self.instance.destroy_instance(None);
        }
        if !std::thread::panicking() {
            assert_eq!(self.take_messages(), Vec::<String>::new());
        }
    }
}

unsafe fn instance(entry: &ash::Entry, mode: Option<ValidationMode>) -> ash::Instance {
    let application = vk::ApplicationInfo::default().api_version(API_VERSION);
    let layers = [c"VK_LAYER_KHRONOS_validation".as_ptr()];
    let extensions = [
        ext::debug_utils::NAME.as_ptr(),
        ext::validation_features::NAME.as_ptr(),
    ];
    let enables = [vk::ValidationFeatureEnableEXT::SYNCHRONIZATION_VALIDATION];
    let mut features =
        vk::ValidationFeaturesEXT::default().enabled_validation_features(match mode {
            Some(ValidationMode::Synchronization) => &enables,
            _ => &[],
        });
    let mut info = vk::InstanceCreateInfo::default().application_info(&application);
    if mode.is_some() {
        info = info
            .enabled_layer_names(&layers)
            .enabled_extension_names(&extensions)
            .push_next(&mut features);
    }
    // SAFETY: every pointer lives until the call returns.
    unsafe { entry.create_instance(&info, None) }.expect("a Vulkan 1.3 driver")
}

fn messenger_info(messages: &Mutex<Vec<String>>) -> vk::DebugUtilsMessengerCreateInfoEXT<'_> {
    use vk::{
        DebugUtilsMessageSeverityFlagsEXT as Severity, DebugUtilsMessageTypeFlagsEXT as Type,
    };
    vk::DebugUtilsMessengerCreateInfoEXT::default()
        .message_severity(Severity::ERROR | Severity::WARNING)
        .message_type(Type::VALIDATION | Type::PERFORMANCE)
        .pfn_user_callback(Some(listen))
        .user_data((&raw const *messages).cast_mut().cast())
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
