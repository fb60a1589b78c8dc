//! The variables of a file that a derived quantity is made of, by their CF standard names, then by the names that models
//! write.
//!
//! ```text
//! value in SI = offset + sum of scale_k x_k        such as  theta = 300 K + T,  p = 1 P + 1 PB  of WRF
//! ```
//!
//! WRF's registry: T is potential temperature less 300 K, P and PB are the pressure's perturbation and base state, Pa;
//! QVAPOR is the mixing ratio of water vapour, kg/kg.

use super::super::axes::{Axis, axes_of, coordinate};
use super::super::choose::drawable;
use super::super::coordinates::Coordinate;
use super::super::model::{Arrays, Variable};
use super::super::units::{Measure, measure};
use super::super::wrf;
use super::si::{ToSi, kelvins, metres_a_second, pascals, percent, shares};
use crate::format::problem::{escape, invalid};
use crate::volume::Problem;

/// One argument of a formula in SI units: what it is made of, still unread.
#[derive(Debug)]
pub(super) struct Part<'a> {
    pub terms: Vec<(Origin<'a>, f64)>,
    pub offset: f64,
}

/// Where the numbers of a part come from.
#[derive(Debug)]
pub(super) enum Origin<'a> {
    Variable(&'a Variable),
    /// Pressures of the levels, Pa, and what the file calls the levels.
    Levels(Vec<f64>, String),
}

impl Origin<'_> {
    /// What the file calls it.
    pub(super) fn name(&self) -> String {
        match self {
            Self::Variable(variable) => escape(&variable.name),
            Self::Levels(_, name) => name.clone(),
        }
    }
}

/// Potential temperature where WRF's T is 0, K.
const WRF_THETA: f64 = 300.0;

/// What is looked for in a group of a file.
pub(super) struct Parts<'a> {
    pub arrays: &'a dyn Arrays,
    /// Variables that can be drawn, the first ones first.
    drawable: Vec<&'a Variable>,
    /// True where the variables are on WRF's grid.
    is_wrf: bool,
}

/// A part, or a part in a unit that it cannot have.
pub(super) type Found<'a> = Result<Option<Part<'a>>, Problem>;

impl<'a> Parts<'a> {
    /// Of the variables in `group`.
    pub(super) fn of(arrays: &'a dyn Arrays, group: &str) -> Self {
        let mut drawable = drawable(arrays);
        drawable.retain(|variable| variable.group() == group);
        let is_wrf = drawable.iter().any(|v| wrf::is_on_grid(arrays, v));
        Self {
            arrays,
            drawable,
            is_wrf,
        }
    }

    /// Names of what can be drawn.
    pub(super) fn names(&self) -> String {
        let names = self.drawable.iter().map(|variable| variable.name.as_str());
        names.collect::<Vec<_>>().join(", ")
    }

