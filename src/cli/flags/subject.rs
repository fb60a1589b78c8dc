//! What a camera is turned to, and from where it is seen when no word says it.

use crate::{
    camera::{BoundingSphere, Orbit},
    volume::Grid,
};
use glam::DVec3;

/// What a camera is turned to.
#[derive(Clone, Copy, Debug)]
pub struct Subject {
    /// Around the uncropped grid box.
    pub bounds: BoundingSphere,
    /// From the middle of the box to the middles of three of its faces.
    pub half_axes: [DVec3; 3],
    /// Of its voxels.
    pub smallest_spacing: f64,
    /// A piece of the Earth, x to the east and y to the north.
    pub is_earth: bool,
}

impl Subject {
    /// The box of this grid.
    pub fn new(grid: &Grid, is_earth: bool) -> Self {
        let half = 0.5 * grid.far_corner();
        let axis = |k: usize| half[k] * grid.world_from_voxel.matrix3.col(k);
        Self {
            bounds: BoundingSphere::of_grid(&grid.world_from_voxel, grid.dims),
            half_axes: [0, 1, 2].map(axis),
            smallest_spacing: grid.smallest_spacing(),
            is_earth,
        }
    }

    /// How far the box reaches from its middle along a unit vector.
    pub fn half_extent(&self, direction: DVec3) -> f64 {
        self.half_axes
            .iter()
            .map(|axis| axis.dot(direction).abs())
            .sum()
    }

    /// Where a camera stands that no word places.
    pub fn side(&self) -> Orbit {
        let [azimuth_degrees, elevation_degrees] = if self.is_earth {
            // As on a map: east is right, north is away.
            [-60.0, 25.0]
        } else {
            // Three sides of a box are seen, and of a head more than the profile.
            [60.0, 15.0]
        };
        Orbit {
            azimuth_degrees,
            elevation_degrees,
            roll_degrees: 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::flags::CameraFlags;

    #[test]
    fn the_earth_is_seen_from_the_south_with_east_on_the_right() {
        let [earth, other] = [true, false].map(|is_earth| Subject {
            bounds: BoundingSphere {
                center: DVec3::new(10.0, 20.0, 30.0),
                radius: 5.0,
            },
            half_axes: [DVec3::X, DVec3::Y, DVec3::Z],
            smallest_spacing: 1.0,
            is_earth,
        });
        let of = |flags: &CameraFlags| flags.camera(&earth, [8, 6]).expect("a camera");
        let found = of(&CameraFlags::default());
        let frame = found.frame();
        assert!(frame.right.x > 0.8 && frame.up.z > 0.9, "{frame:?}");
        assert!(found.target.y - found.eye.y > 15.0, "{found:?}");
        // A word places the camera as it does everywhere.
        let side = CameraFlags {
            azimuth: Some(60.0),
            elevation: Some(15.0),
            ..CameraFlags::default()
        };
        let anything = CameraFlags::default().camera(&other, [8, 6]);
        assert_eq!(of(&side), anything.expect("a camera"));
        let roll = CameraFlags {
            roll: Some(9.0),
            ..CameraFlags::default()
        };
        assert_eq!(of(&roll).eye, found.eye);
    }
}
