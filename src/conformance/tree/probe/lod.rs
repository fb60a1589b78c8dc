//! Levels of detail: which levels a sampler reads, and how it mixes two of them.
//!
//! ```text
//! l = clamp(level asked for + mipLodBias, minLod, maxLod)        d = clamp(l, 0, levels - 1)
//! NEAREST    the level that d is nearest to        LINEAR    (1 - f) of floor(d) and f of the next, f = d - floor(d)
//! ```

use super::filter::{legal, texels_of};
use super::raw::{self, RawImage};
use super::{kit, lod_implicit};
use crate::conformance::case::{Case, Stop};
use crate::conformance::measurement::{Bound, Measurement};
use crate::conformance::need::Want;
use crate::conformance::stand::{Random, Stand};
use crate::gpu::{Bindings, ComputePipeline, Gpu, Item, Resource, Sampler, Use};
use crate::shaders::shader;
use ash::vk;
use std::sync::Arc;

const DERIVATION: &str = "Vulkan specification, LOD operation and image level selection: the level is asked for, the sampler's bias is \
added, minLod, maxLod and the levels there are bound it. It has b bits behind the point (4 are the least of Vulkan: outside of that \
fails; mipmapPrecisionBits as reported: outside is a warning) and may be rounded either way: of NEAREST either level is legal within \
2^-b of the middle of two, of LINEAR the share of the next level lies between its two neighbours of b bits. Inside of a level the legal \
weights are those of probe.filter; 16-bit floats are rounded once an axis and once between levels, 2^-11 of the largest texel each.";

const COARSE: &str =
    "levels are chosen or mixed more coarsely than the bits that the device reports";

/// Texels along each axis of level 0, and levels down to a single one.
pub const SIDE: u32 = 8;
pub const LEVELS: u32 = 4;
pub const FORMAT: vk::Format = vk::Format::R16_SFLOAT;

/// What the sampler makes of the level that is asked for.
#[derive(Clone, Copy)]
struct Bounds {
    bias: f32,
    least: f32,
    most: f32,
}

/// Kinds of image, filters inside and between levels, bounds of the level.
pub fn cases() -> Vec<Case> {
    let bounds = [
        ("explicit", 0.0, 0.0, 16.0),
        ("clamped", 0.0, 0.75, 2.25),
        ("biased_up", 1.5, 0.0, 16.0),
        ("biased_down", -0.625, 0.0, 16.0),
        ("biased_and_clamped", 3.0, 0.5, 1.25),
    ];
    let mut cases = Vec::new();
    for (kind_word, is_array) in [("3d", false), ("2d_array", true)] {
        for (inside_word, inside) in FILTERS {
            for (between_word, between) in BETWEEN {
                for (word, bias, least, most) in bounds {
                    let of = Of {
                        is_array,
                        minified: inside,
                        magnified: inside,
                        between,
                        bounds: Bounds { bias, least, most },
                    };
                    let name = format!("probe.lod.{kind_word}.{inside_word}.{between_word}.{word}");
                    cases.push(of.case(name));
                }
            }
        }
        let of = Of {
            is_array,
            minified: vk::Filter::NEAREST,
            magnified: vk::Filter::LINEAR,
            between: vk::SamplerMipmapMode::NEAREST,
            bounds: Bounds {
                bias: 0.0,
                least: -16.0,
                most: 16.0,
            },
        };
        cases.push(of.case(format!("probe.lod.{kind_word}.magnified_or_minified")));
    }
    cases.extend(lod_implicit::cases());
    cases
}

const FILTERS: [(&str, vk::Filter); 2] = [
    ("nearest", vk::Filter::NEAREST),
    ("linear", vk::Filter::LINEAR),
];

/// Filters between levels.
pub const BETWEEN: [(&str, vk::SamplerMipmapMode); 2] = [
    ("to_nearest", vk::SamplerMipmapMode::NEAREST),
    ("mixed", vk::SamplerMipmapMode::LINEAR),
];

/// What cases of levels need of their format.
pub fn need() -> Item {
    let features = vk::FormatFeatureFlags::SAMPLED_IMAGE;
    Item::Format(
        FORMAT,
        features | vk::FormatFeatureFlags::SAMPLED_IMAGE_FILTER_LINEAR,
    )
}

#[derive(Clone, Copy)]
struct Of {
    is_array: bool,
    minified: vk::Filter,
    magnified: vk::Filter,
    between: vk::SamplerMipmapMode,
    bounds: Bounds,
}

/// Texels of each level, x fastest.
pub type Levels = Vec<Vec<f64>>;

impl Of {
    fn case(self, name: String) -> Case {
        let seeded = name.clone();
        let case = Case::new(name, move |stand| self.measure(stand, &seeded)).needing(need());
        match self.bounds.bias == 0.0 {
            true => case,
            false => case.wanting(Want::SamplerBias),
        }
    }

