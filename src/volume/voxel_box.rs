//! Boxes of voxels: `min <= voxel < max` along each axis.

/// Voxels from `min` (included) to `max` (excluded).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "json", derive(serde::Serialize, serde::Deserialize))]
#[allow(missing_docs, reason = "the line above says it")]
pub struct VoxelBox {
    pub min: [u32; 3],
    pub max: [u32; 3],
}

impl VoxelBox {
    /// Whether all of its voxels are in `other` too.
    pub fn is_in(&self, other: &Self) -> bool {
        (0..3).all(|k| self.min[k] >= other.min[k] && self.max[k] <= other.max[k])
    }

    /// What both have; `None` where they have no voxel in common.
    pub fn and(&self, other: &Self) -> Option<Self> {
        let both = Self {
            min: std::array::from_fn(|k| self.min[k].max(other.min[k])),
            max: std::array::from_fn(|k| self.max[k].min(other.max[k])),
        };
        (0..3).all(|k| both.min[k] < both.max[k]).then_some(both)
    }

    /// The smallest box that has the voxels of both.
    pub fn around(&self, other: &Self) -> Self {
        Self {
            min: std::array::from_fn(|k| self.min[k].min(other.min[k])),
            max: std::array::from_fn(|k| self.max[k].max(other.max[k])),
        }
    }

    /// Voxels along x, y, z.
    pub fn dims(&self) -> [u32; 3] {
        std::array::from_fn(|k| self.max[k] - self.min[k])
    }

    /// Boxes of so many slices along z, the last one thinner, that make up this one.
    pub fn slabs(self, slices: u32) -> impl Iterator<Item = Self> {
        let [first, end] = [self.min[2], self.max[2]];
        let slices = slices.max(1);
        (first..end).step_by(slices as usize).map(move |z| {
            let mut slab = self;
            (slab.min[2], slab.max[2]) = (z, z.saturating_add(slices).min(end));
            slab
        })
    }
}
