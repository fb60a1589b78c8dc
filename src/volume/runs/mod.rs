//! Run-length encoded slices: of each row of voxels the longest runs of full ones.
//!
//! ```text
//! axis a, others j = a + 1, k = a + 2 (mod 3)        row = j + n_j k
//! runs of a row     runs[row_first[row] .. row_first[row + 1]], ascending by start
//! ```
//!
//! So rows of one slice of axis k stand together. A run is not empty, ends with its row, and has an empty voxel or the
//! end of the row on each side: of a set there is one encoding.

mod along;
mod bits;

pub use bits::{RankWord, RunBits};

use super::VoxelSet;

/// Full voxels beside each other in a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Run {
    /// Number of the first one along the axis.
    pub start: u32,
    /// How many there are, at least one.
    pub length: u32,
}

impl Run {
    /// Number of the voxel behind the last one.
    pub fn end(self) -> u32 {
        self.start + self.length
    }
}

/// The runs of a set of voxels along one axis.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Runs {
    axis: usize,
    dims: [u32; 3],
    row_first: Vec<u32>,
    runs: Vec<Run>,
}

impl Runs {
    /// The runs of `set` along `axis`: 0, 1, 2 for x, y, z.
    ///
    /// # Panics
    /// For another axis, and where there are more than 2^32 - 1 runs.
    pub fn new(set: &VoxelSet, axis: usize) -> Self {
        assert!(axis < 3, "axis {axis} of 0, 1, 2");
        let dims = set.dims();
        let mut made = Self {
            axis,
            dims,
            row_first: vec![0],
            runs: Vec::new(),
        };
        for row in 0..made.row_count() {
            made.add_row(|i| set.contains(made_voxel(axis, dims, row, i)));
        }
        made
    }

    fn add_row(&mut self, is_full: impl Fn(u32) -> bool) {
        let count = self.dims[self.axis];
        let mut start = None;
        for i in 0..=count {
            // Behind the end of a row nothing is full.
            match (start, i < count && is_full(i)) {
                (None, true) => start = Some(i),
                (Some(first), false) => {
                    self.runs.push(Run {
                        start: first,
                        length: i - first,
                    });
                    start = None;
                }
                _ => {}
            }
        }
        let count = u32::try_from(self.runs.len()).expect("less than 2^32 runs");
        self.row_first.push(count);
    }

    /// Along which axis the runs lie.
    pub fn axis(&self) -> usize {
        self.axis
    }

    /// Voxels along x, y, z.
    pub fn dims(&self) -> [u32; 3] {
        self.dims
    }

    /// How many rows there are.
    pub fn row_count(&self) -> usize {
        let [j, k] = others(self.axis).map(|axis| self.dims[axis] as usize);
        j * k
    }

    /// How many runs there are.
    pub fn run_count(&self) -> usize {
        self.runs.len()
    }

    /// How many voxels are full.
    pub fn full_count(&self) -> u64 {
        self.runs.iter().map(|run| u64::from(run.length)).sum()
    }

    /// Number of the first run of each row, and of all runs.
    pub fn row_first(&self) -> &[u32] {
        &self.row_first
    }

    /// All runs, row by row.
    pub fn runs(&self) -> &[Run] {
        &self.runs
    }

    /// The runs of a row.
    ///
    /// # Panics
    /// Where there is no such row.
    pub fn row(&self, row: usize) -> &[Run] {
        &self.runs[self.row_first[row] as usize..self.row_first[row + 1] as usize]
    }

    /// The row of a voxel, and its number along it.
    pub fn place(&self, voxel: [u32; 3]) -> (usize, u32) {
        let [j, k] = others(self.axis);
        let row = voxel[j] as usize + self.dims[j] as usize * voxel[k] as usize;
        (row, voxel[self.axis])
    }

    /// The voxel number `i` along a row.
    pub fn voxel(&self, row: usize, i: u32) -> [u32; 3] {
        made_voxel(self.axis, self.dims, row, i)
    }

    /// Whether `voxel` is full; voxels outside of the grid are not.
    pub fn contains(&self, voxel: [u32; 3]) -> bool {
        let is_inside = (0..3).all(|k| voxel[k] < self.dims[k]);
        let (row, i) = self.place(voxel);
        is_inside && self.next_full(row, i) == Some(i)
    }

    /// The first full voxel of a row that is number `i` or behind it.
    ///
    /// # Panics
    /// Where there is no such row.
    pub fn next_full(&self, row: usize, i: u32) -> Option<u32> {
        let runs = self.row(row);
        let next = runs.partition_point(|run| run.end() <= i);
        runs.get(next).map(|run| run.start.max(i))
    }

    /// The full voxels row by row: the order of [`RunBits::rank`].
    pub fn voxels(&self) -> impl Iterator<Item = [u32; 3]> + '_ {
        let of_row = move |row: usize| {
            let numbers = self.row(row).iter().flat_map(|run| run.start..run.end());
            numbers.map(move |i| self.voxel(row, i))
        };
        (0..self.row_count()).flat_map(of_row)
    }

    /// The set that was encoded.
    pub fn decode(&self) -> VoxelSet {
        let mut set = VoxelSet::empty(self.dims);
        for voxel in self.voxels() {
            set.insert(voxel);
        }
        set
    }

    /// Size of the rows and runs in memory.
    pub fn bytes(&self) -> u64 {
        (size_of_val(self.row_first.as_slice()) + size_of_val(self.runs.as_slice())) as u64
    }
}

/// The two other axes, in the order that numbers rows.
fn others(axis: usize) -> [usize; 2] {
    [(axis + 1) % 3, (axis + 2) % 3]
}

fn made_voxel(axis: usize, dims: [u32; 3], row: usize, i: u32) -> [u32; 3] {
    let [j, k] = others(axis);
    let mut voxel = [i; 3];
    voxel[j] = (row % dims[j] as usize) as u32;
    voxel[k] = (row / dims[j] as usize) as u32;
    voxel
}
