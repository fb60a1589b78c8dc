//! A set of voxels of a grid, one bit a voxel: those that are full.

/// Some of the voxels of a grid, which are called full. Which they are says a predicate: such as that a transfer function
/// gives their value an extinction.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct VoxelSet {
    dims: [u32; 3],
    /// Voxel n, x fastest, is bit n % 64 of word n / 64.
    words: Vec<u64>,
}

impl VoxelSet {
    /// The voxels of a grid of `dims` voxels for which `is_full` is true. It is asked once a voxel, x fastest, then y,
    /// then z.
    pub fn by(dims: [u32; 3], mut is_full: impl FnMut([u32; 3]) -> bool) -> Self {
        let mut made = Self::empty(dims);
        let mut n = 0;
        for z in 0..dims[2] {
            for y in 0..dims[1] {
                for x in 0..dims[0] {
                    made.words[n / 64] |= u64::from(is_full([x, y, z])) << (n % 64);
                    n += 1;
                }
            }
        }
        made
    }

    /// No voxel of the grid.
    pub fn empty(dims: [u32; 3]) -> Self {
        let count = dims.iter().map(|&n| n as usize).product::<usize>();
        Self {
            dims,
            words: vec![0; count.div_ceil(64)],
        }
    }

    /// Voxels along x, y, z.
    pub fn dims(&self) -> [u32; 3] {
        self.dims
    }

    /// Whether `voxel` is full; voxels outside of the grid are not.
    pub fn contains(&self, voxel: [u32; 3]) -> bool {
        let is_inside = (0..3).all(|k| voxel[k] < self.dims[k]);
        is_inside && {
            let n = self.number(voxel);
            self.words[n / 64] >> (n % 64) & 1 == 1
        }
    }

    /// Makes `voxel` full.
    ///
    /// # Panics
    /// Where it lies outside of the grid.
    pub fn insert(&mut self, voxel: [u32; 3]) {
        let is_inside = (0..3).all(|k| voxel[k] < self.dims[k]);
        assert!(is_inside, "{voxel:?} is no voxel of {:?}", self.dims);
        let n = self.number(voxel);
        self.words[n / 64] |= 1 << (n % 64);
    }

    /// How many voxels are full.
    pub fn full_count(&self) -> u64 {
        self.words
            .iter()
            .map(|word| u64::from(word.count_ones()))
            .sum()
    }

    /// How many voxels the grid has.
    pub fn voxel_count(&self) -> u64 {
        self.dims.iter().map(|&n| u64::from(n)).product()
    }

    fn number(&self, [x, y, z]: [u32; 3]) -> usize {
        let [nx, ny, _] = self.dims.map(|n| n as usize);
        (z as usize * ny + y as usize) * nx + x as usize
    }
}
