//! From the wind in metres to the velocity of a drawn place.
//!
//! ```text
//! plain            dp/dt = s A (u, v, w)        s world length of a metre, A the directions of the components
//! map              dx/dt = s m_x u,  dy/dt = s m_y v        m the map factor, bilinear
//! degrees          dx/dt = s u cos(middle latitude) / cos(latitude),  dy/dt = s v
//! pressures        dz/dt = s ω dz/dp        of the standard atmosphere, whose heights are drawn
//! ```
//!
//! A longitude of the drawn world is as long as at its middle latitude, hence the quotient of cosines.

use super::atmosphere::metres_per_pascal;
use super::error::FieldError;
use super::snapshot::Columns;
use crate::volume::Grid;
use glam::{DMat3, DVec3};
use std::f64::consts::{FRAC_PI_2, TAU};

/// Where the components of the wind point, and how the map of the world stretches them.
#[derive(Clone, Debug, PartialEq)]
pub enum Horizontal {
    /// Along the axes of the world.
    World,
    /// Along the axes of the grid, which may be turned: the first along x of the voxels, and so on.
    GridAxes,
    /// East and north on a map: lengths on the map over those on the Earth, for each column of voxels, x fastest.
    Map {
        /// Along x.
        x: Vec<f64>,
        /// Along y.
        y: Vec<f64>,
    },
    /// East and north on a grid of degrees: world length of a degree of longitude along x and of latitude along y, both
    /// counted from 0.
    Degrees {
        /// Of longitude.
        x: f64,
        /// Of latitude.
        y: f64,
    },
}

/// What the upward component is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Vertical {
    /// m/s, or missing.
    Metres,
    /// Pa/s, in a world whose heights are those of pressures in the standard atmosphere.
    Pascals,
}

/// What makes a velocity of the drawn world of the wind.
#[derive(Clone, Debug, PartialEq)]
pub struct Metric {
    /// World length of a metre: 0.001 where the world is kilometres.
    pub world_per_metre: f64,
    /// Of the first two components.
    pub horizontal: Horizontal,
    /// Of the third.
    pub vertical: Vertical,
}

impl Metric {
    /// Components along the axes of a world, of which a metre has so much length.
    pub fn plain(world_per_metre: f64) -> Self {
        Self {
            world_per_metre,
            horizontal: Horizontal::World,
            vertical: Vertical::Metres,
        }
    }
}

/// The cosine of a latitude that is a pole's.
const AT_POLE: f64 = 1e-6;

#[derive(Clone, Debug)]
enum Stretch {
    None,
    Map([Columns; 2]),
    Degrees {
        radians_per_world: f64,
        middle_cosine: f64,
    },
}

/// A metric on a grid.
#[derive(Clone, Debug)]
pub(super) struct GridMetric {
    world_per_metre: f64,
    axes: Option<DMat3>,
    stretch: Stretch,
    vertical: Vertical,
}

impl GridMetric {
    pub fn new(metric: Metric, grid: &Grid) -> Result<Self, FieldError> {
        let positive = |what, found: f64| match found > 0.0 && found.is_finite() {
            true => Ok(()),
            false => Err(FieldError::NotPositive { what, found }),
        };
        positive("the world length of a metre", metric.world_per_metre)?;
        let wants_axes = match (&metric.horizontal, metric.vertical) {
            (Horizontal::Degrees { .. }, _) => Some("a grid of degrees"),
            (Horizontal::Map { .. }, _) => Some("a map"),
            (_, Vertical::Pascals) => Some("an upward wind in pressures"),
            _ => None,
        };
        if let Some(what) = wants_axes {
            check_axes(grid, what)?;
        }
        let mut axes = None;
        let stretch = match metric.horizontal {
            Horizontal::World => Stretch::None,
            Horizontal::GridAxes => {
                let m = grid.world_from_voxel.matrix3;
                let columns = [m.x_axis, m.y_axis, m.z_axis].map(DVec3::normalize);
                axes = Some(DMat3::from_cols(columns[0], columns[1], columns[2]));
                Stretch::None
            }
            Horizontal::Map { x, y } => {
                for &factor in x.iter().chain(&y) {
                    positive("the map factor", factor)?;
                }
                let columns = |numbers: Vec<f64>| columns(numbers, grid, "the map factor");
                Stretch::Map([columns(x)?, columns(y)?])
            }
            Horizontal::Degrees { x, y } => {
                positive("the length of a degree of longitude", x)?;
                positive("the length of a degree of latitude", y)?;
                Stretch::Degrees {
                    radians_per_world: y.recip().to_radians(),
                    middle_cosine: x / y,
                }
            }
        };
        Ok(Self {
            world_per_metre: metric.world_per_metre,
            axes,
            stretch,
            vertical: metric.vertical,
        })
    }