    fn measure(self, stand: &mut Stand, name: &str) -> Result<Measurement, Stop> {
        let mut random = stand.random(name);
        let device = stand.device()?;
        let gpu = Arc::clone(device.gpu());
        let (codes, levels) = random_levels(self.is_array, &mut random);
        let image = image(device, self.is_array, &codes)?;
        let asked = self.asked(&mut random);
        let coordinates: Vec<[f32; 4]> = asked.iter().map(|a| self.coordinates(*a)).collect();
        let clamp = vk::SamplerAddressMode::CLAMP_TO_EDGE;
        let info = vk::SamplerCreateInfo::default()
            .mag_filter(self.magnified)
            .min_filter(self.minified)
            .mipmap_mode(self.between)
            .address_mode_u(clamp)
            .address_mode_v(clamp)
            .address_mode_w(clamp)
            .mip_lod_bias(self.bounds.bias)
            .min_lod(self.bounds.least)
            .max_lod(self.bounds.most);
        let sampler = raw::sampler(&gpu, &info)?;
        let stand_in = Sampler::nearest_clamp(&gpu)?;
        let places = kit::buffer(&gpu, &coordinates, "places")?;
        let found = kit::zeros::<f32>(&gpu, coordinates.len(), "found")?;
        let layout = vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL;
        let given = [
            ("probed", Resource::Texture(image.view(), layout)),
            ("probed_sampler", Resource::Sampler(&stand_in)),
            ("places", Resource::Storage(&places)),
            ("found", Resource::Storage(&found)),
        ];
        let pipeline = ComputePipeline::new(
            &gpu,
            shader(match self.is_array {
                true => "probe/levels_array",
                false => "probe/levels_3d",
            }),
        )?;
        let bindings = Bindings::new(&gpu, pipeline.layout(), &given)?;
        raw::rebind_sampler(&gpu, &bindings, 1, sampler.get());
        let groups = [(coordinates.len() as u32).div_ceil(64), 1, 1];
        device.run(|cmd| {
            // SAFETY: recorded outside rendering; `run` waits, and all that is bound lives meanwhile.
            unsafe { pipeline.dispatch(cmd, &bindings, &[], groups) };
            Ok(())
        })?;
        let found = kit::read(&found)?;
        Ok(self.compare(&levels, &asked, &found, bits(&gpu)))
    }

    /// Places in texels of level 0, at their centres, and levels from below the first to beyond the last.
    fn asked(self, random: &mut Random) -> Vec<([f64; 3], f64)> {
        let mut asked = Vec::new();
        let finest = 64;
        for i in -finest..=finest * LEVELS as i32 {
            for _ in 0..8 {
                let place = [0; 3].map(|_| f64::from(random.below(SIDE)) + 0.5);
                asked.push((place, f64::from(i) / f64::from(finest)));
            }
        }
        asked
    }

    fn coordinates(self, (place, level): ([f64; 3], f64)) -> [f32; 4] {
        let [x, y, z] = place;
        let side = f64::from(SIDE);
        let z = if self.is_array { z - 0.5 } else { z / side };
        [(x / side) as f32, (y / side) as f32, z as f32, level as f32]
    }

    fn compare(
        self,
        levels: &Levels,
        asked: &[([f64; 3], f64)],
        found: &[f32],
        bits: [u32; 2],
    ) -> Measurement {
        let [of_levels, of_texels] = bits;
        let bound = Bound::new("levels", DERIVATION)
            .with("mipmapPrecisionBits", of_levels.into())
            .with("subTexelPrecisionBits", of_texels.into());
        let mut measurement = Measurement::new(bound, 1000);
        let all = levels.iter().flatten();
        let largest = all.fold(0.0f64, |most, v| most.max(v.abs()));
        let coarse = 4.0 / 2048.0 * largest;
        let fine = 32.0 / f64::from(1u32 << 24) * largest;
        for (&(place, level), &found) in asked.iter().zip(found) {
            let at = || format!("level {level} of place {place:?}");
            let must = self.legal(levels, place, level, [4, 4]);
            measurement.take_in(at, nearest(&must, found), found.into(), coarse);
            let [low, high] = nearest(&self.legal(levels, place, level, bits), found);
            let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
            measurement.prefer(COARSE, at, middle, found.into(), half + fine);
        }
        measurement
    }

    /// All that a look-up may give, as ranges.
    fn legal(self, levels: &Levels, place: [f64; 3], asked: f64, bits: [u32; 2]) -> Vec<[f64; 2]> {
        let Bounds { bias, least, most } = self.bounds;
        let level = asked + f64::from(bias);
        let level = level.clamp(f64::from(least), f64::from(most));
        let last = f64::from(LEVELS - 1);
        let unit = 2f64.powi(-(bits[0] as i32));
        // Where a level is nearly 0, either filter.
        let mut filters = Vec::new();
        if level <= unit {
            filters.push(self.magnified);
        }
        if level > -unit {
            filters.push(self.minified);
        }
        let mut ranges = Vec::new();
        for filter in filters {
            let one = |k: f64| self.inside(levels, k as usize, place, filter, bits[1]);
            let d = level.clamp(0.0, last);
            if self.between == vk::SamplerMipmapMode::NEAREST {
                let low = ((d - unit + 0.5).ceil() - 1.0).clamp(0.0, last);
                let high = (d + unit + 0.5).floor().clamp(0.0, last);
                let mut k = low;
                while k <= high {
                    ranges.push(one(k));
                    k += 1.0;
                }
                continue;
            }
            let mut range = [f64::INFINITY, f64::NEG_INFINITY];
            for d in [(d / unit).floor() * unit, (d / unit).ceil() * unit] {
                let first = d.floor();
                let (a, b) = (one(first), one((first + 1.0).min(last)));
                let mixed = |i: usize| a[i] + (d - first) * (b[i] - a[i]);
                range = [range[0].min(mixed(0)), range[1].max(mixed(1))];
            }
            ranges.push(range);
        }
        ranges
    }

