//! Volumes that stay where they are, on disk as a rule: bricks come to the device when a picture needs them.
//!
//! ```text
//! Stream::open(source, pick, options)        once: which values there are in each brick
//! Renderer::streamed(device, &stream)        for each picture, from front to back:
//!     bricks in the picture, whose values are seen, that nothing before them hides -> read -> upload -> draw
//! ```
//!
//! Bricks stay on the device as long as there is room. The picture is that of the whole volume: each sample lies in one
//! brick, which stores the neighbours that filters need (`sampling.md` 3).

mod cache;
mod places;
mod row;

pub(super) use cache::{Cache, if_it_fits};
pub(super) use places::{Eye, Place};

use crate::resident::{Cell, Halo, Whole, cells_of_side};
use crate::volume::{
    Overview, ReadError, Source, Survey, Surveyed, TimeComponent, Volume, VoxelType, Voxels,
};
use glam::DAffine3;
use std::ops::ControlFlow;
use std::sync::Arc;

/// A volume that is drawn without being in memory.
#[derive(Clone)]
pub struct Stream {
    source: Arc<dyn Source>,
    pick: TimeComponent,
    outline: Volume,
    whole: Whole,
    cells: Vec<Cell>,
    ranges: Vec<Option<[f64; 2]>>,
    overview: Overview,
    piece_bytes: u64,
    device_bytes: u64,
    all_device_bytes: u64,
}

impl std::fmt::Debug for Stream {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Stream")
            .field("path", &self.source.path())
            .field("whole", &self.whole)
            .field("bricks", &self.cells.len())
            .finish_non_exhaustive()
    }
}

/// How a stream reads and keeps bricks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StreamOptions {
    /// Voxels of its own along each side of a brick.
    pub side: u32,
    /// Bytes of voxels that the first look at a source holds at once, twice, and that neighbours take that are read
    /// together.
    pub piece_bytes: u64,
    /// Bytes of the device that bricks may take. One of them is there in any case.
    pub device_bytes: u64,
    /// Bytes that all on the device may take, pictures too: bricks leave where they would be more.
    pub all_device_bytes: u64,
}

impl Default for StreamOptions {
    /// Bricks of 120 voxels a side, a whole number of macro cells; 128 MiB; 1 GiB, and whatever pictures take.
    fn default() -> Self {
        Self {
            side: 120,
            piece_bytes: 128 << 20,
            device_bytes: 1 << 30,
            all_device_bytes: u64::MAX,
        }
    }
}

impl Stream {
    /// Looks at all of one time and component of a source. `tell` hears how many bricks are done of how many, and may
    /// end the work.
    ///
    /// # Errors
    /// What the source meets; `None` where `tell` has ended it.
    ///
    /// # Panics
    /// Where `options.side` is 0.
    pub fn open(
        source: Arc<dyn Source>,
        pick: TimeComponent,
        options: StreamOptions,
        tell: &mut dyn FnMut(usize, usize) -> ControlFlow<()>,
    ) -> Result<Option<Self>, ReadError> {
        const MOST_SEEN: u64 = 1 << 22;
        let dims = source.header().dims;
        if let Some(Surveyed { side, survey }) = source.surveyed(pick, MOST_SEEN)? {
            let cells = cells_of_side(dims, side);
            if cells.len() == survey.ranges.len() {
                return Ok(Some(Self::new(source, pick, cells, survey, options)));
            }
        }
        let cells = cells_of_side(dims, options.side);
        let boxes: Vec<_> = cells.iter().map(|cell| cell.stored).collect();
        let most = [options.piece_bytes, MOST_SEEN];
        let survey = Survey::of(source.as_ref(), pick, &boxes, most, tell)?;
        Ok(survey.map(|survey| Self::new(source, pick, cells, survey, options)))
    }

    fn new(
        source: Arc<dyn Source>,
        pick: TimeComponent,
        cells: Vec<Cell>,
        survey: Survey,
        options: StreamOptions,
    ) -> Self {
        let header = source.header();
        let value_range = survey.value_range.unwrap_or([0.0; 2]);
        let outline = Volume {
            dims: header.dims,
            world_from_voxel: header.world_from_voxel,
            voxels: no_voxels(header.stored),
            rescale: header.rescale,
            validity: survey.has_holes.then(Vec::new),
            hounsfield: header.hounsfield,
            unit: header.unit.clone(),
            loss: survey.loss,
            value_range,
        };
        Self {
            pick,
            whole: Whole {
                grid: outline.grid(),
                value_range,
                has_holes: survey.has_holes,
            },
            outline,
            cells,
            ranges: survey.ranges,
            overview: survey.overview,
            piece_bytes: options.piece_bytes,
            device_bytes: options.device_bytes,
            all_device_bytes: options.all_device_bytes,
            source,
        }
    }

    /// Every n-th voxel: what shows which values there are.
    pub fn overview(&self) -> &Overview {
        &self.overview
    }

    /// The same volume placed elsewhere in the world.
    pub fn placed(mut self, world_from_voxel: DAffine3) -> Self {
        self.outline.world_from_voxel = world_from_voxel;
        self.whole.grid = self.outline.grid();
        self
    }

    /// What stands for the volume in a [`Scene`](crate::scene::Scene): all of it but the voxels.
    pub fn outline(&self) -> &Volume {
        &self.outline
    }

    /// How many bricks there are.
    pub fn brick_count(&self) -> usize {
        self.cells.len()
    }

    pub(super) fn whole(&self) -> &Whole {
        &self.whole
    }

    pub(super) fn cells(&self) -> &[Cell] {
        &self.cells
    }

    /// Whether bricks are best drawn row by row.
    pub(super) fn is_of_rows(&self) -> bool {
        self.source.reads_whole_rows()
    }

    /// The values that filters may make in a brick; `None` where no sample has one.
    pub(super) fn range(&self, brick: usize, halo: Halo) -> Option<[f32; 2]> {
        let [low, high] = self.ranges[brick]?;
        // Codes are mixed with the precision of their format, as in macro cells.
        let slack = match self.outline.voxels.voxel_type().is_float() {
            true => 0.0,
            false => self.outline.rescale.slope.abs(),
        };
        let rounding = match self.outline.voxels.voxel_type() {
            VoxelType::F16 => 2f64.powi(-9),
            _ => 2f64.powi(-18),
        };
        let beyond = 0.5 * f64::from(halo.overshoot) * (high - low)
            + slack
            + rounding * low.abs().max(high.abs());
        Some([(low - beyond) as f32, (high + beyond) as f32])
    }
}

/// No voxels, of the type that they have in memory.
fn no_voxels(stored: VoxelType) -> Voxels {
    match stored {
        VoxelType::U8 => Voxels::U8(Vec::new()),
        VoxelType::I8 => Voxels::I8(Vec::new()),
        VoxelType::U16 => Voxels::U16(Vec::new()),
        VoxelType::I16 => Voxels::I16(Vec::new()),
        VoxelType::F16 => Voxels::F16(Vec::new()),
        _ => Voxels::F32(Vec::new()),
    }
}
