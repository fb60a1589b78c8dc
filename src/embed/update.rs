//! New voxels of a box of a volume that is being drawn: the next step of a simulation, a brush, a part of a time series.
//!
//! ```text
//! volume.update_reads(region)              which voxels are looked at: the box, and some around it on some devices
//! volume.stage_update(region, voxels)      a staging buffer that holds what changes
//! volume.record_update(cmd, update)        copies between barriers: frames before see the old voxels, later ones the new
//! ```
//!
//! What is drawn then is to the bit what a new volume of the changed voxels would show.

use super::{Error, Volume};
use crate::gpu::{Buffer, Memory};
use crate::resident::{ChangedCells, ChangedCorners, GpuVolume, Slab};
use crate::volume::{Rescale, VoxelBox, VoxelPart};
use ash::vk;
use std::sync::Arc;
use std::sync::atomic::Ordering;

/// Copies into images begin at multiples of so many bytes.
const ALIGNMENT_BYTES: u64 = 4;

/// New voxels of a box of a volume, staged: [`Volume::record_update`] brings them there.
#[derive(Debug)]
pub struct Update {
    /// Of which volume.
    of: Arc<()>,
    region: VoxelBox,
    staging: Buffer,
    /// For each texture of the volume, in their order: where in the buffer, and where it goes.
    slabs: Vec<Vec<(u64, Slab)>>,
    corners: (u64, ChangedCorners),
    cells: (u64, ChangedCells),
}

impl Update {
    /// The voxels that it changes.
    pub fn region(&self) -> VoxelBox {
        self.region
    }

    /// Whether it was staged for this very volume.
    pub fn is_of(&self, volume: &Volume) -> bool {
        Arc::ptr_eq(volume.token(), &self.of)
    }
}

impl Volume {
    /// The voxels that [`Volume::stage_update`] looks at where those of `region` change: no more than the box itself,
    /// but on drivers that compute on the CPU, where what is known of empty space is found from voxels in memory.
    ///
    /// # Errors
    /// [`Error::Update`] where the box is empty or outside of the volume; [`Error::NotEmbedded`] for filters that read
    /// coefficients, which all voxels have a part in.
    pub fn update_reads(&self, region: VoxelBox) -> Result<VoxelBox, Error> {
        let dims = self.grid().dims;
        let is_inside = (0..3).all(|k| region.min[k] < region.max[k] && region.max[k] <= dims[k]);
        if !is_inside {
            return Err(wrong(
                format!("a box of one voxel or more in {dims:?}"),
                format!("from {:?} to before {:?}", region.min, region.max),
            ));
        }
        if self.textures().any(|texture| texture.spline().is_some()) {
            return Err(Error::NotEmbedded {
                what: "an update of a part of a volume whose filter reads coefficients of a spline",
                hint: "each of them hangs on all voxels: make another volume and `set_volume`",
            });
        }
        let corners = self.copies().iter().filter_map(GpuVolume::corners);
        let reads = corners.fold(region, |all, corners| {
            all.around(&corners.looks_at(region, dims))
        });
        Ok(match self.cells() {
            Some(cells) => reads.around(&cells.looks_at(region)),
            None => reads,
        })
    }

    /// Stages new voxels of `region`: `part` holds them, and what else [`Volume::update_reads`] names; all of the
    /// changed volume does too. Beside the region its voxels are those that are there, and in holes they hold some valid
    /// number.
    ///
    /// # Errors
    /// As [`Volume::update_reads`]; [`Error::Update`] for voxels of another type, of too small a box, with values
    /// outside of [`Volume::value_range`] (which a host that will update makes as large as it needs), and for holes in
    /// a volume that had none; where the device gives no memory.
    pub fn stage_update(&self, region: VoxelBox, part: VoxelPart) -> Result<Update, Error> {
        let reads = self.update_reads(region)?;
        self.check_part(&part, region, reads)?;
        let dims = self.grid().dims;
        let mut bytes = 0;
        let slabs = self.textures().map(|texture| {
            let placed = texture.slabs_in(region).map(|slab| {
                let offset = bytes;
                bytes += texture.staging_bytes(slab.region);
                (offset, slab)
            });
            placed.collect::<Vec<_>>()
        });
        let slabs: Vec<_> = slabs.collect();
        let corners = self.copies().iter().find_map(GpuVolume::corners);
        let corners = corners.map(|corners| corners.changed(&part, region, dims));
        let corners = corners.unwrap_or_default();
        let cells = self.cells().map(|cells| cells.changed(&part, region));
        let cells = cells.unwrap_or_default();
        let corner_bytes: &[u8] = bytemuck::cast_slice(&corners.words);
        let cell_bytes: &[u8] = bytemuck::cast_slice(&cells.ranges);
        let first_corner = bytes.next_multiple_of(ALIGNMENT_BYTES);
        let first_cell = first_corner + corner_bytes.len() as u64;
        let all = first_cell + cell_bytes.len() as u64;
        let gpu = self.copies()[0].gpu();
        let usage = vk::BufferUsageFlags::TRANSFER_SRC;
        let staging = Buffer::new(gpu, all, usage, Memory::Upload, "staging of an update")?;
        for (texture, slabs) in self.textures().zip(&slabs) {
            for (offset, slab) in slabs {
                let bytes = texture.staging_bytes(slab.region);
                staging.write_with(*offset, bytes, |out| {
                    texture.write_part(&part, slab.region, out);
                })?;
            }
        }
        staging.write(first_corner, corner_bytes)?;
        staging.write(first_cell, cell_bytes)?;
        Ok(Update {
            of: Arc::clone(self.token()),
            region,
            staging,
            slabs,
            corners: (first_corner, corners),
            cells: (first_cell, cells),
        })
    }

