//! The voxels that matter, on the device: as an octree or as runs, which rays go by in place of macro cells.
//!
//! ```text
//! both      voxels along x, y, z, a word each
//! octree    how often the root is halved; what it holds: 0 nothing, 1 full voxels alone, 2 both; mixed nodes, two words each
//! runs      of each 32 voxels of a row along x a mask, and how many full ones come before
//! ```

use crate::gpu::{Buffer, Error, Headless, Memory, Use, buffer_barrier, buffer_to_buffer};
use crate::volume::{Address, NodeState, Octree, Runs, VoxelSet};
use ash::vk;
use std::sync::Arc;

/// A structure of voxels as `shaders/lib/full_voxels.wgsl` reads it, in the device's own memory: rays look it up at each leap.
#[derive(Debug)]
pub struct FullVoxels(Buffer);

impl FullVoxels {
    /// The octree of a set.
    ///
    /// # Errors
    /// Where the device gives no memory, or has no buffers of that size.
    pub fn octree(device: &mut Headless, set: &VoxelSet) -> Result<Self, Error> {
        let octree = Octree::new(set);
        let root = match octree.at(&Address::default()) {
            Some(NodeState::Full) => 1,
            Some(NodeState::Mixed) => 2,
            Some(NodeState::Empty) | None => 0,
        };
        let head = [octree.side().trailing_zeros(), root];
        Self::of_words(device, set, &head, bytemuck::cast_slice(octree.nodes()))
    }

    /// The runs of a set along x.
    ///
    /// # Errors
    /// As [`FullVoxels::octree`].
    pub fn runs(device: &mut Headless, set: &VoxelSet) -> Result<Self, Error> {
        let bits = Runs::new(set, 0).bits();
        Self::of_words(device, set, &[], bytemuck::cast_slice(bits.words()))
    }

    fn of_words(
        device: &mut Headless,
        set: &VoxelSet,
        head: &[u32],
        rest: &[u32],
    ) -> Result<Self, Error> {
        let [nx, ny, nz] = set.dims();
        let words = [&[nx, ny, nz], head, rest].concat();
        let bytes: &[u8] = bytemuck::cast_slice(&words);
        let size = bytes.len() as u64;
        let gpu = device.gpu();
        let made = |usage, reached_by, name| Buffer::new(gpu, size, usage, reached_by, name);
        let from = vk::BufferUsageFlags::TRANSFER_SRC;
        let to = vk::BufferUsageFlags::STORAGE_BUFFER | vk::BufferUsageFlags::TRANSFER_DST;
        let staging = made(from, Memory::Upload, "staging of full voxels")?;
        let full = made(to, Memory::Device, "full voxels")?;
        staging.write(0, bytes)?;
        let whole = vk::BufferCopy::default().size(size);
        let gpu = Arc::clone(gpu);
        device.run(|cmd| {
            // SAFETY: both live until `run` has waited, and nothing else knows them yet; the host has written before.
            unsafe {
                buffer_to_buffer(&gpu, cmd, &staging, &full, &[whole])?;
                buffer_barrier(&gpu, cmd, &full, Use::TransferWrite, Use::ComputeRead);
            }
            Ok(())
        })?;
        Ok(Self(full))
    }

    pub(super) fn buffer(&self) -> &Buffer {
        &self.0
    }
}
