//! Where the points of a grid lie in the world: kilometres east, north and up for a piece of the Earth.
//!
//! ```text
//! x = R cos(middle latitude) longitude,   y = R latitude        (equirectangular, in radians)
//! z = height,   -depth,   geopotential / g,   or the standard atmosphere's height of a pressure
//! ```
//!
//! A grid without degrees, pressures or a map keeps the numbers of its coordinates.

use super::coordinates::Coordinate;
use super::knots::{is_even, is_monotone, step};
use super::units::Measure;
use crate::format::earth::{GRAVITY, WIDEST_LATITUDE, kilometres_of_degree, standard_height};
use crate::format::geometry::world_from_voxel;
use crate::volume::Heights;
use glam::{DAffine3, DVec3};

/// Levels that are only numbers are spread over this part of the longer horizontal side.
const HEIGHT_OF_NUMBERS: f64 = 0.25;

/// The points of a grid in the world.
#[derive(Debug)]
pub(super) struct Place {
    /// Even steps; where an axis is uneven, those between its ends.
    pub world_from_voxel: DAffine3,
    /// The points of each axis that is uneven.
    pub uneven: [Option<Vec<f64>>; 3],
    /// True where the world is kilometres on the Earth.
    pub is_earth: bool,
    /// Kilometres of a degree along x and y, where points there are given in degrees.
    pub degrees: [Option<f64>; 2],
    /// What places along z stand for.
    pub heights: Heights,
    pub notes: Vec<String>,
}

/// `dims` points along x, y, z, with the coordinates that are known. `None` where they span no volume.
pub(super) fn place(dims: [u32; 3], coordinates: &[Option<Coordinate>; 3]) -> Option<Place> {
    let [x, y, z] = coordinates.each_ref().map(Option::as_ref);
    let is_of_earth = |c: &Coordinate| c.measure == Measure::Degrees || c.is_projection;
    let is_earth = x.is_some_and(is_of_earth)
        || y.is_some_and(is_of_earth)
        || z.is_some_and(|z| matches!(z.measure, Measure::Pressure(_) | Measure::Geopotential));
    let mut notes = Vec::new();
    if !is_earth {
        let points = as_they_stand(dims, coordinates, &mut notes);
        return from_points(dims, points, false, notes);
    }
    let (points, degrees, heights) = on_earth(dims, x, y, z, &mut notes);
    let spanned = from_points(dims, points, true, notes)?;
    Some(Place {
        degrees,
        heights,
        ..spanned
    })
}

/// The place of points that are given for each axis, in world units.
pub(super) fn from_points(
    dims: [u32; 3],
    points: [Vec<f64>; 3],
    is_earth: bool,
    notes: Vec<String>,
) -> Option<Place> {
    let steps = points.each_ref().map(|points| step(points, points.len()));
    // An axis of one point is as thick as the shortest step of the others.
    let shortest = steps
        .iter()
        .flatten()
        .map(|step| step.abs())
        .fold(f64::INFINITY, f64::min);
    let thick = if shortest.is_finite() { shortest } else { 1.0 };
    let steps = DVec3::from_array(steps.map(|step| step.unwrap_or(thick)));
    let firsts = points
        .each_ref()
        .map(|points| points.first().copied().unwrap_or(0.0));
    let columns = [
        DVec3::new(steps.x, 0.0, 0.0),
        DVec3::new(0.0, steps.y, 0.0),
        DVec3::new(0.0, 0.0, steps.z),
    ];
    let world_from_voxel = world_from_voxel(columns, DVec3::from_array(firsts))?;
    let mut sizes = dims.iter();
    let uneven = points.map(|points| {
        let size = sizes.next().copied().unwrap_or(0);
        let is_whole = usize::try_from(size) == Ok(points.len());
        (is_whole && !is_even(&points)).then_some(points)
    });
    Some(Place {
        world_from_voxel,
        uneven,
        is_earth,
        degrees: [None; 2],
        heights: Heights::Lengths,
        notes,
    })
}

fn on_earth(
    dims: [u32; 3],
    x: Option<&Coordinate>,
    y: Option<&Coordinate>,
    z: Option<&Coordinate>,
    notes: &mut Vec<String>,
) -> ([Vec<f64>; 3], [Option<f64>; 2], Heights) {
    let degrees = |c: Option<&Coordinate>| c.is_some_and(|c| c.measure == Measure::Degrees);
    let middle = match y {
        Some(y) if degrees(Some(y)) => {
            let ends = y.points.first().zip(y.points.last());
            ends.map_or(0.0, |(first, last)| 0.5 * (first + last))
        }
        _ => 0.0,
    };
    let middle = middle.clamp(-WIDEST_LATITUDE, WIDEST_LATITUDE);
    if degrees(x) || degrees(y) {
        notes.push(format!(
            "the world is in kilometres: degrees are lengths at latitude {middle}"
        ));
    } else {
        notes.push("the world is in kilometres".to_owned());
    }
    let [along_x, along_y] = kilometres_of_degree(middle);
    let horizontal = |c: Option<&Coordinate>, degree: f64| {
        let c = c?;
        let factor = match c.measure {
            Measure::Degrees => degree,
            Measure::Length(metres) => metres / 1000.0,
            _ => return None,
        };
        Some(
            c.points
                .iter()
                .map(|point| point * factor)
                .collect::<Vec<_>>(),
        )
    };
    let lengths = [degrees(x).then_some(along_x), degrees(y).then_some(along_y)];
    let east = horizontal(x, along_x);
    let north = horizontal(y, along_y);
    // A horizontal axis without coordinates has the step of the other one.
    let step_of = |points: &Option<Vec<f64>>| {
        let points = points.as_ref()?;
        step(points, points.len()).map(f64::abs)
    };
    let other = step_of(&north).or(step_of(&east)).unwrap_or(1.0);
    for (points, name) in [(&east, "x"), (&north, "y")] {
        if points.is_none() {
            notes.push(format!(
                "the file gives no coordinates along {name}: points are taken {other} km apart"
            ));
        }
    }
    let [nx, ny, nz] = dims;
    let east = east.unwrap_or_else(|| evenly(nx, other));
    let north = north.unwrap_or_else(|| evenly(ny, other));
    let width = extent(&east).max(extent(&north));
    let (up, are) = heights(nz, z, width, notes);
    ([east, north, up], lengths, are)
}

