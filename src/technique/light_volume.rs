//! The light volume on the device: what comes through to each node of a coarse grid from all around and from each
//! light, made by two kinds of compute passes whenever volume, transfer function, lights or cuts change.
//!
//! ```text
//! view.light_plan()                            pure: the grid and its paths, None where a picture needs none
//!     LightVolume::new                         objects
//!     light.bind(inputs)                       once for each brick
//!     light.record(cmd, bricks)                cells of each brick, then nodes
//!     Inputs { light: Some(&light), .. }       techniques read it
//! ```

use super::{Filter, GpuChannel, Inputs, LightPlan, SampleInputs, Settings};
use crate::gpu::{
    Bindings, Buffer, ComputePipeline, Error, Gpu, Memory, ParameterRing, Resource, Use, barriers,
    buffer_barrier, group_count, within,
};
use crate::resident::{GpuVolume, TextureLayout};
use crate::shaders::{LightGrid, shader};
use ash::vk;
use std::ops::Range;
use std::sync::Arc;

/// The passes, their buffers, and what they leave.
#[derive(Debug)]
pub struct LightVolume {
    gpu: Arc<Gpu>,
    plan: LightPlan,
    of_cells: ComputePipeline,
    of_nodes: ComputePipeline,
    parameters: ParameterRing,
    cells: Buffer,
    volume: Buffer,
    nodes_bound: Bindings,
    // Bound above.
    _paths: Buffer,
}

impl LightVolume {
    /// Compiles the passes for pictures of `volume` with these settings and makes the buffers.
    ///
    /// # Errors
    /// Where the device gives no memory, or has no buffers of that size.
    pub fn new(
        gpu: &Arc<Gpu>,
        plan: LightPlan,
        settings: &Settings,
        volume: &GpuVolume,
    ) -> Result<Self, Error> {
        let parts = [GpuChannel::numbers(volume)];
        Self::mixed(gpu, plan, settings, SampleInputs::Scalar, &parts)
    }

    /// The same for pictures of several volumes, `parts`, that go together as `mix` says.
    ///
    /// # Errors
    /// As [`LightVolume::new`].
    ///
    /// # Panics
    /// Where `parts` is empty.
    pub fn mixed(
        gpu: &Arc<Gpu>,
        plan: LightPlan,
        settings: &Settings,
        mix: SampleInputs,
        parts: &[GpuChannel],
    ) -> Result<Self, Error> {
        let name = name_of_cells(settings, mix, parts);
        let of_nodes = ComputePipeline::new(gpu, shader("light_volume"))?;
        let storage = vk::BufferUsageFlags::STORAGE_BUFFER;
        let buffer =
            |numbers: u64, name| Buffer::new(gpu, 4 * numbers, storage, Memory::Device, name);
        let cells = buffer(plan.cell_count(), "light cells")?;
        let made = buffer(plan.node_count(), "light volume")?;
        let path_bytes: &[u8] = bytemuck::cast_slice(&plan.paths);
        let (bytes, name_of_paths) = (path_bytes.len() as u64, "light paths");
        let paths = Buffer::new(gpu, bytes, storage, Memory::Upload, name_of_paths)?;
        paths.write(0, path_bytes)?;
        let parameters = ParameterRing::new(gpu, size_of::<LightGrid>() as u32, 1, "light grid")?;
        parameters.write(0, bytemuck::bytes_of(&plan.parameters()))?;
        let given = [
            ("light_grid", Resource::Uniform(&parameters)),
            ("light_cells", Resource::Storage(&cells)),
            ("light_paths", Resource::Storage(&paths)),
            ("light_volume", Resource::Storage(&made)),
        ];
        let nodes_bound = Bindings::new(gpu, of_nodes.layout(), &given)?;
        Ok(Self {
            gpu: Arc::clone(gpu),
            plan,
            of_cells: ComputePipeline::new(gpu, shader(&name))?,
            of_nodes,
            parameters,
            cells,
            volume: made,
            nodes_bound,
            _paths: paths,
        })
    }

    /// What it is made of and for.
    pub fn plan(&self) -> &LightPlan {
        &self.plan
    }

    /// What techniques read: one number a node, x fastest, bundle after bundle.
    pub fn buffer(&self) -> &Buffer {
        &self.volume
    }

    /// Binds the matter of one brick: a volume and its transfer function, or several.
    ///
    /// # Errors
    /// Where an input is missing.
    pub fn bind(&self, inputs: &Inputs) -> Result<Bindings, Error> {
        let own = [
            ("light_grid", Resource::Uniform(&self.parameters)),
            ("light_cells", Resource::Storage(&self.cells)),
        ];
        inputs.bind(&self.gpu, self.of_cells.layout(), &own)
    }

