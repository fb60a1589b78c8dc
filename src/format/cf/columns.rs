//! Levels that follow the ground, each column at heights of its own, on even heights above the sea.
//!
//! ```text
//! height = (PH + PHB) / g        of the faces between layers; a layer's middle is halfway between its faces
//! ```
//!
//! Linear in height between the two levels around a point; below the lowest and above the highest level of a
//! column there is no data. WRF's registry: PH and PHB are perturbation and base-state geopotential, m2 s-2.

use super::grid::check;
use super::regular::{between, valid_numbers};
use crate::format::problem::at;
use crate::volume::{Header, Piece, ReadError, Source, TimeComponent, VoxelBox, Voxels};
use std::path::Path;

/// Free fall as WRF has it, m s-2 (share/module_model_constants.F).
const GRAVITY: f64 = 9.81;

/// Heights of the levels of every column.
pub(super) struct Heights {
    /// The two parts of the geopotential on the faces between layers.
    pub parts: [Box<dyn Source>; 2],
    /// True where values lie in the middle of layers, one fewer than faces.
    pub is_middle: bool,
}

impl Heights {
    /// Heights in km of the columns over `min` to `max`, level by level, x fastest.
    pub(super) fn read(
        &self,
        time: u32,
        min: [u32; 2],
        max: [u32; 2],
    ) -> Result<Vec<f32>, ReadError> {
        let [first, second] = &self.parts;
        let region = VoxelBox {
            min: [min[0], min[1], 0],
            max: [max[0], max[1], first.header().dims[2]],
        };
        let pick = TimeComponent { time, component: 0 };
        let geopotential = |source: &dyn Source| {
            let piece = source.read(pick, region)?;
            Ok(valid_numbers(&piece.voxels, source.header().fill))
        };
        let base = geopotential(second.as_ref())?;
        let mut faces = geopotential(first.as_ref())?;
        for (face, base) in faces.iter_mut().zip(&base) {
            *face = kilometres(f64::from(*face) + f64::from(*base));
        }
        if !self.is_middle {
            return Ok(faces);
        }
        let layer = columns(min, max);
        let above = faces.iter().skip(layer);
        Ok(faces
            .iter()
            .zip(above)
            .map(|(a, b)| 0.5 * (a + b))
            .collect())
    }
}

#[allow(
    clippy::cast_possible_truncation,
    reason = "heights have the type of the geopotential"
)]
fn kilometres(geopotential: f64) -> f32 {
    (geopotential / GRAVITY / 1000.0) as f32
}

/// How many columns stand over a rectangle.
fn columns(min: [u32; 2], max: [u32; 2]) -> usize {
    let side = |k: usize| {
        let ends = max.get(k).zip(min.get(k));
        ends.map_or(0, |(max, min)| max.saturating_sub(*min))
    };
    usize::try_from(u64::from(side(0)).saturating_mul(side(1).into())).unwrap_or(usize::MAX)
}

/// A [`Source`] of even heights over one of levels that follow the ground.
pub(super) struct Columns {
    pub inner: Box<dyn Source>,
    pub heights: Heights,
    pub header: Header,
    /// Height of the lowest voxel's centre and the step between centres, km.
    pub first: f64,
    pub step: f64,
    pub max_bytes: u64,
}

impl Columns {
    fn read_checked(&self, pick: TimeComponent, region: VoxelBox) -> Result<Piece, ReadError> {
        let [min, max] = [region.min, region.max];
        let (corner, end) = ([min[0], min[1]], [max[0], max[1]]);
        let inner = VoxelBox {
            min: [min[0], min[1], 0],
            max: [max[0], max[1], self.inner.header().dims[2]],
        };
        let Piece { voxels, loss } = self.inner.read(pick, inner)?;
        let values = valid_numbers(&voxels, self.inner.header().fill);
        drop(voxels);
        let heights = self.heights.read(pick.time, corner, end)?;
        let count = columns(corner, end);
        // Where each column's next point lies: heights only grow from here on.
        let mut below = vec![0_usize; count];
        let mut out = Vec::new();
        for z in min[2]..max[2] {
            let height = self.first + self.step * f64::from(z);
            for (column, below) in below.iter_mut().enumerate() {
                let at = |list: &[f32], level: usize| {
                    let index = level.saturating_mul(count).saturating_add(column);
                    list.get(index).copied()
                };
                while let Some(next) = at(&heights, below.saturating_add(1))
                    && f64::from(next) < height
                {
                    *below = below.saturating_add(1);
                }
                out.push(sample(
                    height,
                    [0, 1].map(|k| {
                        let level = below.saturating_add(k);
                        Some((at(&heights, level)?, at(&values, level)?))
                    }),
                ));
            }
        }
        let voxels = Voxels::F32(out);
        Ok(Piece { voxels, loss })
    }
}

/// The value at `height` between two levels, each a height and a value; NaN outside of them.
fn sample(height: f64, levels: [Option<(f32, f32)>; 2]) -> f32 {
    let [Some((low, a)), upper] = levels else {
        return f32::NAN;
    };
    let low = f64::from(low);
    match upper {
        _ if height == low => a,
        Some((high, b)) if height >= low && height <= f64::from(high) => {
            let weight = (height - low) / (f64::from(high) - low);
            between(a, b, weight, false)
        }
        _ => f32::NAN,
    }
}

impl Source for Columns {
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
