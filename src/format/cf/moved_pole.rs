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
        corners: corners(arrays, variable, [x, y], place).unwrap_or_default(),
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

/// The points in the corners by the latitudes and longitudes of the file, and where they are drawn.
fn corners(
    arrays: &dyn Arrays,
    variable: &Variable,
    [x, y]: [&str; 2],
    place: &Place,
) -> Option<[Option<MapCorner>; 4]> {
    let [latitude, longitude] = latitude_longitude(arrays, variable, x, y)?;
    let sizes: Vec<u64> = latitude.dimensions.iter().map(|d| d.size).collect();
    let &[ny, nx] = &sizes[..] else {
        return None;
    };
    let [latitudes, longitudes] =
        [latitude, longitude].map(|variable| arrays.numbers(variable).ok());
    let (latitudes, longitudes) = (latitudes?, longitudes?);
    let matrix = place.world_from_voxel.matrix3;
    let corner = |[right, up]: [bool; 2]| {
        let end = |is_last: bool, size: u64| {
            if is_last {
                size.checked_sub(1)
            } else {
                Some(0)
            }
        };
        let [i, j] = [end(right, nx)?, end(up, ny)?];
        let at = usize::try_from(j.checked_mul(nx)?.checked_add(i)?).ok()?;
        let voxel = DVec3::new(i as f64 + 0.5, j as f64 + 0.5, 0.5);
        let place = place.world_from_voxel.transform_point3(voxel);
        Some(MapCorner {
            latitude_longitude: [*latitudes.get(at)?, *longitudes.get(at)?],
            world: [place.x, place.y],
            step: matrix.x_axis.length().min(matrix.y_axis.length()),
        })
    };
    let all = [[false, false], [true, false], [false, true], [true, true]];
    Some(all.map(corner))
}
