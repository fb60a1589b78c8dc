//! Empty space under a transfer function: how far away from each macro cell the nearest one with matter is, in cells.
//!
//! Chebyshev distances on a grid of occupied cells (Deakin and Knackstedt, "Efficient ray casting of volumetric images
//! using distance maps for empty space skipping", Computational Visual Media 6(1), 2020), one pass along each axis.
//! Made anew on the device whenever the function changes.

use super::macro_cells::{MacroCells, ring_of};
use crate::gpu::{
    Bindings, Buffer, ComputePipeline, Error, Gpu, Memory, ParameterRing, Resource, Use,
    buffer_barrier,
};
use crate::shaders::{CellGrid, Pass, shader};
use crate::transfer::Seen;
use ash::vk;
use std::sync::Arc;

/// What is seen, and along the three axes.
const PASSES: u32 = 4;

/// The rooms of a volume's macro cells. Made empty; [`EmptySpace::record`] fills them.
#[derive(Debug)]
pub struct EmptySpace {
    gpu: Arc<Gpu>,
    grids: Vec<CellGrid>,
    rooms: [Buffer; 2],
    grid_ring: ParameterRing,
    /// Of even and of odd passes.
    bindings: [Bindings; 2],
    mapping: Arc<Mapping>,
}

/// What maps of all volumes under one transfer function have in common.
#[derive(Debug)]
struct Mapping {
    pipeline: ComputePipeline,
    pass_ring: ParameterRing,
    seen: Buffer,
}

impl Mapping {
    fn new(gpu: &Arc<Gpu>, seen: &Seen) -> Result<Self, Error> {
        let storage = vk::BufferUsageFlags::STORAGE_BUFFER;
        let mut words = vec![
            seen.first.to_bits(),
            seen.scale.to_bits(),
            seen.next.len() as u32,
        ];
        words.extend_from_slice(&seen.next);
        let bytes: &[u8] = bytemuck::cast_slice(&words);
        let length = bytes.len() as u64;
        let table = Buffer::new(gpu, length, storage, Memory::Upload, "seen values")?;
        table.write(0, bytes)?;
        let pass_ring = ParameterRing::new(gpu, size_of::<Pass>() as u32, PASSES, "passes")?;
        for number in 0..PASSES {
            pass_ring.write(number, bytemuck::bytes_of(&Pass { number }))?;
        }
        Ok(Self {
            pipeline: ComputePipeline::new(gpu, shader("distance_map"))?,
            pass_ring,
            seen: table,
        })
    }
}

impl EmptySpace {
    /// Objects for these cells under a transfer function.
    ///
    /// # Errors
    /// Where the device gives no memory, or has no buffers of that size.
    pub fn new(gpu: &Arc<Gpu>, cells: &MacroCells, seen: &Seen) -> Result<Self, Error> {
        Self::with(gpu, cells, Arc::new(Mapping::new(gpu, seen)?))
    }

    /// The same for other cells under the same transfer function.
    ///
    /// # Errors
    /// As [`EmptySpace::new`].
    pub fn of_others(&self, cells: &MacroCells) -> Result<Self, Error> {
        Self::with(&self.gpu, cells, Arc::clone(&self.mapping))
    }

    fn with(gpu: &Arc<Gpu>, cells: &MacroCells, mapping: Arc<Mapping>) -> Result<Self, Error> {
        let storage = vk::BufferUsageFlags::STORAGE_BUFFER;
        let rooms = || {
            Buffer::new(
                gpu,
                4 * cells.cell_count(),
                storage,
                Memory::Device,
                "rooms",
            )
        };
        let rooms = [rooms()?, rooms()?];
        let grid_ring = ring_of(gpu, cells.grids())?;
        let bound = |before: &Buffer, after: &Buffer| {
            let given = [
                ("cell_grid", Resource::Uniform(&grid_ring)),
                ("cell_ranges", Resource::Storage(cells.ranges())),
                ("seen", Resource::Storage(&mapping.seen)),
                ("rooms_before", Resource::Storage(before)),
                ("rooms_after", Resource::Storage(after)),
                ("which", Resource::Uniform(&mapping.pass_ring)),
            ];
            Bindings::new(gpu, mapping.pipeline.layout(), &given)
        };
        let bindings = [bound(&rooms[1], &rooms[0])?, bound(&rooms[0], &rooms[1])?];
        Ok(Self {
            gpu: Arc::clone(gpu),
            grids: cells.grids().to_vec(),
            rooms,
            grid_ring,
            bindings,
            mapping,
        })
    }

    /// What techniques read: a u32 for each cell, in the order of [`MacroCells::ranges`]. 0: there may be matter.
    pub fn rooms(&self) -> &Buffer {
        &self.rooms[1]
    }

    /// Records what fills them: after the record of the cells.
    ///
    /// # Errors
    /// A grid larger than the device can dispatch.
    ///
    /// # Safety
    /// `cmd` is recording, outside rendering; `self` and the cells live until it has run.
    pub unsafe fn record(&self, cmd: vk::CommandBuffer) -> Result<(), Error> {
        let Mapping {
            pipeline,
            pass_ring,
            ..
        } = &*self.mapping;
        for pass in 0..PASSES {
            let parity = pass as usize % 2;
            for (slot, grid) in (0..).zip(&self.grids) {
                let offsets = [self.grid_ring.offset(slot)?, pass_ring.offset(pass)?];
                let groups = pipeline.groups(grid.cells)?;
                // SAFETY: the caller's promises; a pass reads what the one before wrote, the barrier between.
                unsafe { pipeline.dispatch(cmd, &self.bindings[parity], &offsets, groups) };
            }
            // SAFETY: outside rendering; the buffers live until `cmd` has run.
            unsafe {
                let written = &self.rooms[parity];
                buffer_barrier(&self.gpu, cmd, written, Use::ComputeWrite, Use::ComputeRead);
                let read = &self.rooms[1 - parity];
                buffer_barrier(&self.gpu, cmd, read, Use::ComputeRead, Use::ComputeWrite);
            }
        }
        Ok(())
    }
}
