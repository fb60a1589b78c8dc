//! Macro cells: which values filters can make in each cube of 8^3 voxels, made once a volume is there.
//!
//! ```text
//! volume -> MacroCells::record          ranges: least and most of a cell's voxels and a halo around them
//!        -> EmptySpace::record          distances: how far away matter is, whenever the transfer function changes
//! ```
//!
//! Techniques leave out what lies in cells that cannot matter; the picture stays the same to the bit.

use super::cell_ranges::{CellBox, SamplerError, ranges};
use super::channel_cells::ranges_of_channel;
use super::{GpuVolume, TextureLayout};
use crate::gpu::{
    Bindings, Buffer, ComputePipeline, Error, Gpu, Memory, ParameterRing, Resource, Use,
    buffer_barrier, group_count, within,
};
use crate::shaders::{CELL_THREADS, CELL_VOXELS, CellGrid, CellGridFields, Frame, shader};
use crate::volume::{Volume, VoxelBox, VoxelPart};
use ash::vk;
use std::ops::Range;
use std::sync::Arc;

/// How far around a macro cell the voxels lie that samples in it touch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Halo {
    /// On each side. Half a voxel more than a filter needs, so that rounding of positions does not count: one for
    /// nearest and linear filters, two for wider ones.
    pub voxels: u32,
    /// How far filtered values may lie beyond those of the voxels, as a multiple of half their range: 0 for filters
    /// without negative weights.
    pub overshoot: f32,
    /// Whether values between those of voxels are made.
    pub is_mixed: bool,
}

impl Halo {
    /// The same for cells that know of all voxels that central differences of samples are made of: one more on each
    /// side.
    pub fn of_gradients(self) -> Self {
        Self {
            voxels: self.voxels + 1,
            ..self
        }
    }

    /// Whether cells that know of so much know enough for those that need `other`.
    pub fn covers(self, other: Self) -> bool {
        self.voxels >= other.voxels
            && self.overshoot >= other.overshoot
            && self.is_mixed >= other.is_mixed
    }

    /// What a sampler makes of texels that stand for values `slope` apart where they are integers, or are floats of 16
    /// bits.
    pub(crate) fn sampler_error(self, slope: f32, is_integer: bool, is_half: bool) -> SamplerError {
        SamplerError {
            // It mixes integers with the precision of their format.
            slack: if is_integer && self.is_mixed {
                slope.abs()
            } else {
                0.0
            },
            rounding: match is_half {
                true => 2f32.powi(-9),
                false => 2f32.powi(-18),
            },
        }
    }
}

/// The ranges of a volume's macro cells. Made empty; [`MacroCells::record`] fills them.
#[derive(Debug)]
pub struct MacroCells {
    pub(super) gpu: Arc<Gpu>,
    pub(super) grids: Vec<CellGrid>,
    cell_count: u64,
    pub(super) ranges: Buffer,
    /// `None`: the ranges are there.
    pub(super) pass: Option<Ranging>,
}

/// What finds the ranges on the device.
#[derive(Debug)]
pub(super) struct Ranging {
    pub pipeline: ComputePipeline,
    pub ring: ParameterRing,
    pub bindings: Vec<Bindings>,
}

impl Ranging {
    /// Several for each cell, side by side.
    pub fn threads([x, y, z]: [u32; 3]) -> [u32; 3] {
        [x.saturating_mul(CELL_THREADS), y, z]
    }

    fn groups(&self, grid: &CellGrid) -> Result<[u32; 3], Error> {
        self.pipeline.groups(Self::threads(grid.cells))
    }
}

impl MacroCells {
    /// Bytes of a cell on the device, with those of [`super::EmptySpace`].
    pub const BYTES_PER_CELL: u64 = 16;

