//! Pictures that all processors fill, tile by tile: what is summed up for the pixels of one stays in a cache.

use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

/// Columns and rows.
const SIZE: [usize; 2] = [64, 16];

/// A part of a picture.
pub(super) struct Tile {
    pub columns: Range<usize>,
    pub rows: Range<usize>,
    width: usize,
}

impl Tile {
    fn number(n: usize, [width, height]: [usize; 2]) -> Option<Self> {
        let across = width.div_ceil(SIZE[0]);
        let [x, y] = [SIZE[0] * (n % across), SIZE[1] * (n / across)];
        (y < height).then(|| Self {
            columns: x..(x + SIZE[0]).min(width),
            rows: y..(y + SIZE[1]).min(height),
            width,
        })
    }

    pub fn len(&self) -> usize {
        self.columns.len() * self.rows.len()
    }

    /// Where its pixels are in the picture, row by row.
    pub fn pixels(&self) -> impl Iterator<Item = usize> {
        let columns = &self.columns;
        let row = move |y: usize| columns.clone().map(move |x| y * self.width + x);
        self.rows.clone().flat_map(row)
    }
}

/// A picture of what `fill` makes of each tile, row by row.
pub(super) fn in_tiles<T: Copy + Default + Send>(
    size: [usize; 2],
    fill: impl Fn(&Tile) -> Vec<T> + Sync,
) -> Vec<T> {
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let picture = Mutex::new(vec![T::default(); size[0] * size[1]]);
    let next = AtomicUsize::new(0);
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                while let Some(tile) = Tile::number(next.fetch_add(1, Ordering::Relaxed), size) {
                    let made = fill(&tile);
                    let mut picture = picture.lock().unwrap_or_else(PoisonError::into_inner);
                    for (at, pixel) in tile.pixels().zip(made) {
                        picture[at] = pixel;
                    }
                }
            });
        }
    });
    picture.into_inner().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_pixel_is_in_one_tile() {
        for size in [[1, 1], [64, 16], [65, 17], [3, 200], [200, 3]] {
            let found = in_tiles(size, |tile| tile.pixels().map(|at| at + 1).collect());
            let wanted: Vec<usize> = (1..=size[0] * size[1]).collect();
            assert_eq!(found, wanted, "{size:?}");
        }
    }
}