    /// World y between which there is a wind: where the box of a grid of degrees reaches a pole the first or the last row off it,
    /// else infinite.
    pub fn off_poles(&self, grid: &Grid) -> [f64; 2] {
        let Stretch::Degrees {
            radians_per_world, ..
        } = self.stretch
        else {
            return [f64::NEG_INFINITY, f64::INFINITY];
        };
        let row = |j: u32| {
            grid.world_from_voxel
                .transform_point3(DVec3::new(0.5, f64::from(j) + 0.5, 0.5))
                .y
        };
        let all = || (0..grid.dims[1]).map(row);
        let half = 0.5 * grid.world_from_voxel.matrix3.y_axis.y.abs();
        // The box goes on for half a row: only where that reaches a pole it ends before.
        let reaches =
            |y: f64, side: f64| (side * y + half) * radians_per_world >= FRAC_PI_2 - AT_POLE;
        let is_off = |y: &f64| (y * radians_per_world).cos() > AT_POLE;
        let rows = all().filter(is_off);
        let [low, high] = rows.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], y| {
            [low.min(y), high.max(y)]
        });
        [
            if all().any(|y| reaches(y, -1.0)) {
                low
            } else {
                f64::NEG_INFINITY
            },
            if all().any(|y| reaches(y, 1.0)) {
                high
            } else {
                f64::INFINITY
            },
        ]
    }

    /// World x of both sides of a grid of degrees that closes around the globe: 360 of them, to a thousandth of a
    /// step, as coordinates of 32 bits have them.
    pub fn seam(&self, grid: &Grid) -> Option<[f64; 2]> {
        let Stretch::Degrees {
            radians_per_world,
            middle_cosine,
        } = self.stretch
        else {
            return None;
        };
        let step = grid.world_from_voxel.matrix3.x_axis.x;
        let around = TAU * middle_cosine / radians_per_world;
        let sides = [0.0, f64::from(grid.dims[0])];
        let sides = sides.map(|x| grid.world_from_voxel.transform_point3(x * DVec3::X).x);
        let [low, high] = [sides[0].min(sides[1]), sides[0].max(sides[1])];
        ((high - low - around).abs() <= 1e-3 * step.abs()).then_some([low, high])
    }

    /// World length per second of m/s (or Pa/s upward), at a place of the world that has this one in voxels.
    #[inline]
    pub fn velocity(&self, wind: [f64; 3], place: DVec3, voxel: [f64; 3]) -> DVec3 {
        let [u, v, _] = wind;
        let w = self.metres_up(wind, place);
        let [fx, fy] = match &self.stretch {
            Stretch::None => [1.0; 2],
            Stretch::Map(factors) => factors.each_ref().map(|f| f.at(voxel, false)),
            Stretch::Degrees {
                radians_per_world,
                middle_cosine,
            } => [middle_cosine / (place.y * radians_per_world).cos(), 1.0],
        };
        let drawn = DVec3::new(u * fx, v * fy, w) * self.world_per_metre;
        match &self.axes {
            None => drawn,
            Some(axes) => *axes * drawn,
        }
    }

    /// The true speed, m/s.
    pub fn speed(&self, wind: [f64; 3], place: DVec3) -> f64 {
        let [u, v, _] = wind;
        DVec3::new(u, v, self.metres_up(wind, place)).length()
    }

    #[inline]
    fn metres_up(&self, [_, _, w]: [f64; 3], place: DVec3) -> f64 {
        match self.vertical {
            Vertical::Metres => w,
            Vertical::Pascals => w * metres_per_pascal(place.z / self.world_per_metre),
        }
    }
}

/// One number a column.
pub(super) fn columns(
    numbers: Vec<f64>,
    grid: &Grid,
    what: &'static str,
) -> Result<Columns, FieldError> {
    let wanted = grid.dims[0] as usize * grid.dims[1] as usize;
    let found = numbers.iter().filter(|number| number.is_finite()).count();
    Columns::new(numbers, grid.dims).ok_or(FieldError::Columns {
        what,
        wanted,
        found,
    })
}

/// Fails where an axis of the grid is not along that of the world.
pub(super) fn check_axes(grid: &Grid, what: &'static str) -> Result<(), FieldError> {
    let m = grid.world_from_voxel.matrix3;
    let off = DMat3::from_diagonal(DVec3::new(m.x_axis.x, m.y_axis.y, m.z_axis.z)) != m;
    if off {
        return Err(FieldError::Turned { what });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DAffine3;

    /// Of rows at these latitudes, from the first in steps, in degrees.
    fn off_poles(first: f64, step: f64, rows: u32) -> [f64; 2] {
        let grid = Grid {
            dims: [4, rows, 2],
            world_from_voxel: DAffine3::from_mat3_translation(
                DMat3::from_diagonal(DVec3::new(1.0, step, 1.0)),
                DVec3::new(0.0, first - 0.5 * step, 0.0),
            ),
        };
        let metric = Metric {
            world_per_metre: 1.0,
            horizontal: Horizontal::Degrees { x: 1.0, y: 1.0 },
            vertical: Vertical::Metres,
        };
        let metric = GridMetric::new(metric, &grid).expect("a metric");
        metric.off_poles(&grid)
    }

    #[test]
    fn only_a_box_that_reaches_a_pole_ends_before_it() {
        let open = [f64::NEG_INFINITY, f64::INFINITY];
        assert_eq!(off_poles(31.5, 0.75, 67), open);
        assert_eq!(off_poles(80.0, -1.0, 40), open);
        // Rows on both poles, rows half a step off them, and one pole alone, in both orders.
        assert_eq!(off_poles(-90.0, 10.0, 19), [-80.0, 80.0]);
        assert_eq!(off_poles(89.5, -1.0, 180), [-89.5, 89.5]);
        assert_eq!(off_poles(-90.0, 10.0, 12), [-80.0, f64::INFINITY]);
        assert_eq!(off_poles(90.0, -10.0, 12), [f64::NEG_INFINITY, 80.0]);
    }
}
