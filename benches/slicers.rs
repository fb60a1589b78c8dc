//! Slicers beside a plain caster: a fragment shader that takes the samples of view-aligned slices one after the other,
//! leaves nothing out, and needs no blending (`shaders/probe/fragment_caster.wgsl`).
//!
//! Times of the device, medians; what is measured in a row is drawn in turn. `far` is how far the caster's picture lies
//! from that of the slices, at most, in linear colour and alpha.

mod median;
mod scan;

use ash::vk;
use median::median;
use scan::{SCAN, scan};
use std::error::Error;
use std::sync::Arc;
use stratavox::camera::{self, BoundingSphere, Camera, Lens};
use stratavox::format;
use stratavox::gpu::{
    Bindings, Blend, Buffer, DepthUse, DeviceChoice, Gpu, Headless, Image, Load, Memory, Options,
    ParameterRing, RasterDesc, RasterPipeline, Region, Tile, Timer, Use, begin_rendering_of,
    end_rendering, image_barrier, image_to_buffer, set_area,
};
use stratavox::offscreen::Renderer;
use stratavox::picture::ColorSpace;
use stratavox::resident::{GpuTransfer, GpuVolume};
use stratavox::scene::Scene;
use stratavox::shaders::shader;
use stratavox::technique::{
    ACCUMULATION_FORMAT, InPixel, Inputs, Settings, Skip, Technique, View, accumulation,
    parameter_ring,
};
use stratavox::transfer::{Classified, TransferFunction, Window};
use stratavox::volume::{Limits, Source, TimeComponent, Volume, VolumeSelection, phantom};

const EXTENT: [u32; 2] = [512, 512];
const RUNS: usize = 9;

type Outcome<T> = Result<T, Box<dyn Error>>;

fn main() -> Outcome<()> {
    let limits = Limits::default();
    println!(
        "frames of {EXTENT:?} pixels, medians of {RUNS}, ms on the device, and beside the caster"
    );
    for name in ["phantom:head,n=128", "phantom:head,n=256"] {
        measure(name, phantom::open(name, &limits)?.as_ref())?;
    }
    let scan = scan();
    match scan.exists() {
        true => measure(
            SCAN,
            format::open(&scan, &VolumeSelection::default(), &limits)?.as_ref(),
        ),
        false => {
            println!("skipped: no data at {}", scan.display());
            Ok(())
        }
    }
}

