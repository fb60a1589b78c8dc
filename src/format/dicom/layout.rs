//! How the samples of a picture are laid out, by DICOM PS3.3 section C.7.6.3.1 and PS3.5 section 8.
//!
//! ```text
//! a frame = rows x columns x samples, each of `allocated` bits, of which `stored` bits below `high bit` count
//! ```

use super::DICOM;
use super::fields::DataSet;
use super::tags::{self, *};
use crate::format::convert::to_u64;
use crate::format::problem::{escape, invalid, missing, unsupported};
use crate::volume::{Problem, VoxelType};

/// What a frame looks like once it is decoded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Layout {
    pub rows: u32,
    pub columns: u32,
    pub frames: u32,
    pub bits_allocated: u16,
    pub bits_stored: u16,
    pub high_bit: u16,
    pub is_signed: bool,
    pub is_float: bool,
    pub color: Color,
    /// Reds, greens and blues lie in planes of their own.
    pub is_planar: bool,
}

/// What the samples of a pixel mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Color {
    /// The largest number is brightest.
    Monochrome,
    /// The smallest is.
    Inverted,
    Rgb,
    /// Luma and chroma, each for every pixel.
    YbrFull,
    /// Two pixels share their chroma.
    YbrFull422,
    /// JPEG 2000 turns it into red, green and blue itself.
    Ybr2000,
}

impl Layout {
    /// From the attributes of a data set whose pixels stand in `pixels`.
    pub(super) fn of(set: &DataSet, pixels: u32) -> Result<Self, Problem> {
        let size = |tag| match set.required_u16(tag)? {
            0 => Err(invalid(DICOM, &tags::name(tag), "a number above 0", "0")),
            size => Ok(u32::from(size)),
        };
        let color = color(set)?;
        let bits_allocated = set.required_u16(BITS_ALLOCATED)?;
        let is_float = pixels != PIXEL_DATA;
        let wanted: &[u16] = match pixels {
            FLOAT_PIXEL_DATA => &[32],
            DOUBLE_FLOAT_PIXEL_DATA => &[64],
            _ => &[1, 8, 16, 32],
        };
        if !wanted.contains(&bits_allocated) {
            let what = format!(
                "{bits_allocated} bits allocated for a sample of {}",
                tags::name(pixels)
            );
            return Err(unsupported(DICOM, what));
        }
        let bits_stored = match set.u16(BITS_STORED)? {
            Some(bits) if !is_float => bits,
            _ => bits_allocated,
        };
        let high_bit = match set.u16(HIGH_BIT)? {
            Some(bit) if !is_float => bit,
            _ => bits_stored.saturating_sub(1),
        };
        if bits_stored == 0
            || high_bit >= bits_allocated
            || high_bit.saturating_add(1) < bits_stored
        {
            let wanted = format!("1 to {bits_allocated} bits below the high bit");
            let found = format!("{bits_stored} bits, high bit {high_bit}");
            return Err(invalid(DICOM, &tags::name(BITS_STORED), wanted, &found));
        }
        let is_planar = set.u16(PLANAR_CONFIGURATION)?.unwrap_or(0) == 1;
        let layout = Self {
            rows: size(ROWS)?,
            columns: size(COLUMNS)?,
            frames: frames(set)?,
            bits_allocated,
            bits_stored,
            high_bit,
            is_signed: set.u16(PIXEL_REPRESENTATION)?.unwrap_or(0) == 1,
            is_float,
            color,
            is_planar: is_planar && color.samples() > 1,
        };
        let is_odd = color == Color::YbrFull422 && !layout.columns.is_multiple_of(2);
        let is_wide = match color {
            Color::Monochrome | Color::Inverted => false,
            Color::Rgb | Color::Ybr2000 => !matches!(bits_allocated, 8 | 16),
            Color::YbrFull | Color::YbrFull422 => bits_allocated != 8,
        };
        if is_wide || is_odd {
            let columns = layout.columns;
            let what = format!("colour of {bits_allocated} bits a sample and {columns} columns");
            return Err(unsupported(DICOM, what));
        }
        Ok(layout)
    }

