//! Where the voxels of a volume lie in the world.

use glam::{DAffine3, DMat3, DVec3};

/// A grid of `dims` voxels, placed by a full affine: oblique and sheared grids render as they lie.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// Voxels along x, y, z.
    pub dims: [u32; 3],
    /// Voxel space to world.
    pub world_from_voxel: DAffine3,
}

impl Grid {
    /// Length of each column of `world_from_voxel`: the voxel's size in world length.
    pub fn spacing(&self) -> [f64; 3] {
        let m = self.world_from_voxel.matrix3;
        [m.x_axis.length(), m.y_axis.length(), m.z_axis.length()]
    }

    /// The smallest spacing, axes of one voxel left out (unless all are).
    pub fn smallest_spacing(&self) -> f64 {
        let all = self.spacing();
        let extended = (0..3).filter(|&k| self.dims[k] > 1).map(|k| all[k]);
        extended
            .reduce(f64::min)
            .unwrap_or_else(|| all.into_iter().fold(f64::INFINITY, f64::min))
    }

    /// The corner of the grid box with the largest voxel coordinates.
    pub fn far_corner(&self) -> DVec3 {
        DVec3::from_array(self.dims.map(f64::from))
    }

    /// World length of the longest way through the box: the longest of its four diagonals.
    pub fn diagonal(&self) -> f64 {
        let edges = self.world_from_voxel.matrix3 * DMat3::from_diagonal(self.far_corner());
        let [x, y, z] = [edges.x_axis, edges.y_axis, edges.z_axis];
        let diagonals = [x + y + z, x + y - z, x - y + z, y + z - x];
        diagonals.map(DVec3::length).into_iter().fold(0.0, f64::max)
    }

    /// World position of the centre of the grid box.
    pub fn center(&self) -> DVec3 {
        self.world_from_voxel
            .transform_point3(0.5 * self.far_corner())
    }

    /// The rows of `voxel_from_world` without its translation: row k is the gradient of voxel coordinate k.
    pub fn voxel_rows(&self) -> [DVec3; 3] {
        let inverse: DMat3 = self.world_from_voxel.matrix3.inverse();
        [inverse.row(0), inverse.row(1), inverse.row(2)]
    }
}
