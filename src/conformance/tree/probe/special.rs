//! Infinities, zeros of both signs and what is no number: in shaders that ask for them, in storage images, in blending.

use super::kit::{self, Drawing};
use crate::conformance::case::{Case, Stop};
use crate::conformance::measurement::{Bound, Measurement};
use crate::conformance::need::Want;
use crate::conformance::stand::Stand;
use crate::gpu::{Blend, Image, ImageDesc, ImageKind, Item, Resource, Use, image_barrier};
use ash::vk;
use std::sync::Arc;

const ARITHMETIC: &str = "SignedZeroInfNanPreserve (Vulkan specification, float controls; the shader declares it): sums, differences, \
products and negations of these numbers are those of IEEE 754, exactly, with the signs of zero. Of minima and maxima (FMin, FMax of \
GLSL.std.450) an operand that is no number leaves the result open, and so does the sign of zeros: neither is asked for. What is no number \
is less than nothing.";
const STORED: &str = "Vulkan specification, floating-point format conversions: infinities stay infinities and what is no number stays \
none; what is larger than the largest half becomes that or an infinity.";
const BLENDED: &str = "Vulkan specification, floating-point computation: blending may support infinities and what is no number. What does \
not is a warning; all that is finite is exact (sums of small whole numbers).";

const PICKED: [f32; 8] = [
    f32::INFINITY,
    f32::NEG_INFINITY,
    f32::NAN,
    0.0,
    -0.0,
    1.0,
    -2.5,
    0.25,
];

/// Arithmetic, storage images of both sizes of float, blending.
pub fn cases() -> Vec<Case> {
    let wide = vk::Format::R32G32B32A32_SFLOAT;
    let half = vk::Format::R16G16B16A16_SFLOAT;
    let mut cases =
        vec![Case::new("probe.special.arithmetic", arithmetic).wanting(Want::SpecialFloats)];
    for (word, format) in [("rgba32_sfloat", wide), ("rgba16_sfloat", half)] {
        let name = format!("probe.special.store.{word}");
        let storage = Item::Format(format, vk::FormatFeatureFlags::STORAGE_IMAGE);
        let case = Case::new(name, move |stand| stored(stand, format));
        cases.push(case.needing(storage).wanting(Want::SpecialFloats));
        let name = format!("probe.special.blend.add.{word}");
        let color = vk::FormatFeatureFlags::COLOR_ATTACHMENT;
        let blend = color | vk::FormatFeatureFlags::COLOR_ATTACHMENT_BLEND;
        let case = Case::new(name, move |stand| blended(stand, format));
        cases.push(case.needing(Item::Format(format, blend)));
    }
    cases
}

/// The same number: the sign of zero counts, and what is no number is like any other.
fn same(measurement: &mut Measurement, at: impl Fn() -> String, wanted: f32, found: f32) {
    measurement.take(&at, wanted.into(), found.into(), 0.0);
    if wanted == 0.0 {
        let is_same = wanted.is_sign_negative() == found.is_sign_negative();
        measurement.hold(|| format!("the sign of {}", at()), is_same);
    }
}

fn arithmetic(stand: &mut Stand) -> Result<Measurement, Stop> {
    let pairs: Vec<[f32; 2]> = PICKED
        .iter()
        .flat_map(|&a| PICKED.map(|b| [a, b]))
        .collect();
    let device = stand.device()?;
    let gpu = Arc::clone(device.gpu());
    let given = kit::buffer(&gpu, &pairs, "pairs")?;
    let found = kit::zeros::<[f32; 8]>(&gpu, pairs.len(), "found")?;
    let resources = [
        ("pairs", Resource::Storage(&given)),
        ("found", Resource::Storage(&found)),
    ];
    kit::compute(device, "probe/specials", &resources, [1, 1, 1])?;
    let found: Vec<[f32; 8]> = kit::read(&found)?;
    let mut measurement = Measurement::new(Bound::new("special-arithmetic", ARITHMETIC), 400);
    for (&[a, b], found) in pairs.iter().zip(found) {
        let wanted = [("+", a + b), ("-", a - b), ("*", a * b), ("negated", -a)];
        for ((word, wanted), found) in wanted.into_iter().zip(found) {
            same(
                &mut measurement,
                || format!("{a} {word} {b}"),
                wanted,
                found,
            );
        }
        if !a.is_nan() && !b.is_nan() {
            let at = |word: &str| format!("the {word} of {a} and {b}");
            measurement.take(|| at("smaller"), a.min(b).into(), found[4].into(), 0.0);
            measurement.take(|| at("larger"), a.max(b).into(), found[5].into(), 0.0);
        }
        measurement.take(|| format!("|{a}|"), a.abs().into(), found[6].into(), 0.0);
        let less = f64::from(u8::from(a < b));
        measurement.take(|| format!("{a} < {b}"), less, found[7].into(), 0.0);
    }
    Ok(measurement)
}

