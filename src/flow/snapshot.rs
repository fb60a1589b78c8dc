//! The wind of one time at the centres of voxels, and between them.
//!
//! ```text
//! q = p - 1/2,  i = floor(q),  f = q - i,  taps clamp(i + {0, 1}, 0, n - 1)
//! a + f (b - a) along x, then y, then z          law of the linear filter, in f64 from f32
//! ```
//!
//! There is no data where a voxel of non-zero weight has none.

use super::error::FieldError;
use crate::volume::sample::nearest;
use crate::volume::{Grid, Volume};

/// A component of the wind as a volume has it.
#[derive(Clone, Copy, Debug)]
pub struct Component<'a> {
    /// Its values.
    pub volume: &'a Volume,
    /// What makes m/s of them, or Pa/s of an upward component in pressures.
    pub factor: f64,
}

/// Three components at each voxel, m/s (the third also Pa/s); NaN in the first where there is no data.
#[derive(Clone, Debug)]
pub struct Snapshot {
    nodes: Vec<[f32; 3]>,
    dims: [usize; 3],
}

impl Snapshot {
    /// East, north and up, or along the axes of the grid. Without an upward component lines stay in their level.
    ///
    /// # Errors
    /// [`FieldError::Grids`] where the volumes lie on different grids.
    pub fn new(
        east: Component<'_>,
        north: Component<'_>,
        up: Option<Component<'_>>,
    ) -> Result<Self, FieldError> {
        let grid = east.volume.grid();
        for (name, other) in [("north", Some(north)), ("up", up)] {
            let other = other.map(|component| component.volume.grid());
            if let Some(found) = other.filter(|found| *found != grid) {
                return Err(FieldError::Grids {
                    name,
                    wanted: grid.dims,
                    found: found.dims,
                });
            }
        }
        let dims = grid.dims.map(|n| n as usize);
        let value = |component: Component<'_>, voxel: [u32; 3]| {
            let center = voxel.map(|i| f64::from(i) + 0.5);
            let value = nearest::<f64>(component.volume, center);
            value.map_or(f32::NAN, |value| (value * component.factor) as f32)
        };
        let mut nodes = Vec::with_capacity(dims.iter().product());
        let [nx, ny, nz] = grid.dims;
        for z in 0..nz {
            for y in 0..ny {
                for x in 0..nx {
                    let at = [x, y, z];
                    let up = up.map_or(0.0, |up| value(up, at));
                    nodes.push(with_hole([value(east, at), value(north, at), up]));
                }
            }
        }
        Ok(Self { nodes, dims })
    }

    /// The numbers of a function of the voxel; `None` is no data.
    pub fn from_fn(grid: &Grid, wind: impl Fn([u32; 3]) -> Option<[f32; 3]>) -> Self {
        let [nx, ny, nz] = grid.dims;
        let all = (0..nz).flat_map(|z| (0..ny).flat_map(move |y| (0..nx).map(move |x| [x, y, z])));
        Self {
            nodes: all
                .map(|at| wind(at).map_or([f32::NAN; 3], with_hole))
                .collect(),
            dims: grid.dims.map(|n| n as usize),
        }
    }

    /// Voxels along x, y, z.
    pub(super) fn dims(&self) -> [usize; 3] {
        self.dims
    }

    /// The wind of a voxel; `None` where there is no data.
    pub(super) fn node(&self, index: usize) -> Option<[f32; 3]> {
        Some(self.nodes[index]).filter(|wind| !wind[0].is_nan())
    }

    /// The wind at a place of voxel space; `None` where there is no data. `is_around` where the first column is the neighbour
    /// of the last one.
    #[inline]
    pub(super) fn at(&self, place: [f64; 3], is_around: bool) -> Option<[f64; 3]> {
        let [x, y, z] = [
            Taps::along_x(place[0], self.dims[0], is_around),
            Taps::new(place[1], self.dims[1]),
            Taps::new(place[2], self.dims[2]),
        ];
        let [nx, ny, _] = self.dims;
        let rows = [
            (z.voxels[0] * ny + y.voxels[0]) * nx,
            (z.voxels[0] * ny + y.voxels[1]) * nx,
            (z.voxels[1] * ny + y.voxels[0]) * nx,
            (z.voxels[1] * ny + y.voxels[1]) * nx,
        ];
        let row = |start: usize| {
            let [a, b] = x
                .voxels
                .map(|voxel| self.nodes[start + voxel].map(f64::from));
            lerp(a, b, x.fraction)
        };
        let planes = [
            lerp(row(rows[0]), row(rows[1]), y.fraction),
            lerp(row(rows[2]), row(rows[3]), y.fraction),
        ];
        let wind = lerp(planes[0], planes[1], z.fraction);
        if wind[0].is_nan() {
            return self.beside_holes([x, y, z]);
        }
        Some(wind)
    }

    /// The same where a voxel without data is among the eight: it matters only where it has a weight.
    #[cold]
    fn beside_holes(&self, taps: [Taps; 3]) -> Option<[f64; 3]> {
        let [nx, ny, _] = self.dims;
        let mut sum = [0.0; 3];
        for corner in 0..8_usize {
            let bits = [corner & 1, corner >> 1 & 1, corner >> 2];
            let weight: f64 = (0..3).map(|k| taps[k].weights()[bits[k]]).product();
            if weight == 0.0 {
                continue;
            }
            let [x, y, z] = [0, 1, 2].map(|k| taps[k].voxels[bits[k]]);
            let wind = self.node((z * ny + y) * nx + x)?;
            for (sum, wind) in sum.iter_mut().zip(wind) {
                *sum += weight * f64::from(wind);
            }
        }
        Some(sum)
    }
}

