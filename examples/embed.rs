//! The smallest host: a Vulkan device, queue and command buffer of its own, a volume in its image, and a PNG:
//! `cargo run --example embed -- sphere.png`.
//!
//! `docs/embedding.md` goes on from here: the host's own rendering, its depth buffer, frames in flight.

use ash::vk;
use std::{env, error::Error, path::Path, sync::Arc};
use stratavox::camera::{BoundingSphere, Camera, Lens, View};
use stratavox::embed::{FrameInfo, Renderer, RendererDesc, Volume};
use stratavox::gpu::{
    API_VERSION, Buffer, Caps, Features, Gpu, HostDevice, Image, ImageDesc, ImageKind, Load,
    Memory, Region, Target, Use, image_to_buffer,
};
use stratavox::technique::Settings;
use stratavox::transfer::{Classified, Window};
use stratavox::volume::{self, Limits, TimeComponent, phantom};

const EXTENT: [u32; 2] = [256, 256];
const FORMAT: vk::Format = vk::Format::R8G8B8A8_SRGB;
const BACKGROUND: [f32; 4] = [0.0, 0.05, 0.1, 1.0];
/// Of a family with graphics and compute: the first one of every device that draws.
const QUEUE_FAMILY: u32 = 0;

fn main() -> Result<(), Box<dyn Error>> {
    run(env::args().nth(1).unwrap_or("sphere.png".into()).as_ref())
}

/// Draws the picture and writes it to `path`.
pub fn run(path: &Path) -> Result<(), Box<dyn Error>> {
    // SAFETY: plain Vulkan; what stratavox has made is gone (`draw` has returned) before the device is.
    unsafe {
        let entry = ash::Entry::load()?;
        let application = vk::ApplicationInfo::default().api_version(API_VERSION);
        let info = vk::InstanceCreateInfo::default().application_info(&application);
        let instance = entry.create_instance(&info, None)?;
        let physical_devices = instance.enumerate_physical_devices()?;
        let physical_device = *physical_devices.first().ok_or("no Vulkan device")?;
        let queues = [vk::DeviceQueueCreateInfo::default()
            .queue_family_index(QUEUE_FAMILY)
            .queue_priorities(&[1.0])];
        // All that stratavox asks for.
        let mut features = vk::PhysicalDeviceVulkan13Features::default()
            .dynamic_rendering(true)
            .synchronization2(true);
        let info = vk::DeviceCreateInfo::default()
            .queue_create_infos(&queues)
            .push_next(&mut features);
        let device = instance.create_device(physical_device, &info, None)?;
        // Vulkan cannot be asked what was enabled on a device: the host says it.
        let gpu = Gpu::from_host(HostDevice {
            get_instance_proc_addr: entry.static_fn().get_instance_proc_addr,
            instance: instance.handle(),
            physical_device,
            device: device.handle(),
            queue_family: QUEUE_FAMILY,
            api_version: API_VERSION,
            features: Features {
                dynamic_rendering: true,
                synchronization2: true,
                ..Features::default()
            },
            debug_utils: false,
            caps: Caps::UNLIMITED,
            pipeline_cache: &[],
        });
        let texels = gpu.map_err(Into::into).and_then(|gpu| draw(&device, &gpu));
        device.destroy_device(None);
        instance.destroy_instance(None);
        let color = image::ExtendedColorType::Rgba8;
        Ok(image::save_buffer(
            path, &texels?, EXTENT[0], EXTENT[1], color,
        )?)
    }
}

/// Draws a sphere into an image, sRGB red, green, blue and alpha.
unsafe fn draw(device: &ash::Device, gpu: &Arc<Gpu>) -> Result<Vec<u8>, Box<dyn Error>> {
    // What is seen, and from where.
    let limits = Limits::default();
    let source = phantom::open("phantom:sphere,n=64", &limits)?;
    let region = source.header().whole();
    let voxels = volume::Volume::read(source.as_ref(), TimeComponent::default(), region, &limits)?;
    let function = Window::of_range(voxels.value_range).grey(Classified::Samples);
    let bounds = BoundingSphere::of_grid(&voxels.grid().world_from_voxel, voxels.dims);
    let lens = Lens::Perspective { fov_degrees: 30.0 };
    let from = View::Anterior.orbit();
    let camera = Camera::orbit(&bounds, bounds.center, from, None, lens, EXTENT)?;

    // Once: objects, pipelines, images, descriptor sets.
    let settings = Settings::default();
    let mut volume = Volume::new(gpu, &voxels, &settings)?;
    let class = RendererDesc {
        settings,
        target: FORMAT.into(),
        frames_in_flight: 1,
        host_depth: false,
        gives_depth: false,
        picks: false,
        slice_blending: Default::default(),
    };
    let [width, height] = EXTENT;
    let usage = vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::TRANSFER_SRC;
    let (kind, extent, name) = (ImageKind::D2, [width, height, 1], "picture");
    let desc = ImageDesc {
        kind,
        extent,
        format: FORMAT,
        usage,
        name,
    };
    let image = Image::new(gpu, &desc)?;
    let mut texels = vec![0; 4 * (width * height) as usize];
    let (bytes, to) = (texels.len() as u64, vk::BufferUsageFlags::TRANSFER_DST);
    let readback = Buffer::new(gpu, bytes, to, Memory::Readback, "readback")?;
    let target = Target {
        image: image.raw(),
        view: image.view(),
        format: FORMAT,
        extent: EXTENT,
        before: Use::Nothing.into(),
        after: Use::TransferRead.into(),
    };

    // SAFETY: the pool's only buffer is recorded once and waited for; all that it uses lives until then.
    unsafe {
        let pool = device.create_command_pool(&vk::CommandPoolCreateInfo::default(), None)?;
        let info = vk::CommandBufferAllocateInfo::default().command_pool(pool);
        let cmds @ [cmd] = [device.allocate_command_buffers(&info.command_buffer_count(1))?[0]];
        device.begin_command_buffer(cmd, &vk::CommandBufferBeginInfo::default())?;
        volume.record_upload(gpu, cmd)?;
        let volume = Arc::new(volume);
        let mut renderer = Renderer::new(gpu, &volume, Some(&function), class, EXTENT, &[])?;
        // Once a frame.
        let shot = FrameInfo {
            frame: 0,
            camera: &camera,
            depth: None,
        };
        renderer.record_into(cmd, &shot, &target, Load::Clear(BACKGROUND))?;
        image_to_buffer(gpu, cmd, &image, Region::whole(&image), &readback, 0)?;
        device.end_command_buffer(cmd)?;
        let queue = device.get_device_queue(QUEUE_FAMILY, 0);
        let submit = [vk::SubmitInfo::default().command_buffers(&cmds)];
        device.queue_submit(queue, &submit, vk::Fence::null())?;
        device.queue_wait_idle(queue)?;
        device.destroy_command_pool(pool, None);
    }
    readback.read(0, &mut texels)?;
    Ok(texels)
}
