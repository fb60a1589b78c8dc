//! Latitudes and longitudes whose pole is moved, as models of a region have them.
//!
//! ```text
//! variable:grid_mapping = "m"      m:grid_mapping_name = "rotated_latitude_longitude"
//! m:grid_north_pole_latitude, grid_north_pole_longitude, north_pole_grid_longitude (0)        CF Conventions, appendix F
//! ```
//!
//! The file's own latitudes and longitudes of two dimensions tell whether it agrees with itself.

use super::axes::{coordinate, in_scope};
use super::curved::latitude_longitude;
use super::model::{Arrays, Variable};
use super::place::Place;
use crate::volume::{MapCorner, MapKind, MapProjection, MovedPole};
use glam::DVec3;

/// The map of a variable over the dimensions `y` and `x` whose coordinates count from a moved pole; without the pole where
/// the file does not say it. `None` for all others.
pub(super) fn map(
    arrays: &dyn Arrays,
    variable: &Variable,
    [x, y]: [&str; 2],
    place: &Place,
    notes: &mut Vec<String>,
) -> Option<MapProjection> {
    let is_named = |name: &str, wanted: &str| {
        let found = coordinate(arrays, variable, name);
        found.is_some_and(|found| found.attributes.text("standard_name") == Some(wanted))
    };
    let pole = pole(arrays, variable);
    let is_moved = is_named(x, "grid_longitude") || is_named(y, "grid_latitude");
    if pole.is_none() && !is_moved {
        return None;
    }
    notes.push(match pole {
        Some(pole) => format!(
            "the pole of the grid is moved to latitude {}, longitude {}: x and y run along its own parallels and meridians",
            pole.latitude, pole.longitude
        ),
        None => "the pole of the grid is moved, and the file does not say where to: x and y run along its own parallels and \
                 meridians"
            .to_owned(),
    });
    Some(MapProjection {
        corner: corner(arrays, variable, [x, y], place),
        pole,
        ..MapProjection::of_kind(MapKind::LatitudeLongitude)
    })
}

fn pole(arrays: &dyn Arrays, variable: &Variable) -> Option<MovedPole> {
    let words = variable.attributes.text("grid_mapping")?;
    // The longer form names coordinates behind each mapping.
    let name = words.split_whitespace().next()?.trim_end_matches(':');
    let mapping = in_scope(arrays, variable, name).next()?;
    let attributes = &mapping.attributes;
    let number = |name: &str| attributes.number(name).filter(|n| n.is_finite());
    if attributes.text("grid_mapping_name")? != "rotated_latitude_longitude" {
        return None;
    }
    Some(MovedPole {
        latitude: number("grid_north_pole_latitude").filter(|n| n.abs() <= 90.0)?,
        longitude: number("grid_north_pole_longitude")?,
        grid_longitude: number("north_pole_grid_longitude").unwrap_or(0.0),
    })
}

/// The first point by the latitudes and longitudes of the file, and where it is drawn.
fn corner(
    arrays: &dyn Arrays,
    variable: &Variable,
    [x, y]: [&str; 2],
    place: &Place,
) -> Option<MapCorner> {
    let [latitude, longitude] = latitude_longitude(arrays, variable, x, y)?;
    let first = |variable: &Variable| arrays.numbers(variable).ok()?.first().copied();
    let matrix = place.world_from_voxel.matrix3;
    let at = place.world_from_voxel.transform_point3(DVec3::splat(0.5));
    Some(MapCorner {
        latitude_longitude: [first(latitude)?, first(longitude)?],
        world: [at.x, at.y],
        step: matrix.x_axis.length().min(matrix.y_axis.length()),
    })
}