    /// Records the making of the volume from bricks, each with its bindings and the offset of its parameters in the
    /// ring, in the order of [`super::View::recordings`] of a ray caster: the first begins. Ends with barriers to all
    /// reads by techniques recorded after it, and begins after those recorded before it.
    ///
    /// # Errors
    /// A grid larger than the device can dispatch.
    ///
    /// # Safety
    /// - `cmd` is recording, outside rendering; what was bound and `self` live until it has run;
    /// - the inputs are in [`Use::Sampled`].
    pub unsafe fn record<'a>(
        &self,
        cmd: vk::CommandBuffer,
        bricks: impl IntoIterator<Item = (&'a Bindings, u32)>,
    ) -> Result<(), Error> {
        // SAFETY: the caller's promises.
        unsafe { self.record_part(cmd, bricks, 0..u64::MAX) }
    }

    /// The workgroups of both kinds of passes over so many bricks, numbered one after the other:
    /// [`LightVolume::record_part`] records some of them.
    ///
    /// # Errors
    /// A grid larger than the device can dispatch.
    pub fn group_runs(&self, bricks: usize) -> Result<[Range<u64>; 2], Error> {
        let [cells, nodes] = self.groups()?.map(group_count);
        let cells = cells * bricks as u64;
        Ok([0..cells, cells..cells + nodes])
    }

    /// Of cells and of nodes.
    fn groups(&self) -> Result<[[u32; 3]; 2], Error> {
        let [nx, ny, nz] = self.plan.cells.map(|n| n + 1);
        let nodes = [nx, ny, nz * self.plan.bundle_count];
        Ok([
            self.of_cells.groups(self.plan.cells)?,
            self.of_nodes.groups(nodes)?,
        ])
    }

    /// The same as [`LightVolume::record`] for a part of the work, so that no submission takes long: parts follow each
    /// other, each begins where the one before ended, and all are given the same bricks. No barriers are needed between
    /// them.
    ///
    /// # Errors
    /// As [`LightVolume::record`].
    ///
    /// # Safety
    /// As [`LightVolume::record`], in the order of the parts.
    pub unsafe fn record_part<'a>(
        &self,
        cmd: vk::CommandBuffer,
        bricks: impl IntoIterator<Item = (&'a Bindings, u32)>,
        part: Range<u64>,
    ) -> Result<(), Error> {
        let own = self.parameters.offset(0)?;
        let [cell_groups, node_groups] = self.groups()?;
        let [cell_count, node_count] = [cell_groups, node_groups].map(group_count);
        let mut first = 0;
        // SAFETY: the caller's promises; each write is put between the reads before and after it.
        unsafe {
            let (gpu, written) = (&self.gpu, Use::ComputeWrite);
            if part.start == 0 {
                buffer_barrier(gpu, cmd, &self.cells, Use::ComputeRead, written);
            }
            for (bound, offset) in bricks {
                let run = within(&part, first, cell_count);
                first += cell_count;
                let ends = run.end == cell_count && !run.is_empty();
                self.of_cells
                    .dispatch_run(cmd, bound, &[offset, own], cell_groups, run);
                if ends {
                    buffer_barrier(gpu, cmd, &self.cells, written, written);
                }
            }
            let run = within(&part, first, node_count);
            if run.is_empty() {
                return Ok(());
            }
            if run.start == 0 {
                let cells = (&self.cells, written, Use::ComputeRead);
                let [read, drawn] =
                    [Use::ComputeRead, Use::DrawRead].map(|was| (&self.volume, was, written));
                barriers(gpu, cmd, [], [cells, read, drawn], []);
            }
            let ends = run.end == node_count;
            self.of_nodes
                .dispatch_run(cmd, &self.nodes_bound, &[own], node_groups, run);
            if ends {
                let readers = [Use::ComputeRead, Use::DrawRead];
                let volumes = readers.map(|reader| (&self.volume, written, reader));
                barriers(gpu, cmd, [], volumes, []);
            }
        }
        Ok(())
    }
}

/// The shader that looks at the cells.
fn name_of_cells(settings: &Settings, mix: SampleInputs, parts: &[GpuChannel]) -> String {
    let first = parts[0].volume;
    let layout = match first.layout() {
        TextureLayout::Texture3d => "box",
        TextureLayout::Stack(_) => "stack",
    };
    let has_own_grids = parts.iter().any(|p| p.volume.grid() != first.grid());
    // Cells average voxels anyway: no need to look between them, unless they are coefficients or lie elsewhere.
    let filter = match settings.filter {
        Filter::Linear if has_own_grids => "linear_fetch",
        Filter::Nearest | Filter::Linear => "nearest",
        _ => "kernel",
    };
    let has_holes = parts.iter().any(|part| part.volume.has_holes());
    let holes = if has_holes { "mask" } else { "none" };
    let matter = match mix {
        SampleInputs::Channels => ".of_channels",
        SampleInputs::Colors => ".of_colors",
        _ => "",
    };
    let grids = if has_own_grids { ".own" } else { "" };
    format!("light_cells.{layout}.{filter}.{holes}.points{matter}{grids}")
}
