//! An unevenly spaced grid (levels, Gaussian latitudes) on an even one: linear in the world coordinate between
//! two neighbours, the first and the last point where they were, nothing beyond them.
//!
//! ```text
//! value(w) = a + (b - a) (w - wa) / (wb - wa),   wa and wb the neighbours of w
//! ```
//!
//! A point that lies between a number and none has none.

use super::grid::check;
use super::knots::{Knot, even_count, knots, step};
use crate::format::convert::to_u64;
use crate::format::problem::at;
use crate::volume::{
    Header, Limits, Piece, Problem, ReadError, Source, TimeComponent, VoxelBox, VoxelType, Voxels,
};
use glam::{DAffine3, DVec3};
use std::path::Path;

/// A [`Source`] over one whose points are uneven along some axes.
pub(super) struct Regular {
    inner: Box<dyn Source>,
    header: Header,
    /// For each axis that is resampled, where its points lie among those of the inner source.
    axes: [Option<Vec<Knot>>; 3],
    max_bytes: u64,
}

impl Regular {
    /// `points` are the world coordinates along x, y, z of the inner source's points, for its uneven axes.
    pub(super) fn new(
        inner: Box<dyn Source>,
        points: [Option<Vec<f64>>; 3],
        limits: &Limits,
    ) -> Self {
        let mut header = inner.header().clone();
        let mut axes = [None, None, None];
        let finest: Vec<usize> = points
            .iter()
            .zip(header.dims)
            .map(|(points, size)| match points {
                Some(points) => even_count(points),
                None => usize::try_from(size).unwrap_or(usize::MAX),
            })
            .collect();
        let bytes = finest
            .iter()
            .fold(4_u64, |n, &size| n.saturating_mul(to_u64(size)));
        for (k, points) in points.into_iter().enumerate() {
            let Some(points) = points else { continue };
            let (Some(size), Some(axis)) = (header.dims.get_mut(k), axes.get_mut(k)) else {
                continue;
            };
            // Where the finest does not fit, as many points as there were.
            let count = match finest.get(k) {
                Some(&count) if bytes <= limits.max_bytes => count,
                _ => points.len(),
            };
            let name = ["x", "y", "z"].get(k).copied().unwrap_or("");
            header.notes.push(format!(
                "{} unevenly spaced points along {name} are drawn as {count} even ones, linear between neighbours",
                points.len()
            ));
            *size = u32::try_from(count).unwrap_or(*size);
            let step = step(&points, count).unwrap_or(1.0);
            let first = points.first().copied().unwrap_or(0.0);
            header.world_from_voxel = with_axis(header.world_from_voxel, k, first, step);
            *axis = Some(knots(&points, count));
        }
        header.stored = VoxelType::F32;
        header.fill = None;
        Self {
            inner,
            header,
            axes,
            max_bytes: limits.max_bytes,
        }
    }

    fn read_checked(&self, pick: TimeComponent, region: VoxelBox) -> Result<Piece, ReadError> {
        let mut inner = region;
        for k in 0..3 {
            let Some(Some(axis)) = self.axes.get(k) else {
                continue;
            };
            let knot = |i: u32| usize::try_from(i).ok().and_then(|i| axis.get(i));
            let (Some(min), Some(max)) = (inner.min.get_mut(k), inner.max.get_mut(k)) else {
                continue;
            };
            let ends = knot(*min).zip(knot(max.saturating_sub(1)));
            if let Some((first, last)) = ends {
                *min = first.first;
                *max = last.first.saturating_add(2);
            }
        }
        let Piece { voxels, loss } = self.inner.read(pick, inner)?;
        let mut numbers = valid_numbers(&voxels, self.inner.header().fill);
        drop(voxels);
        let mut dims = inner.dims();
        // From z to x: the fewest numbers are worked on first where levels are few.
        for k in [2, 1, 0] {
            let Some(Some(axis)) = self.axes.get(k) else {
                continue;
            };
            let part = |ends: [u32; 3]| ends.get(k).copied().unwrap_or(0);
            let range = usize::try_from(part(region.min)).unwrap_or(0)
                ..usize::try_from(part(region.max)).unwrap_or(0);
            let knots = axis.get(range).unwrap_or(&[]);
            numbers = along(
                &numbers,
                dims,
                k,
                knots,
                part(inner.min),
                self.header.is_labels,
            )
            .map_err(at(self.path()))?;
            if let Some(size) = dims.get_mut(k) {
                *size = u32::try_from(knots.len()).unwrap_or(0);
            }
        }
        let voxels = Voxels::F32(numbers);
        Ok(Piece { voxels, loss })
    }
}

