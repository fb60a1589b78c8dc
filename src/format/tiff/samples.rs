//! Rows of one sample out of the chunks that lie side by side: bits unpacked, tiles joined, YCbCr to RGB.

use super::TIFF;
use super::chunk::Pixels;
use super::page::{Color, Page};
use super::palette::Palette;
use crate::format::convert::Endian;
use crate::format::problem::invalid;
use crate::volume::{Problem, VoxelType};
use std::ops::Range;

/// Rows of numbers of one sample, as wide as the wanted box.
pub(super) struct Band {
    columns: Range<u32>,
    /// Rows inside the chunks.
    rows: Range<u32>,
    stored: VoxelType,
    pub bytes: Vec<u8>,
    pub endian: Endian,
}

/// Which chunk of a page: rows of chunks, and with separate planes one sample after the other.
pub(super) fn chunk_index(page: &Page, column: u32, row: u32, sample: u32) -> usize {
    let plane = if page.is_planar { sample } else { 0 };
    let index = u64::from(plane)
        .saturating_mul(page.down().into())
        .saturating_add(row.into())
        .saturating_mul(page.across().into())
        .saturating_add(column.into());
    usize::try_from(index).unwrap_or(usize::MAX)
}

impl Band {
    pub(super) fn new(columns: Range<u32>, rows: Range<u32>, stored: VoxelType) -> Self {
        Self {
            columns,
            rows,
            stored,
            bytes: Vec::new(),
            endian: Endian::Little,
        }
    }

    /// Takes over the part of one chunk that lies inside the band.
    pub(super) fn take(
        &mut self,
        page: &Page,
        column: u32,
        pixels: &Pixels,
        sample: u32,
    ) -> Result<(), Problem> {
        let left = column.saturating_mul(page.chunk_width);
        let from = self.columns.start.saturating_sub(left);
        let to = self.columns.end.saturating_sub(left).min(page.chunk_width);
        let to_column = left.saturating_add(from).saturating_sub(self.columns.start);
        self.endian = pixels.endian;
        let number_bytes = self.stored.bytes();
        let row_bytes =
            side(self.columns.end.saturating_sub(self.columns.start)).saturating_mul(number_bytes);
        let rows = side(self.rows.end.saturating_sub(self.rows.start));
        self.bytes.resize(row_bytes.saturating_mul(rows), 0);
        let packed_row = usize::try_from(page.packed_row_bytes()).unwrap_or(usize::MAX);
        let packed_rows = pixels
            .bytes
            .chunks_exact(packed_row.max(1))
            .skip(side(self.rows.start))
            .take(rows);
        let mut filled = 0_usize;
        let out_rows = self.bytes.chunks_exact_mut(row_bytes.max(1));
        for (out, packed) in out_rows.zip(packed_rows) {
            let begins = side(to_column).saturating_mul(number_bytes);
            let out = out.get_mut(begins..).unwrap_or_default();
            if row(page, packed, from..to, sample, out).is_some() {
                filled = filled.saturating_add(1);
            }
        }
        if filled != rows {
            let wanted = format!("{rows} rows of a {}", page.chunk_word());
            return Err(invalid(TIFF, "page", wanted, &filled.to_string()));
        }
        Ok(())
    }

    /// The numbers of a color map that the band's numbers stand for, little-endian.
    pub(super) fn through(&self, palette: &Palette, sample: u32, stored: VoxelType) -> Vec<u8> {
        let mut bytes = Vec::with_capacity(self.bytes.len().saturating_mul(2));
        let mut push = |index: usize| {
            let number = palette.entry(sample, index);
            match stored {
                VoxelType::U8 => bytes.push(number.to_be_bytes()[0]),
                _ => bytes.extend(number.to_le_bytes()),
            }
        };
        match self.stored {
            VoxelType::U16 => {
                for pair in self.bytes.as_chunks::<2>().0 {
                    push(match self.endian {
                        Endian::Little => u16::from_le_bytes(*pair).into(),
                        Endian::Big => u16::from_be_bytes(*pair).into(),
                    });
                }
            }
            _ => self.bytes.iter().for_each(|&index| push(index.into())),
        }
        bytes
    }
}

