//! The map of a WRF file: `MAP_PROJ`, `TRUELAT1`, `TRUELAT2`, `STAND_LON`, and what lies in the middle of the grid.
//!
//! ```text
//! MAP_PROJ 1 Lambert   2 polar stereographic   3 Mercator   6 latitude and longitude       (WRF-ARW Users' Guide, WPS)
//! centre = mean of XLAT, XLONG over the middle point, or the two or four around the middle; else CEN_LAT, CEN_LON
//! ```
//!
//! CEN_LAT and CEN_LON are of the domain that was computed: files that were cut out of it keep them.

use super::model::{Arrays, Kind, Variable};
use super::values::Values;
use crate::volume::{MapCorner, MapKind, MapProjection};

/// A file whose centre is farther from that of its domain is a part of it, degrees.
const APART: f64 = 0.1;

/// The map, where the file tells one; what a person should know of it goes to `notes`.
pub(super) fn map(arrays: &dyn Arrays, notes: &mut Vec<String>) -> Option<MapProjection> {
    let attributes = arrays.attributes();
    let number = |name: &str| attributes.number(name).filter(|n| n.is_finite());
    let kind = match number("MAP_PROJ")? {
        1.0 => MapKind::Lambert,
        2.0 => MapKind::PolarStereographic,
        3.0 => MapKind::Mercator,
        6.0 => MapKind::LatitudeLongitude,
        _ => return None,
    };
    let said = number("CEN_LAT").zip(number("CEN_LON"));
    let found = middle(arrays, "XLAT").zip(middle(arrays, "XLONG"));
    if let (Some((lat, lon)), Some((there_lat, there_lon))) = (found, said) {
        let apart = |a: f64, b: f64| turned(a - b).abs() > APART;
        if apart(lat, there_lat) || apart(lon, there_lon) {
            notes.push(format!(
                "the grid is around latitude {lat:.3}, longitude {lon:.3} by XLAT and XLONG, and not around CEN_LAT {there_lat:.3} and CEN_LON {there_lon:.3}: a part of its domain"
            ));
        }
    }
    let is_conic = kind == MapKind::Lambert;
    let has_true = kind != MapKind::LatitudeLongitude;
    Some(MapProjection {
        kind,
        true_latitudes: [
            number("TRUELAT1").filter(|_| has_true),
            number("TRUELAT2").filter(|_| is_conic),
        ],
        standard_longitude: number("STAND_LON"),
        center: found.or(said).map(|(lat, lon)| [lat, lon]),
        corners: corners(arrays),
        pole: None,
    })
}

/// Names of the latitude and the longitude of each column, where the file has both.
pub(super) fn latitude_longitude(arrays: &dyn Arrays) -> Option<[String; 2]> {
    let names = ["XLAT", "XLONG"];
    let is_there = |name: &&str| arrays.variables().iter().any(|other| other.name == **name);
    names.iter().all(is_there).then(|| names.map(str::to_owned))
}

/// The points in the corners by XLAT and XLONG, and by the steps around the middle.
fn corners(arrays: &dyn Arrays) -> [Option<MapCorner>; 4] {
    [[0, 0], [1, 0], [0, 1], [1, 1]].map(|end| corner(arrays, end))
}

/// The first (0) or the last (1) along x and along y.
fn corner(arrays: &dyn Arrays, [right, up]: [u64; 2]) -> Option<MapCorner> {
    let at = |name| {
        mean(arrays, name, |axis, size| {
            let end = if axis == 0 { right } else { up };
            (end.saturating_mul(size.saturating_sub(1)), 1)
        })
    };
    let latitude_longitude = [at("XLAT")?, at("XLONG")?];
    let variable = arrays.variables().iter().find(|v| v.name == "XLAT")?;
    let sizes: Vec<u64> = variable.dimensions.iter().map(|d| d.size).collect();
    let &[.., ny, nx] = &sizes[..] else {
        return None;
    };
    let attributes = arrays.attributes();
    let step = |name: &str| {
        attributes
            .number(name)
            .filter(|n| *n > 0.0)
            .map(|n| 1e-3 * n)
    };
    let (dx, dy) = (step("DX")?, step("DY")?);
    let half = |n: u64, step: f64, end: u64| (end as f64 - 0.5) * (n as f64 - 1.0) * step;
    Some(MapCorner {
        latitude_longitude,
        world: [half(nx, dx, right), half(ny, dy, up)],
        step: dx.min(dy),
    })
}

/// An angle from -180 to 180.
fn turned(degrees: f64) -> f64 {
    (degrees + 180.0).rem_euclid(360.0) - 180.0
}

/// The mean over the points around the middle of the last two dimensions, at the first index of the others. Longitudes
/// on both sides of 180 degrees go on.
fn middle(arrays: &dyn Arrays, name: &str) -> Option<f64> {
    mean(arrays, name, |_, size| {
        let first = size.saturating_sub(1) / 2;
        (first, if size % 2 == 0 { 2 } else { 1 })
    })
}

/// The mean over points of the last two dimensions, of which `part` says the first and their number: of x (0) or y (1), and of
/// its size.
fn mean(arrays: &dyn Arrays, name: &str, part: impl Fn(usize, u64) -> (u64, u64)) -> Option<f64> {
    let variable: &Variable = arrays.variables().iter().find(|v| v.name == name)?;
    let Kind::Numbers(_) = variable.kind else {
        return None;
    };
    let stored = Values::of(variable, arrays.format()).ok()?.stored;
    let from_end = variable.dimensions.len().checked_sub(2)?;
    let place = |(k, size): (usize, u64)| match k < from_end {
        true => (0, 1),
        false => part(usize::from(k == from_end), size),
    };
    let sizes = variable.dimensions.iter().map(|dimension| dimension.size);
    let (start, count): (Vec<u64>, Vec<u64>) = sizes.enumerate().map(place).unzip();
    let is_empty = variable
        .dimensions
        .iter()
        .any(|dimension| dimension.size == 0);
    let voxels = (!is_empty)
        .then(|| arrays.read(variable, &start, &count, stored).ok())??
        .voxels;
    let numbers: Vec<f64> = (0..voxels.len()).map(|i| voxels.stored(i).into()).collect();
    let first = *numbers.first()?;
    let sum: f64 = numbers.iter().map(|number| turned(number - first)).sum();
    let mean = turned(first + sum / numbers.len() as f64);
    mean.is_finite().then_some(mean)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_are_turned_to_the_nearest() {
        for (degrees, wanted) in [
            (190.0, -170.0),
            (-190.0, 170.0),
            (45.0, 45.0),
            (-360.0, 0.0),
        ] {
            assert_eq!(turned(degrees), wanted);
        }
    }
}
