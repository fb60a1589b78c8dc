//! The voxels of a new volume on their way there, all at once or in pieces.

use super::pieces::{PIECE_BYTES, PIECE_CELLS, Placed, placed, run_of, within};
use super::{Error, Volume};
use crate::gpu::{Buffer, Gpu, Memory};
use crate::resident::GpuVolume;
use crate::volume;
use ash::vk;
use std::ops::Range;

/// What a volume is filled with, and how much of that is recorded. FootprintTexels and cells may have come with the voxels.
#[derive(Debug, Default)]
pub(super) struct Upload {
    /// A buffer for each texture, until all of it is recorded.
    staging: Vec<Buffer>,
    slabs: Vec<Placed>,
    /// Pieces: slabs, and then cells.
    recorded: u64,
    is_done: bool,
}

impl Upload {
    /// Stages the next texture.
    pub fn stage(&mut self, into: &GpuVolume, voxels: &volume::Volume) -> Result<(), Error> {
        let mut bytes = 0;
        let texture = self.staging.len();
        let slabs = into.slabs(PIECE_BYTES);
        let slabs: Vec<_> = placed((texture, into), slabs, &mut bytes).collect();
        let usage = vk::BufferUsageFlags::TRANSFER_SRC;
        let staging = Buffer::new(into.gpu(), bytes, usage, Memory::Upload, "staging")?;
        for Placed { from, slab, .. } in &slabs {
            staging.write_with(*from, into.staging_bytes(slab.region), |out| {
                into.write_staged(voxels, slab.region, out);
            })?;
        }
        self.staging.push(staging);
        self.slabs.extend(slabs);
        Ok(())
    }
}

impl Volume {
    /// Pieces that are left of the upload, none of them long: [`Volume::record_upload_part`] records some.
    ///
    /// # Errors
    /// Where the device cannot dispatch so many cells.
    pub fn upload_parts(&self) -> Result<u64, Error> {
        Ok(match self.upload.is_done {
            true => 0,
            false => self.pieces()?.end - self.upload.recorded,
        })
    }

    /// Records the upload, once. What it was staged in goes when that has run: [`Gpu::announce`] comes before.
    ///
    /// # Errors
    /// [`Error::Uploaded`] the second time, and where the device cannot dispatch so many cells.
    ///
    /// # Safety
    /// `cmd` is recording, outside rendering, after [`Gpu::announce`] of its value, and is submitted before anything
    /// that draws the volume: what is recorded and never submitted is not there, and nobody notices.
    pub unsafe fn record_upload(&mut self, gpu: &Gpu, cmd: vk::CommandBuffer) -> Result<(), Error> {
        // SAFETY: the caller's promises.
        unsafe { self.record_upload_part(gpu, cmd, u64::MAX).map(drop) }
    }

    /// Records the next `count` pieces of the upload, one at least, and says how many are left. The volume is there,
    /// and may be drawn, after the last one.
    ///
    /// # Errors
    /// As [`Volume::record_upload`].
    ///
    /// # Safety
    /// As [`Volume::record_upload`], of all parts, which are submitted in their order.
    pub unsafe fn record_upload_part(
        &mut self,
        gpu: &Gpu,
        cmd: vk::CommandBuffer,
        count: u64,
    ) -> Result<u64, Error> {
        // SAFETY: the caller's promises.
        let left = unsafe { self.record_pieces(gpu, cmd, count)? };
        if left == 0 {
            self.end_upload();
        }
        Ok(left)
    }

    /// The same, with all of the staging kept: [`Volume::end_upload`] comes after the last part.
    ///
    /// # Safety
    /// As [`Volume::record_upload_part`].
    pub(super) unsafe fn record_pieces(
        &mut self,
        gpu: &Gpu,
        cmd: vk::CommandBuffer,
        count: u64,
    ) -> Result<u64, Error> {
        gpu.check_alive("upload a volume")?;
        if self.upload.is_done {
            return Err(Error::Uploaded);
        }
        let Range { start: slabs, end } = self.pieces()?;
        let first = self.upload.recorded;
        let part = first..first.saturating_add(count.max(1)).min(end);
        // SAFETY: the caller's promises; cells come after all slabs, whose barriers make them readable.
        unsafe {
            let run = within(&part, 0..slabs);
            for placed in &self.upload.slabs[run.start as usize..run.end as usize] {
                let texture = self.textures().nth(placed.texture);
                let texture = texture.expect("staged for this one");
                let staging = &self.upload.staging[placed.texture];
                texture.record_upload(cmd, staging, placed.from, &placed.slab)?;
            }
            if part.start == 0 {
                for corners in self.copies().iter().filter_map(GpuVolume::corners) {
                    corners.record_upload(gpu, cmd);
                }
            }
            let run = within(&part, slabs..end);
            if let (Some(cells), false) = (self.cells(), run.is_empty()) {
                cells.record_part(cmd, run_of(cells.group_count()?, &run, end - slabs))?;
            }
        }
        self.upload.recorded = part.end;
        Ok(end - part.end)
    }

    /// All is recorded: what it was staged in waits for the device alone.
    pub(super) fn end_upload(&mut self) {
        self.upload = Upload {
            is_done: true,
            ..Upload::default()
        };
    }

    /// What is recorded, for [`Volume::forget_pieces`].
    pub(super) fn recorded_pieces(&self) -> u64 {
        self.upload.recorded
    }

    /// What was recorded since then was not submitted: it is recorded again.
    pub(super) fn forget_pieces(&mut self, then: u64) {
        self.upload.recorded = then;
    }

    pub(super) fn is_uploaded(&self) -> bool {
        self.upload.is_done
    }

    /// From the end of the slabs to the end of the cells: where none are to be found, both are one.
    fn pieces(&self) -> Result<Range<u64>, Error> {
        let slabs = self.upload.slabs.len() as u64;
        let cells = match self.cells() {
            Some(cells) if cells.group_count()? > 0 => cells.cell_count().div_ceil(PIECE_CELLS),
            _ => 0,
        };
        Ok(slabs..slabs + cells)
    }
}
