//! Voxels on the CPU: where they come from ([`Source`]) and one box of one time in memory ([`Volume`]).
//!
//! A value is what the file means by a stored voxel:
//!
//! ```text
//! value = stored * slope + intercept
//! ```
//!
//! Knows nothing of Vulkan.

mod codes;
mod colors;
mod components;
mod crossings;
mod denoise;
#[doc(hidden)]
pub mod field;
mod grid;
mod header;
mod histogram;
mod holes;
mod joint;
#[cfg(feature = "json")]
mod json;
#[doc(hidden)]
pub mod kernel;
pub mod labels;
mod limits;
mod magnitude;
mod map;
mod octree;
mod part;
#[cfg(feature = "phantoms")]
pub mod phantom;
mod prefilter;
#[cfg(feature = "files")]
mod pyramid;
mod read;
mod read_error;
mod reduce;
mod regrid;
mod runs;
#[doc(hidden)]
pub mod sample;
mod source;
mod statistics;
mod survey;
mod voxel_box;
mod voxel_set;
mod voxels;

pub use codes::Codes;
pub use colors::{luma, read_all, read_colors};
pub(crate) use components::{Component, Components};
pub use crossings::RayInterval;
pub use denoise::{Denoise, MAX_SIGMA_VOXELS, Pass, noise_of, with_numbers};
pub use grid::Grid;
pub use header::{
    Channel, ComponentKind, DerivedVariable, Format, Header, Heights, Rescale, Series,
    VolumeSelection,
};
pub use histogram::Histogram;
pub use joint::{JointHistogram, steepest_gradient};
pub use limits::Limits;
pub use magnitude::Magnitude;
pub use map::{MapCorner, MapKind, MapProjection, MovedPole};
pub use octree::{Address, AddressError, Leaf, LevelCount, MixedNode, NodeState, Octree};
pub use part::VoxelPart;
pub(crate) use part::part_of;
pub use prefilter::{Coefficients, Spline};
#[cfg(feature = "files")]
pub(crate) use pyramid::{Difference, difference, halved, held};
pub use read_error::{Problem, ReadError};
pub use reduce::Reduced;
pub use regrid::{is_same_grid, regridded};
pub use runs::{RankWord, Run, RunBits, Runs};
pub use source::{Piece, PrecisionLoss, Source, TimeComponent};
pub use statistics::Statistics;
#[cfg(feature = "cli")]
pub(crate) use statistics::slices_of_slab;
pub use survey::{Overview, Survey, Surveyed};
pub use voxel_box::VoxelBox;
pub use voxel_set::VoxelSet;
pub use voxels::{VoxelType, Voxels};

use glam::DAffine3;

/// One box of one time of one component in memory. A `Volume` cannot be wrong: there are as many voxels
/// as `dims` say, the affine can be inverted, and every stored number is finite. Only of the outline of a
/// [`Stream`](crate::offscreen::Stream) the voxels are elsewhere: there are none.
#[derive(Clone, Debug)]
pub struct Volume {
    /// Voxels along x, y, z.
    pub dims: [u32; 3],
    /// Voxel space to world.
    pub world_from_voxel: DAffine3,
    /// Stored numbers; a hole holds the nearest valid number.
    pub voxels: Voxels,
    /// Stored number to value.
    pub rescale: Rescale,
    /// One byte a voxel, 1 = valid, 0 = no data; in a label map also [`labels::DIMMED`], which is valid. `None` where
    /// all are valid.
    pub validity: Option<Vec<u8>>,
    /// True where values are Hounsfield units.
    pub hounsfield: bool,
    /// The unit of the values, as the file words it.
    pub unit: Option<String>,
    /// What rounding stored numbers to f32 changed.
    pub loss: PrecisionLoss,
    /// Smallest and largest valid value; `[0.0, 0.0]` where none is valid.
    pub value_range: [f64; 2],
}

impl Volume {
    /// True of the outline of a volume that is drawn brick by brick: its voxels stay where they are.
    pub fn is_outline(&self) -> bool {
        self.voxels.is_empty()
    }

    /// How many voxels hold no data.
    pub fn no_data_count(&self) -> u64 {
        let count = |mask: &Vec<u8>| mask.iter().filter(|&&valid| valid == 0).count() as u64;
        self.validity.as_ref().map_or(0, count)
    }

    /// Where the voxels lie.
    pub fn grid(&self) -> Grid {
        Grid {
            dims: self.dims,
            world_from_voxel: self.world_from_voxel,
        }
    }
}
