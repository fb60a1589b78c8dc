//! Grids of latitudes and longitudes: grid definition template 3.0 of the Manual on Codes.

use super::GRIB;
use super::section::Section;
use crate::format::problem::invalid;
use crate::volume::{Limits, Problem};

/// A regular grid, its points in the order of the message. Angles are integers of [`LatLon::unit`] each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct LatLon {
    pub columns: u32,
    pub rows: u32,
    /// Basic angle and its subdivisions: one unit is their quotient, in degrees.
    basic: [u32; 2],
    /// Latitude and longitude of the first and of the last point.
    first: [i32; 2],
    last: [i32; 2],
    /// Flag table 3.4.
    scan: u8,
}

/// A number that is not given.
const MISSING: u32 = u32::MAX;

/// The bits of flag table 3.4, the first of them the highest.
const WESTWARD: u8 = 0x80;
const NORTHWARD: u8 = 0x40;
const COLUMN_BY_COLUMN: u8 = 0x20;
const BACK_AND_FORTH: u8 = 0x10;

/// What the grid of a section 3 is, or the name of one that we do not read.
pub(super) fn grid(section: &Section, limits: &Limits) -> Result<Result<LatLon, String>, Problem> {
    let points = section.u32(7)?;
    let bytes = u64::from(points).saturating_mul(4);
    if bytes > limits.max_bytes {
        return Err(Problem::Limit {
            what: "a field".to_owned(),
            wanted_bytes: bytes,
            limit_bytes: limits.max_bytes,
        });
    }
    let template = section.u16(13)?;
    if section.u8(6)? != 0 || template != 0 {
        return Ok(Err(format!("grids of template {}", name(template))));
    }
    let grid = LatLon {
        columns: section.u32(31)?,
        rows: section.u32(35)?,
        basic: [section.u32(39)?, section.u32(43)?],
        first: [section.i32(47)?, section.i32(51)?],
        last: [section.i32(56)?, section.i32(60)?],
        scan: section.u8(72)?,
    };
    if section.u8(11)? != 0 || [grid.columns, grid.rows].contains(&MISSING) {
        return Ok(Err("reduced grids (rows of different lengths)".to_owned()));
    }
    if grid.scan & 0x0f != 0 {
        return Ok(Err(
            "grids whose rows are shifted (scanning mode)".to_owned()
        ));
    }
    let area = u64::from(grid.columns).saturating_mul(grid.rows.into());
    if area != u64::from(points) || points == 0 {
        let wanted = format!("Ni x Nj = {} x {}", grid.columns, grid.rows);
        let field = "number of data points";
        return Err(invalid(GRIB, field, wanted, &points.to_string()));
    }
    let [basic, parts] = grid.basic;
    if basic != 0 && basic != MISSING && (parts == 0 || parts == MISSING) {
        let field = "subdivisions of the basic angle";
        return Err(invalid(GRIB, field, "a number above 0", &parts.to_string()));
    }
    Ok(Ok(grid))
}

fn name(template: u16) -> String {
    let words = match template {
        1 => "rotated latitudes and longitudes",
        2 | 3 => "stretched latitudes and longitudes",
        10 => "Mercator",
        20 => "polar stereographic",
        30 => "Lambert conformal",
        40..=43 => "Gaussian latitudes",
        50..=53 => "spherical harmonics",
        90 => "space view",
        100 | 101 => "triangles",
        140 => "Lambert azimuthal equal area",
        _ => return format!("3.{template}"),
    };
    format!("3.{template} ({words})")
}

impl LatLon {
    pub(super) fn points(&self) -> u64 {
        u64::from(self.columns).saturating_mul(self.rows.into())
    }

    /// Degrees of one unit: a millionth, if the message names no other.
    fn unit(&self) -> f64 {
        match self.basic {
            [0 | MISSING, _] => 1e-6,
            [basic, parts] => f64::from(basic) / f64::from(parts),
        }
    }

    /// Latitudes of the rows, degrees north.
    pub(super) fn latitudes(&self) -> Vec<f64> {
        let [first, last] = [self.first[0], self.last[0]].map(f64::from);
        even(first * self.unit(), last * self.unit(), self.rows)
    }

    /// Longitudes of the columns, degrees east; they go on beyond 360 rather than begin again.
    pub(super) fn longitudes(&self) -> Vec<f64> {
        let [first, last] = [self.first[1], self.last[1]].map(|n| f64::from(n) * self.unit());
        let turn = |degrees: f64| match degrees.rem_euclid(360.0) {
            // From a meridian to itself is once around.
            0.0 if self.columns > 1 => 360.0,
            part => part,
        };
        let last = if self.scan & WESTWARD != 0 {
            first - turn(first - last)
        } else {
            first + turn(last - first)
        };
        even(first, last, self.columns)
    }

    /// True where rows run as their latitudes say they do.
    pub(super) fn is_consistent(&self) -> bool {
        let runs_north = self.scan & NORTHWARD != 0;
        self.rows == 1 || (self.last[0] > self.first[0]) == runs_north
    }

    /// Values in the order of the message, brought into rows one after the other.
    pub(super) fn in_rows(&self, values: Vec<f32>) -> Vec<f32> {
        let size = |n: u32| usize::try_from(n).unwrap_or(usize::MAX).max(1);
        let (columns, rows) = (size(self.columns), size(self.rows));
        let mut values = values;
        let is_across = self.scan & COLUMN_BY_COLUMN == 0;
        if self.scan & BACK_AND_FORTH != 0 {
            let line = if is_across { columns } else { rows };
            let backward = values.chunks_mut(line).skip(1).step_by(2);
            backward.for_each(<[f32]>::reverse);
        }
        if is_across {
            return values;
        }
        let row = |y: usize| values.iter().skip(y).step_by(rows).copied();
        (0..rows).flat_map(row).collect()
    }
}

fn even(first: f64, last: f64, count: u32) -> Vec<f64> {
    let steps = f64::from(count.saturating_sub(1).max(1));
    (0..count)
        .map(|i| first + (last - first) * (f64::from(i) / steps))
        .collect()
}
