//! The smallest host: a Vulkan device, an image and a command buffer of its own, a volume in it, and a PNG.
//!
//! ```sh
//! cargo run --example embed -- sphere.png
//! ```
//!
//! `host.rs` is plain Vulkan; here is all that has to do with stratavox.

mod host;

use ash::vk;
use host::{Host, QUEUE_FAMILY};
use std::{env, error::Error, path::Path};
use stratavox::camera::{BoundingSphere, Camera, Lens, View as Facing};
use stratavox::gpu::{API_VERSION, Blend, Caps, Features, Gpu, HostDevice, Use, image_barrier};
use stratavox::resident::{GpuTransfer, GpuVolume};
use stratavox::resolve::Resolve;
use stratavox::technique::raycast::Raycast;
use stratavox::technique::{Inputs, Mode, Settings, View, Words, accumulation, parameter_ring};
use stratavox::transfer::{Classified, Window};
use stratavox::volume::{Limits, Pick, Volume, phantom};

const EXTENT: [u32; 2] = [256, 256];
const FORMAT: vk::Format = vk::Format::R8G8B8A8_SRGB;
const BACKGROUND: [f32; 4] = [0.0, 0.05, 0.1, 1.0];

fn main() -> Result<(), Box<dyn Error>> {
    run(Path::new(
        &env::args().nth(1).unwrap_or("sphere.png".into()),
    ))
}

/// Draws the picture and writes it to `path`.
pub fn run(path: &Path) -> Result<(), Box<dyn Error>> {
    // SAFETY: the handles belong together, and `draw` has let go of them when the host is closed.
    unsafe {
        let host = Host::new()?;
        let drawn = draw(&host);
        let texels = drawn.and_then(|()| Ok(host.texels()?));
        host.close();
        let [width, height] = EXTENT;
        let color = image::ExtendedColorType::Rgba8;
        Ok(image::save_buffer(path, &texels?, width, height, color)?)
    }
}

/// Draws a sphere into the host's image.
///
/// # Safety
/// The host's handles are valid.
unsafe fn draw(host: &Host) -> Result<(), Box<dyn Error>> {
    let limits = Limits::default();
    let source = phantom::open("phantom:sphere,n=64", &limits)?;
    let volume = Volume::read(
        source.as_ref(),
        Pick::default(),
        source.header().whole(),
        &limits,
    )?;
    let grid = volume.grid();
    let bounds = BoundingSphere::of_grid(&grid.world_from_voxel, grid.dims);
    let lens = Lens::Perspective { fov_degrees: 30.0 };
    let facing = Facing::Anterior.orbit();
    let camera = Camera::orbit(&bounds, bounds.center, facing, None, lens, EXTENT)?;
    let function = Window::of_range(volume.value_range).grey(Classified::Samples);
    let settings = Settings::default();
    let view = View {
        grid: &grid,
        camera: &camera,
        extent_pixels: EXTENT,
        in_pixel: [0.0; 2].into(),
        settings: &settings,
    };

    // Set-up: objects, and the descriptor sets that name them.
    // SAFETY: the caller's promise; the device has finished when this function ends.
    let gpu = unsafe { Gpu::from_host(handles(host))? };
    let voxels = GpuVolume::new(&gpu, &volume, view.texture_layout())?;
    let staging = voxels.stage(&volume)?;
    let length = grid.smallest_spacing();
    let transfer = GpuTransfer::new(&gpu, &function, length, settings.color_space)?;
    let ring = parameter_ring(&gpu, voxels.bricks().len() as u32)?;
    let gathered = accumulation(&gpu, EXTENT, "gathered")?;
    let layers = accumulation(&gpu, EXTENT, "layers")?;
    let raycast = Raycast::new(&gpu, &Words::of(&settings, &voxels))?;
    let bind = |brick| {
        let inputs = Inputs {
            beside: &[],
            light: None,
            skip: stratavox::technique::Skip::Nothing,
            ring: &ring,
            volume: &voxels,
            brick,
            transfer: Some(&transfer),
        };
        raycast.bind(&inputs, &gathered, &layers)
    };
    let bound = voxels.bricks().iter().map(bind);
    let bound = bound.collect::<Result<Vec<_>, _>>()?;
    let resolve = Resolve::new(&gpu, Mode::Composite, Blend::Over, FORMAT)?;
    let resolved = resolve.bind(&ring, &gathered, Some(&transfer))?;

    // Once a frame: parameters, then commands.
    let mut recorded = Vec::new();
    for (slot, recording) in (0..).zip(view.recordings(&voxels, Some(&transfer))?) {
        recorded.push((recording.brick, recording.write(&ring, slot)?));
    }
    // SAFETY: barriers stand between the passes; all of it lives until the host has waited.
    unsafe {
        let cmd = host.begin()?;
        voxels.record_upload_all(cmd, &staging)?;
        transfer.record_upload(cmd)?;
        let mut before = Use::Nothing;
        for &(brick, offset) in &recorded {
            for written in [&gathered, &layers] {
                image_barrier(&gpu, cmd, written, before, Use::ComputeWrite);
            }
            raycast.record(cmd, &bound[brick], offset, EXTENT)?;
            before = Use::ComputeWrite;
        }
        image_barrier(
            &gpu,
            cmd,
            &gathered,
            Use::ComputeWrite,
            Use::FragmentSampled,
        );
        host.begin_rendering(cmd);
        resolve.record(cmd, &resolved, recorded[0].1, EXTENT);
        host.end_rendering(cmd);
        host.submit_and_wait(cmd)?;
    }
    Ok(())
}

/// What stratavox must know of the host's device. Vulkan cannot be asked what was enabled on it.
fn handles(host: &Host) -> HostDevice<'static> {
    HostDevice {
        get_instance_proc_addr: host.entry.static_fn().get_instance_proc_addr,
        instance: host.instance.handle(),
        physical_device: host.physical_device,
        device: host.device.handle(),
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
    }
}
