//! The same set as words that a shader reads: of each 32 voxels of a row a mask, and how many full ones come before.
//!
//! ```text
//! word w = row ceil(n / 32) + i / 32             voxel i is full where bit i % 32 of mask is set
//! rank   = first + popcount(mask & (2^(i % 32) - 1))                where in an array its payload lies
//! ```
//!
//! Two bits a voxel, whatever the set; payloads lie without gaps, in the order of [`Runs::voxels`].

use super::Runs;
use std::ops::Range;

/// Of 32 voxels of a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct RankWord {
    /// Bit b: voxel b of the word is full. Bits behind the end of a row are not set.
    pub mask: u32,
    /// Full voxels in all words before.
    pub first: u32,
}

/// The words of all rows.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RunBits {
    row_length: usize,
    words_per_row: usize,
    words: Vec<RankWord>,
}

/// Voxels of a word.
const VOXELS: u32 = 32;

impl Runs {
    /// The runs as words for a device.
    ///
    /// # Panics
    /// Where 2^32 voxels or more are full: ranks are of 32 bits.
    pub fn bits(&self) -> RunBits {
        let words_per_row = self.dims[self.axis].div_ceil(VOXELS) as usize;
        let mut words = vec![RankWord { mask: 0, first: 0 }; words_per_row * self.row_count()];
        for row in 0..self.row_count() {
            let words = &mut words[row * words_per_row..][..words_per_row];
            for run in self.row(row) {
                mark(words, run.start, run.end());
            }
        }
        let mut first = 0_u32;
        for word in &mut words {
            word.first = first;
            let next = first.checked_add(word.mask.count_ones());
            first = next.expect("less than 2^32 full voxels");
        }
        RunBits {
            row_length: self.dims[self.axis] as usize,
            words_per_row,
            words,
        }
    }
}

/// Sets the bits of voxels `start` to before `end`, word by word.
fn mark(words: &mut [RankWord], start: u32, end: u32) {
    let mut at = start;
    while at < end {
        let word = at / VOXELS;
        let until = end.min((word + 1) * VOXELS);
        let ones = u32::MAX >> (VOXELS - (until - at));
        words[word as usize].mask |= ones << (at % VOXELS);
        at = until;
    }
}

impl RunBits {
    /// Those of rows along x of a grid: `is_full` is asked once a voxel, by its number, x fastest, then y, then z. The same as
    /// [`Runs::bits`] of that set along x, without the runs.
    ///
    /// # Panics
    /// As [`Runs::bits`].
    pub fn of_rows(dims: [u32; 3], mut is_full: impl FnMut(usize) -> bool) -> Self {
        Self::of_masks(dims, |voxels| {
            let bits = (0_u32..).zip(voxels);
            bits.fold(0, |mask, (bit, n)| mask | u32::from(is_full(n)) << bit)
        })
    }

    /// The same by a mask for up to 32 voxels of a row at once: bit b says whether voxel `start + b` of the range is full.
    ///
    /// # Panics
    /// As [`Runs::bits`].
    pub fn of_masks(dims: [u32; 3], mut mask_of: impl FnMut(Range<usize>) -> u32) -> Self {
        let [row_length, ny, nz] = dims.map(|n| n as usize);
        let words_per_row = row_length.div_ceil(VOXELS as usize);
        let mut words = Vec::with_capacity(words_per_row * ny * nz);
        let mut first = 0_u32;
        for row in 0..ny * nz {
            for start in (0..row_length).step_by(VOXELS as usize) {
                let count = (row_length - start).min(VOXELS as usize);
                let at = row * row_length + start;
                let mask = mask_of(at..at + count);
                words.push(RankWord { mask, first });
                let next = first.checked_add(mask.count_ones());
                first = next.expect("less than 2^32 full voxels");
            }
        }
        Self {
            row_length,
            words_per_row,
            words,
        }
    }

    /// How many voxels are full.
    pub fn full_count(&self) -> u64 {
        self.words.last().map_or(0, |word| {
            u64::from(word.first) + u64::from(word.mask.count_ones())
        })
    }

    /// How many runs there are: full voxels with an empty one, or the end of the row, before them.
    pub fn run_count(&self) -> u64 {
        let of_row = |words: &[RankWord]| {
            let before = [0]
                .into_iter()
                .chain(words.iter().map(|word| word.mask >> (VOXELS - 1)));
            let starts = words.iter().zip(before);
            let starts = starts.map(|(word, before)| word.mask & !(word.mask << 1 | before));
            starts
                .map(|starts| u64::from(starts.count_ones()))
                .sum::<u64>()
        };
        self.words
            .chunks(self.words_per_row.max(1))
            .map(of_row)
            .sum()
    }

    /// Numbers of the full voxels in the order of their ranks: voxel `i` of a row is `row` times the length of a row + `i`.
    pub fn voxels(&self) -> impl Iterator<Item = usize> + '_ {
        // The next word, and what is left of the one before, whose first voxel has this number.
        let (mut next, mut rest, mut first) = (0, 0_u32, 0);
        std::iter::from_fn(move || {
            while rest == 0 {
                rest = self.words.get(next)?.mask;
                let (row, in_row) = (next / self.words_per_row, next % self.words_per_row);
                first = row * self.row_length + in_row * VOXELS as usize;
                next += 1;
            }
            let bit = rest.trailing_zeros();
            rest &= rest - 1;
            Some(first + bit as usize)
        })
    }

    /// All words, row by row.
    pub fn words(&self) -> &[RankWord] {
        &self.words
    }

    /// Words of each row.
    pub fn words_per_row(&self) -> usize {
        self.words_per_row
    }

    /// How many full voxels come before voxel `i` of a row; `None` where it is not full.
    ///
    /// # Panics
    /// Where there are no such words.
    pub fn rank(&self, row: usize, i: u32) -> Option<u32> {
        let word = self.words[row * self.words_per_row + (i / VOXELS) as usize];
        let bit = 1 << (i % VOXELS);
        (word.mask & bit != 0).then(|| word.first + (word.mask & (bit - 1)).count_ones())
    }

    /// Size of the words in memory.
    pub fn bytes(&self) -> u64 {
        size_of_val(self.words.as_slice()) as u64
    }
}
