//! The points of an axis as its coordinate variable gives them.

use super::knots::is_monotone;
use super::model::{Arrays, Variable};
use super::units::{Measure, measure};
use crate::format::problem::escape;

/// The points of one axis; they all lie in one direction.
#[derive(Clone, Debug)]
pub(super) struct Coordinate {
    pub name: String,
    pub points: Vec<f64>,
    pub measure: Measure,
    /// The unit as the file words it.
    pub units: String,
    /// True where larger numbers are higher up.
    pub is_up: bool,
    /// True for metres on a map.
    pub is_projection: bool,
}

/// Longer axes have no coordinates: no grid of the Earth is so long.
const MAX_POINTS: u64 = 1 << 20;

impl Coordinate {
    /// `None`, and a note, where the numbers place nothing.
    pub(super) fn read(
        arrays: &dyn Arrays,
        variable: &Variable,
        notes: &mut Vec<String>,
    ) -> Option<Self> {
        let name = escape(&variable.name);
        let mut points = (variable.count() <= MAX_POINTS)
            .then(|| arrays.numbers(variable).ok())
            .flatten()
            .unwrap_or_default();
        let attributes = &variable.attributes;
        let slope = attributes.number("scale_factor").unwrap_or(1.0);
        let intercept = attributes.number("add_offset").unwrap_or(0.0);
        for point in &mut points {
            *point = *point * slope + intercept;
        }
        let units = attributes.text("units").unwrap_or("").to_owned();
        let standard_name = attributes.text("standard_name").unwrap_or("");
        let measure = measure(&units);
        if measure == Measure::Degrees {
            unwrap_degrees(&mut points);
        }
        if !is_monotone(&points) {
            notes.push(format!(
                "the coordinates of `{name}` do not all run one way: its points are placed evenly"
            ));
            return None;
        }
        let is_up = match attributes.text("positive") {
            Some(word) => !word.eq_ignore_ascii_case("down"),
            None => !is_down(standard_name, &name, measure),
        };
        Some(Self {
            name,
            points,
            measure,
            units,
            is_up,
            is_projection: standard_name.starts_with("projection_"),
        })
    }
}

/// What counts downwards where the file does not say: pressures, depths, and levels that are numbered from the
/// top or are fractions of the pressure at the ground.
fn is_down(standard_name: &str, name: &str, measure: Measure) -> bool {
    let name = name.to_ascii_lowercase();
    matches!(measure, Measure::Pressure(_))
        || matches!(
            standard_name,
            "depth" | "air_pressure" | "model_level_number"
        )
        || standard_name.starts_with("ocean_") && standard_name.ends_with("depth")
        || standard_name.starts_with("atmosphere_")
            && (standard_name.contains("sigma") || standard_name.contains("hybrid"))
        || ["depth", "hybrid", "sigma", "model_level"]
            .iter()
            .any(|word| name.starts_with(word))
}

/// Longitudes that begin again after 360 or 180 go on instead.
fn unwrap_degrees(points: &mut [f64]) {
    let mut turns = 0.0;
    let mut last = None;
    for point in points {
        if let Some(last) = last {
            if *point - last < -180.0 {
                turns += 360.0;
            } else if *point - last > 180.0 {
                turns -= 360.0;
            }
        }
        last = Some(*point);
        *point += turns;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn longitudes_go_on_where_they_begin_again() {
        let mut points = [350.0, 355.0, 0.0, 5.0];
        unwrap_degrees(&mut points);
        assert_eq!(points, [350.0, 355.0, 360.0, 365.0]);
        let mut points = [170.0, 175.0, -180.0, -175.0];
        unwrap_degrees(&mut points);
        assert_eq!(points, [170.0, 175.0, 180.0, 185.0]);
    }
}
