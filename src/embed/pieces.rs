//! Work that is cut into pieces, so that no device is held for long: how large they are, and what they are counted in.
//!
//! ```text
//! an upload      slabs of voxels, then runs of macro cells
//! an update      the same of its box, and corners between them
//! a function     runs of macro cells under it
//! ```
//!
//! A submission takes at least one piece, and [`Pace`](crate::gpu::Pace) finds how many make 100 ms.

use crate::resident::{GpuVolume, Slab};
use std::ops::Range;

/// Bytes that one piece copies, or a row of voxels.
pub(super) const PIECE_BYTES: u64 = 4 << 20;

/// Macro cells of which one piece finds the ranges: their voxels are half as many as a piece copies bytes.
pub(super) const PIECE_CELLS: u64 = 1 << 12;

/// What a piece is thought to take before one was measured: rather too much.
pub(super) const PIECE_MS: f64 = 20.0;

/// A copy into a texture.
#[derive(Clone, Copy, Debug)]
pub(super) struct Placed {
    /// In the order of [`super::Volume::textures`].
    pub texture: usize,
    /// Byte of the staging buffer.
    pub from: u64,
    pub slab: Slab,
}

/// Slabs one after the other from byte `end` on, which is moved behind them.
pub(super) fn placed<'a>(
    (texture, into): (usize, &'a GpuVolume),
    slabs: impl IntoIterator<Item = Slab> + 'a,
    end: &'a mut u64,
) -> impl Iterator<Item = Placed> + 'a {
    slabs.into_iter().map(move |slab| {
        let from = *end;
        *end += into.staging_bytes(slab.region);
        Placed {
            texture,
            from,
            slab,
        }
    })
}

/// The part of `whole` units that some of `count` pieces are.
pub(super) fn run_of(whole: u64, pieces: &Range<u64>, count: u64) -> Range<u64> {
    let at = |piece: u64| (u128::from(whole) * u128::from(piece) / u128::from(count.max(1))) as u64;
    at(pieces.start)..at(pieces.end)
}

/// What two ranges have in common, counted from the start of the second.
pub(super) fn within(part: &Range<u64>, of: Range<u64>) -> Range<u64> {
    let at = |n: u64| n.clamp(of.start, of.end) - of.start;
    at(part.start)..at(part.end)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_together_are_the_whole() {
        for (whole, count) in [(7, 3), (3, 7), (0, 2), (1 << 40, 1000)] {
            let mut end = 0;
            for piece in 0..count {
                let run = run_of(whole, &(piece..piece + 1), count);
                assert_eq!(run.start, end);
                end = run.end;
            }
            assert_eq!(end, whole);
        }
        assert_eq!(within(&(2..9), 4..7), 0..3);
        assert_eq!(within(&(0..2), 4..7), 0..0);
        assert_eq!(within(&(5..6), 4..7), 1..2);
    }
}