    /// Records an update: frames that were submitted before it show the voxels before, what is recorded later shows the
    /// new ones, and the next [`record`](super::Renderer::record) of each renderer of the volume finds its empty space
    /// anew. The staging buffer goes when that has run: [`Gpu::announce`](crate::gpu::Gpu::announce) comes before.
    ///
    /// Textures go from `SHADER_READ_ONLY_OPTIMAL`, read by vertex, fragment and compute shaders, to
    /// `TRANSFER_DST_OPTIMAL` and back around the copies; ranges of macro cells are copied to, or computed, between a
    /// barrier after compute shaders that read them and one before; corners are copied to in the same way.
    ///
    /// # Errors
    /// [`Error::NotUploaded`] before the volume was; [`Error::Update`] for an update of another volume.
    ///
    /// # Safety
    /// `cmd` is recording, outside rendering, after [`Gpu::announce`](crate::gpu::Gpu::announce) of its value, and is
    /// submitted to the queue that draws the volume, in the order of recording: after what draws the voxels before,
    /// and before what draws the new ones. What is recorded and never submitted is not there, and nobody notices.
    pub unsafe fn record_update(
        &self,
        cmd: vk::CommandBuffer,
        update: Update,
    ) -> Result<(), Error> {
        let gpu = self.copies()[0].gpu();
        gpu.check_alive("update a volume")?;
        if !update.is_of(self) {
            return Err(wrong("an update of this volume", "one of another"));
        }
        if !self.is_uploaded() {
            return Err(Error::NotUploaded);
        }
        let staging = &update.staging;
        // SAFETY: the caller's promises; barriers stand before and after each copy.
        unsafe {
            for (texture, slabs) in self.textures().zip(&update.slabs) {
                for (offset, slab) in slabs {
                    texture.record_upload(cmd, staging, *offset, slab)?;
                }
            }
            if let Some(corners) = self.copies().iter().find_map(GpuVolume::corners) {
                let (first, changed) = &update.corners;
                corners.record_changed(gpu, cmd, changed, staging, *first)?;
            }
            if let Some(cells) = self.cells() {
                let (first, changed) = &update.cells;
                cells.record_changed(cmd, update.region, changed, staging, *first)?;
            }
        }
        self.updates.fetch_add(1, Ordering::Release);
        Ok(())
    }

    /// How many updates were recorded.
    pub(super) fn updates(&self) -> u64 {
        self.updates.load(Ordering::Acquire)
    }

    fn check_part(&self, part: &VoxelPart, region: VoxelBox, reads: VoxelBox) -> Result<(), Error> {
        let (stored, found) = (self.stored, part.voxels.voxel_type());
        if stored != found {
            return Err(wrong(
                format!("voxels of {}", stored.name()),
                format!("voxels of {}", found.name()),
            ));
        }
        if !reads.is_in(&part.held) {
            return Err(wrong(
                format!(
                    "voxels from {:?} to before {:?}, which the update looks at",
                    reads.min, reads.max
                ),
                format!("from {:?} to before {:?}", part.held.min, part.held.max),
            ));
        }
        let sides = (0..3).map(|k| u64::from(part.held.max[k] - part.held.min[k]));
        let count = sides.fold(1, u64::saturating_mul);
        let masked = part.validity.map_or(count, |mask| mask.len() as u64);
        if part.voxels.len() as u64 != count || masked != count {
            return Err(wrong(
                format!("{count} voxels, and as many bytes of a mask"),
                format!("{} and {masked}", part.voxels.len()),
            ));
        }
        let length = region.dims()[0] as usize;
        let rows = || part.rows(region).map(|first| first..first + length);
        let mask = part.validity.filter(|_| !self.copies()[0].has_holes());
        if mask.is_some_and(|mask| rows().any(|row| mask[row].contains(&0))) {
            return Err(wrong(
                "a volume that was made with holes, or voxels without",
                "holes in a volume without",
            ));
        }
        let [low, high] = self.value_range();
        let Rescale { slope, intercept } = self.rescale;
        let value = |at: usize| f64::from(part.voxels.stored(at)) * slope + intercept;
        let outside = |value: &f64| !(low..=high).contains(value);
        // What stands in a hole is nobody's value.
        let has_value = |at: &usize| part.validity.is_none_or(|mask| mask[*at] != 0);
        let values = rows().flatten().filter(has_value).map(value);
        match values.into_iter().find(outside) {
            None => Ok(()),
            Some(value) => Err(wrong(
                format!("values from {low} to {high}, which the volume was made with"),
                value.to_string(),
            )),
        }
    }
}

fn wrong(wanted: impl Into<String>, found: impl Into<String>) -> Error {
    Error::Update {
        wanted: wanted.into(),
        found: found.into(),
    }
}
