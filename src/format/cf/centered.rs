//! Values on the faces of cells, brought to the middles.
//!
//! ```text
//! middle_i = (face_i + face_{i+1}) / 2
//! ```

use super::regular::{between, valid_numbers, with_axis};
use crate::volume::{Header, Piece, ReadError, Source, TimeComponent, VoxelBox, VoxelType, Voxels};
use std::path::Path;

/// Values on the faces of cells along an axis, in the middles.
pub(super) struct Centered {
    inner: Box<dyn Source>,
    header: Header,
    axis: usize,
}

impl Centered {
    pub(super) fn new(inner: Box<dyn Source>, axis: usize) -> Self {
        let mut header = inner.header().clone();
        if let Some(size) = header.dims.get_mut(axis) {
            *size = size.saturating_sub(1);
        }
        let step = header.world_from_voxel.matrix3.col(axis.min(2)).length();
        let half = 0.5
            * step
            * f64::from(
                header
                    .dims
                    .get(axis)
                    .copied()
                    .unwrap_or(1)
                    .saturating_sub(1),
            );
        // Along z the world is that of a part on the levels themselves.
        if axis < 2 {
            header.world_from_voxel = with_axis(header.world_from_voxel, axis, -half, step);
        }
        header.stored = VoxelType::F32;
        header.fill = None;
        let side = match axis {
            0 => "west and east",
            1 => "south and north",
            _ => "below and above",
        };
        header.notes.push(format!(
            "values on the faces of cells {side} are drawn as their means in the middle"
        ));
        Self {
            inner,
            header,
            axis,
        }
    }
}

impl Source for Centered {
    fn path(&self) -> &Path {
        self.inner.path()
    }

    fn header(&self) -> &Header {
        &self.header
    }

    fn read(&self, pick: TimeComponent, region: VoxelBox) -> Result<Piece, ReadError> {
        let mut wider = region;
        if let Some(max) = wider.max.get_mut(self.axis) {
            *max = max.saturating_add(1);
        }
        let Piece { voxels, loss } = self.inner.read(pick, wider)?;
        let numbers = valid_numbers(&voxels, self.inner.header().fill);
        let dims = wider
            .dims()
            .map(|n| usize::try_from(n).unwrap_or(usize::MAX));
        let below = dims.iter().take(self.axis).copied();
        let stride = below.fold(1, usize::saturating_mul).max(1);
        let line = stride
            .saturating_mul(dims.get(self.axis).copied().unwrap_or(1))
            .max(1);
        let mut out = Vec::new();
        for block in numbers.chunks(line) {
            let next = block.iter().skip(stride);
            out.extend(
                block
                    .iter()
                    .zip(next)
                    .map(|(a, b)| between(*a, *b, 0.5, false)),
            );
        }
        let voxels = Voxels::F32(out);
        Ok(Piece { voxels, loss })
    }
}
