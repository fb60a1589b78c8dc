//! Storage images: numbers stored and loaded, in every format that each device has.
//!
//! ```text
//! UNORM of 8 bits  one of the two codes around 255 n, n in [0, 1]     SNORM  127 n, n in [-1, 1]     others  the number
//! ```

use super::kit;
use crate::conformance::case::{Case, Stop};
use crate::conformance::measurement::{Bound, Measurement};
use crate::conformance::test_bed::{Random, TestBed};
use crate::gpu::{Headless, Image, ImageDesc, ImageKind, Item, Resource, Use, image_barrier};
use ash::vk;
use half::f16;
use std::sync::Arc;

const STORE: &str = "A storage image of 32-bit numbers keeps each number, one of smaller integers those that they have; one of 16-bit \
floats one of the two halves around it, one of codes one of the two codes (Vulkan specification, floating-point format conversions and \
fixed-point data conversions): that it is not the nearer one is a warning. A product in 32-bit floats rounds once.";
const LOAD: &str = "What is loaded from a storage image is the number; of a code / 127 or / 255 a division, or a product with a rounded \
number and two roundings, 6 x 2^-24 of the result. Channels that a format lacks are 0, and 1 for alpha.";

/// How a channel is kept.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Channel {
    Unorm8,
    Snorm8,
    Half,
    Single,
    Uint(u32),
    Sint(u32),
}

#[derive(Clone, Copy)]
struct Of {
    word: &'static str,
    /// The word of WGSL.
    wgsl: &'static str,
    format: vk::Format,
    channel: Channel,
    channels: usize,
}

const fn of(
    word: &'static str,
    wgsl: &'static str,
    format: vk::Format,
    channel: Channel,
    channels: usize,
) -> Of {
    Of {
        word,
        wgsl,
        format,
        channel,
        channels,
    }
}

use vk::Format as F;

/// Those that shaders may name without a feature, and every device has.
const FORMATS: [Of; 13] = [
    of(
        "rgba8_unorm",
        "rgba8unorm",
        F::R8G8B8A8_UNORM,
        Channel::Unorm8,
        4,
    ),
    of(
        "rgba8_snorm",
        "rgba8snorm",
        F::R8G8B8A8_SNORM,
        Channel::Snorm8,
        4,
    ),
    of(
        "rgba8_uint",
        "rgba8uint",
        F::R8G8B8A8_UINT,
        Channel::Uint(8),
        4,
    ),
    of(
        "rgba8_sint",
        "rgba8sint",
        F::R8G8B8A8_SINT,
        Channel::Sint(8),
        4,
    ),
    of(
        "rgba16_uint",
        "rgba16uint",
        F::R16G16B16A16_UINT,
        Channel::Uint(16),
        4,
    ),
    of(
        "rgba16_sint",
        "rgba16sint",
        F::R16G16B16A16_SINT,
        Channel::Sint(16),
        4,
    ),
    of(
        "rgba16_sfloat",
        "rgba16float",
        F::R16G16B16A16_SFLOAT,
        Channel::Half,
        4,
    ),
    of("r32_uint", "r32uint", F::R32_UINT, Channel::Uint(32), 1),
    of("r32_sint", "r32sint", F::R32_SINT, Channel::Sint(32), 1),
    of("r32_sfloat", "r32float", F::R32_SFLOAT, Channel::Single, 1),
    of(
        "rgba32_uint",
        "rgba32uint",
        F::R32G32B32A32_UINT,
        Channel::Uint(32),
        4,
    ),
    of(
        "rgba32_sint",
        "rgba32sint",
        F::R32G32B32A32_SINT,
        Channel::Sint(32),
        4,
    ),
    of(
        "rgba32_sfloat",
        "rgba32float",
        F::R32G32B32A32_SFLOAT,
        Channel::Single,
        4,
    ),
];

/// Both ways of each.
pub fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for of in FORMATS {
        let need = Item::Format(of.format, vk::FormatFeatureFlags::STORAGE_IMAGE);
        let word = of.word;
        let stored = Case::new(format!("probe.store.{word}"), move |bed| of.stored(bed));
        cases.push(stored.needing(need));
        let loaded = Case::new(format!("probe.load.{word}"), move |bed| of.loaded(bed));
        cases.push(loaded.needing(need));
    }
    cases
}

