//! Scattered points to a field: interpolation, and its values on a grid.
//!
//! | method | reproduces | |
//! |---|---|---|
//! | `shepard` | polynomials of degree 2, values at points | a quadratic fitted around each point, averaged |
//! | `idw` | constants, values at points | averages of the 16 nearest values |
//! | `nearest` | constants, values at points | the value of the nearest point |
//! | `kernel` | constants | averages of all values within the reach: smooth |
//! | `density` | the sum of weights | weight on a volume: no values |
//!
//! Distances are those of the world, with heights stretched by [`Options::anisotropy`]. Farther than the reach from every
//! point there are no data; a density is 0 there. Points at one place count as one. Points that all lie in one plane are a
//! field in that plane.

mod density;
mod distinct;
mod fill;
mod frame;
mod grid;
mod idw;
mod kernel;
mod least_squares;
mod nearest;
mod shepard;

pub use grid::GridSize;

use super::Points;
use super::neighbours::{Nearest, Neighbours};
use crate::named::named;
use distinct::Distinct;
use frame::Frame;
use glam::{DMat3, DVec3};
use shepard::Quadratics;

/// Mean distances to the nearest neighbour that the reach is where nobody says it.
const REACH: f64 = 3.0;
/// Points that `shepard` wants at least: unknowns of a quadratic, the point itself and one more.
const FEWEST: usize = 11;
/// Shorter or longer than this is no box of points.
const EXTENTS: std::ops::Range<f64> = 1e-30..1e31;

/// How values between points are made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Method {
    /// Modified quadratic Shepard: averages of quadratics that are fitted around each point.
    #[default]
    Shepard,
    /// Averages of the 16 nearest values by inverse distances.
    Idw,
    /// The value of the nearest point.
    Nearest,
    /// Averages of the values within the reach by a kernel.
    Kernel,
    /// Weight on a volume, spread by that kernel.
    Density,
}

named!(Method {
    Shepard "shepard" "averages of quadratics fitted to 17 neighbours; keeps quadratics and values at points (modified Shepard)",
    Idw "idw" "averages of the 16 nearest by inverse distances; keeps values at points",
    Nearest "nearest" "the value of the nearest point",
    Kernel "kernel" "averages of all within the reach by Wendland's kernel; smooth, for values with noise",
    Density "density" "points, or their weights, on a volume, spread by that kernel",
});

/// What is to be known beside the points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// How values are made.
    pub method: Method,
    /// Farther than this from every point there are no data, in world length; the radius of `kernel` and `density`.
    /// `None`: three times the mean distance of a point to its nearest neighbour.
    pub reach: Option<f64>,
    /// How many times a distance along z counts; over 0.
    pub anisotropy: f64,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            method: Method::default(),
            reach: None,
            anisotropy: 1.0,
        }
    }
}

/// Why points make no field, or none on this grid.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum NoField {
    /// A method wants more points.
    #[error("{found} points: wanted at least {wanted} for {method}")]
    TooFew {
        /// At places that differ.
        found: usize,
        /// Of the method.
        wanted: usize,
        /// That wants them.
        method: Method,
    },
    /// There is no plane that the points lie in, and no volume: they are on one line, or at one place.
    #[error("all points lie on one line: wanted points in a plane or a volume")]
    OnOneLine,
    /// A length that is 0, not finite, or that squares of which are no numbers.
    #[error("a reach, an anisotropy or a box of points is no length: wanted numbers over 0")]
    NoLength,
    /// A grid without a voxel.
    #[error(
        "a grid without a voxel: wanted a spacing over 0, or at least one voxel along each axis"
    )]
    NoVoxel,
    /// More memory than there may be.
    #[error("a grid of {} x {} x {} voxels takes {bytes} bytes, and {max_bytes} may be taken", voxels[0], voxels[1], voxels[2])]
    TooLarge {
        /// Along each axis.
        voxels: [f64; 3],
        /// Of their values.
        bytes: u64,
        /// As it was asked.
        max_bytes: u64,
    },
}

