//! Empty space under a transfer function: how far away from each macro cell the nearest one with matter is, in cells.
//!
//! Chebyshev distances on a grid of occupied cells (Deakin and Knackstedt, "Efficient ray casting of volumetric images
//! using distance maps for empty space skipping", Computational Visual Media 6(1), 2020), one pass along each axis.
//! Made anew on the device whenever the function changes.

use super::FullVoxels;
use super::macro_cells::{MacroCells, ring_of};
use crate::gpu::{
    Bindings, Buffer, ComputePipeline, Error, Gpu, Memory, ParameterRing, Resource, Use, barriers,
    buffer_barrier, group_count, within,
};
use crate::shaders::{CELLS_PER_WORD, CellGrid, Pass, shader};
use crate::transfer::{ContourReach, HomogeneousRanges, VisibleRanges};
use ash::vk;
use std::ops::Range;
use std::sync::Arc;

/// What is seen, and along the three axes.
const PASSES: u32 = 4;
/// What is seen of another volume too.
const ALSO: u32 = PASSES;
/// What looks alike.
const LIKE: u32 = PASSES + 1;

/// The distances of a volume's macro cells. Made empty; [`EmptySpace::record`] fills them.
#[derive(Debug)]
pub struct EmptySpace {
    gpu: Arc<Gpu>,
    grids: Vec<CellGrid>,
    distances: [Buffer; 2],
    grid_ring: ParameterRing,
    /// Of even and of odd passes.
    bindings: [Bindings; 2],
    mapping: Arc<Mapping>,
    /// What further volumes show, in which matter may be too.
    others: Vec<(Arc<Mapping>, Bindings)>,
    /// Where samples look alike.
    alike: Option<(Arc<Mapping>, Bindings)>,
    full: Option<FullVoxels>,
}

/// What maps of all volumes under one transfer function have in common.
#[derive(Debug)]
struct Mapping {
    pipeline: Arc<ComputePipeline>,
    pass_ring: ParameterRing,
    seen: Buffer,
}

/// A table over values, as the shader has it.
#[derive(Clone, Copy)]
struct Words<'a> {
    first: f32,
    scale: f32,
    next: &'a [u32],
    contours: &'a [ContourReach],
}

impl<'a> From<&'a VisibleRanges> for Words<'a> {
    fn from(seen: &'a VisibleRanges) -> Self {
        let VisibleRanges {
            first,
            scale,
            next,
            contours,
        } = seen;
        Self {
            first: *first,
            scale: *scale,
            next,
            contours,
        }
    }
}

impl<'a> From<&'a HomogeneousRanges> for Words<'a> {
    fn from(alike: &'a HomogeneousRanges) -> Self {
        let HomogeneousRanges { first, scale, end } = alike;
        Self {
            first: *first,
            scale: *scale,
            next: end,
            contours: &[],
        }
    }
}

impl Mapping {
    fn new<'a>(gpu: &Arc<Gpu>, seen: impl Into<Words<'a>>) -> Result<Self, Error> {
        let pipeline = ComputePipeline::new(gpu, shader("distance_map"))?;
        Self::by(gpu, Arc::new(pipeline), seen)
    }

    fn by<'a>(
        gpu: &Arc<Gpu>,
        pipeline: Arc<ComputePipeline>,
        seen: impl Into<Words<'a>>,
    ) -> Result<Self, Error> {
        let seen = seen.into();
        let storage = vk::BufferUsageFlags::STORAGE_BUFFER;
        let mut words = vec![
            seen.first.to_bits(),
            seen.scale.to_bits(),
            seen.next.len() as u32,
            seen.contours.len() as u32,
        ];
        words.extend_from_slice(seen.next);
        for ContourReach { value, reach } in seen.contours {
            words.extend([value, reach].map(|n| n.to_bits()));
        }
        let bytes: &[u8] = bytemuck::cast_slice(&words);
        let length = bytes.len() as u64;
        let table = Buffer::new(gpu, length, storage, Memory::Upload, "seen values")?;
        table.write(0, bytes)?;
        let pass_ring = ParameterRing::new(gpu, size_of::<Pass>() as u32, LIKE + 1, "passes")?;
        for number in 0..=LIKE {
            pass_ring.write(number, bytemuck::bytes_of(&Pass { number }))?;
        }
        Ok(Self {
            pipeline,
            pass_ring,
            seen: table,
        })
    }

    fn bind(
        &self,
        gpu: &Arc<Gpu>,
        grid_ring: &ParameterRing,
        cells: &MacroCells,
        [before, after]: [&Buffer; 2],
    ) -> Result<Bindings, Error> {
        let given = [
            ("cell_grid", Resource::Uniform(grid_ring)),
            ("cell_ranges", Resource::Storage(cells.ranges())),
            ("seen", Resource::Storage(&self.seen)),
            ("distances_before", Resource::Storage(before)),
            ("distances_after", Resource::Storage(after)),
            ("which", Resource::Uniform(&self.pass_ring)),
        ];
        Bindings::new(gpu, self.pipeline.layout(), &given)
    }
}

