//! Parts of a picture and parts of a dispatch: what is recorded at once need not be all of it.
//!
//! ```text
//! picture     tiles, rectangles of pixels
//! dispatch    runs of its workgroups, counted x fastest, then y, then z: each run is a few boxes
//! ```

use std::ops::Range;

/// A rectangle of a picture, in pixels from the top left.
///
/// Parts of a picture may be recorded in any order and into different submissions; together they must cover each
/// pixel once. Compute passes want corners at multiples of [`Tile::STEP`], or at the edge of the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Tile {
    /// Of the first pixel: across, down.
    pub origin: [u32; 2],
    /// Pixels across and down.
    pub extent: [u32; 2],
}

impl Tile {
    /// Pixels along a side of a workgroup of all passes over pictures.
    pub const STEP: u32 = 8;

    /// What both have; `None` where they have no pixel in common.
    pub fn and(self, other: Self) -> Option<Self> {
        let end = |tile: Self, k: usize| tile.origin[k] + tile.extent[k];
        let origin = [0, 1].map(|k| self.origin[k].max(other.origin[k]));
        let ends = [0, 1].map(|k| end(self, k).min(end(other, k)));
        let is_there = (0..2).all(|k| origin[k] < ends[k]);
        is_there.then(|| Self {
            origin,
            extent: [0, 1].map(|k| ends[k] - origin[k]),
        })
    }

    /// The smallest tile that holds the pixels from `first` to before `end`, with corners where workgroups begin or the
    /// picture of `extent` ends.
    pub fn around([first, end]: [[u32; 2]; 2], extent: [u32; 2]) -> Self {
        let origin = first.map(|n| n / Self::STEP * Self::STEP);
        let end = [0, 1].map(|k| end[k].next_multiple_of(Self::STEP).min(extent[k]));
        Self {
            origin,
            extent: [0, 1].map(|k| end[k].saturating_sub(origin[k])),
        }
    }

    /// All of a picture.
    pub const fn whole(extent: [u32; 2]) -> Self {
        Self {
            origin: [0, 0],
            extent,
        }
    }
}

/// Workgroups of a dispatch that make a box.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Groups {
    /// The first.
    pub base: [u32; 3],
    /// How many along each axis.
    pub count: [u32; 3],
}

/// Workgroups of a dispatch.
pub(crate) fn group_count(groups: [u32; 3]) -> u64 {
    groups.iter().map(|&n| u64::from(n)).product()
}

/// What a part of some work has of `count` workgroups from `first` on, counted from the first of these.
pub(crate) fn within(part: &Range<u64>, first: u64, count: u64) -> Range<u64> {
    let [start, end] = [part.start, part.end].map(|at| at.saturating_sub(first).min(count));
    start..end
}

/// The boxes that a run of the workgroups of a dispatch is made of, five at most.
pub(crate) fn boxes(groups: [u32; 3], run: Range<u64>) -> impl Iterator<Item = Groups> {
    let [nx, ny, _] = groups.map(u64::from);
    let end = run.end.min(group_count(groups));
    let mut next = run.start;
    std::iter::from_fn(move || {
        if next >= end {
            return None;
        }
        let (left, base) = (end - next, [next % nx, next / nx % ny, next / nx / ny]);
        let count = if base[0] != 0 || left < nx {
            [left.min(nx - base[0]), 1, 1]
        } else if base[1] != 0 || left < nx * ny {
            [nx, (left / nx).min(ny - base[1]), 1]
        } else {
            [nx, ny, left / nx / ny]
        };
        next += count.iter().product::<u64>();
        let [base, count] = [base, count].map(|numbers| numbers.map(|n| n as u32));
        Some(Groups { base, count })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_boxes_of_every_run_hold_its_workgroups_once_and_no_others() {
        for groups in [[3, 4, 2], [1, 5, 3], [4, 1, 1], [1, 1, 1], [2, 2, 3]] {
            let [nx, ny, _] = groups.map(u64::from);
            let all = group_count(groups);
            for start in 0..all {
                for end in start..=all {
                    let mut seen = vec![0; all as usize];
                    let found: Vec<_> = boxes(groups, start..end).collect();
                    assert!(found.len() <= 5, "{groups:?} {start}..{end}: {found:?}");
                    for Groups { base, count } in found {
                        for z in base[2]..base[2] + count[2] {
                            for y in base[1]..base[1] + count[1] {
                                for x in base[0]..base[0] + count[0] {
                                    let [x, y, z] = [x, y, z].map(u64::from);
                                    seen[(x + nx * (y + ny * z)) as usize] += 1;
                                }
                            }
                        }
                    }
                    let wanted = (0..all).map(|n| i32::from((start..end).contains(&n)));
                    assert!(seen.into_iter().eq(wanted), "{groups:?} {start}..{end}");
                }
            }
        }
    }

    #[test]
    fn tiles_that_meet_have_their_common_pixels() {
        let tile = |x, y, width, height| Tile {
            origin: [x, y],
            extent: [width, height],
        };
        let around = Tile::around([[9, 3], [17, 20]], [22, 60]);
        assert_eq!(around, tile(8, 0, 14, 24));
        assert_eq!(around.and(tile(16, 8, 100, 8)), Some(tile(16, 8, 6, 8)));
        assert_eq!(around.and(tile(0, 0, 8, 60)), None);
        assert_eq!(around.and(Tile::whole([22, 60])), Some(around));
    }

    #[test]
    fn a_run_beyond_the_end_ends_there() {
        assert_eq!(boxes([2, 2, 1], 3..u64::MAX).count(), 1);
        assert_eq!(boxes([2, 2, 1], 4..u64::MAX).count(), 0);
        assert_eq!(boxes([2, 0, 1], 0..u64::MAX).count(), 0);
    }
}
