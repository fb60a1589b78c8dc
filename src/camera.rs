//! Where the eye is and what it sees, in world space, f64.

use glam::DVec3;

/// A camera. `up` is not parallel to the direction from `eye` to `target`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Where rays start (orthographic: a point of the plane where they start).
    pub eye: DVec3,
    /// A point in the middle of the picture.
    pub target: DVec3,
    /// A direction that points up in the picture.
    pub up: DVec3,
    /// How rays spread.
    pub projection: Projection,
    /// Divides the picture plane; the eye stays.
    pub zoom: f64,
}

/// How rays spread.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// All rays start at the eye.
    Perspective {
        /// Full vertical angle.
        fov_degrees: f64,
    },
    /// All rays are parallel.
    Orthographic {
        /// World height of the picture.
        view_height: f64,
    },
}
