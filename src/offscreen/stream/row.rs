//! Neighbours along x, read at once and cut: a file of rows or slices is gone through once for all of them.

use super::Stream;
use crate::volume::{
    Header, Limits, Piece, ReadError, Source, TimeComponent, Volume, VoxelBox, Voxels, part_of,
};
use std::path::Path;

impl Stream {
    /// How many of these bricks are read together with the first: neighbours along x, as long as a piece holds them.
    pub(in crate::offscreen) fn together(&self, bricks: &[usize]) -> usize {
        if !self.source.reads_whole_rows() {
            return bricks.len().min(1);
        }
        let row = |brick: usize| [1, 2].map(|k| self.cells[brick].index[k]);
        let fits = |count: usize| self.bytes_of(self.region(&bricks[..count])) <= self.piece_bytes;
        let of_row = bricks
            .iter()
            .take_while(|&&brick| row(brick) == row(bricks[0]));
        let most = of_row.count();
        (1..=most)
            .rev()
            .find(|&count| count == 1 || fits(count))
            .unwrap_or(0)
    }

    /// Reads bricks of one row and hands each to `take`, which says whether it wants the next. Those that are not
    /// `wanted` any more are left out.
    pub(in crate::offscreen) fn read_row(
        &self,
        bricks: &[usize],
        wanted: impl Fn(usize) -> bool,
        mut take: impl FnMut(usize, Result<Volume, ReadError>) -> bool,
    ) -> bool {
        let wants: Vec<_> = bricks
            .iter()
            .copied()
            .filter(|&brick| wanted(brick))
            .collect();
        let row = match &wants[..] {
            [] => return true,
            &[brick] => return take(brick, self.read(brick)),
            wants => Row::read(self, self.region(wants)),
        };
        let row = match row {
            Ok(row) => row,
            Err(error) => return take(wants[0], Err(error)),
        };
        let mut left = wants.into_iter().filter(|&brick| wanted(brick));
        left.all(|brick| take(brick, self.read_from(&row, brick)))
    }

    /// The smallest box over these bricks and their halos.
    fn region(&self, bricks: &[usize]) -> VoxelBox {
        let boxes = bricks.iter().map(|&brick| self.cells[brick].stored);
        let over = |a: VoxelBox, b: VoxelBox| VoxelBox {
            min: std::array::from_fn(|k| a.min[k].min(b.min[k])),
            max: std::array::from_fn(|k| a.max[k].max(b.max[k])),
        };
        boxes.reduce(over).expect("bricks are asked for")
    }

    fn bytes_of(&self, region: VoxelBox) -> u64 {
        let voxels: u64 = region.dims().map(u64::from).iter().product();
        voxels * self.outline.voxels.voxel_type().bytes() as u64
    }

    /// The voxels of a brick and its halo.
    pub(in crate::offscreen) fn read(&self, brick: usize) -> Result<Volume, ReadError> {
        self.read_from(self.source.as_ref(), brick)
    }

    fn read_from(&self, source: &dyn Source, brick: usize) -> Result<Volume, ReadError> {
        let limits = Limits {
            max_bytes: u64::MAX,
            ..Limits::default()
        };
        Volume::read(source, self.pick, self.cells[brick].stored, &limits)
    }
}

/// A box of a source, in memory.
struct Row<'a> {
    of: &'a dyn Source,
    region: VoxelBox,
    voxels: Voxels,
}

impl<'a> Row<'a> {
    fn read(stream: &'a Stream, region: VoxelBox) -> Result<Self, ReadError> {
        let of = stream.source.as_ref();
        let Piece { voxels, .. } = of.read(stream.pick, region)?;
        Ok(Self { of, region, voxels })
    }
}

impl Source for Row<'_> {
    fn path(&self) -> &Path {
        self.of.path()
    }

    fn header(&self) -> &Header {
        self.of.header()
    }

    fn read(&self, _: TimeComponent, part: VoxelBox) -> Result<Piece, ReadError> {
        let within = VoxelBox {
            min: std::array::from_fn(|k| part.min[k] - self.region.min[k]),
            max: std::array::from_fn(|k| part.max[k] - self.region.min[k]),
        };
        Ok(part_of(&self.voxels, self.region.dims(), within).into())
    }
}
