//! What a sampler makes of every sub-texel position: the set of legal results.
//!
//! ```text
//! a weight w is rounded to b bits, either way:  floor(w 2^b) 2^-b <= w' <= ceil(w 2^b) 2^-b
//! the result is linear in each weight, so the extremes of all legal ones lie at corners of that box
//! ```
//!
//! With b as the device reports it (`subTexelPrecisionBits`) the result should be inside; with 4, the least that Vulkan
//! demands, it must be.

use super::kit;
use crate::conformance::case::{Case, Stop};
use crate::conformance::measurement::{Bound, Measurement};
use crate::conformance::test_bed::{Random, TestBed};
use crate::gpu::{Image, ImageKind, Item, Resource, Sampler};
use ash::vk;
use std::sync::Arc;

const DERIVATION: &str = "A weight of the sampler has b bits and may be rounded either way: the result lies between the extremes at \
the corners of the box of weights. b = 4 is the least of Vulkan (a result outside of it fails), the reported b is what it should be \
(a result outside is a warning). Vulkan does not say how exactly texels are weighed: the products of the weights, of n texels, may be \
rounded to the reported bits too (n 2^-(b+1) of the largest texel: more than the box alone is a warning); a device that keeps the texels' own precision \
rounds once an axis, half a unit of the format each (3 units of 2^-11 or 2^-24 of the largest texel for floats); one that computes in \
f32 is within 16 x 2^-24.";

const COARSE: &str =
    "weights or texels are coarser than the sub-texel bits that the device reports";

/// Texels along each axis: a power of two, so that places are exact in f32.
const SIDE: u32 = 4;

const FORMATS: [(&str, vk::Format); 4] = [
    ("r8_unorm", vk::Format::R8_UNORM),
    ("r16_unorm", vk::Format::R16_UNORM),
    ("r16_sfloat", vk::Format::R16_SFLOAT),
    ("r32_sfloat", vk::Format::R32_SFLOAT),
];

/// Where places lie.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Places {
    /// Along one axis, 512 between each two texels.
    Along(usize),
    /// Anywhere inside.
    Random,
    /// Far beyond the edges too.
    Beyond,
    /// At the centres of texels: a texel itself.
    Centers,
}

/// Kinds of image, formats, places, filters.
pub fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for (kind_word, kind) in [("3d", ImageKind::D3), ("2d_array", ImageKind::D2Array)] {
        for (format_word, format) in FORMATS {
            for (places_word, places) in [
                ("along_x", Places::Along(0)),
                ("along_y", Places::Along(1)),
                ("along_z", Places::Along(2)),
                ("random", Places::Random),
                ("beyond_edges", Places::Beyond),
                ("centers", Places::Centers),
            ] {
                if kind == ImageKind::D2Array && places == Places::Along(2) {
                    continue;
                }
                for is_linear in [true, false] {
                    let word = if is_linear { "linear" } else { "nearest" };
                    let name =
                        format!("probe.filter.{kind_word}.{word}.{format_word}.{places_word}");
                    let of = Of {
                        kind,
                        format,
                        places,
                        is_linear,
                    };
                    let mut features = vk::FormatFeatureFlags::SAMPLED_IMAGE;
                    if is_linear {
                        features |= vk::FormatFeatureFlags::SAMPLED_IMAGE_FILTER_LINEAR;
                    }
                    let seeded = name.clone();
                    let case = Case::new(name, move |bed| of.measure(bed, &seeded));
                    cases.push(case.needing(Item::Format(format, features)));
                }
            }
        }
    }
    cases
}

#[derive(Clone, Copy)]
struct Of {
    kind: ImageKind,
    format: vk::Format,
    places: Places,
    is_linear: bool,
}

impl Of {
    fn measure(self, bed: &mut TestBed, name: &str) -> Result<Measurement, Stop> {
        let mut random = bed.random(name);
        let count = (SIDE * SIDE * SIDE) as usize;
        let codes: Vec<u32> = (0..count).map(|_| random.below(65_536)).collect();
        let (bytes, values) = texels_of(self.format, &codes);
        let places = self.places(&mut random);
        let device = bed.device()?;
        let gpu = Arc::clone(device.gpu());
        let probed = kit::image(device, self.kind, [SIDE; 3], self.format, &bytes)?;
        let sampler = match self.is_linear {
            true => Sampler::linear_clamp(&gpu)?,
            false => Sampler::nearest_clamp(&gpu)?,
        };
        let coordinates: Vec<[f32; 4]> = places.iter().map(|&p| self.coordinates(p)).collect();
        let found = ask(bed, &self, &probed, &sampler, &coordinates)?;
        let bits = bed.device()?.gpu().limits().subtexel_bits;
        Ok(self.compare(&values, &places, &found, bits))
    }

