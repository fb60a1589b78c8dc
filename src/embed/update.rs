//! New voxels of a box of a volume that is being drawn: the next step of a simulation, a brush, a part of a time
//! series.
//!
//! ```text
//! volume.update_reads(region)              which voxels are looked at: the box, and some around it on some devices
//! volume.stage_update(region, voxels)      a staging buffer that holds what changes
//! volume.record_update(cmd, update)        copies between barriers: frames before see the old voxels, later ones the new
//! ```
//!
//! Updates are recorded in the order in which they were staged (`updates.rs`), each all at once or in pieces.
//!
//! What is drawn then is to the bit what a new volume of the changed voxels would show.

use super::pieces::{PIECE_BYTES, PIECE_CELLS, Placed, placed, within};
use super::updates::Turn;
use super::{Error, Volume};
use crate::gpu::{Buffer, Memory, Region};
use crate::resident::{ChangedCells, GpuVolume};
use crate::shaders::CELL_VOXELS;
use crate::volume::{Rescale, VoxelBox, VoxelPart};
use ash::vk;

/// Copies into images begin at multiples of so many bytes.
const ALIGNMENT_BYTES: u64 = 16;

/// New voxels of a box of a volume, staged: [`Volume::record_update`] brings them there. Dropped before it is recorded,
/// it takes with it all that were staged after it: they were staged from voxels that hold these.
#[derive(Debug)]
pub struct Update {
    turn: Turn,
    region: VoxelBox,
    staging: Buffer,
    slabs: Vec<Placed>,
    /// Where the words of each run of copies begin in the buffer.
    corners: Vec<(u64, Vec<Region>)>,
    /// Where ranges begin in the buffer, and the boxes around which they are found.
    cells: (u64, ChangedCells),
    boxes: Vec<VoxelBox>,
    /// Pieces: slabs, corners, boxes of cells.
    recorded: u64,
}

impl Update {
    /// The voxels that it changes.
    pub fn region(&self) -> VoxelBox {
        self.region
    }

    /// Whether it was staged for this very volume.
    pub fn is_of(&self, volume: &Volume) -> bool {
        self.turn.is_of(&volume.updates)
    }

    /// Pieces that are left of it, none of them long: [`Volume::record_update_part`] records some.
    pub fn parts(&self) -> u64 {
        self.count() - self.recorded
    }

    fn count(&self) -> u64 {
        (self.slabs.len() + self.corners.len() + self.boxes.len()) as u64
    }

    /// What is recorded, for [`Update::forget_pieces`].
    pub(super) fn recorded_pieces(&self) -> u64 {
        self.recorded
    }

    /// What was recorded since then was not submitted: it is recorded again.
    pub(super) fn forget_pieces(&mut self, then: u64) {
        self.recorded = then;
    }

