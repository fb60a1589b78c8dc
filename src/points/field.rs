//! The field of scattered points itself, without a grid: what rays are cast through.
//!
//! ```text
//! mean       f(x) = sum of m_s f_s W(|x - x_s| / R) / sum of m_s W(|x - x_s| / R)
//! density    f(x) = sum of m_s W(|x - x_s| / R) / N         N = 2 pi R^3 / 21, per volume of the world before it was stretched
//! W(r) = (1 - r)^4 (4 r + 1) for r < 1
//! ```
//!
//! These are the fields of `kernel` and `density` of [`super::interpolate`], but that there are no data where no point lies
//! within R, and that points in a plane have a density in space.
//!
//! Points are sorted into cells at least as wide as R, so that all that reach a place lie in its cell and the 26 around; the
//! points of three cells in a row follow each other:
//!
//! ```text
//! cell = floor((x - corner) / edge)       points of cell c: those from starts[c] to starts[c + 1]
//! ```

use super::Points;
use super::distances::bounds;
use super::interpolate::kernel_integral;
use crate::real::Real;
use glam::{DAffine3, DMat3, DVec3};

/// What is made of the points near a place.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Quantity {
    /// The mean of their values by the kernel.
    #[default]
    Mean,
    /// How much of their weight there is on a volume; values do not count.
    Density,
}

/// Which field of points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FieldKernel {
    /// How far a point reaches, in world length; over 0.
    pub radius: f64,
    /// What is made of the points near a place.
    pub quantity: Quantity,
}

/// Cells are so much wider than R: positions along rays in f32 are off by less, in cells.
const ROOM: f64 = 1.0 / 1024.0;
/// Cells along an axis: f32 then tells 2^-14 of one.
const MOST_ALONG: f64 = 1000.0;
/// Cells in all, at most: so many for each point, and 16 MiB.
const CELLS_OF_POINT: f64 = 64.0;
const CELLS: std::ops::RangeInclusive<f64> = 4096.0..=2_097_152.0;

/// Points in cells.
#[derive(Clone, Debug, PartialEq)]
pub struct PointField {
    kernel: FieldKernel,
    /// Lower corner of the first cell, in the world, and the side of a cell.
    corner: DVec3,
    edge: f64,
    /// Cells along each axis.
    counts: [u32; 3],
    /// Sorted by cell, in those the first of the file first; places in cells from the corner.
    points: Vec<FieldPoint>,
    /// For each cell, x fastest, where its points begin, and the end of the last.
    starts: Vec<u32>,
    /// N, in the world before it was stretched.
    integral: f64,
    /// Points in 27 cells around one, at most.
    most_near: u32,
}

/// A point, as it is sorted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FieldPoint {
    /// In cells from the corner.
    pub place: DVec3,
    /// f.
    pub value: f32,
    /// m.
    pub weight: f32,
}

