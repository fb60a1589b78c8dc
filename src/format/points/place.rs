//! Numbers of three columns to places in the world.
//!
//! ```text
//! degrees:      kilometres on the Earth, as those of grids are
//! height:       upwards;   depth: downwards, z = -depth
//! pressure:     the height of the standard atmosphere
//! ```
//!
//! Longitudes go over the date line where the widest gap between them is a quarter of the Earth and lies elsewhere: the box
//! of the points is the shortest arc that holds all of them.
//!
//! With degrees, pressures, or a unit at all three axes, the world is in kilometres; else numbers are as they stand.

use super::quantity::{Quantity, Unit};
use crate::format::earth::{WIDEST_LATITUDE, kilometres_of_degree, standard_height};
use crate::format::problem::escape;
use glam::DVec3;

/// A coordinate over this is no place: its square is no number any more.
const FARTHEST: f64 = 1e30;

/// What stands along one axis.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Axis {
    pub quantity: Quantity,
    pub unit: Option<Unit>,
    pub name: String,
}

/// What stands along x, y and z.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Axes(pub [Axis; 3]);

/// What is known of a world that points were placed in.
#[derive(Debug, Default)]
pub(super) struct World {
    pub is_earth: bool,
    pub degree_lengths: [Option<f64>; 2],
    pub length_metres: Option<f64>,
    pub notes: Vec<String>,
}

impl Axis {
    /// In the world, where a degree has a length and other lengths a factor.
    fn world(&self, number: f64, degree: f64, factor: f64) -> f64 {
        match self.quantity {
            Quantity::Longitude | Quantity::Latitude => number * degree,
            Quantity::Height | Quantity::Length => number * factor,
            // Not -0 at the surface.
            Quantity::Depth => 0.0 - number * factor,
            Quantity::Pressure => kilometres_of_pressure(number).unwrap_or(f64::NAN),
        }
    }

    fn accepts(&self, number: f64) -> bool {
        match self.quantity {
            Quantity::Longitude => number.abs() <= 360.0,
            Quantity::Latitude => number.abs() <= 90.0,
            Quantity::Pressure => kilometres_of_pressure(number).is_some(),
            _ => number.abs() <= FARTHEST,
        }
    }
}

/// By hectopascals.
fn kilometres_of_pressure(number: f64) -> Option<f64> {
    Some(standard_height(number * 100.0)? / 1000.0)
}

impl Axes {
    /// Lengths of which nothing is known.
    pub(super) fn plain() -> Self {
        Self(["x", "y", "z"].map(|name| Axis {
            quantity: Quantity::Length,
            unit: None,
            name: name.to_owned(),
        }))
    }

    fn is_earth(&self) -> bool {
        let of_earth = [Quantity::Longitude, Quantity::Latitude, Quantity::Pressure];
        self.0.iter().any(|axis| of_earth.contains(&axis.quantity))
    }

    fn is_in_kilometres(&self) -> bool {
        self.is_earth() || self.0.iter().all(|axis| axis.unit.is_some())
    }

    /// World length of one of a unit.
    pub(super) fn factor(&self, unit: Option<Unit>) -> f64 {
        let metres = unit.and_then(Unit::metres);
        match metres {
            Some(metres) if self.is_in_kilometres() => metres / 1000.0,
            _ => 1.0,
        }
    }

    /// False where three numbers are no place.
    pub(super) fn accepts(&self, place: DVec3) -> bool {
        let numbers = place.to_array();
        self.0.iter().zip(numbers).all(|(axis, n)| axis.accepts(n))
    }

    /// Puts accepted numbers into the world.
    pub(super) fn place(&self, places: &mut [DVec3]) -> World {
        let [x, y, z] = &self.0;
        let middle = match y.quantity {
            Quantity::Latitude => middle(places.iter().map(|place| place.y)),
            _ => 0.0,
        };
        let middle = middle.clamp(-WIDEST_LATITUDE, WIDEST_LATITUDE);
        let [along_x, along_y] = kilometres_of_degree(middle);
        let over_date_line = match x.quantity {
            Quantity::Longitude => joined(places),
            _ => None,
        };
        let factors = self.0.each_ref().map(|axis| self.factor(axis.unit));
        let [factor_x, factor_y, factor_z] = factors;
        for place in places {
            *place = DVec3::new(
                x.world(place.x, along_x, factor_x),
                y.world(place.y, along_y, factor_y),
                z.world(place.z, 1.0, factor_z),
            );
        }
        let is_east = x.quantity == Quantity::Longitude;
        let is_north = y.quantity == Quantity::Latitude;
        World {
            is_earth: self.is_earth(),
            degree_lengths: [is_east.then_some(along_x), is_north.then_some(along_y)],
            length_metres: self.is_in_kilometres().then_some(1000.0),
            notes: [
                self.notes((is_east || is_north).then_some(middle)),
                over_date_line.into_iter().collect(),
            ]
            .concat(),
        }
    }