/// One component without data leaves none.
fn with_hole(wind: [f32; 3]) -> [f32; 3] {
    match wind.iter().all(|number| number.is_finite()) {
        true => wind,
        false => [f32::NAN; 3],
    }
}

#[inline]
fn lerp(a: [f64; 3], b: [f64; 3], part: f64) -> [f64; 3] {
    [0, 1, 2].map(|k| a[k] + part * (b[k] - a[k]))
}

/// The two voxels of one axis and the weight of the second.
#[derive(Clone, Copy)]
pub(super) struct Taps {
    pub voxels: [usize; 2],
    pub fraction: f64,
}

impl Taps {
    #[inline]
    pub fn new(place: f64, count: usize) -> Self {
        let q = place - 0.5;
        let i = q.floor();
        let first = i as i64;
        let last = count as i64 - 1;
        Self {
            voxels: [first, first + 1].map(|voxel| voxel.clamp(0, last) as usize),
            fraction: q - i,
        }
    }

    /// The same, around the globe where x has no end.
    #[inline]
    pub fn along_x(place: f64, count: usize, is_around: bool) -> Self {
        let taps = Self::new(place, count);
        if !is_around {
            return taps;
        }
        let first = (place - 0.5).floor() as i64;
        let around = |voxel: i64| voxel.rem_euclid(count as i64) as usize;
        Self {
            voxels: [around(first), around(first + 1)],
            ..taps
        }
    }

    fn weights(&self) -> [f64; 2] {
        [1.0 - self.fraction, self.fraction]
    }
}

/// A number of each column of voxels, between them.
#[derive(Clone, Debug)]
pub(super) struct Columns {
    numbers: Vec<f64>,
    dims: [usize; 2],
}

impl Columns {
    /// `None` where there are not as many as columns, or not all are finite.
    pub fn new(numbers: Vec<f64>, [nx, ny, _]: [u32; 3]) -> Option<Self> {
        let dims = [nx as usize, ny as usize];
        let fits = numbers.len() == dims[0] * dims[1] && numbers.iter().all(|n| n.is_finite());
        fits.then_some(Self { numbers, dims })
    }

    /// Bilinear, in voxel space.
    #[inline]
    pub fn at(&self, [x, y, _]: [f64; 3], is_around: bool) -> f64 {
        let x = Taps::along_x(x, self.dims[0], is_around);
        let y = Taps::new(y, self.dims[1]);
        let row = |row: usize| {
            let [a, b] = x
                .voxels
                .map(|column| self.numbers[row * self.dims[0] + column]);
            a + x.fraction * (b - a)
        };
        let [a, b] = y.voxels.map(row);
        a + y.fraction * (b - a)
    }
}
