//! Sets of voxels that structures are tried with.

use stratavox::volume::VoxelSet;

/// Numbers from 0 to 1, always the same ones.
pub struct Random(u64);

impl Random {
    /// Of a seed.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// From 0 (included) to 1.
    pub fn unit(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A number below `count`.
    pub fn below(&mut self, count: u32) -> u32 {
        (self.unit() * f64::from(count)) as u32
    }
}

/// Each voxel full with this probability.
pub fn random(dims: [u32; 3], share: f64, seed: u64) -> VoxelSet {
    let mut random = Random::new(seed);
    VoxelSet::by(dims, |_| random.unit() < share)
}

/// All voxels of a grid, x fastest.
pub fn voxels([nx, ny, nz]: [u32; 3]) -> impl Iterator<Item = [u32; 3]> {
    let row = move |y: u32, z: u32| (0..nx).map(move |x| [x, y, z]);
    (0..nz).flat_map(move |z| (0..ny).flat_map(move |y| row(y, z)))
}

/// The sizes around a word and a power of two, along each axis; no voxel, all, and some at random.
pub fn sets() -> Vec<VoxelSet> {
    let mut sets = Vec::new();
    for n in [1, 31, 32, 33, 63, 64, 65] {
        for dims in [[n, 3, 2], [2, n, 3], [3, 2, n]] {
            for (seed, share) in [0.0, 0.1, 0.5, 0.9, 1.0].into_iter().enumerate() {
                sets.push(random(dims, share, seed as u64 + u64::from(n)));
            }
        }
    }
    // Cubes, and boxes in them, which an octree cuts.
    for (dims, min, max) in [
        ([8; 3], [0, 0, 0], [4, 4, 4]),
        ([16; 3], [3, 2, 5], [9, 14, 6]),
        ([7, 6, 5], [1, 0, 2], [7, 6, 5]),
        ([1; 3], [0; 3], [1; 3]),
    ] {
        sets.push(VoxelSet::by(dims, |voxel| {
            (0..3).all(|k| (min[k]..max[k]).contains(&voxel[k]))
        }));
    }
    sets
}
