//! The level that a device finds by itself, of texture coordinates that grow by so much a pixel.
//!
//! ```text
//! m = texels along u, v and w that a pixel adds        max m <= rho <= sqrt(2) sum m        |m| is exact
//! level = log2 of the larger rho, of a pixel to the right and of one down
//! ```

use super::derivative::SQUARE;
use super::lod::{self, BETWEEN, FORMAT, LEVELS, SIDE};
use super::{kit, raw};
use crate::conformance::case::{Case, Stop};
use crate::conformance::measurement::{Bound, Measurement};
use crate::conformance::stand::Stand;
use crate::gpu::{
    Bindings, Blend, DepthUse, Item, Load, RasterDesc, RasterPipeline, Resource, Sampler, Use,
    begin_rendering, end_rendering, image_barrier, set_area,
};
use crate::shaders::shader;
use ash::vk;
use glam::{DVec3, dvec3};
use std::sync::Arc;

const DERIVATION: &str = "Vulkan specification, scale factor operation: of the texels m that a pixel adds along each axis a device may take \
any continuous and rising function between the largest of them and sqrt(2) times their sum, and of both directions of the picture the \
larger; the level is its log2, with b bits behind the point (4 are the least of Vulkan). Outside of that fails; farther than 2^-b from \
log2 of the length of m, with b as reported, is a warning. Coordinates of up to 64 steps in 32-bit floats move a level by less than \
2^-12. Each level is of one number, and numbers rise with levels.";

const APPROXIMATE: &str = "the level that is found by derivatives is an approximation";

/// What each level is filled with: halves have them.
const NUMBERS: [f64; LEVELS as usize] = [1.0, 3.0, 7.0, 15.0];

/// What a pixel to the right adds and what one down does, in parts of a step: along axes, and across all of them.
const WAYS: [(&str, [DVec3; 2]); 2] = [
    ("implicit", [DVec3::X, DVec3::Y]),
    (
        "implicit_oblique",
        [dvec3(1.0, 0.5, 0.25), dvec3(0.25, 0.25, 0.5)],
    ),
];

/// Of a 3D image, to the nearest level and mixed.
pub fn cases() -> Vec<Case> {
    let color = vk::FormatFeatureFlags::COLOR_ATTACHMENT;
    let target = Item::Format(vk::Format::R32G32B32A32_SFLOAT, color);
    let mut cases = Vec::new();
    for (between_word, between) in BETWEEN {
        for (word, ways) in WAYS {
            let name = format!("probe.lod.3d.{between_word}.{word}");
            let case = Case::new(name, move |stand| measure(stand, between, ways));
            cases.push(case.needing(lod::need()).needing(target));
        }
    }
    cases
}

const EXTENT: [u32; 2] = [64, 16];

