//! From stored numbers to values: `scale_factor`, `add_offset`, `_Unsigned`, `units`.
//!
//! CF Conventions 8.1: value = stored * scale_factor + add_offset. NetCDF Users Guide, appendix B:
//! `_Unsigned = "true"` lets a signed type hold unsigned numbers.

use super::missing::Missing;
use super::model::{Kind, Variable};
use crate::format::problem::{invalid, unsupported};
use crate::volume::{Problem, Rescale, VoxelType};

/// What the stored numbers of a variable mean.
#[derive(Clone, Debug)]
pub(crate) struct Values {
    pub stored: VoxelType,
    pub rescale: Rescale,
    pub missing: Missing,
    pub unit: Option<String>,
    pub is_labels: bool,
}

impl Values {
    pub(crate) fn of(variable: &Variable, format: &'static str) -> Result<Self, Problem> {
        let Kind::Numbers(stored) = variable.kind else {
            return Err(unsupported(format, "a variable that holds no numbers"));
        };
        let attributes = &variable.attributes;
        let is_unsigned = attributes
            .text("_Unsigned")
            .is_some_and(|word| word.eq_ignore_ascii_case("true"));
        let stored = if is_unsigned {
            unsigned(stored)
        } else {
            stored
        };
        let number = |name: &str, default: f64| -> Result<f64, Problem> {
            if attributes.get(name).is_none() {
                return Ok(default);
            }
            let found = attributes.number(name);
            found.filter(|n| n.is_finite()).ok_or_else(|| {
                let found = found.map_or("text".to_owned(), |n| n.to_string());
                invalid(format, name, "a finite number", &found)
            })
        };
        let slope = number("scale_factor", 1.0)?;
        if !slope.is_normal() {
            let found = slope.to_string();
            return Err(invalid(
                format,
                "scale_factor",
                "a number other than 0",
                &found,
            ));
        }
        let has_flags = ["flag_values", "flag_meanings"]
            .iter()
            .any(|name| attributes.get(name).is_some());
        Ok(Self {
            stored,
            rescale: Rescale {
                slope,
                intercept: number("add_offset", 0.0)?,
            },
            missing: Missing::of(attributes, stored, true),
            unit: attributes.text("units").map(str::to_owned),
            is_labels: has_flags && attributes.get("flag_masks").is_none(),
        })
    }
}

/// The unsigned type of the same size.
fn unsigned(stored: VoxelType) -> VoxelType {
    match stored {
        VoxelType::I8 => VoxelType::U8,
        VoxelType::I16 => VoxelType::U16,
        VoxelType::I32 => VoxelType::U32,
        VoxelType::I64 => VoxelType::U64,
        other => other,
    }
}
