//! The grid that points are brought to: cubes, as far as distances go, around the box of the points.
//!
//! ```text
//! spacing    auto: max(d / 2, longest edge / 255),  d the mean distance of a point to its nearest neighbour
//! voxels     ceil(edge / spacing) + 1 along each edge, so that the first and the last centre lie at its ends or beyond
//! ```
//!
//! Of a density the box is wider by the radius of the kernel, so that all of the weight is inside.

use super::{Interpolation, NoField};
use crate::points::distances::bounds;
use crate::volume::Grid;
use glam::{DAffine3, DMat3, DVec3};

/// Voxels along an edge of a grid that nobody gave.
const MOST_VOXELS: f64 = 256.0;
/// Of the mean distance to the nearest neighbour.
const SPACING: f64 = 0.5;
/// Memory of a voxel.
const VOXEL_BYTES: f64 = 4.0;

/// How fine a grid is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum GridSize {
    /// Half the mean distance to the nearest neighbour, at most 256 voxels along each edge.
    #[default]
    Auto,
    /// So many voxels along x, y and z; along the normal of a plane that all points lie in there is one.
    Voxels([u32; 3]),
    /// The edge of a voxel, in world length; along z divided by [`super::Options::anisotropy`].
    Spacing(f64),
}

impl Interpolation {
    /// A grid around the points.
    ///
    /// # Errors
    /// [`NoField::TooLarge`] where the values on it take more than `max_bytes`, four bytes each, or an axis has more than
    /// 2^32 - 1 voxels. [`NoField::NoVoxel`] where a size is 0 or not finite.
    pub fn grid(&self, size: GridSize, max_bytes: u64) -> Result<Grid, NoField> {
        let around = DVec3::splat(self.reach_of_box());
        let [mut low, mut high] = bounds(self.distinct.places.iter().copied());
        (low, high) = (low - around, high + around);
        if let Some(k) = self.frame.normal {
            let middle = 0.5 * (low[k] + high[k]);
            (low[k], high[k]) = (middle, middle);
        }
        let extent = high - low;
        let by_spacing = |spacing: f64| {
            let count = (extent / spacing).ceil() + 1.0;
            (count, DVec3::splat(spacing))
        };
        let (count, spacing) = match size {
            GridSize::Auto => {
                let finest = extent.max_element() / (MOST_VOXELS - 1.0);
                by_spacing((SPACING * self.mean_distance).max(finest * (1.0 + 1e-12)))
            }
            GridSize::Spacing(spacing) if spacing > 0.0 && spacing.is_finite() => {
                by_spacing(spacing)
            }
            GridSize::Voxels(counts) if !counts.contains(&0) => self.by_counts(counts, extent),
            GridSize::Spacing(_) | GridSize::Voxels(_) => return Err(NoField::NoVoxel),
        };
        let bytes = count.element_product() * VOXEL_BYTES;
        // Not so either where it is no number.
        let has_room = bytes <= max_bytes as f64 && count.max_element() <= f64::from(u32::MAX);
        if !has_room {
            return Err(NoField::TooLarge {
                voxels: count.to_array(),
                bytes: bytes as u64,
                max_bytes,
            });
        }
        let corner = 0.5 * (low + high - spacing * count);
        let frame_from_voxel = DAffine3 {
            matrix3: DMat3::from_diagonal(spacing),
            translation: corner,
        };
        let world_from_frame = DAffine3::from_mat3(self.frame_from_world.inverse());
        let grid = Grid {
            dims: count.to_array().map(|n| n as u32),
            world_from_voxel: world_from_frame * frame_from_voxel,
        };
        let determinant = grid.world_from_voxel.matrix3.determinant();
        if determinant.is_normal() && grid.world_from_voxel.is_finite() {
            Ok(grid)
        } else {
            Err(NoField::NoVoxel)
        }
    }

    /// The first and last centres at the ends of the box; of one voxel along an axis its centre in the middle.
    fn by_counts(&self, counts: [u32; 3], extent: DVec3) -> (DVec3, DVec3) {
        let mut count = DVec3::from_array(counts.map(f64::from));
        if let Some(k) = self.frame.normal {
            count[k] = 1.0;
        }
        let steps = (count - 1.0).max(DVec3::ONE);
        let mut spacing = extent / steps;
        if let Some(k) = self.frame.normal {
            spacing[k] = spacing.max_element();
        }
        (count, spacing)
    }
}
