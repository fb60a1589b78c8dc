//! How stored numbers become texels (`sampling.md` 2): the same value comes out on every device.
//!
//! ```text
//! value = (texel * scale + offset) * slope + intercept
//! ```
//!
//! | stored | texel | scale, offset |
//! |---|---|---|
//! | u8, i8 | R8_UNORM, of the code + 0 or + 128 | 255, 0 or -128 |
//! | u16, i16 | R16_UNORM, of the code + 0 or + 32 768 | 65 535, 0 or -32 768 |
//! | f16, f32 | R16_SFLOAT, R32_SFLOAT | 1, 0 |
//!
//! Signed codes are moved and not stored as SNORM, which would merge the two lowest. Software devices filter
//! R8 with 8-bit arithmetic (lavapipe returns 31 values between two texels 30 codes apart), so there 8-bit
//! codes sit in R16_UNORM as code * 257, which is the same fraction. A format that the device cannot filter
//! falls to R32_SFLOAT with the codes themselves; where that is not filtered either, shaders fetch.

use crate::gpu::Gpu;
use crate::volume::{Rescale, VoxelType, Voxels};
use ash::vk;
use half::f16;

/// How texels become values: `(texel * scale + offset) * slope + intercept`, `texel * scale` rounded where
/// codes are integers and nothing has mixed them.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs, reason = "the line above says it")]
pub struct Coding {
    pub scale: f32,
    pub offset: f32,
    pub slope: f32,
    pub intercept: f32,
    pub is_integer: bool,
}

impl Coding {
    /// Texels that are values.
    pub const PLAIN: Self = Self {
        scale: 1.0,
        offset: 0.0,
        slope: 1.0,
        intercept: 0.0,
        is_integer: false,
    };
}

/// A format and what its texels mean.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TexelFormat {
    /// Of the image.
    pub format: vk::Format,
    /// Texel to value.
    pub coding: Coding,
    /// The device's sampler interpolates this format.
    pub is_filtered: bool,
}

impl TexelFormat {
    /// The format for voxels of `stored` type on this device.
    pub fn choose(gpu: &Gpu, stored: VoxelType, rescale: Rescale) -> Self {
        let is_filtered = |format| {
            let features = gpu.format_features(format);
            features.sampled && features.linear
        };
        let wanted = match stored {
            VoxelType::U8 | VoxelType::I8 if !gpu.is_cpu() => vk::Format::R8_UNORM,
            VoxelType::U8 | VoxelType::I8 | VoxelType::U16 | VoxelType::I16 => {
                vk::Format::R16_UNORM
            }
            VoxelType::F16 => vk::Format::R16_SFLOAT,
            _ => vk::Format::R32_SFLOAT,
        };
        let format = if is_filtered(wanted) {
            wanted
        } else {
            vk::Format::R32_SFLOAT
        };
        let (scale, offset) = match (format, stored) {
            (vk::Format::R8_UNORM | vk::Format::R16_UNORM, VoxelType::U8) => (255.0, 0.0),
            (vk::Format::R8_UNORM | vk::Format::R16_UNORM, VoxelType::I8) => (255.0, -128.0),
            (vk::Format::R16_UNORM, VoxelType::U16) => (65535.0, 0.0),
            (vk::Format::R16_UNORM, VoxelType::I16) => (65535.0, -32768.0),
            _ => (1.0, 0.0),
        };
        let coding = Coding {
            scale,
            offset,
            slope: rescale.slope as f32,
            intercept: rescale.intercept as f32,
            is_integer: scale != 1.0,
        };
        Self {
            format,
            coding,
            is_filtered: is_filtered(format),
        }
    }

    /// Bytes of one texel.
    pub fn bytes(&self) -> usize {
        match self.format {
            vk::Format::R8_UNORM => 1,
            vk::Format::R16_UNORM | vk::Format::R16_SFLOAT => 2,
            _ => 4,
        }
    }