fn stored(stand: &mut Stand, format: vk::Format) -> Result<Measurement, Stop> {
    const SIDE: u32 = 16;
    let numbers: Vec<f32> = PICKED
        .into_iter()
        .chain([
            65_504.0,
            -65_504.0,
            70_000.0,
            -1e30,
            f32::MAX,
            f32::MIN,
            2.0,
            -1.0,
        ])
        .cycle()
        .take(4 * (SIDE * SIDE) as usize)
        .collect();
    let is_half = format == vk::Format::R16G16B16A16_SFLOAT;
    let shader = match is_half {
        true => "probe/specials_store.rgba16float",
        false => "probe/specials_store.rgba32float",
    };
    let device = stand.device()?;
    let gpu = Arc::clone(device.gpu());
    let desc = ImageDesc {
        kind: ImageKind::D2,
        extent: [SIDE, SIDE, 1],
        format,
        usage: vk::ImageUsageFlags::STORAGE | vk::ImageUsageFlags::TRANSFER_SRC,
        name: "stored",
    };
    let image = Image::new(&gpu, &desc)?;
    let given = kit::buffer(&gpu, &numbers, "numbers")?;
    device.run(|cmd| {
        // SAFETY: recorded outside rendering; `run` waits.
        unsafe { image_barrier(&gpu, cmd, &image, Use::Nothing, Use::ComputeWrite) };
        Ok(())
    })?;
    let resources = [
        ("stored", Resource::written(&image)),
        ("numbers", Resource::Storage(&given)),
    ];
    kit::compute(device, shader, &resources, [SIDE / 8, SIDE / 8, 1])?;
    let texels = kit::texels(device, &image, Use::ComputeWrite)?;
    let mut measurement = Measurement::new(Bound::new("special-store", STORED), 1000);
    for (i, &wanted) in numbers.iter().enumerate() {
        let found = kit::number(format, &texels, i);
        let at = || format!("{wanted}");
        let is_too_large = is_half && wanted.is_finite() && wanted.abs() > 65_504.0;
        match is_too_large {
            true => {
                let is_one = found.abs() == 65_504.0 || found.is_infinite();
                let is_legal = is_one && found.is_sign_negative() == wanted.is_sign_negative();
                measurement.hold(at, is_legal);
            }
            false => same(&mut measurement, at, wanted, found as f32),
        }
    }
    Ok(measurement)
}

fn blended(stand: &mut Stand, format: vk::Format) -> Result<Measurement, Stop> {
    const COVER: [[f32; 4]; 3] = [
        [-1.0, -1.0, 0.0, 1.0],
        [3.0, -1.0, 0.0, 1.0],
        [-1.0, 3.0, 0.0, 1.0],
    ];
    let (low, high) = (f32::NEG_INFINITY, f32::INFINITY);
    let colors = [
        [1.0, high, low, 2.0],
        [4.0, 1.0, 3.0, high],
        [8.0, 1.0, -1.0, low],
    ];
    let wanted = [13.0, high, low, f32::NAN];
    let drawing = Drawing {
        format,
        extent: [16, 16],
        clear: [0.0; 4],
        blend: Blend::Add,
        corners: &COVER,
        colors: &colors,
        instances: 3,
    };
    let texels = kit::draw(stand, &drawing)?;
    let mut measurement = Measurement::new(Bound::new("special-blend", BLENDED), 256);
    for i in 0..4 * 256 {
        let found = kit::number(format, &texels, i);
        let wanted = f64::from(wanted[i % 4]);
        let at = || format!("channel {}", i % 4);
        match wanted.is_finite() {
            true => measurement.take(at, wanted, found, 0.0),
            false => {
                let meaning = "blending does not support infinities and what is no number";
                measurement.prefer(meaning, at, wanted, found, 0.0);
            }
        }
    }
    Ok(measurement)
}
