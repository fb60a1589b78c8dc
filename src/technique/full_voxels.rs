//! Which voxels are full under a transfer function: those that [`Runs`](crate::volume::Runs) and an
//! [`Octree`](crate::volume::Octree) keep.
//!
//! ```text
//! before filtering (pre-classified)      extinction of the voxel's own value > 0
//! after filtering (post-classified)      some value is seen that a filter can make inside the voxel: the range of the
//!                                        voxel and of the halo around it, a macro cell of one voxel
//! ```
//!
//! A sample in voxels that are not full after filtering adds nothing; one whose voxels of the footprint are all not full
//! before filtering adds nothing to a pre-classified picture.

use crate::color::ColorSpace;
use crate::resident::{Halo, filtered};
use crate::transfer::{Absorption, Points, TransferFunction, VisibleRanges, classify_by_points};
use crate::volume::{Volume, VoxelSet, Voxels};
use std::collections::VecDeque;

/// Voxels whose own value has extinction under `function`, and data. Where gradients have a say, a value alone has none.
pub fn full_before_filtering(volume: &Volume, function: &TransferFunction) -> VoxelSet {
    // Where extinction is not 0 does not depend on the length that opacities are for.
    let absorption = Absorption::Extinction {
        reference_length: 1.0,
    };
    let points = Points::new(function, absorption, ColorSpace::Display);
    let is_seen = |stored: f32| {
        let value = f64::from(stored) * volume.rescale.slope + volume.rescale.intercept;
        let [.., extinction]: [f64; 4] = classify_by_points(&points, value);
        extinction as f32 > 0.0
    };
    // Of 8 and 16 bits each code is classified once.
    let codes = |bits: u32, first: i32| -> Vec<bool> {
        (0..1 << bits)
            .map(|n| is_seen((n + first) as f32))
            .collect()
    };
    let seen = match volume.voxels {
        Voxels::U8(_) => codes(8, 0),
        Voxels::I8(_) => codes(8, i8::MIN.into()),
        Voxels::U16(_) => codes(16, 0),
        Voxels::I16(_) => codes(16, i16::MIN.into()),
        Voxels::F16(_) | Voxels::F32(_) => Vec::new(),
    };
    let validity = volume.validity.as_deref();
    let mut n = 0;
    VoxelSet::by(volume.dims, |_| {
        let is_valid = validity.is_none_or(|valid| valid[n] != 0);
        let is_full = match &volume.voxels {
            Voxels::U8(v) => seen[usize::from(v[n])],
            Voxels::I8(v) => seen[(i32::from(v[n]) - i32::from(i8::MIN)) as usize],
            Voxels::U16(v) => seen[usize::from(v[n])],
            Voxels::I16(v) => seen[(i32::from(v[n]) - i32::from(i16::MIN)) as usize],
            voxels => is_seen(voxels.stored(n)),
        };
        n += 1;
        is_valid && is_full
    })
}

/// Voxels in which a filter that looks as far as `halo` can make a value that `function` shows. As with macro cells, what
/// stands in the place of missing data counts.
pub fn full_after_filtering(volume: &Volume, function: &TransferFunction, halo: Halo) -> VoxelSet {
    full_of_seen(volume, &VisibleRanges::new(function), halo)
}

/// The same of values that are seen.
pub(crate) fn full_of_seen(volume: &Volume, seen: &VisibleRanges, halo: Halo) -> VoxelSet {
    let is_half = matches!(volume.voxels, Voxels::F16(_));
    let is_integer = !volume.voxels.voxel_type().is_float();
    let [slope, intercept] = [volume.rescale.slope, volume.rescale.intercept].map(|n| n as f32);
    let error = halo.sampler_error(slope, is_integer, is_half);
    let is_full = |[least, most]: [f32; 2]| {
        let [a, b] = [least, most].map(|code| code * slope + intercept);
        seen.shows(filtered([a.min(b), a.max(b)], halo.overshoot, error))
    };
    let mut slices = Slices::new(volume, halo.voxels);
    VoxelSet::by(volume.dims, |voxel| is_full(slices.range_around(voxel)))
}

/// Least and most code around each voxel of a slice: first in the slices themselves, then over those around.
struct Slices<'a> {
    volume: &'a Volume,
    reach: u32,
    /// Ranges within slices around the current one, those along x and y done.
    held: VecDeque<Vec<[f32; 2]>>,
    /// Number of the slice behind the last one held.
    next: u32,
    /// The current slice, and its ranges.
    current: Option<u32>,
    ranges: Vec<[f32; 2]>,
}

fn joined(a: [f32; 2], b: [f32; 2]) -> [f32; 2] {
    [a[0].min(b[0]), a[1].max(b[1])]
}

impl<'a> Slices<'a> {
    fn new(volume: &'a Volume, reach: u32) -> Self {
        Self {
            volume,
            reach,
            held: VecDeque::new(),
            next: 0,
            current: None,
            ranges: Vec::new(),
        }
    }

    /// Of a voxel and those around it that the grid has; slices are asked for one after the other.
    fn range_around(&mut self, [x, y, z]: [u32; 3]) -> [f32; 2] {
        if self.current != Some(z) {
            self.go_to(z);
        }
        self.ranges[y as usize * self.volume.dims[0] as usize + x as usize]
    }

    fn go_to(&mut self, z: u32) {
        let end = z.saturating_add(self.reach + 1).min(self.volume.dims[2]);
        while self.next < end {
            self.held.push_back(self.within_slice(self.next));
            self.next += 1;
        }
        let first = z.saturating_sub(self.reach);
        while self.next - (self.held.len() as u32) < first {
            self.held.pop_front();
        }
        self.ranges.clone_from(&self.held[0]);
        for slice in self.held.iter().skip(1) {
            for (range, &other) in self.ranges.iter_mut().zip(slice) {
                *range = joined(*range, other);
            }
        }
        self.current = Some(z);
    }

    /// Ranges over the voxels around within slice `z`.
    fn within_slice(&self, z: u32) -> Vec<[f32; 2]> {
        let [nx, ny, _] = self.volume.dims.map(|n| n as usize);
        let first = z as usize * nx * ny;
        let codes = (first..first + nx * ny).map(|n| [self.volume.voxels.stored(n); 2]);
        let codes: Vec<_> = codes.collect();
        let along_x = spread(&codes, 1, nx, self.reach as usize);
        spread(&along_x, nx, ny, self.reach as usize)
    }
}

/// Of each element the range over itself and `reach` before and behind it along an axis of `count` elements that are
/// `stride` apart.
fn spread(ranges: &[[f32; 2]], stride: usize, count: usize, reach: usize) -> Vec<[f32; 2]> {
    let around = |n: usize| {
        let at = n / stride % count;
        let before = reach.min(at);
        let behind = reach.min(count - 1 - at);
        let others = (n - before * stride..=n + behind * stride).step_by(stride);
        others.map(|m| ranges[m]).fold(ranges[n], joined)
    };
    (0..ranges.len()).map(around).collect()
}
