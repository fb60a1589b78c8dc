//! A host with devices of its own, each made for one picture.

use super::entry;
use crate::shared::{oblique_camera, projections, ramps, sheared_affine, volume_of, waves};
use ash::{ext, vk};
use std::error::Error;
use std::ffi::{CStr, c_void};
use std::sync::{Arc, Mutex};
use stratavox::camera::Camera;
use stratavox::embed::{self, Class, QueueLock, Shot, Submitter};
use stratavox::gpu::{
    self, API_VERSION, Blend, Buffer, Caps, Feature, Features, Gpu, HostDevice, Memory, Region,
    Target, Timer, Use, image_barrier, image_to_buffer,
};
use stratavox::resident::{GpuTransfer, GpuVolume, TextureLayout};
use stratavox::resolve::Resolve;
use stratavox::technique::raycast::Raycast;
use stratavox::technique::{
    ACCUMULATION_FORMAT, Inputs, Mode, Settings, Skip, View, Words, accumulation, parameter_ring,
};
use stratavox::transfer::TransferFunction;
use stratavox::volume::{Grid, Volume};

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
    queue: vk::Queue,
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
            caps: Caps::UNLIMITED,
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

/// A small picture: a volume, what it looks like, and from where.
pub struct Stage {
    pub volume: Volume,
    pub transfer: TransferFunction,
    pub camera: Camera,
    pub settings: Settings,
    pub extent: [u32; 2],
}

impl Stage {
    pub fn new() -> Self {
        let volume = volume_of([16; 3], sheared_affine(), waves);
        let grid = volume.grid();
        Self {
            camera: oblique_camera(&grid, projections(&grid)[1]),
            volume,
            transfer: ramps(),
            settings: Settings::default(),
            extent: [32; 2],
        }
    }

    /// How the volume lies in textures.
    pub fn layout(&self) -> TextureLayout {
        let grid = self.volume.grid();
        self.view(&grid).texture_layout()
    }

    fn view<'a>(&'a self, grid: &'a Grid) -> View<'a> {
        View {
            grid,
            camera: &self.camera,
            extent_pixels: self.extent,
            in_pixel: [0.0; 2].into(),
            settings: &self.settings,
        }
    }

    /// Draws as a host does that records for itself (`examples/embed`), and reads the picture and the time it took.
    pub fn draw(
        &self,
        device: &HostedDevice<'_>,
        gpu: &Arc<Gpu>,
    ) -> Result<Vec<u8>, Box<dyn Error>> {
        let (settings, extent) = (&self.settings, self.extent);
        let grid = self.volume.grid();
        let view = self.view(&grid);
        let voxels = GpuVolume::new(gpu, &self.volume, view.texture_layout())?;
        let staging = voxels.stage(&self.volume)?;
        let (length, space) = (grid.smallest_spacing(), settings.color_space);
        let transfer = GpuTransfer::new(gpu, &self.transfer, length, space)?;
        let ring = parameter_ring(gpu, voxels.bricks().len() as u32)?;
        let gathered = accumulation(gpu, extent, "gathered")?;
        let layers = accumulation(gpu, extent, "layers")?;
        let picture = accumulation(gpu, extent, "picture")?;
        let raycast = Raycast::new(gpu, &Words::of(settings, &voxels))?;
        let inputs = Inputs {
            beside: &[],
            light: None,
            skip: Skip::Nothing,
            ring: &ring,
            volume: &voxels,
            brick: &voxels.bricks()[0],
            transfer: Some(&transfer),
        };
        let bound = raycast.bind(&inputs, &gathered, &layers)?;
        let resolve = Resolve::new(gpu, Mode::Composite, Blend::Replace, ACCUMULATION_FORMAT)?;
        let resolved = resolve.bind(&ring, &gathered, Some(&transfer))?;
        let usage = vk::BufferUsageFlags::TRANSFER_DST;
        let bytes = 16 * u64::from(extent[0]) * u64::from(extent[1]);
        let readback = Buffer::new(gpu, bytes, usage, Memory::Readback, "readback")?;
        let timer = Timer::new(gpu)?;
        let recording = view.recordings(&voxels, Some(&transfer))?[0];
        let offset = recording.write(&ring, 0)?;

        gpu.announce(1);
        let cmd = device.begin();
        // SAFETY: barriers stand between the passes; all of it lives until the device has finished.
        unsafe {
            if let Some(timer) = &timer {
                timer.start(cmd);
            }
            voxels.record_upload_all(cmd, &staging)?;
            transfer.record_upload(cmd)?;
            for written in [&gathered, &layers] {
                image_barrier(gpu, cmd, written, Use::Nothing, Use::ComputeWrite);
            }
            raycast.record(cmd, &bound, offset, extent)?;
            image_barrier(gpu, cmd, &gathered, Use::ComputeWrite, Use::FragmentSampled);
            image_barrier(gpu, cmd, &picture, Use::Nothing, Use::ColorTarget);
            let targets = [(picture.view(), gpu::Load::Clear([0.0; 4]))];
            gpu::begin_rendering(gpu, cmd, &targets, extent);
            resolve.record(cmd, &resolved, offset, extent);
            gpu::end_rendering(gpu, cmd);
            image_barrier(gpu, cmd, &picture, Use::ColorTarget, Use::TransferRead);
            image_to_buffer(gpu, cmd, &picture, Region::whole(&picture), &readback, 0)?;
            gpu::buffer_barrier(gpu, cmd, &readback, Use::TransferWrite, Use::HostRead);
            if let Some(timer) = &timer {
                timer.stop(cmd);
            }
        }
        device.submit_and_wait(cmd);
        // SAFETY: the one submission has ended.
        unsafe { gpu.retire(1) };
        let mut texels = vec![0; bytes as usize];
        readback.read(0, &mut texels)?;
        if let Some(timer) = &timer {
            timer.elapsed_ms()?;
        }
        gpu.pipeline_cache_data()?;
        Ok(texels)
    }

