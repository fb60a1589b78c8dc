//! The voxels that matter, on the device: as an octree or as runs, which rays go by in place of macro cells.
//!
//! ```text
//! both      voxels along x, y, z, a word each
//! octree    how often the root is halved; what it holds: 0 nothing, 1 full voxels alone, 2 both; mixed nodes, two words each
//! runs      of each 32 voxels of a row along x a mask, and how many full ones come before
//! ```

use crate::gpu::{Buffer, Error, Gpu, Memory};
use crate::volume::{Address, NodeState, Octree, Runs, VoxelSet};
use ash::vk;
use std::sync::Arc;

/// A structure of voxels as `shaders/lib/full_voxels.wgsl` reads it, complete at once.
#[derive(Debug)]
pub struct FullVoxels(Buffer);

impl FullVoxels {
    /// The octree of a set.
    ///
    /// # Errors
    /// Where the device gives no memory, or has no buffers of that size.
    pub fn octree(gpu: &Arc<Gpu>, set: &VoxelSet) -> Result<Self, Error> {
        let octree = Octree::new(set);
        let root = match octree.at(&Address::default()) {
            Some(NodeState::Full) => 1,
            Some(NodeState::Mixed) => 2,
            Some(NodeState::Empty) | None => 0,
        };
        let head = [octree.side().trailing_zeros(), root];
        Self::of_words(gpu, set, &head, bytemuck::cast_slice(octree.nodes()))
    }

    /// The runs of a set along x.
    ///
    /// # Errors
    /// As [`FullVoxels::octree`].
    pub fn runs(gpu: &Arc<Gpu>, set: &VoxelSet) -> Result<Self, Error> {
        let bits = Runs::new(set, 0).bits();
        Self::of_words(gpu, set, &[], bytemuck::cast_slice(bits.words()))
    }

    fn of_words(gpu: &Arc<Gpu>, set: &VoxelSet, head: &[u32], rest: &[u32]) -> Result<Self, Error> {
        let [nx, ny, nz] = set.dims();
        let words = [&[nx, ny, nz], head, rest].concat();
        let usage = vk::BufferUsageFlags::STORAGE_BUFFER;
        let bytes: &[u8] = bytemuck::cast_slice(&words);
        let buffer = Buffer::new(
            gpu,
            bytes.len() as u64,
            usage,
            Memory::Upload,
            "full voxels",
        )?;
        buffer.write(0, bytes)?;
        Ok(Self(buffer))
    }

    pub(super) fn buffer(&self) -> &Buffer {
        &self.0
    }
}
