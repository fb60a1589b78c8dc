//! Which parts of a slicer's slices are drawn: patches, squares of the picture on a few slices that follow each other.
//!
//! ```text
//! list(patch) = there is a macro cell with matter in the box around all samples of the patch
//! ```
//!
//! The list is made on the device (`shaders/slice_patches.wgsl`) and drawn by [`super::PatchSlicer`]. Squares are of
//! whole pixels, so each fragment belongs to one, and the picture is the same to the bit.

use super::View;
use crate::gpu::{Buffer, Error, Gpu, Memory, Use, barriers, buffer_barrier};
use crate::resident::Halo;
use crate::shaders::{BATCH_LAYERS, BLOCK_SIDE, LARGEST_BLOCK, LAYER_SLICES, MOST_POINT_PIXELS};
use ash::vk;
use glam::DVec3;
use std::sync::Arc;

/// Slices whose patches share a list.
pub const BATCH_SLICES: u32 = BATCH_LAYERS * LAYER_SLICES;

const _: () = assert!(LARGEST_BLOCK == BLOCK_SIDE * MOST_POINT_PIXELS);

/// Voxels along the side of a square, about: as macro cells, where the volume fills the picture.
const SQUARE_VOXELS: u32 = 8;
const LEAST_PIXELS: u32 = 8;
/// More squares cost more than they spare.
const MAX_SQUARES: u32 = 1 << 14;
/// Entries of lists, of which a device should have room for: 64 MiB.
const MAX_ENTRIES: u64 = 1 << 24;
/// Slabs that reach farther than so many voxels meet matter nearly everywhere.
const LONGEST_SLAB_REACH: f64 = 4.0;

/// How large the lists of a picture get at most.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PatchRoom {
    /// Squares across and down.
    pub squares: [u32; 2],
    /// Batches of slices of one recording.
    pub batches: u32,
}

impl PatchRoom {
    fn square_count(self) -> u64 {
        u64::from(self.squares[0]) * u64::from(self.squares[1])
    }

    fn entries(self) -> u64 {
        self.square_count() * u64::from(self.batches) * u64::from(BATCH_LAYERS)
    }
}

impl View<'_> {
    /// What lists of this picture need; `None` where they would be too long, or the picture has no slices.
    pub fn patch_room(&self) -> Option<PatchRoom> {
        let desc = self.settings.technique.desc();
        if desc.casts_rays {
            return None;
        }
        let slices = (desc.longest_sample_count)(self);
        // One more at each end.
        let batches = (slices + 2.0) / f64::from(BATCH_SLICES);
        let room = PatchRoom {
            squares: self.extent_pixels.map(|n| n.div_ceil(self.patch_pixels())),
            batches: batches.ceil() as u32,
        };
        (room.entries() <= MAX_ENTRIES).then_some(room)
    }

    /// The side of a square in pixels: the same for all cameras.
    pub(super) fn patch_pixels(&self) -> u32 {
        let longest = |sides: &[u32]| sides.iter().copied().max().unwrap_or(1).max(1);
        let (pixels, voxels) = (longest(&self.extent_pixels), longest(&self.grid.dims));
        let wanted = u64::from(SQUARE_VOXELS) * u64::from(pixels) / u64::from(voxels);
        let wanted = wanted.min(MOST_POINT_PIXELS.into());
        let mut side = LEAST_PIXELS;
        while u64::from(2 * side) <= wanted
            || self
                .extent_pixels
                .map(|n| u64::from(n.div_ceil(side)))
                .iter()
                .product::<u64>()
                > MAX_SQUARES.into()
        {
            side *= 2;
        }
        side
    }

    /// How far, in voxels, a sample may lie from where f32 says: a part of how far the ray has come, and half a voxel.
    /// Rays along the slices, which divide by a hundredth, are drawn anyway.
    pub(super) fn patch_reach_voxels(&self) -> f64 {
        let rays = self.rays();
        let world_from_voxel = self.world_from_voxel();
        let far = self.grid.far_corner();
        let corner =
            |i: u32| far * glam::dvec3((i & 1).into(), (i >> 1 & 1).into(), (i >> 2).into());
        let distance =
            |i: u32| (world_from_voxel.transform_point3(corner(i)) - rays.origin).length();
        let farthest = (0..8).map(distance).fold(0.0, f64::max);
        let rows = DVec3::from_array(self.grid.voxel_rows().map(|row| row.length()));
        0.5 + 2f64.powi(-16) * farthest * rows.max_element()
    }

    /// How far around a macro cell the voxels lie that samples touch which begin in it; `None` where that is too far to
    /// be worth knowing.
    pub fn halo(&self) -> Option<Halo> {
        let mut halo = self.settings.halo();
        if self.settings.preintegrated {
            // Both ends of a slab, from its middle.
            let reach = self.slab_reach().max_element();
            if reach.is_nan() || reach > LONGEST_SLAB_REACH {
                return None;
            }
            halo.voxels += reach.ceil() as u32;
        }
        Some(halo)
    }
}