    /// Tells all who draw the volume how much of it is submitted.
    pub(super) fn settle(&self) {
        match self.parts() {
            0 => self.turn.end(),
            _ => self.turn.begin(),
        }
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
                hint: "each of them depends on all voxels: make another volume and `set_volume`",
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
    /// changed volume does too. Beside the region its voxels are those that are there, and in holes they hold some
    /// valid number.
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
        let mut slabs = Vec::new();
        for texture in self.textures().enumerate() {
            let changed = texture.1.slabs_in(region, PIECE_BYTES);
            slabs.extend(placed(texture, changed, &mut bytes));
        }
        let corners = self.copies().iter().find_map(GpuVolume::corners);
        let corners = corners.map(|corners| corners.changed(&part, region, dims));
        let corners = corners.unwrap_or_default();
        let cells = self.cells().map(|cells| cells.changed(&part, region));
        let boxes = match &cells {
            None => Vec::new(),
            // What is there already is copied at once: 8 bytes of 8^3 voxels.
            Some(cells) if !cells.ranges.is_empty() => vec![region],
            Some(_) => region.slabs(slices_of_cells(region)).collect(),
        };
        let cells = cells.unwrap_or_default();
        let corner_bytes: &[u8] = bytemuck::cast_slice(&corners.words);
        let cell_bytes: &[u8] = bytemuck::cast_slice(&cells.ranges);
        let first_corner = bytes.next_multiple_of(ALIGNMENT_BYTES);
        let first_cell = first_corner + corner_bytes.len() as u64;
        let all = first_cell + cell_bytes.len() as u64;
        let gpu = self.copies()[0].gpu();
        let usage = vk::BufferUsageFlags::TRANSFER_SRC;
        let staging = Buffer::new(gpu, all, usage, Memory::Upload, "staging of an update")?;
        for (number, texture) in self.textures().enumerate() {
            for placed in slabs.iter().filter(|placed| placed.texture == number) {
                let region = placed.slab.region;
                staging.write_with(placed.from, texture.staging_bytes(region), |out| {
                    texture.write_part(&part, region, out);
                })?;
            }
        }
        staging.write(first_corner, corner_bytes)?;
        staging.write(first_cell, cell_bytes)?;
        let runs = corners.runs(PIECE_BYTES).into_iter();
        Ok(Update {
            turn: self.updates.turn(region),
            region,
            staging,
            slabs,
            corners: runs.map(|(at, run)| (first_corner + at, run)).collect(),
            cells: (first_cell, cells),
            boxes,
            recorded: 0,
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
    /// [`Error::NotUploaded`] before the volume was; [`Error::Update`] for an update of another volume;
    /// [`Error::UpdateOrder`] where another comes first, or was given up; [`Error::HalfUpdated`] where one was given up
    /// of which a part is there, and this one does not change all of its voxels. What is refused is dropped.
    ///
    /// # Safety
    /// `cmd` is recording, outside rendering, after [`Gpu::announce`](crate::gpu::Gpu::announce) of its value, and is
    /// submitted to the queue that draws the volume, in the order of recording: after what draws the voxels before,
    /// and before what draws the new ones. What is recorded and never submitted is not there, and nobody notices.
    pub unsafe fn record_update(
        &self,
        cmd: vk::CommandBuffer,
        mut update: Update,
    ) -> Result<(), Error> {
        // SAFETY: the caller's promises.
        unsafe { self.record_update_part(cmd, &mut update, u64::MAX)? };
        Ok(())
    }

    /// Records the next `count` pieces of an update, one at least, and says how many are left. Until there are none,
    /// the volume is not drawn ([`Error::HalfUpdated`]); where the update is given up before, that lasts until another
    /// one is recorded that changes all of its voxels.
    ///
    /// # Errors
    /// As [`Volume::record_update`]; the update is what it was then.
    ///
    /// # Safety
    /// As [`Volume::record_update`], of all parts, which are submitted in their order. The update lives until they are
    /// recorded.
    pub unsafe fn record_update_part(
        &self,
        cmd: vk::CommandBuffer,
        update: &mut Update,
        count: u64,
    ) -> Result<u64, Error> {
        // SAFETY: the caller's promises.
        unsafe { self.record_update_pieces(cmd, update, count)? };
        update.settle();
        Ok(update.parts())
    }

    /// The same where nobody is told before it is submitted: [`Update::settle`] comes then.
    ///
    /// # Safety
    /// As [`Volume::record_update_part`].
    pub(super) unsafe fn record_update_pieces(
        &self,
        cmd: vk::CommandBuffer,
        update: &mut Update,
        count: u64,
    ) -> Result<(), Error> {
        let gpu = self.copies()[0].gpu();
        gpu.check_alive("update a volume")?;
        self.check_update(update)?;
        let [slabs, corners] = [update.slabs.len(), update.corners.len()].map(|n| n as u64);
        let (first, end) = (update.recorded, update.count());
        let part = first..first.saturating_add(count.max(1)).min(end);
        let run_in = |of| {
            let run = within(&part, of);
            run.start as usize..run.end as usize
        };
        let staging = &update.staging;
        // SAFETY: the caller's promises; barriers stand before and after each copy.
        unsafe {
            for placed in &update.slabs[run_in(0..slabs)] {
                let texture = self.textures().nth(placed.texture);
                let texture = texture.expect("staged for this one");
                texture.record_upload(cmd, staging, placed.from, &placed.slab)?;
            }
            if let Some(corners_there) = self.copies().iter().find_map(GpuVolume::corners) {
                for (at, run) in &update.corners[run_in(slabs..slabs + corners)] {
                    corners_there.record_changed(gpu, cmd, run, staging, *at)?;
                }
            }
            if let Some(cells) = self.cells() {
                let (first, changed) = &update.cells;
                for &region in &update.boxes[run_in(slabs + corners..end)] {
                    cells.record_changed(cmd, region, changed, staging, *first)?;
                }
            }
        }
        update.recorded = part.end;
        Ok(())
    }

    /// Whether an update may be recorded now.
    ///
    /// # Errors
    /// As [`Volume::record_update`].
    pub fn check_update(&self, update: &Update) -> Result<(), Error> {
        if !update.is_of(self) {
            return Err(wrong("an update of this volume", "one of another"));
        }
        if !self.is_uploaded() {
            return Err(Error::NotUploaded);
        }
        if update.parts() == 0 {
            return Err(wrong("an update that is not recorded", "one that is"));
        }
        update.turn.check()
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

/// Slices of a box whose cells are a piece.
fn slices_of_cells(region: VoxelBox) -> u32 {
    let [nx, ny, _] = region.dims().map(|n| u64::from(n / CELL_VOXELS) + 2);
    let layers = (PIECE_CELLS / (nx * ny)).max(1);
    (layers as u32).saturating_mul(CELL_VOXELS)
}

fn wrong(wanted: impl Into<String>, found: impl Into<String>) -> Error {
    Error::Update {
        wanted: wanted.into(),
        found: found.into(),
    }
}