/// Copies one sample of the pixels `columns` of a packed row to the beginning of `out`; `None` where it is not there.
fn row(page: &Page, packed: &[u8], columns: Range<u32>, sample: u32, out: &mut [u8]) -> Option<()> {
    let samples = side(page.samples_in_chunk());
    let sample = if page.is_planar { 0 } else { side(sample) };
    let (from, to) = (side(columns.start), side(columns.end));
    let count = to.saturating_sub(from);
    if page.look.bits < 8 {
        for (k, out) in out.iter_mut().take(count).enumerate() {
            let pixel = from.saturating_add(k);
            let index = pixel.saturating_mul(samples).saturating_add(sample);
            *out = unpack(packed, index, page.look.bits)?;
        }
        return Some(());
    }
    let number = page.look.stored.bytes();
    let pixel_bytes = number.saturating_mul(samples);
    let pixels = packed
        .chunks_exact(pixel_bytes.max(1))
        .skip(from)
        .take(count);
    let begins = sample.saturating_mul(number);
    let ends = begins.saturating_add(number);
    for (out, pixel) in out.chunks_exact_mut(number.max(1)).zip(pixels) {
        if page.look.color == Color::YCbCr {
            *out.first_mut()? = rgb_of(*pixel.first_chunk()?, sample);
        } else {
            out.copy_from_slice(pixel.get(begins..ends)?);
        }
    }
    Some(())
}

/// A number of 1, 2 or 4 bits; the first lies in the high bits of a byte.
fn unpack(packed: &[u8], index: usize, bits: u32) -> Option<u8> {
    let bit = index.saturating_mul(side(bits));
    let byte = packed.get(bit.wrapping_shr(3)).copied()?;
    let used = u32::try_from(bit & 7).unwrap_or(0).saturating_add(bits);
    let mask = 1_u8.wrapping_shl(bits).wrapping_sub(1);
    Some(byte.wrapping_shr(8_u32.saturating_sub(used)) & mask)
}

/// ITU-R BT.601 with full range, as JFIF 1.02 writes it:
/// R = Y + 1.402 Cr, G = Y - 0.344136 Cb - 0.714136 Cr, B = Y + 1.772 Cb, with Cb and Cr about 128.
#[allow(
    clippy::arithmetic_side_effects,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "floats, clamped to a byte"
)]
fn rgb_of(ycbcr: [u8; 3], sample: usize) -> u8 {
    let [y, cb, cr] = ycbcr.map(f32::from);
    let (cb, cr) = (cb - 128.0, cr - 128.0);
    let color = match sample {
        0 => y + 1.402 * cr,
        1 => y - 0.344_136 * cb - 0.714_136 * cr,
        _ => y + 1.772 * cb,
    };
    color.round().clamp(0.0, 255.0) as u8
}

/// No machine has a usize below 32 bits.
pub(super) fn side(n: u32) -> usize {
    usize::try_from(n).unwrap_or(usize::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_numbers_come_out_of_bytes_from_the_high_end() {
        let packed = [0b1011_0001, 0b0110_0011];
        let bits: Vec<u8> = (0..9).map(|i| unpack(&packed, i, 1).unwrap()).collect();
        assert_eq!(bits, [1, 0, 1, 1, 0, 0, 0, 1, 0]);
        let pairs: Vec<u8> = (0..8).map(|i| unpack(&packed, i, 2).unwrap()).collect();
        assert_eq!(pairs, [2, 3, 0, 1, 1, 2, 0, 3]);
        let halves: Vec<u8> = (0..4).map(|i| unpack(&packed, i, 4).unwrap()).collect();
        assert_eq!(halves, [11, 1, 6, 3]);
    }

    #[test]
    fn the_corners_of_ycbcr_are_the_primaries() {
        // Rounded Y, Cb, Cr of red, green, blue and gray by the inverse of the formula.
        for (ycbcr, rgb) in [
            ([76, 85, 255], [254, 0, 0]),
            ([150, 44, 21], [0, 255, 1]),
            ([29, 255, 107], [0, 0, 254]),
            ([128, 128, 128], [128, 128, 128]),
        ] {
            let found = [0, 1, 2].map(|k| rgb_of(ycbcr, k));
            for (found, wanted) in found.iter().zip(rgb) {
                assert!(found.abs_diff(wanted) <= 1, "{ycbcr:?}: {found}, {wanted}");
            }
        }
    }
}