const EXTENT: [u32; 2] = [64, 32];

impl Of {
    fn stored(self, bed: &mut TestBed) -> Result<Measurement, Stop> {
        let mut random = bed.random("stored");
        let count = EXTENT[0] * EXTENT[1];
        let numbers: Vec<[u32; 4]> = (0..count)
            .map(|_| [0; 4].map(|_| self.channel.random(&mut random)))
            .collect();
        let device = bed.device()?;
        let gpu = Arc::clone(device.gpu());
        let image = self.image(device, Use::Nothing)?;
        let given = kit::buffer(&gpu, &numbers, "numbers")?;
        let resources = [
            ("stored", Resource::written(&image)),
            ("numbers", Resource::Storage(&given)),
        ];
        let shader = format!("probe/store.{}", self.wgsl);
        kit::compute(
            device,
            &shader,
            &resources,
            [EXTENT[0] / 8, EXTENT[1] / 8, 1],
        )?;
        let texels = kit::texels(device, &image, Use::ComputeWrite)?;
        let mut measurement = Measurement::new(Bound::new("store", STORE), count as usize);
        for (texel, numbers) in numbers.iter().enumerate() {
            for (c, &bits) in numbers.iter().enumerate().take(self.channels) {
                let found = self.channel.decoded(&texels, texel * self.channels + c);
                let at = || format!("channel {c} of texel {texel}");
                self.channel.keep(&mut measurement, at, bits, found);
            }
        }
        Ok(measurement)
    }

    fn loaded(self, bed: &mut TestBed) -> Result<Measurement, Stop> {
        let mut random = bed.random("loaded");
        let count = (EXTENT[0] * EXTENT[1]) as usize;
        let mut texels = Vec::new();
        for _ in 0..count * self.channels {
            texels.extend(self.channel.encoded(&mut random));
        }
        let device = bed.device()?;
        let gpu = Arc::clone(device.gpu());
        let image = self.image(device, Use::TransferWrite)?;
        let from = super::raw::copied(&gpu, texels.len() as u64, true)?;
        from.write(0, &texels)?;
        device.run(|cmd| {
            let region = crate::gpu::Region::whole(&image);
            // SAFETY: recorded outside rendering, with barriers between; `run` waits, and both live meanwhile.
            unsafe {
                crate::gpu::buffer_to_image(&gpu, cmd, &from, 0, &image, region)?;
                image_barrier(&gpu, cmd, &image, Use::TransferWrite, Use::ComputeRead);
            }
            Ok(())
        })?;
        let found = kit::zeros::<[u32; 4]>(&gpu, count, "numbers")?;
        let resources = [
            ("loaded", Resource::read(&image)),
            ("numbers", Resource::Storage(&found)),
        ];
        let shader = format!("probe/load.{}", self.wgsl);
        kit::compute(
            device,
            &shader,
            &resources,
            [EXTENT[0] / 8, EXTENT[1] / 8, 1],
        )?;
        let found: Vec<[u32; 4]> = kit::read(&found)?;
        let mut measurement = Measurement::new(Bound::new("load", LOAD), 4 * count);
        for (texel, found) in found.into_iter().enumerate() {
            for (c, bits) in found.into_iter().enumerate() {
                let at = || format!("channel {c} of texel {texel}");
                let wanted = match c < self.channels {
                    true => self.channel.decoded(&texels, texel * self.channels + c),
                    false => f64::from(u8::from(c == 3)),
                };
                let is_code = matches!(self.channel, Channel::Unorm8 | Channel::Snorm8);
                let slack = if is_code { 6.0 * U * wanted.abs() } else { 0.0 };
                measurement.take(at, wanted, self.channel.number(bits), slack);
            }
        }
        Ok(measurement)
    }

    /// An image that comes from nothing, for shaders to write or for copies.
    fn image(self, device: &mut Headless, after: Use) -> Result<Image, Stop> {
        let gpu = Arc::clone(device.gpu());
        let copies = vk::ImageUsageFlags::TRANSFER_SRC | vk::ImageUsageFlags::TRANSFER_DST;
        let desc = ImageDesc {
            kind: ImageKind::D2,
            extent: [EXTENT[0], EXTENT[1], 1],
            format: self.format,
            usage: vk::ImageUsageFlags::STORAGE | copies,
            name: "stored",
        };
        let image = Image::new(&gpu, &desc)?;
        let after = match after {
            Use::Nothing => Use::ComputeWrite,
            other => other,
        };
        device.run(|cmd| {
            // SAFETY: recorded outside rendering; `run` waits.
            unsafe { image_barrier(&gpu, cmd, &image, Use::Nothing, after) };
            Ok(())
        })?;
        Ok(image)
    }
}