    /// In texels, centres at +0.5: exact in f32.
    fn places(self, random: &mut Random) -> Vec<[f64; 3]> {
        let side = f64::from(SIDE);
        let fine = |random: &mut Random, low: f64, high: f64| {
            low + (random.unit() * (high - low) * 512.0).floor() / 512.0
        };
        match self.places {
            Places::Along(axis) => (0..=512 * 3)
                .map(|i| {
                    let mut place = [1.5, 2.5, 1.5];
                    place[axis] = 0.5 + f64::from(i) / 512.0;
                    place
                })
                .collect(),
            Places::Random => (0..2000)
                .map(|_| [0; 3].map(|_| fine(random, 0.5, side - 0.5)))
                .collect(),
            Places::Beyond => (0..2000)
                .map(|_| [0; 3].map(|_| fine(random, -2.0 * side, 3.0 * side)))
                .collect(),
            Places::Centers => (0..SIDE * SIDE * SIDE)
                .map(|i| [i % SIDE, i / SIDE % SIDE, i / SIDE / SIDE].map(|n| f64::from(n) + 0.5))
                .collect(),
        }
    }

    /// For the sampler: normalized, and a whole layer.
    fn coordinates(self, place: [f64; 3]) -> [f32; 4] {
        let [x, y, z] = place;
        let side = f64::from(SIDE);
        let z = match self.kind {
            ImageKind::D3 => z / side,
            _ => layer_of(z),
        };
        [(x / side) as f32, (y / side) as f32, z as f32, 0.0]
    }

    fn compare(self, values: &[f64], places: &[[f64; 3]], found: &[f32], bits: u32) -> Measurement {
        let bound =
            Bound::new("legal-weights", DERIVATION).with("subTexelPrecisionBits", bits.into());
        let mut measurement = Measurement::new(bound, SIDE.pow(3) as usize / 2);
        let largest = values.iter().fold(0.0f64, |most, v| most.max(v.abs()));
        let unit = match self.format {
            vk::Format::R8_UNORM => 1.5 / 255.0,
            vk::Format::R16_UNORM => 1.5 / 65_535.0,
            vk::Format::R16_SFLOAT => 3.0 / 2048.0 * largest,
            _ => 16.0 / f64::from(1u32 << 24) * largest,
        };
        let fine = 16.0 / f64::from(1u32 << 24) * largest;
        let texels = if self.kind == ImageKind::D3 { 8.0 } else { 4.0 };
        let of_products = 0.5 * texels * 2f64.powi(-(bits as i32)) * largest;
        for (&place, &found) in places.iter().zip(found) {
            let at = || format!("place {place:?}");
            if !self.is_linear {
                match self.nearest(values, place) {
                    Some(wanted) => measurement.take(at, wanted, found.into(), fine),
                    None => measurement.leave_out(1),
                }
                continue;
            }
            let [least, reported] = [4, bits].map(|bits| self.legal(values, place, bits));
            measurement.take_in(at, least, found.into(), unit + of_products);
            let [low, high] = reported;
            let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
            measurement.prefer(COARSE, at, middle, found.into(), half + fine);
        }
        measurement
    }

    fn texel(self, values: &[f64], index: [i64; 3]) -> f64 {
        let [x, y, z] = index.map(|i| i.clamp(0, i64::from(SIDE) - 1) as usize);
        let side = SIDE as usize;
        values[x + side * (y + side * z)]
    }

    /// `None` where two texels are as near.
    fn nearest(self, values: &[f64], place: [f64; 3]) -> Option<f64> {
        let [x, y, z] = place;
        let z = match self.kind {
            ImageKind::D2Array => layer_of(z) + 0.5,
            _ => z,
        };
        let is_border = |at: &f64| (at - at.round()).abs() < 1.0 / 64.0;
        if [x, y, z].iter().any(is_border) {
            return None;
        }
        let index = [x, y, z].map(|at| at.floor() as i64);
        Some(self.texel(values, index))
    }