impl PointField {
    /// The field of points.
    ///
    /// # Panics
    /// Where the radius is no number over 0, or there are 2^32 points or more.
    pub fn new(points: &Points, kernel: FieldKernel) -> Self {
        let radius = kernel.radius;
        assert!(radius > 0.0 && radius.is_finite(), "a length over 0");
        assert!(u32::try_from(points.len()).is_ok(), "fewer than 2^32");
        let [corner, high] = bounds(points.places.iter().copied());
        let extent = high - corner;
        let mut edge = (radius * (1.0 + ROOM)).max(extent.max_element() / MOST_ALONG);
        let along = |edge: f64| (extent / edge).floor() + 1.0;
        let most = (CELLS_OF_POINT * points.len() as f64).clamp(*CELLS.start(), *CELLS.end());
        while along(edge).element_product() > most {
            edge *= 1.125;
        }
        let counts = along(edge).to_array().map(|n| n as u32);
        let in_cells = |place: DVec3| (place - corner) / edge;
        let cell_of = |place: DVec3| {
            let [x, y, z] = cell_in(in_cells(place), counts);
            (x + counts[0] * (y + counts[1] * z)) as usize
        };
        // A counting sort: stable.
        let cells = counts.map(|n| n as usize).iter().product::<usize>();
        let mut starts = vec![0_u32; cells + 1];
        for &place in &points.places {
            starts[cell_of(place) + 1] += 1;
        }
        for cell in 0..cells {
            starts[cell + 1] += starts[cell];
        }
        let mut next = starts.clone();
        let nowhere = FieldPoint {
            place: DVec3::ZERO,
            value: 0.0,
            weight: 0.0,
        };
        let mut sorted = vec![nowhere; points.len()];
        for (index, &place) in points.places.iter().enumerate() {
            let at = &mut next[cell_of(place)];
            sorted[*at as usize] = FieldPoint {
                place: in_cells(place),
                value: points.values[index],
                weight: points.weight(index),
            };
            *at += 1;
        }
        let mut made = Self {
            kernel,
            corner,
            edge,
            counts,
            points: sorted,
            starts,
            integral: kernel_integral(radius) / points.stretch,
            most_near: 0,
        };
        made.most_near = made.count_most_near();
        made
    }

    /// The value at a place of the world; `None` where no point is near.
    pub fn at(&self, place: DVec3) -> Option<f64> {
        self.value(((place - self.corner) / self.edge).to_array())
    }

    /// The same at a place in cells. CPU reference of `shaders/lib/filter_field.wgsl`.
    pub fn value<R: Real>(&self, at: [R; 3]) -> Option<R> {
        let number = R::from_f64;
        let home = at.map(|x| x.floor().to_i32());
        // Beyond the cells around them all no point is near.
        let is_near = |k: usize| home[k] >= -1 && home[k] <= self.counts[k] as i32;
        if !(0..3).all(is_near) {
            return None;
        }
        let scale = number(self.cells_per_radius().recip());
        let [low, high] = [-1, 1].map(|step| {
            let last = self.counts.map(|n| n as i32 - 1);
            let cell = |k: usize| (home[k] + step).clamp(0, last[k]);
            [cell(0), cell(1), cell(2)]
        });
        let (mut sum, mut weights) = (number(0.0), number(0.0));
        for z in low[2]..=high[2] {
            for y in low[1]..=high[1] {
                for point in &self.points[self.row(low[0], high[0], y, z)] {
                    let place = point.place.to_array();
                    let off: [R; 3] = std::array::from_fn(|k| (number(place[k]) - at[k]) * scale);
                    let square = off[0] * off[0] + off[1] * off[1] + off[2] * off[2];
                    if square >= number(1.0) {
                        continue;
                    }
                    let r = square.sqrt();
                    let rest = number(1.0) - r;
                    let squared = rest * rest;
                    let kernel = squared * squared * (number(4.0) * r + number(1.0));
                    let weight = R::from_f32(point.weight) * kernel;
                    sum = sum + weight * R::from_f32(point.value);
                    weights = weights + weight;
                }
            }
        }
        (weights > number(0.0)).then(|| match self.kernel.quantity {
            Quantity::Mean => sum / weights,
            Quantity::Density => weights * number(self.density_scale()),
        })
    }

    /// Points of the cells of a row from `first` to `last`.
    fn row(&self, first: i32, last: i32, y: i32, z: i32) -> std::ops::Range<usize> {
        let [nx, ny, _] = self.counts.map(|n| n as usize);
        let start = nx * (y as usize + ny * z as usize);
        let at = |x: i32| self.starts[start + x as usize] as usize;
        at(first)..at(last + 1)
    }

    /// Which field it is.
    pub fn kernel(&self) -> FieldKernel {
        self.kernel
    }

    /// Cells along each axis.
    pub fn counts(&self) -> [u32; 3] {
        self.counts
    }

