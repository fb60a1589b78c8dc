//! How long the pieces last in which a host may submit uploads, updates, what a function has empty, and frames.
//!
//! One piece a submission, from there until the device has done it: no submission is shorter than its longest piece,
//! and `Pace` puts as many into one as take 100 ms. On volumes of noise in a ball, 16 bits a voxel.

mod median;

use ash::vk;
use glam::DAffine3;
use median::median;
use std::error::Error;
use std::sync::Arc;
use stratavox::camera::{BoundingSphere, Camera, Lens, View};
use stratavox::embed::{FrameInfo, Renderer, RendererDesc, Volume};
use stratavox::gpu::{
    self, DeviceChoice, Gpu, Headless, Image, ImageDesc, ImageKind, Load, Options, Target, Use,
};
use stratavox::technique::{Filter, Mode, Settings, Shading, Shadows, Technique};
use stratavox::transfer::{Classified, Window};
use stratavox::volume::{self, Rescale, VoxelBox, Voxels};

const EXTENT: [u32; 2] = [1024, 768];
const FORMAT: vk::Format = vk::Format::R16G16B16A16_SFLOAT;

fn main() -> Result<(), Box<dyn Error>> {
    let mut device = Headless::new(&DeviceChoice::Default, &Options::default())?;
    println!("{}, pictures of {EXTENT:?}", device.gpu().device_name());
    println!(
        "{:<52} {:>7} {:>10} {:>10}",
        "", "pieces", "median", "longest"
    );
    // The names of pictures, none for all.
    let wanted: Vec<_> = std::env::args().skip(1).collect();
    let names = || wanted.iter().filter(|word| !word.starts_with('-'));
    for side in [256, 512] {
        let voxels = ball(side)?;
        println!("{side}^3 voxels of u16");
        pieces_of_volume(&mut device, &voxels)?;
        for (name, settings) in ways() {
            if names().count() == 0 || names().any(|wanted| wanted == name) {
                pieces_of_frames(&mut device, &voxels, name, settings)?;
            }
        }
    }
    Ok(())
}

