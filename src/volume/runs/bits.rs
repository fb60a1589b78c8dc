//! The same set as words that a shader reads: of each 32 voxels of a row a mask, and how many full ones come before.
//!
//! ```text
//! word w = row ceil(n / 32) + i / 32             voxel i is full where bit i % 32 of mask is set
//! rank   = first + popcount(mask & (2^(i % 32) - 1))                where in an array its payload lies
//! ```
//!
//! Two bits a voxel, whatever the set; payloads lie without gaps, in the order of [`Runs::voxels`].

use super::Runs;

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
