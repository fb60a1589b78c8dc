//! The color map of a page: all reds, all greens, all blues, of 16 bits each (TIFF 6.0, section 5).

use super::TIFF;
use super::ifd::{self, Directory, Reader};
use crate::format::problem::invalid;
use crate::volume::{Problem, VoxelType};

/// A color map.
#[derive(Debug)]
pub(super) struct Palette {
    numbers: Vec<u16>,
    colors: usize,
}

impl Palette {
    pub(super) fn read(
        reader: &mut Reader,
        directory: &Directory,
        bits: u32,
    ) -> Result<Self, Problem> {
        let colors = 1_u64.wrapping_shl(bits.min(16));
        let numbers = reader
            .integers(directory, ifd::COLOR_MAP, colors.saturating_mul(3))?
            .ok_or_else(|| invalid(TIFF, "ColorMap", "an entry", "none"))?;
        let mut numbers: Vec<u16> = numbers
            .into_iter()
            .map(|n| u16::try_from(n).unwrap_or(u16::MAX))
            .collect();
        // Old writers gave bytes, and libtiff's tools take them for what they are.
        if numbers.iter().all(|&n| n < 256) {
            numbers.iter_mut().for_each(|n| *n = n.wrapping_shl(8));
        }
        Ok(Self {
            numbers,
            colors: usize::try_from(colors).unwrap_or(usize::MAX),
        })
    }

    /// Bytes where the map was made of bytes, doubled or shifted.
    pub(super) fn stored(&self) -> VoxelType {
        let is_byte = |n: &u16| {
            let [high, low] = n.to_be_bytes();
            low == 0 || low == high
        };
        if self.numbers.iter().all(is_byte) {
            VoxelType::U8
        } else {
            VoxelType::U16
        }
    }

    /// Red, green or blue of a color.
    pub(super) fn entry(&self, sample: u32, index: usize) -> u16 {
        let plane = usize::try_from(sample).unwrap_or(usize::MAX);
        let at = plane.saturating_mul(self.colors).saturating_add(index);
        self.numbers.get(at).copied().unwrap_or(0)
    }
}