    /// Objects for a volume.
    ///
    /// # Errors
    /// Where the device gives no memory, or has no buffers of that size.
    pub fn new(gpu: &Arc<Gpu>, volume: &GpuVolume, halo: Halo) -> Result<Self, Error> {
        let (name, values) = match volume.layout() {
            TextureLayout::Texture3d => ("macro_cells.box", "volume"),
            TextureLayout::Stack(_) => ("macro_cells.stack", "stack"),
        };
        let mut made = Self::empty(gpu, volume, halo, Memory::Device)?;
        let pipeline = ComputePipeline::new(gpu, shader(name))?;
        let ring = ring_of(gpu, &made.grids)?;
        let bound = volume.bricks().iter().map(|brick| {
            let given = [
                (values, Resource::sampled(&brick.values)),
                ("cell_grid", Resource::Uniform(&ring)),
                ("cell_ranges", Resource::Storage(&made.ranges)),
            ];
            Bindings::new(gpu, pipeline.layout(), &given)
        });
        let bindings = bound.collect::<Result<_, _>>()?;
        made.pass = Some(Ranging {
            pipeline,
            ring,
            bindings,
        });
        Ok(made)
    }

    /// The same from the voxels that `volume` was made of, complete at once: on a device that computes on the CPU that
    /// is much faster.
    ///
    /// # Errors
    /// As [`MacroCells::new`].
    ///
    /// # Panics
    /// Where the volume holds coefficients, or other voxels.
    pub fn of_voxels(
        gpu: &Arc<Gpu>,
        volume: &GpuVolume,
        halo: Halo,
        voxels: &Volume,
    ) -> Result<Self, Error> {
        assert!(volume.spline().is_none(), "ranges of voxels");
        assert_eq!(volume.held.dims(), voxels.dims, "the same voxels");
        let made = Self::empty(gpu, volume, halo, Memory::Upload)?;
        for grid in &made.grids {
            let part = VoxelPart {
                held: volume.held,
                ..voxels.into()
            };
            let ranges = ranges(&part, grid, CellBox::whole(grid));
            let offset = 8 * u64::from(grid.first);
            made.ranges.write(offset, bytemuck::cast_slice(&ranges))?;
        }
        Ok(made)
    }

    /// The ranges of `channel`, made of `voxels` on a grid of its own, in the cells of `volume`; complete at once.
    ///
    /// # Errors
    /// As [`MacroCells::new`].
    pub fn of_channel(
        gpu: &Arc<Gpu>,
        volume: &GpuVolume,
        channel: &GpuVolume,
        halo: Halo,
        voxels: &Volume,
    ) -> Result<Self, Error> {
        let made = Self::empty(gpu, volume, halo, Memory::Upload)?;
        let coding = grid_of(channel, channel.held, channel.held, halo, 0);
        for cells in &made.grids {
            let ranges = ranges_of_channel(voxels, &coding, volume.grid(), cells);
            let offset = 8 * u64::from(cells.first);
            made.ranges.write(offset, bytemuck::cast_slice(&ranges))?;
        }
        Ok(made)
    }

    /// The grids of the bricks, and room for their ranges.
    fn empty(
        gpu: &Arc<Gpu>,
        volume: &GpuVolume,
        halo: Halo,
        memory: Memory,
    ) -> Result<Self, Error> {
        let mut first = 0;
        let mut grids = Vec::new();
        for brick in volume.bricks() {
            let grid = grid_of(volume, brick.cell.own, brick.cell.stored, halo, first);
            first += grid.cells.iter().product::<u32>();
            grids.push(grid);
        }
        let storage = vk::BufferUsageFlags::STORAGE_BUFFER
            | vk::BufferUsageFlags::TRANSFER_SRC
            | vk::BufferUsageFlags::TRANSFER_DST;
        let bytes = 8 * u64::from(first);
        Ok(Self {
            gpu: Arc::clone(gpu),
            grids,
            cell_count: first.into(),
            ranges: Buffer::new(gpu, bytes, storage, memory, "cell ranges")?,
            pass: None,
        })
    }

    /// Smallest and largest value of each cell, as pairs of f32: bricks one after the other, x fastest.
    pub fn ranges(&self) -> &Buffer {
        &self.ranges
    }

    /// How many there are in all bricks.
    pub fn cell_count(&self) -> u64 {
        self.cell_count
    }

    pub(super) fn grids(&self) -> &[CellGrid] {
        &self.grids
    }