    /// Fills `texels` with those of the voxels at `first`, `first + stride`, `first + 2 stride` and so on.
    pub fn encode(&self, voxels: &Voxels, first: usize, stride: usize, texels: &mut [u8]) {
        let run = Run { first, stride };
        let unsigned = |code: i8| code.wrapping_sub(i8::MIN) as u8;
        let moved = |code: i16| code.wrapping_sub(i16::MIN) as u16;
        match (self.format, voxels) {
            (vk::Format::R8_UNORM, Voxels::U8(v)) => run.put(v, texels, |code| [code]),
            (vk::Format::R8_UNORM, Voxels::I8(v)) => run.put(v, texels, |code| [unsigned(code)]),
            // code * 257 is the code in both bytes.
            (vk::Format::R16_UNORM, Voxels::U8(v)) => run.put(v, texels, |code| [code; 2]),
            (vk::Format::R16_UNORM, Voxels::I8(v)) => {
                run.put(v, texels, |code| [unsigned(code); 2]);
            }
            (vk::Format::R16_UNORM, Voxels::U16(v)) => run.put(v, texels, u16::to_le_bytes),
            (vk::Format::R16_UNORM, Voxels::I16(v)) => {
                run.put(v, texels, |code| moved(code).to_le_bytes());
            }
            (vk::Format::R16_SFLOAT, Voxels::F16(v)) => run.put(v, texels, f16::to_le_bytes),
            // 32-bit floats hold every stored number.
            (_, Voxels::U8(v)) => run.put(v, texels, |x| f32::from(x).to_le_bytes()),
            (_, Voxels::I8(v)) => run.put(v, texels, |x| f32::from(x).to_le_bytes()),
            (_, Voxels::U16(v)) => run.put(v, texels, |x| f32::from(x).to_le_bytes()),
            (_, Voxels::I16(v)) => run.put(v, texels, |x| f32::from(x).to_le_bytes()),
            (_, Voxels::F16(v)) => run.put(v, texels, |x| x.to_f32().to_le_bytes()),
            (_, Voxels::F32(v)) => run.put(v, texels, f32::to_le_bytes),
        }
    }
}

/// Numbers that lie equally far apart.
struct Run {
    first: usize,
    stride: usize,
}

impl Run {
    /// A loop of its own where numbers are neighbours: the compiler makes vectors of it.
    fn put<T: Copy, const N: usize>(
        &self,
        numbers: &[T],
        texels: &mut [u8],
        texel: impl Fn(T) -> [u8; N],
    ) {
        let texels = texels.as_chunks_mut::<N>().0.iter_mut();
        let numbers = numbers[self.first..].iter();
        if self.stride == 1 {
            texels.zip(numbers).for_each(|(out, &x)| *out = texel(x));
        } else {
            let numbers = numbers.step_by(self.stride);
            texels.zip(numbers).for_each(|(out, &x)| *out = texel(x));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn format(format: vk::Format) -> TexelFormat {
        let coding = Coding {
            scale: 1.0,
            offset: 0.0,
            slope: 1.0,
            intercept: 0.0,
            is_integer: true,
        };
        TexelFormat {
            format,
            coding,
            is_filtered: true,
        }
    }

    #[test]
    fn signed_codes_are_moved_so_that_the_lowest_becomes_zero() {
        let mut texels = [0; 8];
        let voxels = Voxels::I16(vec![i16::MIN, -1, 0, i16::MAX]);
        format(vk::Format::R16_UNORM).encode(&voxels, 0, 1, &mut texels);
        let codes: Vec<_> = texels
            .chunks(2)
            .map(|b| u16::from_le_bytes([b[0], b[1]]))
            .collect();
        assert_eq!(codes, [0, 32767, 32768, 65535]);
    }

    #[test]
    fn eight_bit_codes_fill_sixteen_bits_with_the_same_fraction() {
        let mut texels = [0; 8];
        let voxels = Voxels::U8(vec![0, 1, 200, 255]);
        format(vk::Format::R16_UNORM).encode(&voxels, 0, 1, &mut texels);
        let fractions: Vec<_> = texels
            .chunks(2)
            .map(|b| f64::from(u16::from_le_bytes([b[0], b[1]])) / 65535.0)
            .collect();
        assert_eq!(fractions, [0.0, 1.0 / 255.0, 200.0 / 255.0, 1.0]);
    }

    #[test]
    fn a_run_takes_every_nth_voxel_from_its_first_on() {
        let mut texels = [0; 12];
        let voxels = Voxels::U16((0..20).collect());
        format(vk::Format::R32_SFLOAT).encode(&voxels, 3, 5, &mut texels);
        let numbers = texels.as_chunks::<4>().0;
        let numbers: Vec<_> = numbers.iter().map(|&b| f32::from_le_bytes(b)).collect();
        assert_eq!(numbers, [3.0, 8.0, 13.0]);
    }
}
