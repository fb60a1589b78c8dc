//! Which stored numbers mean that there is no data.
//!
//! NetCDF Users Guide, appendix B: `_FillValue`, `missing_value`, and what lies outside `valid_range` or
//! `valid_min` and `valid_max`, all in the stored type. A header has room for one such number. The others
//! become it while voxels are read; where there is none they become NaN, and integers, which have no NaN, get
//! an unused number for it.

use super::model::Attributes;
use crate::volume::{VoxelType, Voxels};

/// The rules of one variable.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Missing {
    /// The number that goes into the header.
    pub fill: Option<f64>,
    /// Other numbers that mean the same.
    others: Vec<f64>,
    /// Numbers outside are no data.
    valid: [f64; 2],
}

impl Missing {
    /// Nothing is missing.
    pub(crate) const NONE: Self = Self {
        fill: None,
        others: Vec::new(),
        valid: [f64::NEG_INFINITY, f64::INFINITY],
    };

    /// From the attributes of a variable whose numbers are read as `stored`. With `has_default`, the container
    /// has a number of its own for what was never written.
    pub(crate) fn of(attributes: &Attributes, stored: VoxelType, has_default: bool) -> Self {
        let in_type = |number: f64| in_type(number, stored);
        let list = |name| attributes.numbers(name).unwrap_or(&[]).iter().copied();
        let mut named: Vec<f64> = Vec::new();
        let standard =
            default_fill(stored).filter(|_| has_default && attributes.get("_FillValue").is_none());
        // A NaN needs no rule: it is no number in every format.
        for number in list("_FillValue")
            .take(1)
            .chain(list("missing_value"))
            .map(in_type)
            .chain(standard)
            .filter(|number| !number.is_nan())
        {
            if !named.contains(&number) {
                named.push(number);
            }
        }
        let mut others = named.into_iter();
        let mut fill = others.next();
        let [mut low, mut high] = match attributes.numbers("valid_range") {
            Some(&[low, high]) => [low, high],
            _ => {
                let end = |name, open| attributes.number(name).unwrap_or(open);
                [
                    end("valid_min", f64::NEG_INFINITY),
                    end("valid_max", f64::INFINITY),
                ]
            }
        }
        .map(in_type);
        if low.is_nan() || high.is_nan() || low > high {
            [low, high] = Self::NONE.valid;
        }
        if fill.is_none() {
            fill = unused([low, high], stored);
        }
        Self {
            fill,
            others: others.collect(),
            valid: [low, high],
        }
    }

    /// A number as its type holds it, with all of its digits; `None` where it means that there is no data.
    #[cfg(feature = "netcdf")]
    pub(crate) fn known(&self, number: f64, stored: VoxelType) -> Option<f64> {
        let kept = in_type(number, stored);
        let is_missing = kept.is_nan()
            || self.fill == Some(kept)
            || self.others.contains(&kept)
            || kept < self.valid[0]
            || kept > self.valid[1];
        // Those of unsigned types were counted from below.
        let is_wrapped = number < 0.0 && kept >= 0.0;
        (!is_missing).then_some(if is_wrapped { kept } else { number })
    }

    /// True where voxels stay as they were read.
    fn is_one_number(&self) -> bool {
        self.others.is_empty() && self.valid == Self::NONE.valid
    }

    /// Makes one number, or NaN, of all that mean no data.
    pub(crate) fn unify(&self, voxels: &mut Voxels) {
        if self.is_one_number() {
            return;
        }
        let is_missing = |number: f64| {
            number < self.valid[0] || number > self.valid[1] || self.others.contains(&number)
        };
        macro_rules! unify {
            ($numbers:expr, $fill:expr) => {{
                let fill = $fill;
                for number in $numbers.iter_mut() {
                    if is_missing(f64::from(*number)) {
                        *number = fill;
                    }
                }
            }};
        }
        // `unused` and `in_type` see to it that the fill of an integer type is one of its numbers.
        let fill = self.fill;
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a number of the type, and the cast saturates"
        )]
        match voxels {
            Voxels::U8(numbers) => unify!(numbers, fill.unwrap_or(0.0) as u8),
            Voxels::I8(numbers) => unify!(numbers, fill.unwrap_or(0.0) as i8),
            Voxels::U16(numbers) => unify!(numbers, fill.unwrap_or(0.0) as u16),
            Voxels::I16(numbers) => unify!(numbers, fill.unwrap_or(0.0) as i16),
            Voxels::F16(numbers) => {
                unify!(numbers, half::f16::from_f64(fill.unwrap_or(f64::NAN)))
            }
            Voxels::F32(numbers) => unify!(numbers, fill.unwrap_or(f64::NAN) as f32),
        }
    }
}