    /// Draws as a host does that lets us submit, in frames between values of its timeline.
    pub fn submit(
        &self,
        device: &HostedDevice<'_>,
        gpu: &Arc<Gpu>,
    ) -> Result<Vec<u8>, Box<dyn Error>> {
        let mut volume = embed::Volume::new(gpu, &self.volume, &self.settings)?;
        let mut submitter = Submitter::new(gpu, 3)?;
        let image = accumulation(gpu, self.extent, "target")?;
        let usage = vk::BufferUsageFlags::TRANSFER_DST;
        let bytes = 16 * u64::from(self.extent[0]) * u64::from(self.extent[1]);
        let readback = Buffer::new(gpu, bytes, usage, Memory::Readback, "readback")?;
        let class = Class {
            settings: self.settings.clone(),
            target: ACCUMULATION_FORMAT.into(),
            frames_in_flight: 3,
            host_depth: false,
            gives_depth: false,
        };
        let shot = Shot {
            frame: 1,
            camera: &self.camera,
            depth: None,
        };
        let target = Target {
            image: image.raw(),
            view: image.view(),
            format: image.format(),
            extent: self.extent,
            before: Use::Nothing.into(),
            after: Use::TransferRead.into(),
        };
        let locked = |submit: &mut dyn FnMut()| submit();
        let lock = QueueLock {
            queue: device.queue,
            locked: &locked,
        };
        // SAFETY: all of it lives until the timeline has waited, which goes first.
        unsafe {
            gpu.announce(3);
            let mut renderer;
            let timeline = Timeline::new(device);
            let at = |value| [(timeline.semaphore, value)];
            submitter.run(lock, 0, &[], &at(1), |cmd| volume.record_upload(gpu, cmd))?;
            let volume = Arc::new(volume);
            let function = Some(&self.transfer);
            renderer = embed::Renderer::new(gpu, &volume, function, class, self.extent, &[])?;
            let load = gpu::Load::Clear([0.0; 4]);
            submitter.submit(&mut renderer, &shot, &target, load, lock, &at(1), &at(2))?;
            submitter.run(lock, 2, &at(2), &at(3), |cmd| {
                image_to_buffer(gpu, cmd, &image, Region::whole(&image), &readback, 0)?;
                gpu::buffer_barrier(gpu, cmd, &readback, Use::TransferWrite, Use::HostRead);
                Ok(())
            })?;
            timeline.wait(3);
            gpu.retire(3);
        }
        let mut texels = vec![0; bytes as usize];
        readback.read(0, &mut texels)?;
        Ok(texels)
    }
}

/// A timeline of the host's. Dropping it waits for the device.
struct Timeline<'d> {
    semaphore: vk::Semaphore,
    device: &'d HostedDevice<'d>,
}

impl<'d> Timeline<'d> {
    fn new(device: &'d HostedDevice<'_>) -> Self {
        let kind = vk::SemaphoreType::TIMELINE;
        let mut kind = vk::SemaphoreTypeCreateInfo::default().semaphore_type(kind);
        let info = vk::SemaphoreCreateInfo::default().push_next(&mut kind);
        // SAFETY: the device has timelines; `drop` destroys it.
        let semaphore = unsafe { device.device.create_semaphore(&info, None) }.unwrap();
        Self { semaphore, device }
    }

    fn wait(&self, value: u64) {
        let (semaphores, values) = ([self.semaphore], [value]);
        let info = vk::SemaphoreWaitInfo::default()
            .semaphores(&semaphores)
            .values(&values);
        // SAFETY: it is ours, and something that reaches the value was submitted.
        unsafe { self.device.device.wait_semaphores(&info, u64::MAX) }.unwrap();
    }
}

impl Drop for Timeline<'_> {
    fn drop(&mut self) {
        // SAFETY: nothing more is submitted.
        unsafe {
            self.device.device.device_wait_idle().unwrap();
            self.device.device.destroy_semaphore(self.semaphore, None);
        }
    }
}