    fn inside(
        self,
        levels: &Levels,
        level: usize,
        place: [f64; 3],
        filter: vk::Filter,
        bits: u32,
    ) -> [f64; 2] {
        let side = i64::from(SIDE >> level);
        let scale = f64::from(1u32 << level);
        let [x, y, z] = place;
        let place = [
            x / scale,
            y / scale,
            if self.is_array { z } else { z / scale },
        ];
        let deep = if self.is_array { i64::from(SIDE) } else { side };
        let texel = |[x, y, z]: [i64; 3]| {
            let [x, y] = [x, y].map(|n| n.clamp(0, side - 1));
            levels[level][(x + side * (y + side * z.clamp(0, deep - 1))) as usize]
        };
        match filter {
            vk::Filter::NEAREST => [texel(place.map(|p| p.floor() as i64)); 2],
            _ => {
                let layer = self.is_array.then(|| place[2].floor() as i64);
                legal(&texel, place, layer, bits)
            }
        }
    }
}

/// The range that a number is in, or nearest to.
fn nearest(ranges: &[[f64; 2]], found: f32) -> [f64; 2] {
    let found = f64::from(found);
    let off = |[low, high]: &[f64; 2]| (low - found).max(found - high);
    let least = ranges.iter().min_by(|a, b| off(a).total_cmp(&off(b)));
    *least.unwrap_or(&[f64::NAN; 2])
}

/// `mipmapPrecisionBits` and `subTexelPrecisionBits`.
pub fn bits(gpu: &Gpu) -> [u32; 2] {
    let instance = gpu.instance();
    // SAFETY: the physical device belongs to the instance; both live as long as `gpu`.
    let limits = unsafe { instance.get_physical_device_properties(gpu.physical_device()) }.limits;
    [
        limits.mipmap_precision_bits,
        limits.sub_texel_precision_bits,
    ]
}

fn random_levels(is_array: bool, random: &mut Random) -> (Vec<Vec<u8>>, Levels) {
    let level = |level: u32| {
        let side = SIDE >> level;
        let deep = if is_array { SIDE } else { side };
        let codes: Vec<u32> = (0..side * side * deep)
            .map(|_| random.below(65_536))
            .collect();
        texels_of(FORMAT, &codes)
    };
    (0..LEVELS).map(level).unzip()
}

/// An image of all levels, for shaders to read.
pub fn image(
    device: &mut crate::gpu::Headless,
    is_array: bool,
    levels: &[Vec<u8>],
) -> Result<RawImage, Stop> {
    let gpu = Arc::clone(device.gpu());
    let (kind, depth, layers) = match is_array {
        true => (vk::ImageType::TYPE_2D, 1, SIDE),
        false => (vk::ImageType::TYPE_3D, SIDE, 1),
    };
    let info = vk::ImageCreateInfo::default()
        .image_type(kind)
        .format(FORMAT)
        .extent(vk::Extent3D {
            width: SIDE,
            height: SIDE,
            depth,
        })
        .mip_levels(LEVELS)
        .array_layers(layers)
        .samples(vk::SampleCountFlags::TYPE_1)
        .usage(vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST);
    let image = RawImage::new(&gpu, &info, vk::ImageAspectFlags::COLOR)?;
    // Each level begins at a multiple of four bytes.
    let aligned = |texels: &Vec<u8>| texels.len().next_multiple_of(4);
    let bytes: usize = levels.iter().map(aligned).sum();
    let from = raw::copied(&gpu, bytes as u64, true)?;
    let mut regions = Vec::new();
    let mut offset = 0;
    for (level, texels) in (0u32..).zip(levels) {
        from.write(offset, texels)?;
        regions.push(image.level(level, [SIDE >> level; 3], offset));
        offset += aligned(texels) as u64;
    }
    device.run(|cmd| {
        let to = vk::ImageLayout::TRANSFER_DST_OPTIMAL;
        // SAFETY: recorded outside rendering, with barriers between; `run` waits, and both live meanwhile.
        unsafe {
            image.barrier(cmd, Use::Nothing.state(), Use::TransferWrite.state());
            let raw = gpu.device();
            for region in regions {
                raw.cmd_copy_buffer_to_image(cmd, from.raw(), image.raw(), to, &[region]);
            }
            image.barrier(cmd, Use::TransferWrite.state(), Use::Sampled.state());
        }
        Ok(())
    })?;
    Ok(image)
}