/// An attribute's number as the stored type holds it: negative ones of a type read as unsigned begin again from
/// above, floats lose the digits that the type has no room for.
fn in_type(number: f64, stored: VoxelType) -> f64 {
    let wrapped = |bits: i32| {
        if number < 0.0 && number.is_finite() {
            number + 2_f64.powi(bits)
        } else {
            number
        }
    };
    match stored {
        VoxelType::U8 => wrapped(8),
        VoxelType::U16 => wrapped(16),
        VoxelType::U32 => as_f32(wrapped(32)),
        VoxelType::U64 => as_f32(wrapped(64)),
        VoxelType::I8 | VoxelType::I16 => number,
        VoxelType::F16 => half::f16::from_f64(number).to_f64(),
        VoxelType::I32 | VoxelType::I64 | VoxelType::F32 | VoxelType::F64 => as_f32(number),
    }
}

/// Numbers of 32 and 64 bits are kept as f32.
#[allow(
    clippy::cast_possible_truncation,
    reason = "rounding is what this is for"
)]
fn as_f32(number: f64) -> f64 {
    f64::from(number as f32)
}

/// A number of a small integer type outside `valid`.
fn unused([low, high]: [f64; 2], stored: VoxelType) -> Option<f64> {
    let [least, most] = match stored {
        VoxelType::U8 => [0.0, f64::from(u8::MAX)],
        VoxelType::I8 => [f64::from(i8::MIN), f64::from(i8::MAX)],
        VoxelType::U16 => [0.0, f64::from(u16::MAX)],
        VoxelType::I16 => [f64::from(i16::MIN), f64::from(i16::MAX)],
        _ => return None,
    };
    if most > high {
        Some(most)
    } else {
        Some(least).filter(|&least| least < low)
    }
}

/// What the NetCDF library writes where nothing was written, netcdf.h `NC_FILL_*`; bytes have no such number
/// that may not be data.
fn default_fill(stored: VoxelType) -> Option<f64> {
    match stored {
        VoxelType::U8 | VoxelType::I8 | VoxelType::F16 => None,
        VoxelType::I16 => Some(-32_767.0),
        VoxelType::U16 => Some(65_535.0),
        VoxelType::I32 => Some(-2_147_483_647.0),
        VoxelType::U32 => Some(4_294_967_295.0),
        VoxelType::I64 => Some(-9_223_372_036_854_775_806.0),
        VoxelType::U64 => Some(18_446_744_073_709_551_614.0),
        VoxelType::F32 | VoxelType::F64 => Some(9.969_209_968_386_869e36),
    }
    .map(|number| in_type(number, stored))
}

#[cfg(test)]
mod tests {
    use super::super::model::Value;
    use super::*;

    fn attributes(list: &[(&str, &[f64])]) -> Attributes {
        let pairs = list
            .iter()
            .map(|(name, numbers)| ((*name).to_owned(), Value::Numbers(numbers.to_vec())));
        Attributes(pairs.collect())
    }

    fn unified(list: &[(&str, &[f64])], mut voxels: Voxels) -> (Option<f64>, Voxels) {
        let missing = Missing::of(&attributes(list), voxels.voxel_type(), false);
        missing.unify(&mut voxels);
        (missing.fill, voxels)
    }

    #[test]
    fn all_that_means_no_data_becomes_the_fill() {
        let list: &[(&str, &[f64])] = &[
            ("_FillValue", &[-1.0]),
            ("missing_value", &[-2.0, -3.0]),
            ("valid_range", &[-2.0, 100.0]),
        ];
        let (fill, voxels) = unified(list, Voxels::I16(vec![-3, -2, -1, 0, 100, 101]));
        assert_eq!(fill, Some(-1.0));
        assert_eq!(voxels, Voxels::I16(vec![-1, -1, -1, 0, 100, -1]));
    }

    #[test]
    fn integers_without_a_fill_get_an_unused_number_and_floats_nan() {
        let (fill, voxels) = unified(&[("valid_max", &[9.0])], Voxels::U8(vec![9, 10, 0]));
        assert_eq!((fill, voxels), (Some(255.0), Voxels::U8(vec![9, 255, 0])));
        let (fill, voxels) = unified(&[("valid_min", &[0.1])], Voxels::F32(vec![0.1, 0.0]));
        assert_eq!(fill, None);
        assert_eq!(
            voxels.stored(0),
            0.1,
            "0.1 is the same number in f32 and f64"
        );
        assert!(voxels.stored(1).is_nan());
    }

    #[test]
    fn a_negative_fill_of_unsigned_numbers_counts_from_above() {
        let (fill, _) = unified(&[("_FillValue", &[-1.0])], Voxels::U8(vec![0]));
        assert_eq!(fill, Some(255.0));
        let (fill, _) = unified(&[("_FillValue", &[-2.0])], Voxels::U16(vec![0]));
        assert_eq!(fill, Some(65_534.0));
    }

    #[test]
    fn what_was_never_written_is_no_data_where_the_container_says_so() {
        let none = Attributes::default();
        let of = |stored, has_default| Missing::of(&none, stored, has_default).fill;
        assert_eq!(of(VoxelType::I16, true), Some(-32_767.0));
        assert_eq!(of(VoxelType::I16, false), None);
        assert_eq!(of(VoxelType::I8, true), None);
        let written = attributes(&[("_FillValue", &[f64::NAN])]);
        assert_eq!(Missing::of(&written, VoxelType::F32, true).fill, None);
    }
}
