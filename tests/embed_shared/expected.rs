//! What a host's image must hold, and how far a device may be off it.

use super::{HostImage, Stage};
use crate::shared::device;
use ash::vk;
use stratavox::color::encode_srgb;
use stratavox::gpu::Headless;
use stratavox::offscreen::Renderer;
use stratavox::scene::Scene;

/// What the arithmetic of a device may change in a CPU reference's picture of [`super::Stage`]: both compute in f32,
/// in the same order, and neither exactly.
///
/// Five roundings of voxel coordinates that are sums of numbers up to 200, on values that change by at most
/// 1/3 (the fade) + 1/4 (the waves) a voxel, on opacities that change by 0.25 while values change by 0.3, of at
/// most 40 samples, each of which lets the light behind it through or not. Colours change less.
fn arithmetic() -> f64 {
    let position_voxels = 5.0 * 200.0 * 2f64.powi(-24);
    let value = (1.0 / 3.0 + 1.0 / 4.0) * position_voxels;
    40.0 * 0.25 / 0.3 * value
}

/// The offscreen picture, in the numbers of [`HostImage::numbers`]: what hosts draw too, to the bit.
pub fn offscreen(stage: &Stage) -> Vec<[f64; 4]> {
    offscreen_with(stage, device())
}

/// The same on another device.
pub fn offscreen_with(stage: &Stage, device: Headless) -> Vec<[f64; 4]> {
    let scene = Scene {
        volume: &stage.volume,
        transfer: Some(&stage.transfer),
        beside: Default::default(),
        camera: &stage.camera,
        extent_pixels: stage.extent,
        settings: &stage.settings,
    };
    let mut renderer = Renderer::new(device, &stage.volume).unwrap();
    let rendered = renderer.render(&scene, &[]).unwrap();
    let pixels = rendered.picture.pixels;
    let seen = pixels.iter().filter(|pixel| pixel[3] > 0.1).count();
    assert!(seen > 100, "only {seen} pixels show anything");
    pixels.iter().map(|pixel| pixel.map(f64::from)).collect()
}

/// A premultiplied pixel over what the host has drawn, premultiplied too.
pub fn over(pixel: [f32; 4], behind: [f32; 4]) -> [f64; 4] {
    let left = 1.0 - f64::from(pixel[3]);
    std::array::from_fn(|c| f64::from(pixel[c]) + left * f64::from(behind[c]))
}

/// Compares what the host fetched with `wanted`, in the numbers that the target blends: linear light for
/// floats and `SRGB`, what is shown for `UNORM`. `blends` is how often each pixel was blended.
///
/// - Floats: source, product and sum are each rounded, to nearest or not, once a blend, of numbers up to 1.
/// - `UNORM`: half a unit each for the source's colour, for its alpha (times the target), and for the sum.
/// - `SRGB`: half a unit for the target as it is read, 0.6 for the result (Direct3D's functional specification
///   allows both, and Vulkan's devices are those); its alpha as `UNORM`.
#[track_caller]
pub fn assert_close(image: &HostImage, wanted: &[[f64; 4]], blends: u32, what: &str) {
    let found = image.numbers();
    assert_eq!(found.len(), wanted.len(), "{what}");
    let [width, _] = image.extent.map(|n| n as usize);
    let mut worst = (0.0, String::new());
    for (i, (wanted, found)) in wanted.iter().zip(&found).enumerate() {
        for c in 0..4 {
            let (stored, allowed) = stored(image.format, c, wanted[c], blends);
            let ratio = (found[c] - stored).abs() / allowed;
            // A NaN is no number's neighbour.
            if ratio.is_nan() || ratio > worst.0 {
                let (x, y) = (i % width, i / width);
                let text = format!(
                    "channel {c} of ({x}, {y}) is {}, wanted {stored} +- {allowed}",
                    found[c]
                );
                worst = (if ratio.is_nan() { f64::INFINITY } else { ratio }, text);
            }
        }
    }
    println!("{what}: {:.3} of what is allowed, {}", worst.0, worst.1);
    assert!(worst.0 <= 1.0, "{what}: {}", worst.1);
}

/// The number that a format stores for `wanted`, and how far it may be off.
fn stored(format: vk::Format, channel: usize, wanted: f64, blends: u32) -> (f64, f64) {
    let off = arithmetic();
    let roundings = 3.0 * f64::from(blends);
    match format {
        vk::Format::R32G32B32A32_SFLOAT => (wanted, off + roundings * 2f64.powi(-23)),
        vk::Format::R16G16B16A16_SFLOAT => (wanted, off + roundings * 2f64.powi(-10)),
        vk::Format::R8G8B8A8_SRGB if channel < 3 => {
            let level = |linear: f64| 255.0 * encode_srgb(linear.clamp(0.0, 1.0));
            let slack = level(wanted + off) - level(wanted - off);
            (level(wanted), 0.5 + 0.6 + slack)
        }
        _ => (255.0 * wanted, 1.5 + 255.0 * off),
    }
}