    fn named(&self, standard_names: &[&str], names: &[&str]) -> Option<&'a Variable> {
        let standard = |variable: &&&Variable| {
            let found = variable.attributes.text("standard_name");
            found.is_some_and(|found| standard_names.contains(&found))
        };
        let by_standard = self.drawable.iter().find(standard);
        let by_name = || names.iter().find_map(|name| self.by_name(name));
        by_standard.copied().or_else(by_name)
    }

    fn by_name(&self, name: &str) -> Option<&'a Variable> {
        let is_it = |variable: &&&Variable| variable.name.rsplit('/').next() == Some(name);
        self.drawable.iter().find(is_it).copied()
    }

    /// A variable in SI units.
    fn part(&self, variable: &'a Variable, to_si: ToSi, wanted: &str) -> Result<Part<'a>, Problem> {
        let units = variable.attributes.text("units").unwrap_or("");
        let [scale, offset] = to_si(units).ok_or_else(|| {
            let field = format!("units of {}", escape(&variable.name));
            invalid(self.arrays.format(), &field, wanted, units)
        })?;
        Ok(Part {
            terms: vec![(Origin::Variable(variable), scale)],
            offset,
        })
    }

    /// WRF's variables have the units of its registry.
    fn of_wrf(&self, names: &[&str], offset: f64) -> Option<Part<'a>> {
        let found = names.iter().map(|name| {
            let variable = self.is_wrf.then(|| self.by_name(name))??;
            Some((Origin::Variable(variable), 1.0))
        });
        Some(Part {
            terms: found.collect::<Option<_>>()?,
            offset,
        })
    }

    /// K.
    pub(super) fn temperature(&self) -> Found<'a> {
        let names: &[&str] = match self.is_wrf {
            true => &[],
            false => &["t", "ta", "TMP", "tmp"],
        };
        let found = self.named(&["air_temperature"], names);
        found
            .map(|v| self.part(v, kelvins, "K or degC"))
            .transpose()
    }

    /// K.
    pub(super) fn potential_temperature(&self) -> Found<'a> {
        if let Some(part) = self.of_wrf(&["T"], WRF_THETA) {
            return Ok(Some(part));
        }
        let found = self.named(&["air_potential_temperature"], &["theta"]);
        found
            .map(|v| self.part(v, kelvins, "K or degC"))
            .transpose()
    }

    /// Pa.
    pub(super) fn pressure(&self) -> Found<'a> {
        if let Some(part) = self.of_wrf(&["P", "PB"], 0.0) {
            return Ok(Some(part));
        }
        let names: &[&str] = match self.is_wrf {
            true => &[],
            false => &["p", "pres", "PRES"],
        };
        let found = self.named(&["air_pressure"], names);
        found
            .map(|v| self.part(v, pascals, "Pa or hPa"))
            .transpose()
    }

    /// Pa, of the levels of another part.
    pub(super) fn pressure_of_levels(&self, beside: &Part<'a>) -> Option<Part<'a>> {
        let variable = beside.variable()?;
        let axes = axes_of(self.arrays, variable);
        let vertical = axes.iter().position(|axis| *axis == Axis::Z)?;
        let dimension = variable.dimensions.get(vertical)?;
        let levels = coordinate(self.arrays, variable, &dimension.name)?;
        let Measure::Pressure(pascals) = measure(levels.attributes.text("units")?) else {
            return None;
        };
        let read = Coordinate::read(self.arrays, levels, &mut Vec::new())?;
        let pressures = read.points.iter().map(|point| point * pascals).collect();
        Some(Part {
            terms: vec![(Origin::Levels(pressures, escape(&levels.name)), 1.0)],
            offset: 0.0,
        })
    }

    /// Mixing ratio, kg/kg.
    pub(super) fn mixing_ratio(&self) -> Found<'a> {
        if let Some(part) = self.of_wrf(&["QVAPOR"], 0.0) {
            return Ok(Some(part));
        }
        let found = self.named(&["humidity_mixing_ratio"], &[]);
        let wanted = "kg kg-1 or g kg-1";
        found.map(|v| self.part(v, shares, wanted)).transpose()
    }

    /// kg of vapour in a kg of moist air.
    pub(super) fn specific_humidity(&self) -> Found<'a> {
        let names: &[&str] = match self.is_wrf {
            true => &[],
            false => &["q", "hus", "SPFH"],
        };
        let found = self.named(&["specific_humidity"], names);
        let wanted = "kg kg-1 or g kg-1";
        found.map(|v| self.part(v, shares, wanted)).transpose()
    }

    /// %.
    pub(super) fn relative_humidity(&self) -> Found<'a> {
        let found = self.named(&["relative_humidity"], &["hur", "RH", "rh"]);
        found.map(|v| self.part(v, percent, "% or 1")).transpose()
    }

    /// East and north, m/s: both or none.
    pub(super) fn horizontal_wind(&self) -> Result<Option<[Part<'a>; 2]>, Problem> {
        const STANDARD: [[&str; 2]; 2] =
            [["eastward_wind", "northward_wind"], ["x_wind", "y_wind"]];
        const NAMES: [[&str; 2]; 6] = [
            ["U", "V"],
            ["u", "v"],
            ["ua", "va"],
            ["uwnd", "vwnd"],
            ["UGRD", "VGRD"],
            ["UO", "VO"],
        ];
        if let (Some(u), Some(v)) = (self.of_wrf(&["U"], 0.0), self.of_wrf(&["V"], 0.0)) {
            return Ok(Some([u, v]));
        }
        let both = |[east, north]: [Option<&'a Variable>; 2]| Some([east?, north?]);
        let standard = STANDARD.map(|pair| both(pair.map(|name| self.named(&[name], &[]))));
        let named = NAMES.map(|pair| both(pair.map(|name| self.by_name(name))));
        let Some([east, north]) = standard.into_iter().chain(named).flatten().next() else {
            return Ok(None);
        };
        let part =
            |variable| self.part(variable, metres_a_second, "m s-1, cm s-1, km h-1 or knots");
        Ok(Some([part(east)?, part(north)?]))
    }

    /// Upward, m/s, along the same dimensions as `beside`. `None` too where the file has the tendency of pressure instead.
    pub(super) fn upward_wind(&self, beside: &Part<'a>) -> Option<Part<'a>> {
        if let Some(part) = self.of_wrf(&["W"], 0.0) {
            return Some(part);
        }
        let found = self.named(&["upward_air_velocity"], &["W", "w", "wa", "DZDT"])?;
        let is_beside = beside.variable()?.dimensions == found.dimensions;
        self.part(found, metres_a_second, "")
            .ok()
            .filter(|_| is_beside)
    }
}

impl<'a> Part<'a> {
    /// `P + PB`, `T + 300`, `0.001 q`.
    pub(super) fn words(&self) -> String {
        let term = |(origin, scale): &(Origin, f64)| match *scale == 1.0 {
            true => origin.name(),
            false => format!("{scale} {}", origin.name()),
        };
        let offset = (self.offset != 0.0).then(|| self.offset.to_string());
        let words = self.terms.iter().map(term).chain(offset);
        words.collect::<Vec<_>>().join(" + ")
    }

    /// The first variable of it.
    pub(super) fn variable(&self) -> Option<&'a Variable> {
        self.terms.iter().find_map(|(from, _)| match from {
            Origin::Variable(variable) => Some(*variable),
            Origin::Levels(..) => None,
        })
    }
}
