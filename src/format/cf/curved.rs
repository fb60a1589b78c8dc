//! Grids whose latitudes and longitudes are arrays of two dimensions: oceans on bent grids, rotated poles.
//!
//! They are drawn flat, as their middle is: neighbours along the middle row and the middle column lie as far from
//! each other as they do on average on the sphere,
//!
//! ```text
//! distance = 2 R asin sqrt(sin^2(dlat / 2) + cos(lat1) cos(lat2) sin^2(dlon / 2))
//! ```
//!
//! CF Conventions 5.2: the attribute `coordinates` names the two.

use super::axes::in_scope;
use super::coordinates::Coordinate;
use super::model::{Arrays, Variable};
use super::units::{Measure, is_east, is_north};
use crate::format::earth::RADIUS_KM;

/// Larger arrays of coordinates are not read.
const MAX_POINTS: u64 = 1 << 24;

/// Coordinates along x and y in km, from 0; `None` where the variable has no such latitudes and longitudes over
/// the dimensions `y` and `x`.
pub(super) fn flattened(
    arrays: &dyn Arrays,
    variable: &Variable,
    x: &str,
    y: &str,
) -> Option<[Coordinate; 2]> {
    let [latitude, longitude] = latitude_longitude(arrays, variable, x, y)?;
    let [rows, columns] = latitude.dimensions.as_slice() else {
        return None;
    };
    let (rows, columns) = (
        usize::try_from(rows.size).ok()?,
        usize::try_from(columns.size).ok()?,
    );
    let latitudes = arrays.numbers(latitude).ok()?;
    let longitudes = arrays.numbers(longitude).ok()?;
    let at = |row: usize, column: usize| {
        let index = row.checked_mul(columns)?.checked_add(column)?;
        Some((*latitudes.get(index)?, *longitudes.get(index)?))
    };
    let middle = (rows.checked_div(2)?, columns.checked_div(2)?);
    let row: Option<Vec<_>> = (0..columns).map(|column| at(middle.0, column)).collect();
    let column: Option<Vec<_>> = (0..rows).map(|row| at(row, middle.1)).collect();
    let east = mean_step(&row?, |from, to| turn(to.1 - from.1))?;
    let north = mean_step(&column?, |from, to| to.0 - from.0)?;
    let coordinate = |name: &str, count: usize, step: f64| Coordinate {
        name: name.to_owned(),
        points: (0..count).map(|i| i as f64 * step).collect(),
        measure: Measure::Length(1000.0),
        units: "km".to_owned(),
        is_up: true,
        is_projection: true,
    };
    Some([coordinate(x, columns, east), coordinate(y, rows, north)])
}

/// The latitudes and longitudes of a variable over the dimensions `y` and `x`.
pub(super) fn latitude_longitude<'a>(
    arrays: &'a dyn Arrays,
    variable: &Variable,
    x: &str,
    y: &str,
) -> Option<[&'a Variable; 2]> {
    let words = variable.attributes.text("coordinates")?;
    let find = |is_it: fn(&str) -> bool| {
        words
            .split_whitespace()
            .filter_map(|name| in_scope(arrays, variable, name).next())
            .find(|other| {
                let dimensions = other.dimensions.as_slice();
                matches!(dimensions, [first, second] if first.name == y && second.name == x)
                    && is_it(other.attributes.text("units").unwrap_or(""))
                    && other.count() <= MAX_POINTS
            })
    };
    Some([find(is_north)?, find(is_east)?])
}

/// A latitude and a longitude, in degrees.
type Point = (f64, f64);

/// The mean distance of neighbours in km, negative where the line runs against `ahead`; `None` for a line that
/// has no length.
fn mean_step(line: &[Point], ahead: impl Fn(Point, Point) -> f64) -> Option<f64> {
    let pairs = line.iter().zip(line.iter().skip(1));
    let (mut length, mut way, mut count) = (0.0, 0.0, 0.0);
    for (&from, &to) in pairs {
        length += distance(from, to);
        way += ahead(from, to);
        count += 1.0;
    }
    let step = length / count;
    step.is_normal()
        .then_some(if way < 0.0 { -step } else { step })
}

/// A difference of longitudes the short way round.
fn turn(degrees: f64) -> f64 {
    (degrees + 180.0).rem_euclid(360.0) - 180.0
}

/// The length of the great circle between two points, km.
fn distance(from: Point, to: Point) -> f64 {
    let sin2 = |degrees: f64| (0.5 * degrees.to_radians()).sin().powi(2);
    let cosines = from.0.to_radians().cos() * to.0.to_radians().cos();
    let chord2 = sin2(to.0 - from.0) + cosines * sin2(to.1 - from.1);
    2.0 * RADIUS_KM * chord2.clamp(0.0, 1.0).sqrt().asin()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_are_those_of_the_sphere() {
        let quarter = 0.5 * std::f64::consts::PI * RADIUS_KM;
        assert!((distance((0.0, 0.0), (0.0, 90.0)) - quarter).abs() < 1e-9);
        assert!((distance((-90.0, 12.0), (0.0, 170.0)) - quarter).abs() < 1e-9);
        let east = mean_step(&[(60.0, 359.9), (60.0, 0.0), (60.0, 0.1)], |a, b| {
            turn(b.1 - a.1)
        });
        // A tenth of a degree on a circle half as long as the equator.
        let wanted = 0.5 * 0.1_f64.to_radians() * RADIUS_KM;
        assert!((east.unwrap() - wanted).abs() < 1e-5 * wanted);
        let south = mean_step(&[(10.0, 0.0), (9.0, 0.0)], |a, b| b.0 - a.0);
        assert!(south.unwrap() < 0.0);
        assert_eq!(mean_step(&[(10.0, 0.0)], |a, b| b.0 - a.0), None);
        assert_eq!(
            mean_step(&[(f64::NAN, 0.0), (0.0, 0.0)], |a, b| b.0 - a.0),
            None
        );
    }
}
