//! The blocks of a picture in an order in which any first part of them is spread over all of it: what the first
//! submissions take then tells what the others will.
//!
//! ```text
//! order     n/2 + the numbers 0 .. n by their bits from the lowest on (van der Corput 1935), modulo n
//! ```

use super::Tile;
use std::ops::Range;

/// A picture in blocks.
#[derive(Clone, Debug)]
pub struct Blocks {
    extent: [u32; 2],
    /// Pixels of a block across and down, multiples of [`Tile::STEP`].
    size: [u32; 2],
    /// Numbers of rows and of columns of blocks, in the order in which their turn comes.
    rows: Vec<u32>,
    columns: Vec<u32>,
}

impl Blocks {
    /// So many across and down, of one size, as far as workgroups go.
    pub fn new(extent: [u32; 2], count: [u32; 2]) -> Self {
        let size = [0, 1].map(|k: usize| {
            let side = extent[k].div_ceil(count[k].max(1)).max(1);
            side.next_multiple_of(Tile::STEP)
        });
        Self {
            extent,
            size,
            rows: spread(extent[1].div_ceil(size[1])),
            columns: spread(extent[0].div_ceil(size[0])),
        }
    }

    /// How many there are.
    pub fn count(&self) -> u64 {
        self.rows.len() as u64 * self.columns.len() as u64
    }

    /// The pixels of some of them, put together to few tiles.
    pub fn tiles(&self, part: Range<u64>) -> Vec<Tile> {
        if part == (0..self.count()) {
            return vec![Tile::whole(self.extent)];
        }
        let [down, across] = [self.rows.len(), self.columns.len()];
        let mut is_in = vec![false; down * across];
        for number in part {
            let number = number as usize;
            let (row, column) = (self.rows[number % down], self.columns[number / down]);
            is_in[row as usize * across + column as usize] = true;
        }
        // Runs of a row, each put to the same run of the row above where there is one.
        let mut tiles = Vec::<Tile>::new();
        for (row, blocks) in (0_u32..).zip(is_in.chunks(across.max(1))) {
            for (start, end) in runs(blocks) {
                let (x, y) = (start as u32 * self.size[0], row * self.size[1]);
                let width = (end as u32 * self.size[0]).min(self.extent[0]) - x;
                let height = self.size[1].min(self.extent[1] - y);
                let is_above = |tile: &&mut Tile| {
                    let bottom = tile.origin[1] + tile.extent[1];
                    bottom == y && tile.origin[0] == x && tile.extent[0] == width
                };
                match tiles.iter_mut().rev().find(is_above) {
                    Some(above) => above.extent[1] += height,
                    None => tiles.push(Tile {
                        origin: [x, y],
                        extent: [width, height],
                    }),
                }
            }
        }
        tiles
    }
}

/// Where there are some: the first, and the end.
fn runs(are_in: &[bool]) -> Vec<(usize, usize)> {
    let mut runs = Vec::new();
    let mut at = 0;
    while at < are_in.len() {
        let length = are_in[at..].iter().take_while(|&&is| is).count();
        if length > 0 {
            runs.push((at, at + length));
        }
        at += length.max(1);
    }
    runs
}

/// The numbers from 0 to `count`, the middle one first.
fn spread(count: u32) -> Vec<u32> {
    let mut order: Vec<u32> = (0..count).collect();
    order.sort_by_key(|number| number.reverse_bits());
    for number in &mut order {
        *number = (*number + count / 2) % count;
    }
    order
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tiles_of_parts_hold_each_pixel_once_with_corners_where_workgroups_begin() {
        for extent in [[64, 64], [33, 17], [8, 8], [1, 1], [100, 7], [7, 100]] {
            for count in [[1, 100], [2, 100], [3, 2], [100, 3], [1, 1]] {
                for size in [1, 2, 3, 5, 1000] {
                    let blocks = Blocks::new(extent, count);
                    let mut seen = vec![0; (extent[0] * extent[1]) as usize];
                    for start in (0..blocks.count()).step_by(size) {
                        let end = (start + size as u64).min(blocks.count());
                        for Tile { origin, extent: of } in blocks.tiles(start..end) {
                            assert!(origin.iter().all(|at| at % Tile::STEP == 0));
                            for y in origin[1]..origin[1] + of[1] {
                                for x in origin[0]..origin[0] + of[0] {
                                    seen[(x + extent[0] * y) as usize] += 1;
                                }
                            }
                        }
                    }
                    assert!(seen.iter().all(|&n| n == 1), "{extent:?} {count:?} {size}");
                }
            }
        }
    }

    #[test]
    fn any_first_part_is_spread_over_the_picture() {
        let order = spread(64);
        for count in [2, 4, 8, 16, 32] {
            let mut first = order[..count].to_vec();
            first.sort_unstable();
            let gaps = first.windows(2).map(|pair| pair[1] - pair[0]);
            assert!(gaps.into_iter().all(|gap| gap as usize == 64 / count));
        }
        assert_eq!(order[0], 32);
    }

    #[test]
    fn a_picture_without_pixels_has_no_blocks() {
        assert_eq!(Blocks::new([0, 0], [1, 1]).count(), 0);
    }
}
