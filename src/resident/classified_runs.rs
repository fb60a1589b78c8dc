//! Classified voxels on the device as runs: of each row of voxels along x those alone whose optical depth is over 0.
//!
//! ```text
//! words      of each 32 voxels of a row a mask, and how many full voxels come before          8 bytes
//! payload    of full voxels in their order (red, green, blue times depth, depth)              8 bytes, or 16
//! ```
//!
//! Lacroute and Levoy, "Fast Volume Rendering Using a Shear-Warp Factorization of the Viewing Transformation", SIGGRAPH
//! 1994, keep theirs for each of the three axes; with ranks one encoding serves all of them.

mod on_device;
mod texels;

use crate::gpu::{Error, Headless, Image};
use crate::volume::{Rescale, RunBits, Volume, Voxels};
use ash::vk;
use half::f16;
pub use on_device::RunBuilder;
use texels::{Texels, bytes_of, read_back};

/// The floats of a payload.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PayloadFloats {
    /// Of 16 bits: off by 2^-11 of each number, and by 2^-25 below 2^-14.
    Half,
    /// Of 32 bits, as volumes hold them.
    Single,
}

/// Who makes runs of classified voxels: the bytes are the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MadeBy {
    /// The host, of four volumes ([`ClassifiedRuns::new`]).
    Host,
    /// The device, of codes ([`RunBuilder`]).
    Device,
}

/// What runs of classified voxels take.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RunsSize {
    /// Voxels whose optical depth is over 0.
    pub full: u64,
    /// Longest sequences of them in rows along x.
    pub runs: u64,
    /// Bytes of words and payload on the device.
    pub bytes: u64,
}

/// The runs of four volumes as `technique::preclassified` makes them: red, green and blue times depth, and depth.
#[derive(Debug)]
pub struct ClassifiedRuns {
    words: Image,
    payload: Image,
    size: RunsSize,
    made_by: MadeBy,
}

impl PayloadFloats {
    /// Of the four numbers of a voxel.
    fn format(self) -> vk::Format {
        match self {
            Self::Half => vk::Format::R16G16B16A16_SFLOAT,
            Self::Single => vk::Format::R32G32B32A32_SFLOAT,
        }
    }

    fn encode(self, numbers: [f32; 4], bytes: &mut [u8]) {
        match self {
            Self::Half => {
                let halves = numbers.map(|n| f16::from_f32(n).to_bits());
                bytes.copy_from_slice(bytemuck::bytes_of(&halves));
            }
            Self::Single => bytes.copy_from_slice(bytemuck::bytes_of(&numbers)),
        }
    }

    /// Bytes of a payload.
    fn bytes(self) -> u64 {
        match self {
            Self::Half => 8,
            Self::Single => 16,
        }
    }

    /// Whether what a voxel is made of can be such floats.
    fn hold(self, numbers: [f32; 4]) -> bool {
        self == Self::Single || numbers.into_iter().all(|n| n <= f16::MAX.to_f32())
    }

    /// Whether the numbers of a volume can be.
    fn hold_all(self, volume: &Volume) -> bool {
        self.hold([volume.value_range[1] as f32; 4])
    }
}

/// The numbers of four volumes of plain floats on one grid; `None` of others, and where such floats cannot hold them.
fn numbers_of(volumes: [&Volume; 4], floats: PayloadFloats) -> Option<[&[f32]; 4]> {
    let grid = volumes[0].grid();
    let plain = volumes.map(|volume| match &volume.voxels {
        Voxels::F32(numbers)
            if volume.rescale == Rescale::default()
                && volume.grid() == grid
                && floats.hold_all(volume) =>
        {
            Some(&numbers[..])
        }
        _ => None,
    });
    match plain {
        [Some(red), Some(green), Some(blue), Some(depth)] => Some([red, green, blue, depth]),
        _ => None,
    }
}

impl RunsSize {
    fn new(full: u64, runs: u64, images: [&Image; 2]) -> Self {
        Self {
            full,
            runs,
            bytes: images.map(bytes_of).into_iter().sum(),
        }
    }
}

impl ClassifiedRuns {
    /// The runs of four volumes: red, green and blue times depth, and depth; `None` where they are not floats without a rescale
    /// on one grid, or have numbers larger than such floats can be.
    ///
    /// # Errors
    /// Where the device gives no memory, or has no images of that size.
    pub fn new(
        device: &mut Headless,
        volumes: [&Volume; 4],
        floats: PayloadFloats,
    ) -> Result<Option<Self>, Error> {
        let Some(numbers) = numbers_of(volumes, floats) else {
            return Ok(None);
        };
        let validity = volumes[3].validity.as_deref();
        let bits = RunBits::of_masks(volumes[3].dims, |voxels| {
            let depths = numbers[3][voxels.clone()].iter().map(|&depth| depth > 0.0);
            let full = mask_of(depths);
            validity.map_or(full, |valid| {
                full & mask_of(valid[voxels].iter().map(|&valid| valid != 0))
            })
        });
        let mut words: &[u8] = bytemuck::cast_slice(bits.words());
        let words = Texels {
            format: vk::Format::R32G32_UINT,
            count: bits.words().len() as u64,
            name: "words of runs",
        }
        .image(device, |out| {
            let (next, rest) = words.split_at(words.len().min(out.len()));
            let (own, behind) = out.split_at_mut(next.len());
            own.copy_from_slice(next);
            behind.fill(0);
            words = rest;
        })?;
        let mut full = bits.voxels();
        let payload = Texels {
            format: floats.format(),
            count: bits.full_count(),
            name: "payload of runs",
        }
        .image(device, |out| {
            for texel in out.chunks_exact_mut(floats.bytes() as usize) {
                match full.next() {
                    Some(n) => floats.encode(numbers.map(|of| of[n]), texel),
                    None => texel.fill(0),
                }
            }
        })?;
        let size = RunsSize::new(bits.full_count(), bits.run_count(), [&words, &payload]);
        Ok(Some(Self {
            words,
            payload,
            size,
            made_by: MadeBy::Host,
        }))
    }

    /// The bytes of the words and of the payload as they lie on the device: whole rows of 4096 texels, where there is more than
    /// one.
    ///
    /// # Errors
    /// Where the device gives no memory, or is lost.
    pub fn read(&self, device: &mut Headless) -> Result<[Vec<u8>; 2], Error> {
        Ok([
            read_back(device, &self.words)?,
            read_back(device, &self.payload)?,
        ])
    }

    /// What they take.
    pub fn size(&self) -> RunsSize {
        self.size
    }

    /// Who made them.
    pub fn made_by(&self) -> MadeBy {
        self.made_by
    }

    /// In [`Use::Sampled`], as the payload is.
    pub(crate) fn words(&self) -> &Image {
        &self.words
    }

    pub(crate) fn payload(&self) -> &Image {
        &self.payload
    }
}

/// Bit b: of voxel b.
fn mask_of(full: impl Iterator<Item = bool>) -> u32 {
    let bits = (0_u32..).zip(full);
    bits.fold(0, |mask, (bit, full)| mask | u32::from(full) << bit)
}
