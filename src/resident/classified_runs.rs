//! Classified voxels on the device as runs: of each row of voxels along x those alone whose optical depth is over 0.
//!
//! ```text
//! words      of each 32 voxels of a row a mask, and how many full voxels come before          8 bytes
//! payload    of full voxels in their order (red, green, blue times depth, depth)              8 bytes, or 16
//! ```
//!
//! Lacroute and Levoy, "Fast Volume Rendering Using a Shear-Warp Factorization of the Viewing Transformation", SIGGRAPH
//! 1994, keep theirs for each of the three axes; with ranks one encoding serves all of them.

use crate::gpu::{
    Buffer, Error, Headless, Image, ImageDesc, ImageKind, Memory, Region, Use, buffer_to_image,
    image_barrier,
};
use crate::volume::{Rescale, RunBits, Volume, Voxels};
use ash::vk;
use half::f16;
use std::sync::Arc;

/// Texels of a row (`shaders/lib/channels_on_runs.wgsl`).
const WIDTH: u32 = 4096;
/// Rows that are staged at once.
const STAGED_ROWS: u32 = 64;

/// The floats of a payload.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PayloadFloats {
    /// Of 16 bits: off by 2^-11 of each number, and by 2^-25 below 2^-14.
    Half,
    /// Of 32 bits, as volumes hold them.
    Single,
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

    /// Whether the numbers of a volume can be such floats.
    fn hold(self, volume: &Volume) -> bool {
        self == Self::Single || volume.value_range[1] <= f64::from(f16::MAX)
    }
}

/// The numbers of four volumes of plain floats on one grid; `None` of others, and where such floats cannot hold them.
fn numbers_of(volumes: [&Volume; 4], floats: PayloadFloats) -> Option<[&[f32]; 4]> {
    let grid = volumes[0].grid();
    let plain = volumes.map(|volume| match &volume.voxels {
        Voxels::F32(numbers)
            if volume.rescale == Rescale::default()
                && volume.grid() == grid
                && floats.hold(volume) =>
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
        let is_full = |n: usize| numbers[3][n] > 0.0 && validity.is_none_or(|valid| valid[n] != 0);
        let bits = RunBits::of_rows(volumes[3].dims, is_full);
        let mut words = bits.words().iter();
        let words = Texels {
            format: vk::Format::R32G32_UINT,
            count: words.len() as u64,
            name: "words of runs",
        }
        .image(device, |texel| {
            let word = words.next();
            word.map(|word| texel.copy_from_slice(bytemuck::bytes_of(word)))
        })?;
        let mut full = bits.voxels();
        let payload = Texels {
            format: floats.format(),
            count: bits.full_count(),
            name: "payload of runs",
        }
        .image(device, |texel| {
            let voxel = full.next();
            voxel.map(|n| floats.encode(numbers.map(|of| of[n]), texel))
        })?;
        Ok(Some(Self {
            size: RunsSize {
                full: bits.full_count(),
                runs: bits.run_count(),
                bytes: bytes_of(&words) + bytes_of(&payload),
            },
            words,
            payload,
        }))
    }

    /// What they take.
    pub fn size(&self) -> RunsSize {
        self.size
    }

    /// In [`Use::Sampled`], as the payload is.
    pub(crate) fn words(&self) -> &Image {
        &self.words
    }

    pub(crate) fn payload(&self) -> &Image {
        &self.payload
    }
}

fn bytes_of(image: &Image) -> u64 {
    let bytes = Region::whole(image).bytes(image.format());
    bytes.expect("a format of ours")
}

/// So many texels in rows.
#[derive(Clone, Copy)]
struct Texels {
    format: vk::Format,
    count: u64,
    name: &'static str,
}

impl Texels {
    /// Their image, and one texel where there are none. `write` puts the next one into its place; behind the last it gives `None`, and
    /// the rest of the last row is 0.
    fn image(
        self,
        device: &mut Headless,
        mut write: impl FnMut(&mut [u8]) -> Option<()>,
    ) -> Result<Image, Error> {
        let gpu = Arc::clone(device.gpu());
        let count = self.count.max(1);
        let height = count.div_ceil(WIDTH.into());
        let desc = ImageDesc {
            kind: ImageKind::D2,
            extent: [
                count.min(WIDTH.into()) as u32,
                height.try_into().unwrap_or(u32::MAX),
                1,
            ],
            format: self.format,
            usage: vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST,
            name: self.name,
        };
        let image = Image::new(&gpu, &desc)?;
        let [width, height, _] = desc.extent;
        let part = |first: u32| Region {
            origin: [0, first, 0],
            extent: [width, STAGED_ROWS.min(height - first), 1],
        };
        let bytes = |part: Region| part.bytes(self.format).expect("a format of ours");
        let texel_bytes = bytes(part(0)) / u64::from(part(0).extent[1] * width);
        let usage = vk::BufferUsageFlags::TRANSFER_SRC;
        let staging = Buffer::new(&gpu, bytes(part(0)), usage, Memory::Upload, "staged runs")?;
        for first in (0..height).step_by(STAGED_ROWS as usize) {
            let part = part(first);
            staging.write_with(0, bytes(part), |out| {
                for texel in out.chunks_exact_mut(texel_bytes as usize) {
                    if write(texel).is_none() {
                        texel.fill(0);
                    }
                }
            })?;
            let before = match first {
                0 => Use::Nothing,
                _ => Use::Sampled,
            };
            device.run(|cmd| {
                // SAFETY: recorded outside rendering; both live until `run` has waited, and nothing else knows the image yet; the host
                // has written these rows before.
                unsafe {
                    image_barrier(&gpu, cmd, &image, before, Use::TransferWrite);
                    buffer_to_image(&gpu, cmd, &staging, 0, &image, part)?;
                    image_barrier(&gpu, cmd, &image, Use::TransferWrite, Use::Sampled);
                }
                Ok(())
            })?;
        }
        Ok(image)
    }
}
