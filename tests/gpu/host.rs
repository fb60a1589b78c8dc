//! A device that a host made stays the host's.

use crate::gpu_shared::*;
use ash::{ext, vk};
use std::{
    ffi::{CStr, c_void},
    sync::{Arc, Mutex},
};
use stratavox::gpu::*;

const LAYER: &CStr = c"VK_LAYER_KHRONOS_validation";

/// A host with an instance, a device and a queue of its own. Its messenger listens where the layer is installed.
struct Host {
    entry: ash::Entry,
    instance: ash::Instance,
    physical_device: vk::PhysicalDevice,
    device: ash::Device,
    queue: vk::Queue,
    debug_utils: Option<(ext::debug_utils::Instance, vk::DebugUtilsMessengerEXT)>,
    messages: Box<Mutex<Vec<String>>>,
}

unsafe extern "system" fn listen(
    _: vk::DebugUtilsMessageSeverityFlagsEXT,
    _: vk::DebugUtilsMessageTypeFlagsEXT,
    data: *const vk::DebugUtilsMessengerCallbackDataEXT<'_>,
    messages: *mut c_void,
) -> vk::Bool32 {
    // SAFETY: the layer's data is valid during the call; the messages live in the box of the host.
    let text = unsafe { CStr::from_ptr((*data).p_message) }
        .to_string_lossy()
        .into_owned();
    // SAFETY: as above.
    unsafe { &*messages.cast::<Mutex<Vec<String>>>() }
        .lock()
        .unwrap()
        .push(text);
    vk::FALSE
}

impl Host {
    /// # Safety
    /// `close` must be called once everything made on the device is gone.
    unsafe fn new() -> Self {
        // SAFETY: plain Vulkan set-up, every argument of which is right.
        unsafe {
            let entry = ash::Entry::load().expect("a Vulkan loader");
            let layers = entry.enumerate_instance_layer_properties().unwrap();
            let has_layer = layers
                .iter()
                .any(|layer| layer.layer_name_as_c_str() == Ok(LAYER));
            let layers = [LAYER.as_ptr()];
            let extensions = [ext::debug_utils::NAME.as_ptr()];
            let application = vk::ApplicationInfo::default().api_version(API_VERSION);
            let mut info = vk::InstanceCreateInfo::default().application_info(&application);
            if has_layer {
                info = info
                    .enabled_layer_names(&layers)
                    .enabled_extension_names(&extensions);
            }
            let instance = entry
                .create_instance(&info, None)
                .expect("a Vulkan 1.3 driver");
            let messages = Box::new(Mutex::new(Vec::new()));
            let debug_utils = has_layer.then(|| {
                let info = vk::DebugUtilsMessengerCreateInfoEXT::default()
                    .message_severity(vk::DebugUtilsMessageSeverityFlagsEXT::ERROR)
                    .message_type(vk::DebugUtilsMessageTypeFlagsEXT::VALIDATION)
                    .pfn_user_callback(Some(listen))
                    .user_data((&raw const *messages).cast_mut().cast());
                let debug_utils = ext::debug_utils::Instance::new(&entry, &instance);
                let messenger = debug_utils
                    .create_debug_utils_messenger(&info, None)
                    .unwrap();
                (debug_utils, messenger)
            });
            let physical_device = instance.enumerate_physical_devices().unwrap()[0];
            let mut features = vk::PhysicalDeviceVulkan13Features::default()
                .dynamic_rendering(true)
                .synchronization2(true);
            let queues = [vk::DeviceQueueCreateInfo::default()
                .queue_family_index(0)
                .queue_priorities(&[1.0])];
            let info = vk::DeviceCreateInfo::default()
                .queue_create_infos(&queues)
                .push_next(&mut features);
            let device = instance
                .create_device(physical_device, &info, None)
                .unwrap();
            let queue = device.get_device_queue(0, 0);
            Self {
                entry,
                instance,
                physical_device,
                device,
                queue,
                debug_utils,
                messages,
            }
        }
    }

    fn handles(&self) -> HostDevice<'static> {
        HostDevice {
            get_instance_proc_addr: self.entry.static_fn().get_instance_proc_addr,
            instance: self.instance.handle(),
            physical_device: self.physical_device,
            device: self.device.handle(),
            queue_family: 0,
            api_version: API_VERSION,
            features: Features {
                dynamic_rendering: true,
                synchronization2: true,
                ..Features::default()
            },
            debug_utils: self.debug_utils.is_some(),
            caps: Caps::UNLIMITED,
            pipeline_cache: &[],
        }
    }

    /// Destroys everything of the host's, and returns what the layer has said until then.
    ///
    /// # Safety
    /// Everything made on the device is gone.
    unsafe fn close(self) -> Vec<String> {
        // SAFETY: the caller's promise.
        unsafe {
            self.device.destroy_device(None);
            if let Some((debug_utils, messenger)) = &self.debug_utils {
                debug_utils.destroy_debug_utils_messenger(*messenger, None);
            } else {
                println!("skipped: no validation layer to say what was left behind");
            }
            self.instance.destroy_instance(None);
        }
        self.messages.into_inner().unwrap()
    }
}

