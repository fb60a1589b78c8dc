//! Data put on a device: a volume as bricks or as stacks of slices, a transfer function as table and points.
//!
//! Making them only creates objects. Their content is uploaded by recorded copies (or, where the host
//! reaches the memory, written at once); nothing here submits or waits.

mod blue_noise;
mod bricks;
mod cell_ranges;
mod changed_cells;
mod changed_footprints;
mod channel_cells;
mod classified_runs;
mod empty_space;
mod footprint_texels;
mod full_voxels;
mod gradients;
mod macro_cells;
mod plan;
mod slabs;
mod texel;
mod transfer;
mod upload;
mod volume;

pub(crate) use bricks::sort_front_to_back;
pub use bricks::{Cell, cells_of_side, front_to_back, front_to_back_by_rows};
pub(crate) use cell_ranges::filtered;
pub(crate) use changed_cells::ChangedCells;
pub use classified_runs::{ClassifiedRuns, MadeBy, PayloadFloats, RunBuilder, RunsSize};
pub use empty_space::EmptySpace;
pub use footprint_texels::FootprintTexels;
pub use full_voxels::FullVoxels;
pub use gradients::{KeptGradients, KeptOperator};
pub use macro_cells::{Halo, MacroCells};
pub use plan::VolumePlan;
pub use texel::{Coding, TexelFormat};
pub use transfer::{GpuTransfer, TransferLayout};
pub use upload::Slab;
pub use volume::{Brick, GpuVolume, Texels, TextureLayout, Whole};
