//! A source with fewer voxels: every block of `factor` cubed becomes one.
//!
//! ```text
//! reduced[i] = mean of the valid source[factor * i .. factor * (i + 1)]     position_source = factor * position
//! ```
//!
//! Of labels the voxel in the middle of the block is taken: nothing lies between two names.

use super::voxels::Stored;
use super::{Header, Piece, ReadError, Source, TimeComponent, VoxelBox, Voxels};
use glam::{DAffine3, DVec3};
use half::f16;
use std::path::Path;

/// A [`Source`] over another one.
pub struct Reduced {
    source: Box<dyn Source>,
    header: Header,
    factor: u32,
    slab_bytes: u64,
}

impl Reduced {
    /// Blocks of `factor` voxels a side; the last of an axis may be cut. A factor of 0 is taken as 1.
    ///
    /// Of the source `slab_bytes` are in memory at once, or the slices that make one reduced slice.
    pub fn new(source: Box<dyn Source>, factor: u32, slab_bytes: u64) -> Self {
        let factor = factor.max(1);
        let whole = source.header();
        let scale = DAffine3::from_scale(DVec3::splat(factor.into()));
        let [x, y, z] = whole.dims.map(|n| n.div_ceil(factor));
        let mut header = Header {
            dims: [x, y, z],
            world_from_voxel: whole.world_from_voxel * scale,
            levels: 1,
            ..whole.clone()
        };
        let [from_x, from_y, from_z] = whole.dims;
        let how = if whole.is_labels {
            "the middle one of each block"
        } else {
            "means of blocks"
        };
        header.notes.push(format!(
            "reduced from {from_x} x {from_y} x {from_z} to {x} x {y} x {z} voxels, {how} of {factor} a side"
        ));
        Self {
            source,
            header,
            factor,
            slab_bytes,
        }
    }

    /// The voxels of the source that `region` is made of.
    fn region_of_source(&self, region: VoxelBox) -> VoxelBox {
        let dims = self.source.header().dims;
        VoxelBox {
            min: region.min.map(|n| n * self.factor),
            max: std::array::from_fn(|k| region.max[k].saturating_mul(self.factor).min(dims[k])),
        }
    }
}

impl Source for Reduced {
    fn prepare(&self, watch: &(dyn Fn(f64) + Sync)) {
        self.source.prepare(watch);
    }

    fn path(&self) -> &Path {
        self.source.path()
    }

    fn header(&self) -> &Header {
        &self.header
    }

    fn reads_parts(&self) -> bool {
        self.source.reads_parts()
    }

    fn reads_whole_rows(&self) -> bool {
        self.source.reads_whole_rows()
    }

    fn read(&self, pick: TimeComponent, region: VoxelBox) -> Result<Piece, ReadError> {
        let slice = self.region_of_source(VoxelBox {
            max: [region.max[0], region.max[1], region.min[2] + 1],
            ..region
        });
        let slice_voxels: u64 = slice.dims().iter().map(|&n| u64::from(n)).product();
        let slice_bytes = slice_voxels.saturating_mul(self.header.stored.bytes() as u64);
        let slices = u32::try_from(self.slab_bytes / slice_bytes.max(1)).unwrap_or(u32::MAX);
        let mut whole: Option<Piece> = None;
        for first in (region.min[2]..region.max[2]).step_by(slices.max(1) as usize) {
            let mut slab = region;
            slab.min[2] = first;
            slab.max[2] = first.saturating_add(slices.max(1)).min(region.max[2]);
            let inner = self.region_of_source(slab);
            let found = self.source.read(pick, inner)?;
            let blocks = Blocks {
                from: inner.dims().map(|n| n as usize),
                to: slab.dims().map(|n| n as usize),
                factor: self.factor as usize,
                fill: self.header.fill,
                is_labels: self.header.is_labels,
            };
            let voxels = blocks.reduce(&found.voxels);
            match &mut whole {
                None => {
                    whole = Some(Piece {
                        voxels,
                        loss: found.loss,
                    });
                }
                Some(so_far) => {
                    so_far.voxels.append(voxels);
                    so_far.loss = so_far.loss.and(found.loss);
                }
            }
        }
        Ok(whole.expect("a region is not empty"))
    }
}

/// The blocks of one slab; the first begins at its corner.
pub(super) struct Blocks {
    pub from: [usize; 3],
    pub to: [usize; 3],
    pub factor: usize,
    pub fill: Option<f64>,
    pub is_labels: bool,
}

impl Blocks {
    pub fn reduce(&self, voxels: &Voxels) -> Voxels {
        match voxels {
            Voxels::U8(v) => Voxels::U8(self.of(v, |mean| mean.round() as u8)),
            Voxels::I8(v) => Voxels::I8(self.of(v, |mean| mean.round() as i8)),
            Voxels::U16(v) => Voxels::U16(self.of(v, |mean| mean.round() as u16)),
            Voxels::I16(v) => Voxels::I16(self.of(v, |mean| mean.round() as i16)),
            Voxels::F16(v) => Voxels::F16(self.of(v, f16::from_f64)),
            Voxels::F32(v) => Voxels::F32(self.of(v, |mean| mean as f32)),
        }
    }

    fn of<T: Stored>(&self, voxels: &[T], from_mean: impl Fn(f64) -> T) -> Vec<T> {
        let fill = self.fill.and_then(T::from_fill);
        let [nx, ny, _] = self.to;
        let count: usize = self.to.iter().product();
        (0..count)
            .map(|i| {
                let block = [i % nx, i / nx % ny, i / (nx * ny)];
                let [x, y, z] = self.range(block);
                if self.is_labels {
                    let middle = [x, y, z].map(|range| (range.start + range.end - 1) / 2);
                    return voxels[self.index(middle)];
                }
                let (mut sum, mut valid) = (0.0, 0_u32);
                for z in z.clone() {
                    for y in y.clone() {
                        let row = self.index([x.start, y, z]);
                        for voxel in &voxels[row..row + x.len()] {
                            let number = f64::from(voxel.to_f32());
                            if number.is_finite() && Some(*voxel) != fill {
                                sum += number;
                                valid += 1;
                            }
                        }
                    }
                }
                if valid == 0 {
                    // No data stays the "no data" that it was.
                    return voxels[self.index([x.start, y.start, z.start])];
                }
                from_mean(sum / f64::from(valid))
            })
            .collect()
    }

    fn range(&self, block: [usize; 3]) -> [std::ops::Range<usize>; 3] {
        std::array::from_fn(|k| {
            let first = block[k] * self.factor;
            first..(first + self.factor).min(self.from[k])
        })
    }

    fn index(&self, [x, y, z]: [usize; 3]) -> usize {
        x + self.from[0] * (y + self.from[1] * z)
    }
}

impl Voxels {
    /// `more` of the same type behind these.
    fn append(&mut self, more: Self) {
        match (self, more) {
            (Self::U8(a), Self::U8(b)) => a.extend(b),
            (Self::I8(a), Self::I8(b)) => a.extend(b),
            (Self::U16(a), Self::U16(b)) => a.extend(b),
            (Self::I16(a), Self::I16(b)) => a.extend(b),
            (Self::F16(a), Self::F16(b)) => a.extend(b),
            (Self::F32(a), Self::F32(b)) => a.extend(b),
            _ => unreachable!("a source has one type of voxels"),
        }
    }
}

impl std::fmt::Debug for Reduced {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Reduced")
            .field("path", &self.source.path())
            .field("factor", &self.factor)
            .finish_non_exhaustive()
    }
}
