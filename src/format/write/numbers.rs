//! Stored numbers to the bytes of a file, little-endian.
//!
//! ```text
//! value  = stored * slope + intercept
//! number = value, or with a window (value - low) / (high - low) * largest
//! ```

use crate::volume::{Rescale, VoxelType, Voxels};
use half::f16;

/// How a stored number becomes one of the file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Map {
    /// The type in the file.
    pub number: VoxelType,
    /// The identity where stored numbers are kept.
    pub rescale: Rescale,
    /// The values that are spread over the type.
    pub window: Option<[f64; 2]>,
    /// The stored number that means "no data".
    pub fill: Option<f64>,
}

/// Stored numbers as little-endian bytes of their type.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Bytes {
    pub bytes: Vec<u8>,
    pub stored: VoxelType,
}

/// What changed on the way.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Tally {
    /// Beyond the ends of the type.
    pub clamped: u64,
    /// Not finite, where the type has integers only.
    pub not_finite: u64,
    /// Rounded to f32 before they came here.
    pub rounded: u64,
}

impl Tally {
    pub(super) fn notes(self, number: VoxelType) -> Vec<String> {
        let name = number.name();
        let lines = [
            (
                self.clamped,
                format!("beyond the ends of {name} were moved to them"),
            ),
            (
                self.not_finite,
                format!("that were not finite are 0: {name} has no such number"),
            ),
            (self.rounded, "were rounded to 32-bit floats".to_owned()),
        ];
        let said = lines.into_iter().filter(|(count, _)| *count > 0);
        said.map(|(count, what)| format!("{count} numbers {what}"))
            .collect()
    }
}

impl Bytes {
    pub(super) fn of(voxels: &Voxels) -> Self {
        let bytes = match voxels {
            Voxels::U8(v) => v.clone(),
            Voxels::I8(v) => v.iter().flat_map(|n| n.to_le_bytes()).collect(),
            Voxels::U16(v) => v.iter().flat_map(|n| n.to_le_bytes()).collect(),
            Voxels::I16(v) => v.iter().flat_map(|n| n.to_le_bytes()).collect(),
            Voxels::F16(v) => v.iter().flat_map(|n| n.to_le_bytes()).collect(),
            Voxels::F32(v) => v.iter().flat_map(|n| n.to_le_bytes()).collect(),
        };
        Self {
            bytes,
            stored: voxels.voxel_type(),
        }
    }
}

impl Map {
    /// The bytes of the file.
    pub(super) fn apply(&self, from: Bytes, tally: &mut Tally) -> Vec<u8> {
        let marks_holes = self.fill.is_some() && self.number.is_float();
        let is_kept = self.rescale == Rescale::default() && self.window.is_none() && !marks_holes;
        if is_kept && from.stored == self.number {
            return from.bytes;
        }
        let mut out = Vec::new();
        // One arm a type: the compiler makes each a tight loop.
        macro_rules! each {
            ($number:ty, $wide:expr) => {{
                let (all, _) = from.bytes.as_chunks::<{ size_of::<$number>() }>();
                out.reserve_exact(all.len().saturating_mul(self.number.bytes()));
                for bytes in all {
                    let stored: f64 = $wide(<$number>::from_le_bytes(*bytes));
                    self.push(stored, &mut out, tally);
                }
            }};
        }
        #[allow(
            clippy::cast_precision_loss,
            reason = "only numbers that change their type come here; an f64 is as near as it gets"
        )]
        match from.stored {
            VoxelType::U8 => each!(u8, f64::from),
            VoxelType::I8 => each!(i8, f64::from),
            VoxelType::U16 => each!(u16, f64::from),
            VoxelType::I16 => each!(i16, f64::from),
            VoxelType::U32 => each!(u32, f64::from),
            VoxelType::I32 => each!(i32, f64::from),
            VoxelType::U64 => each!(u64, |n: u64| n as f64),
            VoxelType::I64 => each!(i64, |n: i64| n as f64),
            VoxelType::F16 => each!(f16, f64::from),
            VoxelType::F32 => each!(f32, f64::from),
            VoxelType::F64 => each!(f64, |n: f64| n),
        }
        out
    }

    fn push(&self, stored: f64, out: &mut Vec<u8>, tally: &mut Tally) {
        let mut value = stored * self.rescale.slope + self.rescale.intercept;
        if self.fill == Some(stored) && self.number.is_float() {
            value = f64::NAN;
        }
        if let Some([low, high]) = self.window {
            // What lies beyond a window is at its ends: that is what a window is.
            let along = ((value - low) / (high - low)).clamp(0.0, 1.0);
            value = along * largest(self.number);
        }
        encode(value, self.number, out, tally);
    }
}