/// The lists of one picture at a time: a host that has several in flight has one for each.
#[derive(Debug)]
pub struct Patches {
    gpu: Arc<Gpu>,
    room: PatchRoom,
    /// Draws of nothing, one a batch.
    at_rest: Buffer,
    pub(super) draws: Buffer,
    pub(super) listed: Buffer,
    pub(super) opaque_since: Buffer,
}

impl Patches {
    /// Buffers for lists of that size.
    ///
    /// # Errors
    /// Where the device gives no memory, or has no buffers of that size.
    pub fn new(gpu: &Arc<Gpu>, room: PatchRoom) -> Result<Self, Error> {
        use vk::BufferUsageFlags as Usage;
        // Of no vertices, one instance; the list says which one is the first.
        let draws = [0, 1, 0, 0u32].repeat(room.batches as usize);
        let bytes = 4 * draws.len() as u64;
        let at_rest = Buffer::new(
            gpu,
            bytes,
            Usage::TRANSFER_SRC,
            Memory::Upload,
            "draws at rest",
        )?;
        at_rest.write(0, bytemuck::cast_slice(&draws))?;
        let on_device = |bytes, usage, name| {
            let usage = usage | Usage::STORAGE_BUFFER | Usage::TRANSFER_DST;
            Buffer::new(gpu, bytes, usage, Memory::Device, name)
        };
        Ok(Self {
            gpu: Arc::clone(gpu),
            room,
            at_rest,
            draws: on_device(bytes, Usage::INDIRECT_BUFFER, "draws of patches")?,
            listed: on_device(4 * room.entries(), Usage::empty(), "patches")?,
            opaque_since: on_device(
                4 + 4 * room.square_count(),
                Usage::empty(),
                "opaque patches",
            )?,
        })
    }

    /// Whether lists of that size fit.
    pub fn holds(&self, room: PatchRoom) -> bool {
        let Self { room: own, .. } = self;
        own.batches >= room.batches
            && own.square_count() >= room.square_count()
            && own.entries() >= room.entries()
    }

    /// Forgets which squares are opaque: before a picture.
    ///
    /// # Safety
    /// `cmd` is recording, outside rendering; `self` lives until it has run.
    pub unsafe fn record_start(&self, cmd: vk::CommandBuffer) {
        let since = &self.opaque_since;
        // SAFETY: the caller's promises.
        unsafe {
            buffer_barrier(&self.gpu, cmd, since, Use::DrawRead, Use::TransferWrite);
            self.gpu.record(|device| {
                device.cmd_fill_buffer(cmd, since.raw(), 0, vk::WHOLE_SIZE, u32::MAX)
            });
            buffer_barrier(&self.gpu, cmd, since, Use::TransferWrite, Use::DrawRead);
        }
    }

    /// Empties the lists.
    ///
    /// # Safety
    /// As [`Self::record_start`]; the lists must be made after it.
    pub(super) unsafe fn record_empty(&self, cmd: vk::CommandBuffer) {
        let (gpu, draws, listed) = (&self.gpu, &self.draws, &self.listed);
        let regions = [vk::BufferCopy::default().size(draws.bytes())];
        // SAFETY: the caller's promises; both buffers are of one size.
        unsafe {
            buffer_barrier(gpu, cmd, draws, Use::DrawIndirect, Use::TransferWrite);
            gpu.record(|device| {
                device.cmd_copy_buffer(cmd, self.at_rest.raw(), draws.raw(), &regions)
            });
            let emptied = (draws, Use::TransferWrite, Use::ComputeWrite);
            let drawn = (listed, Use::DrawRead, Use::ComputeWrite);
            barriers(gpu, cmd, [], [emptied, drawn], []);
        }
    }

    /// The lists are there.
    ///
    /// # Safety
    /// As [`Self::record_start`].
    pub(super) unsafe fn record_listed(&self, cmd: vk::CommandBuffer) {
        let draws = (&self.draws, Use::ComputeWrite, Use::DrawIndirect);
        let listed = (&self.listed, Use::ComputeWrite, Use::DrawRead);
        // SAFETY: the caller's promises.
        unsafe { barriers(&self.gpu, cmd, [], [draws, listed], []) };
    }

    /// Tells which batch of slices of the picture, counted from 1 over all its bricks, is drawn next: squares that were
    /// opaque before it are left out.
    ///
    /// # Safety
    /// As [`Self::record_start`].
    pub unsafe fn record_batch(&self, cmd: vk::CommandBuffer, batch: u32) {
        // SAFETY: the caller's promises.
        unsafe { self.record_batch_for(cmd, batch, Use::DrawRead) };
    }

    /// The same for another use that is next.
    ///
    /// # Safety
    /// As [`Self::record_start`].
    pub(super) unsafe fn record_batch_for(&self, cmd: vk::CommandBuffer, batch: u32, next: Use) {
        let since = &self.opaque_since;
        // SAFETY: the caller's promises.
        unsafe {
            buffer_barrier(&self.gpu, cmd, since, Use::DrawRead, Use::TransferWrite);
            self.gpu
                .record(|device| device.cmd_fill_buffer(cmd, since.raw(), 0, 4, batch));
            buffer_barrier(&self.gpu, cmd, since, Use::TransferWrite, next);
        }
    }
}