/// A field of scattered points.
#[derive(Clone, Debug)]
pub struct Interpolation {
    method: Method,
    distinct: Distinct,
    neighbours: Neighbours,
    quadratics: Option<Quadratics>,
    frame: Frame,
    /// Heights stretched, along the axes of the frame: places are kept so.
    frame_from_world: DMat3,
    mean_distance: f64,
    reach: f64,
    /// Of the kernel, in the world.
    integral: f64,
}

/// Squared distance and index.
type Found = (f64, u32);

impl Interpolation {
    /// The field of points.
    ///
    /// # Errors
    /// [`NoField`] where there are too few points for the method, they lie on one line, or a length is none.
    ///
    /// # Panics
    /// Where there are 2^32 points or more.
    pub fn new(points: &Points, options: &Options) -> Result<Self, NoField> {
        Self::by(points, options, threads())
    }

    fn by(points: &Points, options: &Options, threads: usize) -> Result<Self, NoField> {
        let Options {
            method,
            reach,
            anisotropy,
        } = *options;
        assert!(
            u32::try_from(points.len()).is_ok(),
            "fewer than 2^32 points"
        );
        let is_length = |length: f64| EXTENTS.contains(&length);
        if !is_length(anisotropy) || !reach.is_none_or(is_length) {
            return Err(NoField::NoLength);
        }
        let stretch = DMat3::from_diagonal(DVec3::new(1.0, 1.0, anisotropy));
        let all = (0..points.len()).map(|i| {
            let [value, weight] = [points.values[i], points.weight(i)].map(f64::from);
            (stretch * points.places[i], value, weight)
        });
        let mut distinct = Distinct::of(all);
        let found = distinct.places.len();
        if method == Method::Shepard && found < FEWEST {
            return Err(NoField::TooFew {
                found,
                wanted: FEWEST,
                method,
            });
        }
        let [low, high] = super::distances::bounds(distinct.places.iter().copied());
        if found > 1 && !is_length((high - low).max_element()) {
            return Err(NoField::NoLength);
        }
        let frame = Frame::of(&distinct.places).ok_or(NoField::OnOneLine)?;
        let frame_from_world = frame.space_from_frame.transpose() * stretch;
        for place in &mut distinct.places {
            *place = frame.space_from_frame.transpose() * *place;
        }
        let neighbours = Neighbours::new(&distinct.places);
        let mean_distance = mean_distance(&distinct.places, &neighbours);
        let reach = reach.unwrap_or(REACH * mean_distance);
        let is_plane = frame.normal.is_some();
        // A volume, or an area of the plane, in the world.
        let world_from_frame = frame_from_world.inverse();
        let measure = match frame.normal {
            None => world_from_frame.determinant().abs(),
            Some(k) => {
                let [a, b] = [(k + 1) % 3, (k + 2) % 3].map(|k| world_from_frame.col(k));
                a.cross(b).length()
            }
        };
        let quadratics = (method == Method::Shepard).then(|| {
            let Distinct { places, values, .. } = &distinct;
            Quadratics::fitted(places, values, &neighbours, frame.normal, threads)
        });
        Ok(Self {
            method,
            distinct,
            neighbours,
            quadratics,
            frame,
            frame_from_world,
            mean_distance,
            reach,
            integral: density::integral(reach, is_plane) * measure,
        })
    }

    /// The value at a place of the world; `None` where there are no data.
    pub fn at(&self, place: DVec3) -> Option<f64> {
        self.in_frame(self.frame_from_world * place, 0.0, &mut Scratch::new(self))
    }

    /// Mean distance of a point to its nearest neighbour, heights stretched.
    pub fn mean_distance(&self) -> f64 {
        self.mean_distance
    }

    /// Farther than this from every point there are no data, heights stretched.
    pub fn reach(&self) -> f64 {
        self.reach
    }

    /// Places where several points are, which count as one with their mean value and the sum of their weights.
    pub fn merged_places(&self) -> usize {
        self.distinct.merged
    }