impl EmptySpace {
    /// Objects for these cells under a transfer function.
    ///
    /// # Errors
    /// Where the device gives no memory, or has no buffers of that size.
    pub fn new(gpu: &Arc<Gpu>, cells: &MacroCells, seen: &VisibleRanges) -> Result<Self, Error> {
        Self::of_several(gpu, &[(cells, seen)])
    }

    /// Objects for volumes in one place, of one grid in the same bricks: empty is what is so in all of them.
    ///
    /// # Errors
    /// As [`EmptySpace::new`].
    ///
    /// # Panics
    /// Without a volume, or where the volumes have other cells.
    pub fn of_several(
        gpu: &Arc<Gpu>,
        several: &[(&MacroCells, &VisibleRanges)],
    ) -> Result<Self, Error> {
        let ((cells, seen), others) = several.split_first().expect("at least one volume");
        let mut made = Self::with(gpu, cells, Arc::new(Mapping::new(gpu, *seen)?))?;
        for (other, seen) in others {
            assert_eq!(other.cell_count(), cells.cell_count(), "the same cells");
            let mapping = Arc::new(Mapping::new(gpu, *seen)?);
            let distances = &made.distances;
            let bound =
                mapping.bind(gpu, &made.grid_ring, other, [&distances[1], &distances[0]])?;
            made.others.push((mapping, bound));
        }
        Ok(made)
    }

    /// The same of one volume, and where samples of it look alike.
    ///
    /// # Errors
    /// As [`EmptySpace::new`].
    pub fn with_alike(
        gpu: &Arc<Gpu>,
        cells: &MacroCells,
        seen: &VisibleRanges,
        alike: &HomogeneousRanges,
    ) -> Result<Self, Error> {
        let mut made = Self::new(gpu, cells, seen)?;
        let pipeline = Arc::clone(&made.mapping.pipeline);
        let mapping = Arc::new(Mapping::by(gpu, pipeline, alike)?);
        let [before, after] = &made.distances;
        let bound = mapping.bind(gpu, &made.grid_ring, cells, [before, after])?;
        made.alike = Some((mapping, bound));
        Ok(made)
    }

    /// What finds empty space, for [`EmptySpace::by`].
    ///
    /// # Errors
    /// Where the device refuses.
    pub fn pipeline(gpu: &Arc<Gpu>) -> Result<Arc<ComputePipeline>, Error> {
        ComputePipeline::new(gpu, shader("distance_map")).map(Arc::new)
    }

    /// As [`EmptySpace::new`], without compiling anything.
    ///
    /// # Errors
    /// As [`EmptySpace::new`].
    pub fn by(
        gpu: &Arc<Gpu>,
        pipeline: &Arc<ComputePipeline>,
        cells: &MacroCells,
        seen: &VisibleRanges,
    ) -> Result<Self, Error> {
        let mapping = Mapping::by(gpu, Arc::clone(pipeline), seen)?;
        Self::with(gpu, cells, Arc::new(mapping))
    }

    /// The same for other cells under the same transfer function.
    ///
    /// # Errors
    /// As [`EmptySpace::new`].
    pub fn of_others(&self, cells: &MacroCells) -> Result<Self, Error> {
        Self::with(&self.gpu, cells, Arc::clone(&self.mapping))
    }

    fn with(gpu: &Arc<Gpu>, cells: &MacroCells, mapping: Arc<Mapping>) -> Result<Self, Error> {
        let storage = vk::BufferUsageFlags::STORAGE_BUFFER | vk::BufferUsageFlags::TRANSFER_SRC;
        let distances = || {
            Buffer::new(
                gpu,
                4 * cells.cell_count(),
                storage,
                Memory::Device,
                "distance_map",
            )
        };
        let distances = [distances()?, distances()?];
        let grid_ring = ring_of(gpu, cells.grids())?;
        let bound = |distances| mapping.bind(gpu, &grid_ring, cells, distances);
        let [a, b] = &distances;
        let bindings = [bound([b, a])?, bound([a, b])?];
        Ok(Self {
            gpu: Arc::clone(gpu),
            grids: cells.grids().to_vec(),
            distances,
            grid_ring,
            bindings,
            mapping,
            others: Vec::new(),
            alike: None,
            full: None,
        })
    }

    /// The same for rays that go by a structure of voxels; tiles of rays still go by the cells.
    #[must_use]
    pub fn with_full_voxels(self, full: FullVoxels) -> Self {
        Self {
            full: Some(full),
            ..self
        }
    }

    /// What these rays read.
    pub(crate) fn full_voxels(&self) -> Option<&Buffer> {
        self.full.as_ref().map(FullVoxels::buffer)
    }

    /// What techniques read: a byte for each cell, in words (`shaders/lib/distance_map_word.wgsl`). 0: there may be matter.
    pub fn distance_map(&self) -> &Buffer {
        &self.distances[1]
    }

    /// Records what fills them: after the record of the cells, and once more whenever those have changed. The barriers
    /// of a pass also stand behind compute shaders that read what was there before.
    ///
    /// # Errors
    /// A grid larger than the device can dispatch.
    ///
    /// # Safety
    /// `cmd` is recording, outside rendering; `self` and the cells live until it has run.
    pub unsafe fn record(&self, cmd: vk::CommandBuffer) -> Result<(), Error> {
        // SAFETY: the caller's promises.
        unsafe { self.record_part(cmd, 0..u64::MAX) }
    }

