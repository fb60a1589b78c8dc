//! Winds of WRF's columns at the heights that are drawn, from the numbers of a file.
//!
//! ```text
//! faces  z_k = (PH + PHB)_k / g        W lies there;   middles  (z_k + z_(k+1)) / 2     U lies there, a face of x to each side
//! u_i = (U_i + U_(i+1)) / 2            between levels linear in height; outside of a column nothing
//! ```

use super::{Found, sees, within};
use crate::fixtures::{open, open_as, values};
use glam::DVec3;
use stratavox::volume::TimeComponent;

const FILE: &str = "netcdf/wrf.nc";
const GRAVITY: f64 = 9.81;
/// Metres: heights are f32 kilometres, and so are the heights that W has for values there.
const ROUNDING: f64 = 1e-3;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Fault {
    /// PH without PHB.
    NoBaseGeopotential,
    /// W in the middles of layers.
    MassLevels,
    /// U of the faces of the next cell.
    NextCell,
}

/// Columns and levels, and the numbers of the first time as they are stored.
fn stored(name: &str) -> ([usize; 3], Vec<f64>) {
    let source = open(FILE, Some(name)).expect("a variable");
    let numbers = values(source.as_ref(), TimeComponent::default());
    let numbers = numbers.into_iter().map(|n| n.expect("no hole")).collect();
    (source.header().dims.map(|n| n as usize), numbers)
}

/// The value at a height between the levels of a column, or how near an end is where there is none.
fn between(levels: &[(f64, f64)], height: f64) -> Result<f64, f64> {
    let inside = levels
        .windows(2)
        .find(|pair| pair[0].0 <= height && height <= pair[1].0);
    match inside {
        Some([(low, a), (high, b)]) => Ok(a + (height - low) / (high - low) * (b - a)),
        _ => Err(levels
            .iter()
            .map(|(z, _)| (z - height).abs())
            .fold(f64::INFINITY, f64::min)),
    }
}

fn are_those_of_the_columns(fault: Option<Fault>) -> Found {
    let ([nx, ny, count], ph) = stored("PH");
    let (_, base) = stored("PHB");
    let faces: Vec<f64> = ph
        .iter()
        .zip(&base)
        .map(|(ph, base)| match fault {
            Some(Fault::NoBaseGeopotential) => ph / GRAVITY,
            _ => (ph + base) / GRAVITY,
        })
        .collect();
    let face = |x: usize, y: usize, k: usize| faces[(k * ny + y) * nx + x];
    let middle = |x, y, k| 0.5 * (face(x, y, k) + face(x, y, k + 1));
    let (_, w) = stored("W");
    let ([ux, ..], u) = stored("U");
    let levels = |name: &str, x: usize, y: usize| -> Vec<(f64, f64)> {
        let of_w = |k: usize| {
            let at_mass = fault == Some(Fault::MassLevels) && k + 1 < count;
            let height = if at_mass {
                middle(x, y, k)
            } else {
                face(x, y, k)
            };
            (height, w[(k * ny + y) * nx + x])
        };
        let of_u = |k: usize| {
            let first = x + usize::from(fault == Some(Fault::NextCell));
            let side = |x: usize| u[(k * ny + y) * ux + x.min(ux - 1)];
            (middle(x, y, k), 0.5 * (side(first) + side(first + 1)))
        };
        match name {
            "W" => (0..count).map(of_w).collect(),
            _ => (0..count - 1).map(of_u).collect(),
        }
    };
    for name in ["W", "U"] {
        let drawn = open_as(FILE, Some(name), false).expect("a variable");
        let header = drawn.header();
        assert_eq!(
            header.dims[..2]
                .iter()
                .map(|&n| n as usize)
                .collect::<Vec<_>>(),
            [nx, ny]
        );
        let (mut worst, mut seen): (f64, u32) = (0.0, 0);
        for (i, found) in values(drawn.as_ref(), TimeComponent::default())
            .iter()
            .enumerate()
        {
            let [x, y, z] = [i % nx, i / nx % ny, i / nx / ny];
            let center = DVec3::new(x as f64, y as f64, z as f64) + DVec3::splat(0.5);
            let height = 1000.0 * header.world_from_voxel.transform_point3(center).z;
            let off = match (found, between(&levels(name, x, y), height)) {
                (Some(found), Ok(wanted)) => (found - wanted).abs(),
                (None, Err(_)) => 0.0,
                // Either side of an end is right where rounding decides.
                (Some(_), Err(off)) => {
                    if off < ROUNDING {
                        0.0
                    } else {
                        f64::INFINITY
                    }
                }
                (None, Ok(_)) => {
                    let column = levels(name, x, y);
                    let ends = [column[0].0, column[column.len() - 1].0];
                    let off = ends.map(|end| (end - height).abs());
                    if off[0].min(off[1]) < ROUNDING {
                        0.0
                    } else {
                        f64::INFINITY
                    }
                }
            };
            worst = worst.max(off);
            seen += u32::from(found.is_some());
        }
        assert!(seen > 30, "{seen} voxels of {name}");
        within(name, worst, ROUNDING)?;
    }
    Ok(())
}

#[test]
fn winds_are_those_of_the_columns() {
    use Fault::*;
    sees(
        &[NoBaseGeopotential, MassLevels, NextCell],
        are_those_of_the_columns,
    );
}