/// Half a unit in the last place of an f32 at 1.
const U: f64 = 1.0 / (1u32 << 24) as f64;

impl Channel {
    /// Bits of a number as a shader has it, beyond the ends of codes too.
    fn random(self, random: &mut Random) -> u32 {
        match self {
            Self::Unorm8 | Self::Snorm8 => ((3.0 * random.unit() - 1.5) as f32).to_bits(),
            Self::Half | Self::Single => ((2.0 * random.unit() - 1.0) as f32).to_bits(),
            Self::Uint(bits) => random.bits() as u32 >> (32 - bits),
            Self::Sint(bits) => (random.bits() as i32 >> (32 - bits)) as u32,
        }
    }

    /// Bytes of a number as an image has it.
    fn encoded(self, random: &mut Random) -> Vec<u8> {
        let word = match self {
            Self::Half => f16::from_f64(2.0 * random.unit() - 1.0).to_bits().into(),
            Self::Single => self.random(random),
            _ => random.bits() as u32,
        };
        word.to_le_bytes()[..self.bytes()].to_vec()
    }

    fn bytes(self) -> usize {
        match self {
            Self::Unorm8 | Self::Snorm8 => 1,
            Self::Half => 2,
            Self::Single => 4,
            Self::Uint(bits) | Self::Sint(bits) => bits as usize / 8,
        }
    }

    /// Number `i` of an image's texels.
    fn decoded(self, texels: &[u8], i: usize) -> f64 {
        let mut word = [0; 4];
        let bytes = self.bytes();
        word[..bytes].copy_from_slice(&texels[bytes * i..bytes * (i + 1)]);
        let word = u32::from_le_bytes(word);
        match self {
            Self::Unorm8 => f64::from(word) / 255.0,
            Self::Snorm8 => (f64::from(word as u8 as i8) / 127.0).max(-1.0),
            Self::Half => f16::from_bits(word as u16).to_f64(),
            Self::Single => f32::from_bits(word).into(),
            Self::Uint(_) => word.into(),
            Self::Sint(bits) => (((word << (32 - bits)) as i32) >> (32 - bits)).into(),
        }
    }

    /// The number of bits as a shader has them.
    fn number(self, bits: u32) -> f64 {
        match self {
            Self::Uint(_) => bits.into(),
            Self::Sint(_) => (bits as i32).into(),
            _ => f32::from_bits(bits).into(),
        }
    }

    /// What a shader has stored against what is kept of it.
    fn keep(self, measurement: &mut Measurement, at: impl Fn() -> String, bits: u32, found: f64) {
        let number = self.number(bits);
        let (least, most) = match self {
            Self::Unorm8 => (0.0, 255.0),
            Self::Snorm8 => (-1.0, 127.0),
            Self::Half => {
                // Halves around a number are 2^-10 of its power of two apart.
                let apart = 2f64.powi(-10) * 2f64.powf(number.abs().log2().floor());
                let apart = apart.max(2f64.powi(-24));
                measurement.take(&at, number, found, apart);
                let meaning = "stores of 16-bit floats are cut off and not rounded";
                measurement.prefer(meaning, at, number, found, 0.5 * apart);
                return;
            }
            _ => {
                measurement.take(at, number, found, 0.0);
                return;
            }
        };
        let number = number.clamp(least, 1.0);
        let code = number * most;
        let slack = U * number.abs();
        let around = [code.floor() / most, code.ceil() / most];
        // On a whole code the two around it are it alone, but for the rounding of the product.
        let around = match (code - code.round()).abs() <= U * code.abs() && number.abs() < 1.0 {
            true => [(code.round() - 1.0) / most, (code.round() + 1.0) / most],
            false => around,
        };
        measurement.take_in(&at, around, found, slack);
        let meaning = "codes are cut off and not rounded";
        measurement.prefer(meaning, at, number, found, 0.5 / most + slack);
    }
}
