//! Levels: the fixed surfaces of section 4, by code table 4.5.

use super::section::Section;
use crate::format::cf::{Attributes, Value};
use crate::volume::Problem;

/// The types of the two surfaces around a field, and how high they are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Level {
    pub surfaces: [u8; 2],
    /// In the unit of the first surface's type; of a layer its middle.
    pub height: f64,
}

/// No surface.
const NONE: u8 = 255;

impl Level {
    pub(super) fn of(section: &Section) -> Result<Self, Problem> {
        let surfaces = [section.u8(23)?, section.u8(29)?];
        let height = |octet: usize| -> Result<Option<f64>, Problem> {
            let bits = section.u32(octet.saturating_add(1))?;
            let scaled = f64::from(section.i32(octet.saturating_add(1))?);
            let is_missing = section.u8(octet)? == u8::MAX || bits == u32::MAX;
            // A power of ten divides exactly, one with a minus does not multiply so.
            let factor = section.i8(octet)?;
            let power = 10_f64.powi(factor.saturating_abs());
            let height = if factor < 0 {
                scaled * power
            } else {
                scaled / power
            };
            Ok((!is_missing).then_some(height))
        };
        let first = height(24)?.unwrap_or(0.0);
        let second = if surfaces[0] == surfaces[1] {
            height(30)?
        } else {
            None
        };
        Ok(Self {
            surfaces,
            height: second.map_or(first, |second| 0.5 * (first + second)),
        })
    }

    /// What the vertical coordinate is; `None` for a surface that has no height of its own.
    pub(super) fn kind(&self, centre: u16) -> Kind {
        /// The number of NCEP, whose levels of models count upwards.
        const NCEP: u16 = 7;
        let [first, second] = self.surfaces;
        let model = if centre == NCEP { UP } else { DOWN };
        let (word, unit, positive) = match first {
            1 => ("surface", None, UP),
            2 => ("cloudBase", None, UP),
            3 => ("cloudTop", None, UP),
            4 => ("freezingLevel", None, UP),
            6 => ("maxWind", None, UP),
            7 => ("tropopause", None, UP),
            8 => ("top", None, UP),
            100 => ("isobaric", Some("Pa"), DOWN),
            101 => ("meanSea", None, UP),
            102 => ("heightAboveSea", Some("m"), UP),
            103 => ("heightAboveGround", Some("m"), UP),
            104 => ("sigma", Some("1"), DOWN),
            105 => ("hybrid", Some("1"), model),
            106 => ("depthBelowLand", Some("m"), DOWN),
            107 => ("theta", Some("K"), UP),
            118 | 119 => ("hybridHeight", Some("1"), UP),
            150 => ("generalVertical", Some("1"), DOWN),
            160 => ("depthBelowSea", Some("m"), DOWN),
            200 => ("atmosphere", None, UP),
            _ => ("level", Some("1"), UP),
        };
        let is_layer = second != NONE;
        Kind {
            word: match (word, is_layer) {
                ("level", _) => format!("level{first}"),
                (word, true) => format!("{word}Layer"),
                (word, false) => word.to_owned(),
            },
            unit,
            positive,
        }
    }
}

const UP: &str = "up";
const DOWN: &str = "down";

/// A kind of levels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Kind {
    /// As it stands in the names of variables and axes.
    pub word: String,
    /// `None` where a field lies on one surface that has no number.
    pub unit: Option<&'static str>,
    positive: &'static str,
}

impl Kind {
    pub(super) fn attributes(&self) -> Attributes {
        let text = |name: &str, text: &str| (name.to_owned(), Value::Text(text.to_owned()));
        Attributes(vec![
            text("axis", "Z"),
            text("units", self.unit.unwrap_or("1")),
            text("positive", self.positive),
        ])
    }
}
