//! The numbers of a volume in the order of a file, a slab at a time.

use super::layout::Layout;
use super::numbers::{Bytes, Tally};
use super::{SLAB_BYTES, Selection, WriteVolumeError};
use crate::format::convert::to_u64;
use crate::volume::{Source, TimeComponent, VoxelBox};
use std::io::Write;
use std::ops::Range;

/// Reads, converts and writes.
pub(super) struct Slabs<'a> {
    pub source: &'a dyn Source,
    pub selection: &'a Selection,
    pub layout: &'a Layout,
    pub tally: Tally,
    pub progress: &'a mut dyn FnMut(usize, usize),
}

impl Slabs<'_> {
    /// The numbers of a voxel side by side, times slowest.
    pub(super) fn interleaved(&mut self, out: &mut impl Write) -> Result<(), WriteVolumeError> {
        let components = self.selection.components.clone();
        let slabs = self.slabs(to_u64(components.len()));
        let of = slabs.len().saturating_mul(self.selection.times.len());
        let mut done = 0_usize;
        for time in self.selection.times.clone() {
            for slab in &slabs {
                let mut parts = Vec::new();
                for component in components.clone() {
                    parts.push(self.numbers(TimeComponent { time, component }, slab)?);
                }
                out.write_all(&side_by_side(parts, self.layout.number.bytes()))?;
                done = done.saturating_add(1);
                (self.progress)(done, of);
            }
        }
        Ok(())
    }

    /// One component after the other, each with all its times.
    pub(super) fn one_by_one(&mut self, out: &mut impl Write) -> Result<(), WriteVolumeError> {
        let slabs = self.slabs(1);
        let of = slabs
            .len()
            .saturating_mul(self.selection.times.len())
            .saturating_mul(self.selection.components.len());
        let mut done = 0_usize;
        for component in self.selection.components.clone() {
            for time in self.selection.times.clone() {
                for slab in &slabs {
                    out.write_all(&self.numbers(TimeComponent { time, component }, slab)?)?;
                    done = done.saturating_add(1);
                    (self.progress)(done, of);
                }
            }
        }
        Ok(())
    }

    /// Slices that are read together.
    fn slabs(&self, components: u64) -> Vec<Range<u32>> {
        let VoxelBox { min, max } = self.selection.region;
        let [x, y, _] = self.selection.region.dims().map(u64::from);
        let bytes = to_u64(self.source.header().stored.bytes().max(4));
        let slice = x
            .saturating_mul(y)
            .saturating_mul(bytes)
            .saturating_mul(components);
        let thick = SLAB_BYTES.checked_div(slice).unwrap_or(1).max(1);
        let thick = u32::try_from(thick).unwrap_or(u32::MAX);
        let ([_, _, start], [_, _, end]) = (min, max);
        let mut slabs = Vec::new();
        let mut z = start;
        while z < end {
            let next = z.saturating_add(thick).min(end);
            slabs.push(z..next);
            z = next;
        }
        slabs
    }

    /// The bytes of one component of a slab.
    fn numbers(
        &mut self,
        pick: TimeComponent,
        slab: &Range<u32>,
    ) -> Result<Vec<u8>, WriteVolumeError> {
        let VoxelBox { min, max } = self.selection.region;
        let ([x0, y0, _], [x1, y1, _]) = (min, max);
        let region = VoxelBox {
            min: [x0, y0, slab.start],
            max: [x1, y1, slab.end],
        };
        let exact = match self.source.header().stored.is_kept_exactly() {
            true => None,
            false => self.source.read_bytes(pick, region)?,
        };
        let numbers = match exact {
            Some(bytes) => Bytes {
                bytes,
                stored: self.source.header().stored,
            },
            None => {
                let piece = self.source.read(pick, region)?;
                self.tally.rounded = self.tally.rounded.saturating_add(piece.loss.changed);
                Bytes::of(&piece.voxels)
            }
        };
        Ok(self.layout.map.apply(numbers, &mut self.tally))
    }
}

/// The numbers of several lists in turn.
fn side_by_side(mut parts: Vec<Vec<u8>>, bytes: usize) -> Vec<u8> {
    if parts.len() == 1 {
        return parts.pop().unwrap_or_default();
    }
    let total = parts.iter().map(Vec::len).fold(0, usize::saturating_add);
    let mut out = Vec::with_capacity(total);
    let mut lists: Vec<_> = parts.iter().map(|part| part.chunks_exact(bytes)).collect();
    while out.len() < total {
        for list in &mut lists {
            out.extend_from_slice(list.next().unwrap_or_default());
        }
    }
    out
}

#[cfg(test)]
mod tests {
    #[test]
    fn numbers_of_one_voxel_stand_together() {
        let parts = vec![vec![1, 1, 2, 2], vec![3, 3, 4, 4]];
        assert_eq!(super::side_by_side(parts, 2), [1, 1, 3, 3, 2, 2, 4, 4]);
    }
}