    /// The workgroups of each pass over all bricks, numbered one after the other: [`EmptySpace::record_part`] records
    /// some of them.
    ///
    /// # Errors
    /// A grid larger than the device can dispatch.
    pub fn group_runs(&self) -> Result<[Range<u64>; PASSES as usize], Error> {
        let groups =
            |grid: &CellGrid| Ok(group_count(self.mapping.pipeline.groups(words_of(grid))?));
        let count = self.grids.iter().map(groups).sum::<Result<u64, Error>>()?;
        Ok(std::array::from_fn(|pass| {
            count * pass as u64..count * (pass as u64 + 1)
        }))
    }

    /// The same as [`EmptySpace::record`] for a part of the work, so that no submission takes long: parts follow each
    /// other, each begins where the one before ended. No barriers are needed between them.
    ///
    /// # Errors
    /// As [`EmptySpace::record`].
    ///
    /// # Safety
    /// As [`EmptySpace::record`], in the order of the parts.
    pub unsafe fn record_part(
        &self,
        cmd: vk::CommandBuffer,
        part: Range<u64>,
    ) -> Result<(), Error> {
        let Mapping {
            pipeline,
            pass_ring,
            ..
        } = &*self.mapping;
        let mut first = 0;
        for pass in 0..PASSES {
            let parity = pass as usize % 2;
            for (slot, grid) in (0..).zip(&self.grids) {
                let offsets = [self.grid_ring.offset(slot)?, pass_ring.offset(pass)?];
                let groups = pipeline.groups(words_of(grid))?;
                let run = within(&part, first, group_count(groups));
                first += group_count(groups);
                let others = self.others.iter().filter(|_| pass == 0 && !run.is_empty());
                // SAFETY: the caller's promises; a pass reads what the one before wrote, the barrier between.
                unsafe {
                    pipeline.dispatch_run(
                        cmd,
                        &self.bindings[parity],
                        &offsets,
                        groups,
                        run.clone(),
                    );
                    // Each cell may be found to have matter in a further volume.
                    for (mapping, bindings) in others {
                        let (distances, again) = (&self.distances[parity], Use::ComputeWrite);
                        buffer_barrier(&self.gpu, cmd, distances, again, again);
                        let offsets = [offsets[0], mapping.pass_ring.offset(ALSO)?];
                        mapping
                            .pipeline
                            .dispatch_run(cmd, bindings, &offsets, groups, run.clone());
                    }
                };
            }
            if let Some((mapping, bindings)) = self.alike.as_ref().filter(|_| pass == PASSES - 1) {
                // SAFETY: the caller's promises; each workgroup looks at what it has written itself, the barrier
                // between.
                unsafe { self.record_alike(cmd, mapping, bindings, &part, first)? };
            }
            // What ends a pass is recorded with its last workgroup.
            if part.start >= first || part.end < first {
                continue;
            }
            // SAFETY: outside rendering; the buffers live until `cmd` has run.
            unsafe {
                let written = (&self.distances[parity], Use::ComputeWrite, Use::ComputeRead);
                let read = (
                    &self.distances[1 - parity],
                    Use::ComputeRead,
                    Use::ComputeWrite,
                );
                barriers(&self.gpu, cmd, [], [written, read], []);
            }
        }
        Ok(())
    }

    /// What comes behind the last pass, whose workgroups end with number `end`: cells of the same workgroups.
    ///
    /// # Safety
    /// As [`EmptySpace::record_part`].
    unsafe fn record_alike(
        &self,
        cmd: vk::CommandBuffer,
        mapping: &Mapping,
        bindings: &Bindings,
        part: &Range<u64>,
        end: u64,
    ) -> Result<(), Error> {
        let groups = |grid: &CellGrid| mapping.pipeline.groups(words_of(grid));
        let counts = self.grids.iter().map(|grid| Ok(group_count(groups(grid)?)));
        let counts = counts.collect::<Result<Vec<u64>, Error>>()?;
        let mut first = end - counts.iter().sum::<u64>();
        for ((slot, grid), count) in (0..).zip(&self.grids).zip(counts) {
            let run = within(part, first, count);
            first += count;
            if run.is_empty() {
                continue;
            }
            let offsets = [
                self.grid_ring.offset(slot)?,
                mapping.pass_ring.offset(LIKE)?,
            ];
            let again = Use::ComputeWrite;
            // SAFETY: the caller's promises; a cell is marked behind its last pass.
            unsafe {
                buffer_barrier(&self.gpu, cmd, &self.distances[1], again, again);
                let pipeline = &mapping.pipeline;
                pipeline.dispatch_run(cmd, bindings, &offsets, groups(grid)?, run);
            }
        }
        Ok(())
    }
}

/// Threads for the cells of a brick, one a word.
fn words_of(grid: &CellGrid) -> [u32; 3] {
    let [nx, ny, nz] = grid.cells;
    [nx.div_ceil(CELLS_PER_WORD), ny, nz]
}
