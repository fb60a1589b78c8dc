//! A30: how exact blending in 8 bits, in half and in single precision is, against the number of slices.
//!
//! A homogeneous medium of optical depth 1 in N slices of opacity a. A rounding of e made at each slice
//! decays as the slices in front of it absorb, so that together they are off by at most
//!
//! ```text
//! e (1 - (1 - a)^N) / a   <=   e min(N, 1/a)
//! ```

use crate::shared::{device, volume_of};
use ash::vk;
use glam::{DAffine3, DVec3};
use half::f16;
use std::sync::Arc;
use stratavox::camera::{Camera, Projection};
use stratavox::gpu::{
    Buffer, Headless, Image, ImageDesc, ImageKind, Load, Memory, Region, Use, begin_rendering,
    end_rendering, image_barrier, image_to_buffer,
};
use stratavox::picture::ColorSpace;
use stratavox::resident::{GpuTransfer, GpuVolume, TextureLayout};
use stratavox::technique::blend::Drawn;
use stratavox::technique::{
    Inputs, Mode, Order, Settings, ShaderVariant, Slicer, Technique, View, parameter_ring,
};
use stratavox::transfer::{ColorPoint, Interpolation, OpacityPoint, TransferFunction};
use stratavox::volume::Volume;

const COLOR: f64 = 0.8;
const EXTENT: [u32; 2] = [4, 4];
const VOXELS: u32 = 8;

/// Premultiplied red and alpha of the middle of a picture of `slices` slices, and how many there were.
fn drawn(device: &mut Headless, format: vk::Format, order: Order, slices: u32) -> [f64; 2] {
    let volume = volume_of([VOXELS; 3], DAffine3::IDENTITY, |_| 1.0);
    let center = volume.grid().center();
    let settings = Settings {
        technique: Technique::Slices3d,
        order,
        samples_per_voxel: f64::from(slices) / f64::from(VOXELS),
        conformance: true,
        color_space: ColorSpace::Display,
        ..Settings::default()
    };
    let camera = Camera {
        eye: center - 20.0 * DVec3::Z,
        target: center,
        up: DVec3::Y,
        projection: Projection::Orthographic { view_height: 6.0 },
        zoom: 1.0,
    };
    // Opacity per length of the box: optical depth 1.
    let transfer = TransferFunction {
        color: vec![ColorPoint {
            value: 0.0,
            srgb: [COLOR; 3],
        }],
        opacity: vec![OpacityPoint {
            value: 0.0,
            opacity: -(-1.0f64).exp_m1(),
        }],
        reference_length: Some(VOXELS.into()),
        interpolation: Interpolation::Linear,
        gradient_transfer: None,
        medium: None,
    };
    let gpu = Arc::clone(device.gpu());
    let voxels = uploaded(device, &volume);
    let length = f64::from(VOXELS);
    let table = GpuTransfer::new(&gpu, &transfer, length, ColorSpace::Display).unwrap();
    // SAFETY: recorded outside rendering; `run` waits, and `table` lives meanwhile.
    device
        .run(|cmd| unsafe { table.record_upload(cmd) })
        .unwrap();
    let grid = volume.grid();
    let view = View {
        grid: &grid,
        camera: &camera,
        extent_pixels: EXTENT,
        in_pixel: [0.0; 2].into(),
        settings: &settings,
    };
    let recording = view.recordings(&voxels, Some(&table)).unwrap()[0];
    let ring = parameter_ring(&gpu, 1).unwrap();
    let offset = recording.write(&ring, 0).unwrap();
    let planes = recording.slices;
    let words = ShaderVariant::of(&settings, &voxels);
    let drawn = Drawn::Picture(Mode::Composite);
    let slicer = Slicer::new(&gpu, Technique::Slices3d, drawn, order, &words, format).unwrap();
    let inputs = Inputs {
        beside: &[],
        light: None,
        points: None,
        field: None,
        sky: None,
        skip: stratavox::technique::Skip::Nothing,
        ring: &ring,
        volume: &voxels,
        brick: &voxels.bricks()[0],
        transfer: Some(&table),
    };
    let bindings = slicer.bind(&inputs).unwrap();
    let target = Image::new(
        &gpu,
        &ImageDesc {
            kind: ImageKind::D2,
            extent: [EXTENT[0], EXTENT[1], 1],
            format,
            usage: vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::TRANSFER_SRC,
            name: "target",
        },
    )
    .unwrap();
    let region = Region::whole(&target);
    let bytes = region.bytes(format).unwrap();
    let usage = vk::BufferUsageFlags::TRANSFER_DST;
    let back = Buffer::new(&gpu, bytes, usage, Memory::Readback, "readback").unwrap();
    let run = device.run(|cmd| {
        // SAFETY: recorded in order, with barriers between; `run` waits, and all that is bound lives meanwhile.
        unsafe {
            image_barrier(&gpu, cmd, &target, Use::Nothing, Use::ColorTarget);
            let clear = Load::Clear([0.0; 4]);
            begin_rendering(&gpu, cmd, &[(target.view(), clear)], EXTENT);
            slicer.record(cmd, &bindings, offset, EXTENT, 0..planes);
            end_rendering(&gpu, cmd);
            image_barrier(&gpu, cmd, &target, Use::ColorTarget, Use::TransferRead);
            image_to_buffer(&gpu, cmd, &target, region, &back, 0)
        }
    });
    run.unwrap();
    let mut texels = vec![0u8; bytes as usize];
    back.read(0, &mut texels).unwrap();
    [0, 3].map(|channel| decoded(format, &texels, 5 * 4 + channel))
}