fn ways() -> [(&'static str, Settings); 6] {
    let lit = |shadows| Settings {
        shading: Some(Shading {
            shadows,
            ..Shading::default()
        }),
        ..Settings::default()
    };
    let sliced = |technique, settings| Settings {
        technique,
        ..settings
    };
    [
        ("rays", Settings::default()),
        ("rays in light", lit(Shadows::Off)),
        (
            "rays, MIP",
            Settings {
                mode: Mode::Mip,
                ..Settings::default()
            },
        ),
        (
            "rays, cubic filter in light",
            Settings {
                filter: Filter::CubicSmooth,
                ..lit(Shadows::Off)
            },
        ),
        (
            "slices in light",
            sliced(Technique::Slices3d, lit(Shadows::Off)),
        ),
        (
            "half-angle slices",
            sliced(Technique::Slices3d, lit(Shadows::HalfAngle)),
        ),
    ]
}

/// Noise in a ball.
fn ball(side: u32) -> Result<volume::Volume, Box<dyn Error>> {
    let radius = f64::from(side) / 2.0;
    let value = |[x, y, z]: [u32; 3]| {
        let off = [x, y, z].map(|n| f64::from(n) + 0.5 - radius);
        let from_center = off.iter().map(|n| n * n).sum::<f64>().sqrt() / radius;
        let noise =
            (x.wrapping_mul(73_856_093) ^ y.wrapping_mul(19_349_663) ^ z.wrapping_mul(83_492_791))
                >> 5;
        let noise = f64::from(noise % 4096);
        ((1.0 - from_center).max(0.0) * 60_000.0 + noise) as u16
    };
    let all =
        (0..side).flat_map(|z| (0..side).flat_map(move |y| (0..side).map(move |x| [x, y, z])));
    let values = all.map(value).collect();
    let (dims, affine) = ([side; 3], DAffine3::IDENTITY);
    Ok(volume::Volume::from_voxels(
        dims,
        affine,
        Voxels::U16(values),
        Rescale::default(),
        None,
    )?)
}

/// A submission for each piece, until none is left. What each took.
fn submit_each(
    device: &mut Headless,
    mut record: impl FnMut(vk::CommandBuffer) -> Result<u64, stratavox::embed::Error>,
) -> Result<Vec<f64>, Box<dyn Error>> {
    let mut times = Vec::new();
    loop {
        let left = device.run(|cmd| match record(cmd) {
            Ok(left) => Ok(left),
            Err(stratavox::embed::Error::Gpu(error)) => Err(error),
            Err(other) => panic!("{other}"),
        })?;
        times.push(device.submissions().last_ms);
        if left == 0 {
            return Ok(times);
        }
    }
}

fn line(what: &str, times: &[f64]) {
    let longest = times.iter().copied().fold(0.0, f64::max);
    let (count, middle) = (times.len(), median(times.to_vec()));
    println!("{what:<52} {count:>7} {middle:>7.2} ms {longest:>7.2} ms");
}

fn upload(
    device: &mut Headless,
    voxels: &volume::Volume,
    settings: &Settings,
) -> Result<(Volume, Vec<f64>), Box<dyn Error>> {
    let gpu = Arc::clone(device.gpu());
    let mut made = Volume::new(&gpu, voxels, settings)?;
    // SAFETY: outside rendering, in order; `run` waits.
    let times = submit_each(device, |cmd| unsafe {
        made.record_upload_part(&gpu, cmd, 1)
    })?;
    Ok((made, times))
}

fn pieces_of_volume(device: &mut Headless, voxels: &volume::Volume) -> Result<(), Box<dyn Error>> {
    let settings = Settings::default();
    let (there, times) = upload(device, voxels, &settings)?;
    line("upload", &times);
    let [side, ..] = voxels.dims;
    for (what, min, max) in [
        ("update of all", 0, side),
        ("update of a box of 64^3", side / 2 - 31, side / 2 + 33),
    ] {
        let region = VoxelBox {
            min: [min; 3],
            max: [max; 3],
        };
        let mut update = there.stage_update(region, voxels.into())?;
        // SAFETY: as above.
        let times = submit_each(device, |cmd| unsafe {
            there.record_update_part(cmd, &mut update, 1)
        })?;
        line(what, &times);
    }
    Ok(())
}

fn pieces_of_frames(
    device: &mut Headless,
    voxels: &volume::Volume,
    name: &str,
    settings: Settings,
) -> Result<(), Box<dyn Error>> {
    let gpu: Arc<Gpu> = Arc::clone(device.gpu());
    let (there, times) = upload(device, voxels, &settings)?;
    if settings.filter != Filter::Linear {
        line(&format!("{name}: upload and cells"), &times);
    }
    let classified = match settings.mode {
        Mode::Mip => Classified::Projection,
        _ => Classified::Samples,
    };
    let function = Window::of_range(voxels.value_range).grey(classified);
    let bounds = BoundingSphere::of_grid(&voxels.world_from_voxel, voxels.dims);
    let lens = Lens::Perspective { fov_degrees: 30.0 };
    let camera = Camera::orbit(
        &bounds,
        bounds.center,
        View::Left.orbit(),
        None,
        lens,
        EXTENT,
    )?;
    let class = RendererDesc {
        settings,
        target: FORMAT.into(),
        frames_in_flight: 1,
        host_depth: false,
        gives_depth: false,
        picks: false,
        slice_blending: Default::default(),
    };
    let mut renderer = Renderer::new(&gpu, &Arc::new(there), Some(&function), class, EXTENT, &[])?;
    let image = picture(&gpu)?;
    let target = Target {
        image: image.raw(),
        view: image.view(),
        format: FORMAT,
        extent: EXTENT,
        before: Use::Nothing.into(),
        after: Use::TransferRead.into(),
    };
    let shot = FrameInfo {
        frame: 0,
        camera: &camera,
        depth: None,
    };
    // The first frame is not counted: drivers compile with it. The second has a function that is new.
    let mut frame = |renderer: &mut Renderer| -> Result<Vec<f64>, Box<dyn Error>> {
        renderer.begin_parts(&shot)?;
        // SAFETY: as above; the image lives until `run` has waited for the last.
        submit_each(device, |cmd| unsafe {
            renderer.record_part_into(cmd, 0, 1, &target, Load::Clear([0.0; 4]))
        })
    };
    frame(&mut renderer)?;
    renderer.set_function(Some(&function))?;
    let times = frame(&mut renderer)?;
    let of_picture = renderer.begin_parts(&shot)? as usize;
    let (of_function, of_picture) = times.split_at(times.len() - of_picture);
    if !of_function.is_empty() {
        line(&format!("{name}: what a function has empty"), of_function);
    }
    line(&format!("{name}: frame"), of_picture);
    Ok(())
}

fn picture(gpu: &Arc<Gpu>) -> Result<Image, gpu::Error> {
    let [width, height] = EXTENT;
    let desc = ImageDesc {
        kind: ImageKind::D2,
        extent: [width, height, 1],
        format: FORMAT,
        usage: vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::TRANSFER_SRC,
        name: "picture",
    };
    Image::new(gpu, &desc)
}