/// The number that full intensity has.
fn largest(number: VoxelType) -> f64 {
    match number {
        VoxelType::U8 => u8::MAX.into(),
        VoxelType::I8 => i8::MAX.into(),
        VoxelType::U16 => u16::MAX.into(),
        VoxelType::I16 => i16::MAX.into(),
        VoxelType::U32 => u32::MAX.into(),
        VoxelType::I32 => i32::MAX.into(),
        // The largest f64 below 2^64 and 2^63.
        VoxelType::U64 => 18_446_744_073_709_549_568.0,
        VoxelType::I64 => 9_223_372_036_854_774_784.0,
        VoxelType::F16 | VoxelType::F32 | VoxelType::F64 => 1.0,
    }
}

/// Appends the nearest number of a type.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_precision_loss,
    reason = "rounding to the type is what this is for; a cast from a float stops at the ends of the type"
)]
fn encode(value: f64, number: VoxelType, out: &mut Vec<u8>, tally: &mut Tally) {
    macro_rules! integer {
        ($number:ty) => {{
            if !value.is_finite() {
                tally.not_finite = tally.not_finite.saturating_add(1);
            }
            let rounded = value.round_ties_even();
            let kept = rounded as $number;
            // 2^64 and 2^63 as f64 are beyond the largest integers, which turn into them.
            let is_beyond = value.is_finite() && kept as f64 != rounded;
            tally.clamped = tally.clamped.saturating_add(is_beyond.into());
            let kept = if value.is_finite() { kept } else { 0 };
            out.extend(kept.to_le_bytes());
        }};
    }
    match number {
        VoxelType::U8 => integer!(u8),
        VoxelType::I8 => integer!(i8),
        VoxelType::U16 => integer!(u16),
        VoxelType::I16 => integer!(i16),
        VoxelType::U32 => integer!(u32),
        VoxelType::I32 => integer!(i32),
        VoxelType::U64 => integer!(u64),
        VoxelType::I64 => integer!(i64),
        VoxelType::F16 => {
            let kept = f16::from_f64(value);
            tally.clamped = tally
                .clamped
                .saturating_add((value.is_finite() && !kept.is_finite()).into());
            out.extend(kept.to_le_bytes());
        }
        VoxelType::F32 => {
            let kept = value as f32;
            tally.clamped = tally
                .clamped
                .saturating_add((value.is_finite() && !kept.is_finite()).into());
            out.extend(kept.to_le_bytes());
        }
        VoxelType::F64 => out.extend(value.to_le_bytes()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mapped(map: Map, voxels: Voxels) -> (Vec<u8>, Tally) {
        let mut tally = Tally::default();
        let bytes = map.apply(Bytes::of(&voxels), &mut tally);
        (bytes, tally)
    }

    const KEEP: Map = Map {
        number: VoxelType::U8,
        rescale: Rescale {
            slope: 1.0,
            intercept: 0.0,
        },
        window: None,
        fill: None,
    };

    #[test]
    fn what_does_not_fit_goes_to_the_nearest_end_and_is_counted() {
        let numbers = [-1.0, 0.4, 0.6, 1.5, 255.4, 256.0, f32::NAN, f32::INFINITY];
        let (bytes, tally) = mapped(KEEP, Voxels::F32(numbers.to_vec()));
        assert_eq!(bytes, [0, 0, 1, 2, 255, 255, 0, 0]);
        let wanted = Tally {
            clamped: 2,
            not_finite: 2,
            rounded: 0,
        };
        assert_eq!(tally, wanted);
        assert_eq!(tally.notes(VoxelType::U8).len(), 2);
    }

    #[test]
    fn a_window_goes_from_nothing_to_the_largest_number_and_stops_there() {
        let map = Map {
            window: Some([-1000.0, 1000.0]),
            rescale: Rescale {
                slope: 2.0,
                intercept: -1000.0,
            },
            ..KEEP
        };
        let (bytes, tally) = mapped(map, Voxels::I16(vec![-5, 0, 500, 1000, 2000]));
        assert_eq!(bytes, [0, 0, 128, 255, 255]);
        assert_eq!(tally, Tally::default());
    }

    #[test]
    fn voxels_without_data_are_no_numbers_where_the_type_has_such() {
        let map = Map {
            number: VoxelType::F32,
            fill: Some(-9.0),
            ..KEEP
        };
        let (bytes, _) = mapped(map, Voxels::F32(vec![-9.0, 1.5]));
        assert!(f32::from_le_bytes(bytes[..4].try_into().unwrap()).is_nan());
        assert_eq!(bytes[4..], 1.5_f32.to_le_bytes());
    }
}
