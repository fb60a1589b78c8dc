//! The length of vectors, as a source of its own.
//!
//! ```text
//! length = sqrt(sum over components of value^2),  value = stored * slope + intercept
//! ```
//!
//! In f64, kept as f32. No data where any component is.

use super::{
    ComponentKind, Header, Piece, PrecisionLoss, ReadError, Rescale, Source, TimeComponent,
    VoxelBox, VoxelType, Voxels,
};
use std::path::Path;

/// A source of one number a voxel, the length of what another source holds.
pub struct Magnitude {
    of: Box<dyn Source>,
    header: Header,
}

impl std::fmt::Debug for Magnitude {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Magnitude")
            .field("header", &self.header)
            .finish_non_exhaustive()
    }
}

impl Magnitude {
    /// The length of all components of `source` together.
    pub fn new(source: Box<dyn Source>) -> Self {
        let mut header = Header {
            components: 1,
            stored: VoxelType::F32,
            rescale: Rescale::default(),
            // Holes are NaN, see `slab`.
            fill: None,
            meaning: ComponentKind::Numbers,
            is_labels: false,
            hounsfield: false,
            ..source.header().clone()
        };
        header.notes.push(format!(
            "a voxel holds a vector of {} numbers: its length is taken; --component N takes one of them",
            source.header().components
        ));
        Self { of: source, header }
    }
}

impl Source for Magnitude {
    fn path(&self) -> &Path {
        self.of.path()
    }

    fn header(&self) -> &Header {
        &self.header
    }

    fn reads_parts(&self) -> bool {
        self.of.reads_parts()
    }

    fn reads_whole_rows(&self) -> bool {
        self.of.reads_whole_rows()
    }

    fn read(&self, pick: TimeComponent, region: VoxelBox) -> Result<Piece, ReadError> {
        let [nx, ny, _] = region.dims().map(u64::from);
        let slices = (SLAB_VOXELS / (nx * ny).max(1)).clamp(1, u32::MAX.into()) as u32;
        let mut lengths = Vec::new();
        let mut loss = PrecisionLoss::default();
        for z in (region.min[2]..region.max[2]).step_by(slices as usize) {
            let mut slab = region;
            (slab.min[2], slab.max[2]) = (z, z.saturating_add(slices).min(region.max[2]));
            loss = loss.and(self.slab(pick, slab, &mut lengths)?);
        }
        Ok(Piece {
            voxels: Voxels::F32(lengths),
            loss,
        })
    }
}

/// Voxels whose squares are in memory at once.
const SLAB_VOXELS: u64 = 1 << 22;

impl Magnitude {
    fn slab(
        &self,
        pick: TimeComponent,
        region: VoxelBox,
        lengths: &mut Vec<f32>,
    ) -> Result<PrecisionLoss, ReadError> {
        let Header {
            components,
            rescale,
            fill,
            ..
        } = *self.of.header();
        let Rescale { slope, intercept } = rescale;
        let mut squares: Vec<f64> = Vec::new();
        let mut loss = PrecisionLoss::default();
        for component in 0..components {
            let piece = self.of.read(TimeComponent { component, ..pick }, region)?;
            squares.resize(piece.voxels.len(), 0.0);
            loss = loss.and(piece.loss);
            // What was rounded to f32 meets a fill that was rounded too.
            let is_fill = |stored: f32| {
                fill.is_some_and(|fill| f64::from(stored) == fill || stored == fill as f32)
            };
            for (i, square) in squares.iter_mut().enumerate() {
                let stored = piece.voxels.stored(i);
                let value = f64::from(stored) * slope + intercept;
                *square += if is_fill(stored) {
                    f64::NAN
                } else {
                    value * value
                };
            }
        }
        lengths.extend(squares.into_iter().map(|square| square.sqrt() as f32));
        Ok(loss)
    }
}