    /// The smallest and the largest legal result.
    fn legal(self, values: &[f64], place: [f64; 3], bits: u32) -> [f64; 2] {
        let layer = (self.kind == ImageKind::D2Array).then(|| layer_of(place[2]) as i64);
        legal(&|index| self.texel(values, index), place, layer, bits)
    }
}

/// The smallest and the largest legal result at a place in texels, of texels by index; of one layer, where there are
/// such.
pub fn legal(
    texel: &dyn Fn([i64; 3]) -> f64,
    place: [f64; 3],
    layer: Option<i64>,
    bits: u32,
) -> [f64; 2] {
    let scale = 2f64.powi(bits.min(30) as i32);
    let mut first = place.map(|p| (p - 0.5).floor() as i64);
    let mut weights = place.map(|p| {
        let part = (p - 0.5) - (p - 0.5).floor();
        [
            (part * scale).floor() / scale,
            (part * scale).ceil() / scale,
        ]
    });
    if let Some(layer) = layer {
        first[2] = layer;
        weights[2] = [0.0; 2];
    }
    let mut extremes = [f64::INFINITY, f64::NEG_INFINITY];
    for corner in 0..8 {
        let w = [0, 1, 2].map(|k: usize| weights[k][corner >> k & 1]);
        let mut sum = 0.0;
        for tap in 0..8 {
            let bit = |k: usize| (tap >> k & 1) as i64;
            let share = [0, 1, 2].map(|k: usize| if bit(k) == 1 { w[k] } else { 1.0 - w[k] });
            let index = [0, 1, 2].map(|k: usize| first[k] + bit(k));
            sum += share.iter().product::<f64>() * texel(index);
        }
        extremes = [extremes[0].min(sum), extremes[1].max(sum)];
    }
    extremes
}

/// Layers are chosen, never mixed.
fn layer_of(z: f64) -> f64 {
    z.floor().clamp(0.0, f64::from(SIDE) - 1.0)
}

fn ask(
    bed: &mut TestBed,
    of: &Of,
    probed: &Image,
    sampler: &Sampler,
    coordinates: &[[f32; 4]],
) -> Result<Vec<f32>, Stop> {
    let device = bed.device()?;
    let gpu = Arc::clone(device.gpu());
    let places = kit::buffer(&gpu, coordinates, "places")?;
    let found = kit::zeros::<f32>(&gpu, coordinates.len(), "found")?;
    let given = [
        ("probed", Resource::sampled(probed)),
        ("probed_sampler", Resource::Sampler(sampler)),
        ("places", Resource::Storage(&places)),
        ("found", Resource::Storage(&found)),
    ];
    let name = match of.kind {
        ImageKind::D3 => "probe/filter_3d",
        _ => "probe/filter_array",
    };
    let groups = [(coordinates.len() as u32).div_ceil(64), 1, 1];
    kit::compute(device, name, &given, groups)?;
    kit::read(&found)
}

/// Bytes and values of texels of random codes of 16 bits.
pub fn texels_of(format: vk::Format, codes: &[u32]) -> (Vec<u8>, Vec<f64>) {
    let all = codes.iter().copied();
    match format {
        vk::Format::R8_UNORM => (
            all.clone().map(|code| (code >> 8) as u8).collect(),
            all.map(|code| f64::from(code >> 8) / 255.0).collect(),
        ),
        vk::Format::R16_UNORM => (
            all.clone()
                .flat_map(|code| (code as u16).to_le_bytes())
                .collect(),
            all.map(|code| f64::from(code) / 65_535.0).collect(),
        ),
        vk::Format::R16_SFLOAT => {
            let half = |code: u32| half::f16::from_f64(f64::from(code) / 32_768.0 - 1.0);
            (
                all.clone()
                    .flat_map(|code| half(code).to_le_bytes())
                    .collect(),
                all.map(|code| half(code).to_f64()).collect(),
            )
        }
        _ => {
            let single = |code: u32| (f64::from(code) / 32_768.0 - 1.0) as f32;
            (
                all.clone()
                    .flat_map(|code| single(code).to_le_bytes())
                    .collect(),
                all.map(|code| single(code).into()).collect(),
            )
        }
    }
}