/// The affine with another first centre and step along an axis that is one of the world's.
#[allow(
    clippy::arithmetic_side_effects,
    reason = "vectors of f64: nothing wraps or panics"
)]
pub(super) fn with_axis(affine: DAffine3, k: usize, first: f64, step: f64) -> DAffine3 {
    let mut centers = affine * DAffine3::from_translation(DVec3::splat(0.5));
    let axis = DVec3::AXES.get(k).copied().unwrap_or(DVec3::ZERO);
    let column = axis * step;
    match k {
        0 => centers.matrix3.x_axis = column,
        1 => centers.matrix3.y_axis = column,
        _ => centers.matrix3.z_axis = column,
    }
    centers.translation += axis * (first - centers.translation.dot(axis));
    centers * DAffine3::from_translation(DVec3::splat(-0.5))
}

/// As f32, NaN where there is no data.
#[allow(
    clippy::cast_possible_truncation,
    reason = "the fill is rounded as the numbers were"
)]
pub(super) fn valid_numbers(voxels: &Voxels, fill: Option<f64>) -> Vec<f32> {
    let fill = fill.map(|fill| fill as f32);
    let valid = |number: f32| {
        if Some(number) == fill || !number.is_finite() {
            f32::NAN
        } else {
            number
        }
    };
    (0..voxels.len()).map(|i| valid(voxels.stored(i))).collect()
}

/// Linear between two numbers; the ends are taken as they are. For labels the nearer one.
#[allow(
    clippy::cast_possible_truncation,
    reason = "rounding the sum to the type of voxels"
)]
pub(super) fn between(a: f32, b: f32, weight: f64, is_labels: bool) -> f32 {
    if weight <= 0.0 || is_labels && weight < 0.5 {
        a
    } else if weight >= 1.0 || is_labels {
        b
    } else {
        let (a, b) = (f64::from(a), f64::from(b));
        (a + (b - a) * weight) as f32
    }
}

/// Resamples one axis of a box of numbers, x fastest. The first number lies at the inner index `origin`.
fn along(
    numbers: &[f32],
    dims: [u32; 3],
    k: usize,
    knots: &[Knot],
    origin: u32,
    is_labels: bool,
) -> Result<Vec<f32>, Problem> {
    let size = |axis: usize| usize::try_from(dims.get(axis).copied().unwrap_or(1)).unwrap_or(0);
    // Numbers between neighbours on the axis, and lines of such neighbours.
    let stride = (0..k).map(size).fold(1, usize::saturating_mul);
    let block = stride.saturating_mul(size(k)).max(1);
    let blocks = numbers.len().checked_div(block).unwrap_or(0);
    let count = blocks.saturating_mul(knots.len()).saturating_mul(stride);
    let mut out = Vec::new();
    out.try_reserve_exact(count).map_err(|_| Problem::Limit {
        what: "the resampled volume".to_owned(),
        wanted_bytes: to_u64(count).saturating_mul(4),
        limit_bytes: 0,
    })?;
    for block in numbers.chunks(block) {
        for knot in knots {
            let index = usize::try_from(knot.first.saturating_sub(origin)).unwrap_or(usize::MAX);
            let layer = |index: usize| {
                let start = index.saturating_mul(stride);
                block
                    .get(start..start.saturating_add(stride))
                    .unwrap_or(&[])
            };
            let pairs = layer(index).iter().zip(layer(index.saturating_add(1)));
            out.extend(pairs.map(|(a, b)| between(*a, *b, knot.weight, is_labels)));
        }
    }
    Ok(out)
}

impl Source for Regular {
    fn path(&self) -> &Path {
        self.inner.path()
    }

    fn header(&self) -> &Header {
        &self.header
    }

    fn read(&self, pick: TimeComponent, region: VoxelBox) -> Result<Piece, ReadError> {
        check(&self.header, pick, region, self.max_bytes).map_err(at(self.path()))?;
        self.read_checked(pick, region)
    }
}