#[test]
fn a_host_submits_what_we_record_and_gets_its_device_back_clean() {
    // SAFETY: everything below is dropped before `close`, and waited for before it is dropped.
    unsafe {
        let host = Host::new();
        let gpu = Gpu::from_host(host.handles()).unwrap();
        let pipeline = ComputePipeline::new(&gpu, &ramp()).unwrap();
        let ring = ParameterRing::new(&gpu, 8, 1, "params").unwrap();
        ring.write(0, bytemuck::cast_slice(&[2_u32, 5])).unwrap();
        let buffer = readback(&gpu, 256);
        let resources = [
            ("numbers", Resource::Storage(&buffer)),
            ("params", Resource::Uniform(&ring)),
        ];
        let bindings = Bindings::new(&gpu, pipeline.layout(), &resources).unwrap();

        let info = vk::CommandPoolCreateInfo::default();
        let pool = host.device.create_command_pool(&info, None).unwrap();
        let info = vk::CommandBufferAllocateInfo::default()
            .command_pool(pool)
            .command_buffer_count(1);
        let cmd = host.device.allocate_command_buffers(&info).unwrap()[0];
        gpu.announce(1);
        host.device
            .begin_command_buffer(cmd, &vk::CommandBufferBeginInfo::default())
            .unwrap();
        pipeline.dispatch(cmd, &bindings, &[0], pipeline.groups([64, 1, 1]).unwrap());
        buffer_barrier(&gpu, cmd, &buffer, Use::ComputeWrite, Use::HostRead);
        host.device.end_command_buffer(cmd).unwrap();
        let fence = host
            .device
            .create_fence(&vk::FenceCreateInfo::default(), None)
            .unwrap();
        let cmds = [cmd];
        let submit = vk::SubmitInfo::default().command_buffers(&cmds);
        host.device
            .queue_submit(host.queue, &[submit], fence)
            .unwrap();
        // Dropped while the device may still use it.
        drop((pipeline, bindings, ring));
        gpu.retire(0);
        assert_eq!(gpu.live_objects()["pipeline"], 1);
        host.device
            .wait_for_fences(&[fence], true, u64::MAX)
            .unwrap();
        gpu.retire(1);
        assert!(
            !gpu.live_objects().contains_key("pipeline"),
            "{:?}",
            gpu.live_objects()
        );
        assert_eq!(
            numbers::<u32>(&buffer),
            (0..64).map(|i| 2 * i + 5).collect::<Vec<_>>()
        );

        drop(buffer);
        assert_eq!(Arc::strong_count(&gpu), 1);
        drop(gpu);
        // Still the host's, and still alive.
        host.device.destroy_fence(fence, None);
        host.device.destroy_command_pool(pool, None);
        host.device.device_wait_idle().unwrap();
        assert_eq!(host.close(), Vec::<String>::new());
    }
}

type Change = fn(&mut HostDevice<'_>);

#[test]
fn what_a_host_did_not_enable_is_named() {
    // SAFETY: nothing is made on the device.
    unsafe {
        let host = Host::new();
        let whole = host.handles();
        let without = |change: Change| {
            let mut handles = whole;
            change(&mut handles);
            Gpu::from_host(handles)
                .expect_err("something is missing")
                .to_string()
        };
        let cases: [(Change, &str); 5] = [
            (
                |host| host.features.dynamic_rendering = false,
                "lacks dynamicRendering (wanted enabled, found not enabled)",
            ),
            (
                |host| host.features.synchronization2 = false,
                "lacks synchronization2",
            ),
            (
                |host| host.queue_family = 1000,
                "lacks queueFlags of the queue family (wanted GRAPHICS | COMPUTE, found no family 1000)",
            ),
            (
                |host| host.api_version = vk::API_VERSION_1_2,
                "host's instance speaks Vulkan 1.2.0, wanted 1.3.0",
            ),
            (
                |host| host.api_version = 0,
                "host's instance speaks Vulkan 0.0.0",
            ),
        ];
        for (change, wanted) in cases {
            let found = without(change);
            assert!(found.contains(wanted), "{found}");
        }
        assert_eq!(host.close(), Vec::<String>::new());
    }
}

#[test]
fn a_pipeline_cache_that_is_not_this_device_s_is_ignored() {
    // SAFETY: nothing is left on the device at `close`.
    unsafe {
        let host = Host::new();
        let good = Gpu::from_host(host.handles())
            .unwrap()
            .pipeline_cache_data()
            .unwrap();
        let mut foreign = good.clone();
        foreign[20] ^= 1;
        for data in [&good[..], &foreign, &good[..31], b"anything", &[0xff; 4096]] {
            let gpu = Gpu::from_host(HostDevice {
                pipeline_cache: data,
                ..host.handles()
            })
            .unwrap();
            ComputePipeline::new(&gpu, &ramp()).unwrap();
        }
        assert_eq!(host.close(), Vec::<String>::new());
    }
}
