//! Codes of formats to numbers and back: every code of 8 and of 16 bits, floats with their infinities and what is no
//! number.
//!
//! ```text
//! UNORM of b bits    code / (2^b - 1), and round(that (2^b - 1)) is the code        SFLOAT    the number itself
//! ```

use super::kit;
use crate::conformance::case::{Case, Stop};
use crate::conformance::measurement::{Bound, Measurement};
use crate::conformance::test_bed::TestBed;
use crate::gpu::{ImageKind, Item, Resource};
use ash::vk;
use half::f16;
use std::sync::Arc;

/// Half a unit in the last place of an f32 at 1.
const U: f64 = 1.0 / (1u32 << 24) as f64;

const UNORM: &str = "code / (2^b - 1) is a division, or a product with a rounded number and two roundings: 3 x 2^-24 of the result. \
The code comes back by rounding where the error is under half a code, which is checked with the same number.";
const FLOAT: &str = "A float is fetched as it is. Numbers too small to be normal may become zero (Vulkan lets shaders flush \
them), which is a warning, and what is no number stays none.";
/// Every format that volumes have.
pub fn cases() -> Vec<Case> {
    let sampled = |format| Item::Format(format, vk::FormatFeatureFlags::SAMPLED_IMAGE);
    let unorm = |name, format, bits| {
        Case::new(name, move |bed| unorm(bed, format, bits)).needing(sampled(format))
    };
    vec![
        unorm("probe.fetch.r8_unorm.every_code", vk::Format::R8_UNORM, 8),
        unorm(
            "probe.fetch.r16_unorm.every_code",
            vk::Format::R16_UNORM,
            16,
        ),
        Case::new("probe.fetch.r16_sfloat.every_code", halves)
            .needing(sampled(vk::Format::R16_SFLOAT)),
        Case::new("probe.fetch.r32_sfloat.all_kinds", singles)
            .needing(sampled(vk::Format::R32_SFLOAT)),
    ]
}

/// The first channels of texels, as bits of f32.
fn fetched(
    bed: &mut TestBed,
    extent: [u32; 3],
    format: vk::Format,
    texels: &[u8],
) -> Result<Vec<u32>, Stop> {
    let device = bed.device()?;
    let gpu = Arc::clone(device.gpu());
    let probed = kit::image(device, ImageKind::D3, extent, format, texels)?;
    let count = extent.iter().product::<u32>();
    let found = kit::zeros::<u32>(&gpu, count as usize, "found")?;
    let given = [
        ("probed", Resource::sampled(&probed)),
        ("found", Resource::Storage(&found)),
    ];
    kit::compute(device, "probe/fetch", &given, [count.div_ceil(64), 1, 1])?;
    kit::read(&found)
}

/// As many texels as a format of 16 bits has codes.
const WIDE: [u32; 3] = [64, 64, 16];

fn unorm(bed: &mut TestBed, format: vk::Format, bits: u32) -> Result<Measurement, Stop> {
    let count = 1u32 << bits;
    let (extent, texels): (_, Vec<u8>) = match bits {
        8 => ([16, 4, 4], (0..=u8::MAX).collect()),
        _ => (WIDE, (0..=u16::MAX).flat_map(u16::to_le_bytes).collect()),
    };
    let found = fetched(bed, extent, format, &texels)?;
    let most = f64::from(count - 1);
    let mut measurement = Measurement::new(Bound::new("unorm", UNORM), count as usize);
    for (code, bits) in found.into_iter().enumerate() {
        let found = f64::from(f32::from_bits(bits));
        let wanted = code as f64 / most;
        measurement.take(
            || format!("code {code}"),
            wanted,
            found,
            6.0 * U * wanted + f64::MIN_POSITIVE,
        );
        let back = (found * most).round();
        measurement.take(
            || format!("code {code}, rounded back"),
            code as f64,
            back,
            0.5,
        );
    }
    Ok(measurement)
}

fn halves(bed: &mut TestBed) -> Result<Measurement, Stop> {
    let texels: Vec<u8> = (0..=u16::MAX).flat_map(u16::to_le_bytes).collect();
    let found = fetched(bed, WIDE, vk::Format::R16_SFLOAT, &texels)?;
    let wanted = (0..=u16::MAX).map(f16::from_bits);
    let mut measurement = Measurement::new(Bound::new("float", FLOAT), 65_536);
    for (wanted, found) in wanted.zip(found) {
        let is_tiny = wanted.to_f64() != 0.0 && wanted.to_f64().abs() < f16::MIN_POSITIVE.to_f64();
        float(
            &mut measurement,
            wanted.to_f64(),
            f32::from_bits(found),
            is_tiny,
        );
    }
    Ok(measurement)
}

fn singles(bed: &mut TestBed) -> Result<Measurement, Stop> {
    let mut random = bed.random("singles");
    let mut numbers = vec![
        0.0,
        -0.0,
        1.0,
        f32::MAX,
        f32::MIN,
        f32::MIN_POSITIVE,
        1e-40,
        -1e-40,
        f32::INFINITY,
        f32::NEG_INFINITY,
        f32::NAN,
        -f32::NAN,
    ];
    numbers.resize_with(4096, || f32::from_bits(random.bits() as u32));
    let texels: Vec<u8> = numbers
        .iter()
        .flat_map(|number| number.to_le_bytes())
        .collect();
    let found = fetched(bed, [16, 16, 16], vk::Format::R32_SFLOAT, &texels)?;
    let mut measurement = Measurement::new(Bound::new("float", FLOAT), 4096);
    for (&wanted, found) in numbers.iter().zip(found) {
        let is_tiny = wanted.is_subnormal();
        float(
            &mut measurement,
            wanted.into(),
            f32::from_bits(found),
            is_tiny,
        );
    }
    Ok(measurement)
}

fn float(measurement: &mut Measurement, wanted: f64, found: f32, is_tiny: bool) {
    let at = || format!("the number {wanted:e}");
    let found = f64::from(found);
    match is_tiny {
        true => {
            measurement.take(at, wanted, found, wanted.abs());
            measurement.prefer(
                "numbers too small to be normal become zero",
                at,
                wanted,
                found,
                0.0,
            );
        }
        false if wanted.is_nan() => measurement.hold(at, found.is_nan()),
        false => measurement.take(at, wanted, found, 0.0),
    }
}