    /// True where all points lie in one plane: to a millionth of the longest edge of their box.
    pub fn is_plane(&self) -> bool {
        self.frame.normal.is_some()
    }

    /// What is added to the box of the points on all sides.
    fn reach_of_box(&self) -> f64 {
        match self.method {
            Method::Density => self.reach,
            _ => 0.0,
        }
    }

    /// The value at a place of the frame, `step` away from the one before.
    fn in_frame(&self, at: DVec3, step: f64, scratch: &mut Scratch) -> Option<f64> {
        let Distinct {
            places,
            values,
            weights,
            ..
        } = &self.distinct;
        match self.method {
            Method::Kernel | Method::Density => {
                self.neighbours.within(at, self.reach, &mut scratch.near);
                let near = &scratch.near;
                if self.method == Method::Kernel {
                    return kernel::value(near, self.reach, values, weights);
                }
                Some(density::value(near, self.reach, weights, self.integral))
            }
            Method::Nearest | Method::Idw | Method::Shepard => {
                let found = scratch.nearest(self, at, step)?;
                Some(match &self.quadratics {
                    _ if self.method == Method::Nearest => nearest::value(found, values),
                    None => idw::value(found, values),
                    Some(quadratics) => quadratics.value(at, found, places, values),
                })
            }
        }
    }
}

/// Lists that a thread keeps from voxel to voxel.
struct Scratch {
    first: Nearest,
    nearest: Nearest,
    near: Vec<(u32, f64)>,
    /// What is nearest to a place a step away is at most a step farther than this.
    farthest: Option<f64>,
}

impl Scratch {
    fn new(of: &Interpolation) -> Self {
        let wanted = match of.method {
            Method::Nearest => 1,
            // With the one that R is the distance of.
            _ => idw::NEAREST + 1,
        };
        Self {
            first: Nearest::new(1),
            nearest: Nearest::new(wanted),
            near: Vec::new(),
            farthest: None,
        }
    }

    /// The next place is not a step away.
    fn leave(&mut self) {
        self.farthest = None;
    }

    /// The nearest points; `None` where the first one is beyond the reach.
    fn nearest(&mut self, of: &Interpolation, at: DVec3, step: f64) -> Option<&[Found]> {
        let reach = of.reach;
        let farthest = match self.farthest {
            Some(farthest) => (farthest + step) * (1.0 + 1e-9),
            None => {
                of.neighbours.nearest(at, reach, &mut self.first);
                self.first.found().first()?;
                f64::INFINITY
            }
        };
        of.neighbours.nearest(at, farthest, &mut self.nearest);
        let found = self.nearest.found();
        let first = found.first()?.0;
        if first > reach * reach {
            self.farthest = None;
            return None;
        }
        self.farthest = Some(self.nearest.radius());
        Some(self.nearest.found())
    }
}

fn threads() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// The integral over space of Wendland's kernel of this radius.
pub(super) fn kernel_integral(radius: f64) -> f64 {
    density::integral(radius, false)
}

/// Mean distance of a point to its nearest neighbour at another place; `None` where all are at one.
///
/// # Panics
/// Where there are 2^32 points or more.
pub fn mean_distance_of(points: &Points) -> Option<f64> {
    assert!(u32::try_from(points.len()).is_ok(), "fewer than 2^32");
    let all = points.places.iter().map(|&place| (place, 0.0, 1.0));
    let places = Distinct::of(all).places;
    (places.len() > 1).then(|| mean_distance(&places, &Neighbours::new(&places)))
}

/// Over all places; there are two at least.
fn mean_distance(places: &[DVec3], neighbours: &Neighbours) -> f64 {
    let mut nearest = Nearest::new(2);
    let distances = places.iter().map(|&place| {
        neighbours.nearest(place, f64::INFINITY, &mut nearest);
        nearest.found()[1].0.sqrt()
    });
    distances.sum::<f64>() / places.len() as f64
}

#[cfg(test)]
mod tests;