/// Heights in km, and what they stand for; levels that are only numbers are spread over a part of `width`.
fn heights(
    count: u32,
    z: Option<&Coordinate>,
    width: f64,
    notes: &mut Vec<String>,
) -> (Vec<f64>, Heights) {
    let sign = |z: &Coordinate| if z.is_up { 1.0 } else { -1.0 };
    let known: Option<Vec<f64>> = z.and_then(|z| match z.measure {
        Measure::Length(metres) => {
            let factor = sign(z) * metres / 1000.0;
            Some(z.points.iter().map(|point| point * factor).collect())
        }
        Measure::Geopotential => {
            let factor = 1.0 / GRAVITY / 1000.0;
            Some(z.points.iter().map(|point| point * factor).collect())
        }
        Measure::Pressure(pascals) => {
            let height = |point: &f64| Some(standard_height(point * pascals)? / 1000.0);
            z.points.iter().map(height).collect()
        }
        _ => None,
    });
    if let Some(points) = known.filter(|points| is_monotone(points)) {
        if z.is_some_and(|z| matches!(z.measure, Measure::Pressure(_))) && count > 1 {
            notes.push("pressures lie at their heights in the standard atmosphere".to_owned());
            return (points, Heights::Pressures);
        }
        return (points, Heights::Lengths);
    }
    let gaps = f64::from(count.saturating_sub(1).max(1));
    let step = HEIGHT_OF_NUMBERS * width / gaps;
    let step = if step > 0.0 { step } else { 1.0 };
    // Numbers that grow upwards stand in the file from the bottom, and so do levels without any.
    let is_rising = z.is_none_or(|z| {
        let grows = z
            .points
            .first()
            .zip(z.points.last())
            .is_none_or(|(a, b)| a <= b);
        grows == z.is_up
    });
    if count > 1 {
        let name = z.map_or("", |z| z.name.as_str());
        let first = if is_rising { "lowest" } else { "highest" };
        notes.push(format!(
            "the levels {name} are only numbers: they are spread evenly over a quarter of the width, the first of them {first}"
        ));
    }
    // The lowest lies at the height 0, where the ground of maps is.
    let mut points = evenly(count, step);
    if !is_rising {
        points.reverse();
    }
    let are = match count > 1 {
        true => Heights::Levels,
        false => Heights::Lengths,
    };
    (points, are)
}

/// Coordinates that are in no way of the Earth: one unit for all three, or metres, or numbers as they are.
fn as_they_stand(
    dims: [u32; 3],
    coordinates: &[Option<Coordinate>; 3],
    notes: &mut Vec<String>,
) -> [Vec<f64>; 3] {
    let long = coordinates
        .iter()
        .zip(dims)
        .filter(|&(_, size)| size > 1)
        .map(|(coordinate, _)| coordinate.as_ref());
    let measures: Vec<Option<Measure>> = long.map(|c| Some(c?.measure)).collect();
    let first = measures.first().copied().flatten();
    let is_one_unit = measures.iter().all(|measure| *measure == first);
    let all_are_lengths = measures
        .iter()
        .all(|measure| matches!(measure, Some(Measure::Length(_))));
    match first {
        Some(_) if is_one_unit => {
            let named = coordinates.iter().flatten().find(|c| !c.units.is_empty());
            if let Some(named) = named {
                let units = crate::format::problem::escape(&named.units);
                notes.push(format!("the world is in {units}"));
            }
        }
        _ if all_are_lengths => notes.push("the world is in metres".to_owned()),
        _ => {
            notes.push(
                "not all axes have coordinates in one unit: voxels are 1 apart along each"
                    .to_owned(),
            );
            return dims.map(|size| evenly(size, 1.0));
        }
    }
    let mut sizes = dims.iter();
    coordinates.each_ref().map(|coordinate| {
        let size = sizes.next().copied().unwrap_or(1);
        let Some(c) = coordinate else {
            return evenly(size, 1.0);
        };
        let factor = match c.measure {
            Measure::Length(metres) if !is_one_unit => metres,
            _ => 1.0,
        };
        let factor = if c.is_up { factor } else { -factor };
        c.points.iter().map(|point| point * factor).collect()
    })
}

/// `count` points from 0, each a step behind the last.
fn evenly(count: u32, step: f64) -> Vec<f64> {
    (0..count).map(|i| f64::from(i) * step).collect()
}

fn extent(points: &[f64]) -> f64 {
    let ends = points.first().zip(points.last());
    ends.map_or(0.0, |(first, last)| (last - first).abs())
}
