//! What JSON has no number for: a fill crosses as its bits, it may be NaN; an affine as its twelve numbers.

use serde::{Deserialize, Deserializer, Serialize, Serializer};

pub mod bits {
    use super::*;

    pub fn serialize<S: Serializer>(number: &Option<f64>, to: S) -> Result<S::Ok, S::Error> {
        number.map(f64::to_bits).serialize(to)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Option<f64>, D::Error> {
        Ok(Option::deserialize(from)?.map(f64::from_bits))
    }
}

pub mod affine {
    use super::*;
    use glam::DAffine3;

    pub fn serialize<S: Serializer>(affine: &DAffine3, to: S) -> Result<S::Ok, S::Error> {
        affine.to_cols_array().serialize(to)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<DAffine3, D::Error> {
        Ok(DAffine3::from_cols_array(&Deserialize::deserialize(from)?))
    }
}