/// All seen, and the upper part of the values, which leaves most of the volume empty.
fn functions(volume: &Volume) -> [(&'static str, TransferFunction); 2] {
    let [low, high] = volume.value_range;
    let upper = [low + 0.3 * (high - low), high];
    [("all seen", volume.value_range), ("upper", upper)]
        .map(|(name, range)| (name, Window::of_range(range).grey(Classified::Samples)))
}

fn measure(name: &str, source: &dyn Source) -> Outcome<()> {
    let whole = source.header().whole();
    let volume = Volume::read(source, TimeComponent::default(), whole, &Limits::default())?;
    let bounds = BoundingSphere::of_grid(&volume.world_from_voxel, volume.dims);
    let lens = Lens::Perspective { fov_degrees: 30.0 };
    let facing = camera::View::Left.orbit();
    let camera = Camera::orbit(&bounds, bounds.center, facing, None, lens, EXTENT)?;
    let device = Headless::new(&DeviceChoice::Default, &Options::default())?;
    println!(
        "\n{name}, {:?} voxels, {}",
        volume.dims,
        device.gpu().device_name()
    );
    let mut renderer = Renderer::new(device, &volume)?;
    for (seen, function) in functions(&volume) {
        let mut caster = Caster::new(&volume, &function, &camera)?;
        let ways = [
            ("3D slices, nothing left out", Technique::Slices3d, false),
            ("3D slices", Technique::Slices3d, true),
            ("2D stacks, nothing left out", Technique::Slices2d, false),
            ("2D stacks", Technique::Slices2d, true),
        ];
        let mut times = vec![Vec::new(); ways.len() + 1];
        for run in 0..=RUNS {
            for (way, (_, technique, skip)) in ways.iter().enumerate() {
                let settings = Settings {
                    technique: *technique,
                    skip: *skip,
                    ..Settings::default()
                };
                let scene = Scene {
                    beside: Default::default(),
                    volume: &volume,
                    transfer: Some(&function),
                    camera: &camera,
                    extent_pixels: EXTENT,
                    settings: &settings,
                };
                let drawn = renderer.render(&scene, &[])?;
                // The first of each warms up.
                if run > 0 {
                    times[way].push(drawn.gpu_ms.ok_or("a device without a clock")?);
                }
                if run == 0 && way == 0 {
                    caster.draw()?;
                    println!(
                        "{seen}: far {:.2e}",
                        caster.farthest(&drawn.picture.pixels)?
                    );
                }
            }
            let ms = caster.draw()?;
            if run > 0 {
                times[ways.len()].push(ms);
            }
        }
        let medians: Vec<f64> = times.into_iter().map(median).collect();
        let plain = medians[ways.len()];
        println!("{:<32} {plain:>8.1}", format!("{seen}: plain caster"));
        for ((way, _, _), ms) in ways.iter().zip(&medians) {
            println!(
                "{:<32} {ms:>8.1} {:>6.2}",
                format!("{seen}: {way}"),
                ms / plain
            );
        }
    }
    Ok(())
}

/// The caster, with all that it needs on a device of its own.
struct Caster {
    // Dropped in this order: the device last.
    pipeline: RasterPipeline,
    bound: Bindings,
    _volume: GpuVolume,
    _transfer: GpuTransfer,
    _ring: ParameterRing,
    offset: u32,
    target: Image,
    readback: Buffer,
    timer: Timer,
    gpu: Arc<Gpu>,
    device: Headless,
}

impl Caster {
    fn new(volume: &Volume, function: &TransferFunction, camera: &Camera) -> Outcome<Self> {
        let mut device = Headless::new(&DeviceChoice::Default, &Options::default())?;
        let gpu = Arc::clone(device.gpu());
        let settings = Settings {
            technique: Technique::Slices3d,
            ..Settings::default()
        };
        let grid = volume.grid();
        let view = View {
            grid: &grid,
            camera,
            extent_pixels: EXTENT,
            in_pixel: InPixel::CENTER,
            settings: &settings,
        };
        let there = GpuVolume::new(&gpu, volume, view.texture_layout())?;
        let staging = there.stage(volume)?;
        let length = function.reference_length.unwrap_or(grid.smallest_spacing());
        let transfer = GpuTransfer::new(&gpu, function, length, ColorSpace::Linear)?;
        // SAFETY: recorded outside rendering; `run` waits, and all of it lives meanwhile.
        device.run(|cmd| unsafe {
            there.record_upload_all(cmd, &staging)?;
            transfer.record_upload(cmd)
        })?;
        let recordings = view.recordings(&there, Some(&transfer))?;
        let [recording] = &recordings[..] else {
            return Err("the caster draws volumes of one brick".into());
        };
        let ring = parameter_ring(&gpu, 1)?;
        let offset = recording.write(&ring, 0)?;
        let pipeline = RasterPipeline::new(
            &gpu,
            &RasterDesc {
                vertex: shader("resolve_cover"),
                fragment: shader("probe/fragment_caster.none.table"),
                target: ACCUMULATION_FORMAT.into(),
                depth: DepthUse::Ignored,
                blend: Blend::Replace,
            },
        )?;
        let inputs = Inputs {
            ring: &ring,
            volume: &there,
            brick: &there.bricks()[0],
            transfer: Some(&transfer),
            beside: &[],
            light: None,
            points: None,
            field: None,
            sky: None,
            skip: Skip::Nothing,
        };
        let bound = inputs.bind(&gpu, pipeline.layout(), &[])?;
        let [width, height] = EXTENT;
        let bytes = 16 * u64::from(width * height);
        let to = vk::BufferUsageFlags::TRANSFER_DST;
        Ok(Self {
            pipeline,
            bound,
            _volume: there,
            _transfer: transfer,
            _ring: ring,
            offset,
            target: accumulation(&gpu, EXTENT, "picture")?,
            readback: Buffer::new(&gpu, bytes, to, Memory::Readback, "readback")?,
            timer: Timer::new(&gpu)?.ok_or("a device without a clock")?,
            gpu,
            device,
        })
    }

    /// Milliseconds on the device.
    fn draw(&mut self) -> Outcome<f64> {
        let (gpu, target) = (&self.gpu, &self.target);
        // SAFETY: barriers stand between, and all of it lives until `run` has waited.
        self.device.run(|cmd| unsafe {
            image_barrier(gpu, cmd, target, Use::Nothing, Use::ColorTarget);
            self.timer.start(cmd);
            let clear = Load::Clear([0.0; 4]);
            begin_rendering_of(gpu, cmd, &[(target.view(), clear)], Tile::whole(EXTENT));
            set_area(gpu, cmd, EXTENT);
            self.pipeline
                .draw(cmd, &self.bound, &[self.offset], 3, 0..1);
            end_rendering(gpu, cmd);
            self.timer.stop(cmd);
            image_barrier(gpu, cmd, target, Use::ColorTarget, Use::TransferRead);
            image_to_buffer(gpu, cmd, target, Region::whole(target), &self.readback, 0)
        })?;
        Ok(self
            .timer
            .elapsed_ms()?
            .ok_or("the clock has not stopped")?)
    }

    fn farthest(&self, pixels: &[[f32; 4]]) -> Outcome<f32> {
        let mut bytes = vec![0; 16 * pixels.len()];
        self.readback.read(0, &mut bytes)?;
        let numbers = bytes
            .as_chunks()
            .0
            .iter()
            .map(|four| f32::from_ne_bytes(*four));
        let apart = numbers.zip(pixels.iter().flatten());
        Ok(apart.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max))
    }
}