    /// The type of a decoded sample.
    pub(super) fn stored(&self) -> VoxelType {
        match (self.bits_allocated, self.is_signed, self.is_float) {
            (64, _, _) => VoxelType::F64,
            (_, _, true) => VoxelType::F32,
            (1, _, _) | (8, false, _) => VoxelType::U8,
            (8, true, _) => VoxelType::I8,
            (16, false, _) => VoxelType::U16,
            (16, true, _) => VoxelType::I16,
            (_, false, _) => VoxelType::U32,
            (_, true, _) => VoxelType::I32,
        }
    }

    pub(super) fn pixels(&self) -> u64 {
        u64::from(self.rows).saturating_mul(self.columns.into())
    }

    /// Bytes of one sample once it is decoded.
    pub(super) fn sample_bytes(&self) -> u64 {
        to_u64(self.stored().bytes())
    }

    /// Bytes of a frame once it is decoded; at most 2^16 * 2^16 * 8.
    pub(super) fn frame_bytes(&self) -> u64 {
        self.pixels()
            .saturating_mul(self.sample_bytes())
            .saturating_mul(self.color.samples().into())
    }

    /// Bits of a frame as native pixels have it.
    pub(super) fn native_frame_bits(&self) -> u64 {
        let samples = match self.color {
            Color::YbrFull422 => 2,
            color => color.samples(),
        };
        self.pixels()
            .saturating_mul(samples.into())
            .saturating_mul(self.bits_allocated.into())
    }

    /// True where both make pictures of one volume.
    pub(super) fn fits(&self, other: &Self) -> bool {
        let alike = Self {
            frames: self.frames,
            is_planar: self.is_planar,
            color: self.color,
            ..*other
        };
        alike == *self
            && self.color.samples() == other.color.samples()
            && (self.color == Color::Inverted) == (other.color == Color::Inverted)
    }
}

impl Color {
    pub(super) fn samples(self) -> u32 {
        match self {
            Self::Monochrome | Self::Inverted => 1,
            _ => 3,
        }
    }
}

fn color(set: &DataSet) -> Result<Color, Problem> {
    let samples = set.u16(SAMPLES_PER_PIXEL)?.unwrap_or(1);
    let text = set.text(PHOTOMETRIC_INTERPRETATION);
    let color = match text.as_deref() {
        Some("MONOCHROME2") => Color::Monochrome,
        // Before 1993 the attribute could be left out.
        None if samples == 1 => Color::Monochrome,
        Some("MONOCHROME1") => Color::Inverted,
        Some("RGB") => Color::Rgb,
        Some("YBR_FULL") => Color::YbrFull,
        Some("YBR_FULL_422") => Color::YbrFull422,
        Some("YBR_RCT" | "YBR_ICT") => Color::Ybr2000,
        Some(other) => {
            let what = format!("the photometric interpretation `{}`", escape(other));
            return Err(unsupported(DICOM, what));
        }
        None => return Err(missing(DICOM, &tags::name(PHOTOMETRIC_INTERPRETATION))),
    };
    if u32::from(samples) != color.samples() {
        let wanted = format!("{} for {}", color.samples(), text.unwrap_or_default());
        return Err(invalid(
            DICOM,
            &tags::name(SAMPLES_PER_PIXEL),
            wanted,
            &samples.to_string(),
        ));
    }
    Ok(color)
}

fn frames(set: &DataSet) -> Result<u32, Problem> {
    match set.number(NUMBER_OF_FRAMES)? {
        None => Ok(1),
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a whole number of 1 to 10^9"
        )]
        Some(n) if (1.0..=1e9).contains(&n) && n.fract() == 0.0 => Ok(n as u32),
        Some(n) => Err(invalid(
            DICOM,
            &tags::name(NUMBER_OF_FRAMES),
            "a whole number above 0",
            &n.to_string(),
        )),
    }
}