    /// Tells the parameters of a recording of brick number `brick` where its cells are.
    pub fn tell(&self, brick: usize, frame: &mut Frame) {
        let grid = &self.grids[brick];
        frame.cells = grid.cells;
        frame.cells_first = grid.first;
        frame.cells_origin = grid.origin.map(|n| n as f32);
    }

    /// Records what fills them, once; nothing where they are complete.
    ///
    /// # Errors
    /// A brick larger than the device can dispatch.
    ///
    /// # Safety
    /// - `cmd` is recording, outside rendering; `self` and the volume live until it has run;
    /// - the volume's textures are in [`Use::Sampled`].
    pub unsafe fn record(&self, cmd: vk::CommandBuffer) -> Result<(), Error> {
        // SAFETY: the caller's promises.
        unsafe { self.record_part(cmd, 0..u64::MAX) }
    }

    /// Workgroups of all bricks, 0 where the cells are complete: [`MacroCells::record_part`] records some of them.
    ///
    /// # Errors
    /// A brick larger than the device can dispatch.
    pub fn group_count(&self) -> Result<u64, Error> {
        let Some(pass) = &self.pass else { return Ok(0) };
        let groups = |grid: &CellGrid| Ok(group_count(pass.groups(grid)?));
        self.grids.iter().map(groups).sum()
    }

    /// The same as [`MacroCells::record`] for a part of the work, so that no submission takes long: parts together make
    /// the whole, and need no barriers between them.
    ///
    /// # Errors
    /// As [`MacroCells::record`].
    ///
    /// # Safety
    /// As [`MacroCells::record`].
    pub unsafe fn record_part(
        &self,
        cmd: vk::CommandBuffer,
        part: Range<u64>,
    ) -> Result<(), Error> {
        let Some(pass) = &self.pass else {
            return Ok(());
        };
        let mut first = 0;
        for (slot, (grid, bindings)) in (0..).zip(self.grids.iter().zip(&pass.bindings)) {
            let groups = pass.groups(grid)?;
            let offset = pass.ring.offset(slot)?;
            let run = within(&part, first, group_count(groups));
            first += group_count(groups);
            // SAFETY: the caller's promises; bricks write cells of their own.
            unsafe {
                pass.pipeline
                    .dispatch_run(cmd, bindings, &[offset], groups, run)
            };
        }
        // SAFETY: outside rendering; the buffer lives until `cmd` has run.
        unsafe {
            buffer_barrier(
                &self.gpu,
                cmd,
                &self.ranges,
                Use::ComputeWrite,
                Use::ComputeRead,
            )
        };
        Ok(())
    }
}

/// The parameters of the bricks, one slot each.
pub(super) fn ring_of(gpu: &Arc<Gpu>, grids: &[CellGrid]) -> Result<ParameterRing, Error> {
    let bytes = size_of::<CellGrid>() as u32;
    let ring = ParameterRing::new(gpu, bytes, grids.len() as u32, "cell grids")?;
    for (slot, grid) in (0..).zip(grids) {
        ring.write(slot, bytemuck::bytes_of(grid))?;
    }
    Ok(ring)
}

fn grid_of(
    volume: &GpuVolume,
    own: VoxelBox,
    stored: VoxelBox,
    halo: Halo,
    first: u32,
) -> CellGrid {
    let coding = volume.texel().coding;
    let signed = |voxel: [u32; 3]| voxel.map(|n| n as i32);
    let is_half = volume.texel().format == vk::Format::R16_SFLOAT;
    let error = halo.sampler_error(coding.slope, coding.is_integer, is_half);
    let fields = CellGridFields {
        cells: own.dims().map(|n| n.div_ceil(CELL_VOXELS)),
        first,
        origin: signed(own.min),
        halo: halo.voxels as i32,
        stored_min: signed(stored.min),
        stored_last: signed(stored.max.map(|n| n - 1)),
        code_scale: coding.scale,
        code_offset: coding.offset,
        slope: coding.slope,
        intercept: coding.intercept,
        codes_are_integers: coding.is_integer.into(),
        overshoot: halo.overshoot,
        slack: error.slack,
        rounding: error.rounding,
        axis: match volume.layout() {
            TextureLayout::Texture3d => 0,
            TextureLayout::Stack(axis) => axis as u32,
        },
    };
    fields.into()
}