    /// The points, sorted by cell.
    pub fn points(&self) -> &[FieldPoint] {
        &self.points
    }

    /// For each cell, x fastest, where its points begin, and the end of the last.
    pub fn starts(&self) -> &[u32] {
        &self.starts
    }

    /// From the world to cells.
    pub fn cells_from_world(&self) -> DAffine3 {
        let scale = self.edge.recip();
        DAffine3 {
            matrix3: DMat3::from_diagonal(DVec3::splat(scale)),
            translation: -self.corner * scale,
        }
    }

    /// R, in cells: under 1.
    pub fn cells_per_radius(&self) -> f64 {
        self.kernel.radius / self.edge
    }

    /// 1 / N; of means 0, which no density has.
    pub fn density_scale(&self) -> f64 {
        match self.kernel.quantity {
            Quantity::Mean => 0.0,
            Quantity::Density => self.integral.recip(),
        }
    }

    /// Points in 27 cells around one, at most.
    pub fn most_near(&self) -> u32 {
        self.most_near
    }

    fn count_most_near(&self) -> u32 {
        let [nx, ny, nz] = self.counts.map(|n| n as i32);
        let around = |k: i32, n: i32| (k - 1).max(0)..=(k + 1).min(n - 1);
        let of_cell = |x: i32, y: i32, z: i32| {
            let row = |y, z| self.row((x - 1).max(0), (x + 1).min(nx - 1), y, z).len();
            let rows = around(z, nz).flat_map(|z| around(y, ny).map(move |y| (y, z)));
            rows.map(|(y, z)| row(y, z)).sum::<usize>()
        };
        let columns = (0..nz).flat_map(|z| (0..ny).map(move |y| (y, z)));
        let cells = columns.flat_map(|(y, z)| (0..nx).map(move |x| (x, y, z)));
        cells.map(|(x, y, z)| of_cell(x, y, z)).max().unwrap_or(0) as u32
    }

    /// How far each cell is from the nearest one with a point, in cells along the axis on which it is farthest: two sweeps over
    /// all cells, there and back (Borgefors, "Distance transformations in digital images", 1986).
    pub fn distances(&self) -> Vec<u32> {
        let [nx, ny, nz] = self.counts.map(|n| n as i32);
        let index = |x: i32, y: i32, z: i32| (x + nx * (y + ny * z)) as usize;
        let is_empty = |cell: usize| self.starts[cell] == self.starts[cell + 1];
        let mut distances: Vec<u32> = (0..self.starts.len() - 1)
            .map(|cell| if is_empty(cell) { u32::MAX - 1 } else { 0 })
            .collect();
        let all = || -1..=1;
        let steps = all().flat_map(|z| all().flat_map(move |y| all().map(move |x| [x, y, z])));
        // The half of the neighbours that a sweep has been at.
        let before: Vec<[i32; 3]> = steps.take(13).collect();
        let mut sweep = |sign: i32| {
            for i in 0..nx * ny * nz {
                let i = if sign > 0 { i } else { nx * ny * nz - 1 - i };
                let [x, y, z] = [i % nx, i / nx % ny, i / (nx * ny)];
                let mut least = distances[i as usize];
                for step in &before {
                    let [a, b, c] = [x + sign * step[0], y + sign * step[1], z + sign * step[2]];
                    let is_cell = [(a, nx), (b, ny), (c, nz)];
                    if is_cell.into_iter().all(|(k, n)| (0..n).contains(&k)) {
                        least = least.min(distances[index(a, b, c)] + 1);
                    }
                }
                distances[i as usize] = least;
            }
        };
        sweep(1);
        sweep(-1);
        distances
    }
}

/// The cell of a place in cells, the nearest there is.
fn cell_in(at: DVec3, counts: [u32; 3]) -> [u32; 3] {
    let at = at.to_array();
    std::array::from_fn(|k| (at[k] as u32).min(counts[k] - 1))
}