fn uploaded(device: &mut Headless, volume: &Volume) -> GpuVolume {
    let made = GpuVolume::new(device.gpu(), volume, TextureLayout::Texture3d).unwrap();
    let staging = made.stage(volume).unwrap();
    // SAFETY: recorded outside rendering; `run` waits, and both live meanwhile.
    let run = device.run(|cmd| unsafe { made.record_upload_all(cmd, &staging) });
    run.unwrap();
    made
}

fn decoded(format: vk::Format, texels: &[u8], i: usize) -> f64 {
    match format {
        vk::Format::R8G8B8A8_UNORM => f64::from(texels[i]) / 255.0,
        vk::Format::R16G16B16A16_SFLOAT => {
            f16::from_le_bytes([texels[2 * i], texels[2 * i + 1]]).to_f64()
        }
        _ => f32::from_le_bytes(texels[4 * i..4 * i + 4].try_into().unwrap()).into(),
    }
}

/// Roundings of size e add up to at most this many e over N slices of opacity a.
fn effective(slices: u32, opacity: f64) -> f64 {
    if opacity <= 0.0 {
        return slices.into();
    }
    (1.0 - (1.0 - opacity).powf(slices.into())) / opacity
}

/// What red and alpha may be off by.
///
/// 8 bits: a device may turn the source into 8 bits before it blends, then multiply, then store: half a unit
/// each for the source's color and for its alpha (which the color behind it is multiplied with), and half for
/// the store. Slices whose opacity rounds to nothing damp nothing.
///
/// Floats: one rounding of the source, one of the product, one of the sum, of numbers up to the final one.
/// Under multiplies the source by 1 - A, whose own error adds as much again.
fn allowed(format: vk::Format, order: Order, slices: u32, exact: [f64; 2]) -> [f64; 2] {
    let opacity = -(-1.0 / f64::from(slices)).exp_m1();
    let feedback = if order == Order::FrontToBack {
        2.0
    } else {
        1.0
    };
    match format {
        vk::Format::R8G8B8A8_UNORM => {
            let half = 0.5 / 255.0;
            // With under, what is left shines through by 1 - A of the target: no damping by a rounded source.
            let damped = match order {
                Order::BackToFront => effective(slices, opacity - half),
                Order::FrontToBack => slices.into(),
            };
            [half * (2.0 + COLOR) * damped, half * 3.0 * damped]
        }
        _ => {
            let unit = match format {
                vk::Format::R16G16B16A16_SFLOAT => 2f64.powi(-11),
                _ => 2f64.powi(-24),
            };
            exact.map(|number| 3.0 * feedback * unit * number * effective(slices, opacity))
        }
    }
}

#[test]
fn blending_is_as_exact_as_its_format_allows() {
    let mut device = device();
    let exact_alpha = -(-1.0f64).exp_m1();
    let exact = [COLOR * exact_alpha, exact_alpha];
    let formats = [
        vk::Format::R8G8B8A8_UNORM,
        vk::Format::R16G16B16A16_SFLOAT,
        vk::Format::R32G32B32A32_SFLOAT,
    ];
    let mut checked = 0;
    for format in formats {
        if !device.gpu().format_features(format).blend {
            println!("skipped: this device does not blend {format:?}");
            continue;
        }
        for order in [Order::BackToFront, Order::FrontToBack] {
            // In 8 bits the allowance is all there is from 256 slices on.
            let is_coarse = format == vk::Format::R8G8B8A8_UNORM;
            let most = if is_coarse { 128 } else { 1024 };
            for slices in [16, 32, 64, 128, 256, 512, 1024]
                .into_iter()
                .filter(|&n| n <= most)
            {
                let found = drawn(&mut device, format, order, slices);
                let allowed = allowed(format, order, slices, exact);
                for (i, what) in [(0, "red"), (1, "alpha")] {
                    let error = found[i] - exact[i];
                    println!(
                        "{format:?} {order:?} {slices} slices, {what}: off by {:.5} of 1/255, allowed {:.5}",
                        255.0 * error,
                        255.0 * allowed[i]
                    );
                    assert!(
                        error.abs() <= allowed[i],
                        "{format:?} {order:?} {slices} slices, {what}: off by {error:e}, allowed {:e}",
                        allowed[i]
                    );
                    checked += 1;
                }
            }
        }
    }
    assert!(checked >= 2 * 2 * 4, "hardly any format can be blended");
}

#[test]
fn in_8_bits_512_slices_draw_nothing() {
    // Less than half a unit of 8 bits at a time comes to nothing, on every device: what the other test draws
    // in 8 bits is drawn in 8 bits.
    let mut device = device();
    for order in [Order::BackToFront, Order::FrontToBack] {
        let found = drawn(&mut device, vk::Format::R8G8B8A8_UNORM, order, 512);
        assert_eq!(found, [0.0, 0.0], "{order:?}");
    }
}