    fn notes(&self, middle: Option<f64>) -> Vec<String> {
        let mut notes = Vec::new();
        if let Some(middle) = middle {
            notes.push(format!(
                "the world is in kilometres: degrees are lengths at latitude {middle:.2}"
            ));
        } else if self.is_in_kilometres() {
            notes.push("the world is in kilometres".to_owned());
        }
        for axis in &self.0 {
            let name = escape(&axis.name);
            match (axis.quantity, axis.unit) {
                (Quantity::Longitude | Quantity::Latitude, _) => {}
                (Quantity::Pressure, unit) => {
                    if unit.is_none() {
                        notes.push(format!("the column {name} has no unit: hPa are taken"));
                    }
                    notes.push(
                        "pressures lie at their heights in the standard atmosphere".to_owned(),
                    );
                }
                (_, None) if self.is_in_kilometres() => {
                    notes.push(format!("the column {name} has no unit: km are taken"));
                }
                (_, Some(unit)) if !self.is_in_kilometres() => {
                    let word = unit.word();
                    notes.push(format!(
                        "not all axes have a unit: the {word} of {name} are taken as they stand"
                    ));
                }
                _ => {}
            }
        }
        notes
    }
}

/// Longitudes with a wider gap, degrees, are not those of the whole Earth.
const WIDE_GAP: f64 = 90.0;

/// Turns longitudes around the Earth so that they lie in the shortest arc that holds all of them, where that is shorter and
/// they are not all around it; says so.
#[allow(
    clippy::arithmetic_side_effects,
    reason = "arithmetic of f64: nothing wraps or panics"
)]
fn joined(places: &mut [DVec3]) -> Option<String> {
    let mut all: Vec<f64> = places.iter().map(|place| place.x).collect();
    let [low, high] = all
        .iter()
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], &n| {
            [low.min(n), high.max(n)]
        });
    for longitude in &mut all {
        *longitude = (*longitude + 180.0).rem_euclid(360.0) - 180.0;
    }
    all.sort_unstable_by(f64::total_cmp);
    let first = *all.first()?;
    let next = all.iter().skip(1).copied().chain([first + 360.0]);
    let gaps = all.iter().zip(next).map(|(from, to)| (to - from, to));
    let (gap, begin) = gaps.max_by(|(a, _), (b, _)| a.total_cmp(b))?;
    let arc = 360.0 - gap;
    // A rounding of degrees is no turn.
    if gap < WIDE_GAP || high - low <= arc + 1e-6 {
        return None;
    }
    let begin = if begin >= 180.0 { begin - 360.0 } else { begin };
    let middle = begin + 0.5 * arc;
    for place in places {
        place.x += 360.0 * ((middle - place.x) / 360.0).round();
    }
    Some(format!(
        "longitudes go over the date line: they count from {begin:.2} to {:.2}",
        begin + arc
    ))
}

/// Half way from the smallest to the largest.
fn middle(numbers: impl Iterator<Item = f64>) -> f64 {
    let [low, high] = numbers.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], n| {
        [low.min(n), high.max(n)]
    });
    if low <= high { 0.5 * (low + high) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn joined_longitudes(longitudes: &[f64]) -> (Vec<f64>, Option<String>) {
        let place = |&x: &f64| DVec3::new(x, 1.0, 2.0);
        let mut places: Vec<DVec3> = longitudes.iter().map(place).collect();
        let note = joined(&mut places);
        assert!(places.iter().all(|p| (p.y, p.z) == (1.0, 2.0)));
        (places.iter().map(|p| p.x).collect(), note)
    }

    #[test]
    fn points_on_both_sides_of_the_date_line_lie_in_the_shortest_arc() {
        let (found, note) = joined_longitudes(&[179.0, -178.0, 170.0, -160.0]);
        assert_eq!(found, [179.0, 182.0, 170.0, 200.0]);
        assert!(note.is_some_and(|note| note.contains("from 170.00 to 200.00")));
        // East of Greenwich and west of it, counted from 0.
        let (found, note) = joined_longitudes(&[355.0, 10.0, 350.0]);
        assert_eq!(found, [-5.0, 10.0, -10.0]);
        assert!(note.is_some());
        for as_they_are in [
            &[-100.0, 20.0, 30.0][..],
            &[170.0, 200.0],
            &[-5.0],
            &[12.0, 12.0],
            // All around the Earth.
            &[-179.0, -100.0, -20.0, 60.0, 140.0, 179.0],
        ] {
            let (found, note) = joined_longitudes(as_they_are);
            assert_eq!((found.as_slice(), note), (as_they_are, None));
        }
        assert_eq!(joined_longitudes(&[]), (Vec::new(), None));
    }
}