fn measure(
    stand: &mut Stand,
    between: vk::SamplerMipmapMode,
    ways: [DVec3; 2],
) -> Result<Measurement, Stop> {
    let device = stand.device()?;
    let gpu = Arc::clone(device.gpu());
    let level = |(level, number): (usize, &f64)| {
        let side = SIDE as usize >> level;
        half::f16::from_f64(*number)
            .to_le_bytes()
            .repeat(side * side * side)
    };
    let levels: Vec<Vec<u8>> = NUMBERS.iter().enumerate().map(level).collect();
    debug_assert_eq!(FORMAT, vk::Format::R16_SFLOAT);
    let image = lod::image(device, false, &levels)?;
    let clamp = vk::SamplerAddressMode::CLAMP_TO_EDGE;
    let info = vk::SamplerCreateInfo::default()
        .mag_filter(vk::Filter::NEAREST)
        .min_filter(vk::Filter::NEAREST)
        .mipmap_mode(between)
        .address_mode_u(clamp)
        .address_mode_v(clamp)
        .address_mode_w(clamp)
        .max_lod(16.0);
    let sampler = raw::sampler(&gpu, &info)?;
    let stand_in = Sampler::nearest_clamp(&gpu)?;
    let format = vk::Format::R32G32B32A32_SFLOAT;
    let target = kit::target(&gpu, format, EXTENT)?;
    let pipeline = RasterPipeline::new(
        &gpu,
        &RasterDesc {
            vertex: shader("probe/implicit_corners"),
            fragment: shader("probe/implicit_level"),
            target: format.into(),
            blend: Blend::Replace,
            depth: DepthUse::Ignored,
        },
    )?;
    let corners = kit::buffer(&gpu, &SQUARE, "corners")?;
    let steps = kit::buffer(&gpu, &[[0.0f32; 4]; 3], "steps")?;
    let layout = vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL;
    let given = [
        ("corners", Resource::Storage(&corners)),
        ("probed", Resource::Texture(image.view(), layout)),
        ("probed_sampler", Resource::Sampler(&stand_in)),
        ("steps", Resource::Storage(&steps)),
    ];
    let bindings = Bindings::new(&gpu, pipeline.layout(), &given)?;
    raw::rebind_sampler(&gpu, &bindings, 3, sampler.get());
    let bits = lod::bits(&gpu)[0];
    let bound = Bound::new("implicit-levels", DERIVATION).with("mipmapPrecisionBits", bits.into());
    let mut measurement = Measurement::new(bound, 1000);
    let largest = |of: fn(DVec3) -> f64| ways.map(of).into_iter().fold(0.0, f64::max).log2();
    let least = largest(|way| way.max_element());
    let most = largest(|way| way.element_sum()) + 0.5;
    let exact = largest(|way| way.length());
    for eighths in -4..=8 * LEVELS as i32 {
        let level = f64::from(eighths) / 8.0;
        let step = level.exp2() / f64::from(SIDE);
        let [right, down] = ways.map(|way| (step * way).as_vec3().extend(0.0).to_array());
        let size = [EXTENT[0] as f32, EXTENT[1] as f32, 0.0, 0.0];
        steps.write(0, bytemuck::cast_slice(&[right, down, size]))?;
        device.run(|cmd| {
            // SAFETY: recorded in order, with barriers between; `run` waits, and all that is bound lives meanwhile.
            unsafe {
                image_barrier(&gpu, cmd, &target, Use::Nothing, Use::ColorTarget);
                let clear = Load::Clear([0.0; 4]);
                begin_rendering(&gpu, cmd, &[(target.view(), clear)], EXTENT);
                set_area(&gpu, cmd, EXTENT);
                pipeline.draw(cmd, &bindings, &[], SQUARE.len() as u32, 0..1);
                end_rendering(&gpu, cmd);
            }
            Ok(())
        })?;
        let texels = kit::texels(device, &target, Use::ColorTarget)?;
        let must = legal(between, [level + least, level + most], 4);
        let should = legal(between, [level + exact; 2], bits);
        for pixel in 0..(EXTENT[0] * EXTENT[1]) as usize {
            let found = kit::number(format, &texels, 4 * pixel);
            let at = || format!("pixel {pixel} at level {level}");
            measurement.take_in(at, must, found, 1e-3);
            let [low, high] = should;
            let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
            measurement.prefer(APPROXIMATE, at, middle, found, half + 1e-3);
        }
    }
    Ok(measurement)
}

/// The smallest and the largest number that levels in a range may give: numbers rise with levels.
fn legal(between: vk::SamplerMipmapMode, [low, high]: [f64; 2], bits: u32) -> [f64; 2] {
    let last = f64::from(LEVELS - 1);
    let unit = 2f64.powi(-(bits as i32)) + 2f64.powi(-12);
    let (low, high) = (low - unit, high + unit);
    let bounded = |d: f64| d.clamp(0.0, last);
    if between == vk::SamplerMipmapMode::NEAREST {
        let first = bounded((bounded(low) + 0.5).ceil() - 1.0);
        let second = bounded((bounded(high) + 0.5).floor());
        return [NUMBERS[first as usize], NUMBERS[second as usize]];
    }
    [low, high].map(|d| {
        let d = bounded(d);
        let first = d.floor();
        let next = (first + 1.0).min(last);
        let (a, b) = (NUMBERS[first as usize], NUMBERS[next as usize]);
        a + (d - first) * (b - a)
    })
}
