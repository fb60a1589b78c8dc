//! How far slabs reach: the pieces of a ray that pre-integrated classification takes for samples.
//!
//! ```text
//! equal steps         h / 2 to both ends from the middle
//! planes              h / (2 cos phi), phi the angle of the ray to the forward direction
//! stack along k       1 / (2 n) of a slice along k, and that times tan of the ray's angle to the axis beside it
//! base plane          the same of its rays
//! ```
//!
//! Slicers draw covers in the middle of slabs: they are larger than the domain by as much, and those around the eye
//! are the whole picture. Bricks hold as many voxels more.
//!
//! A segment between two ends of an isosurface's ray belongs to the brick of its far end and reaches a whole step out
//! of it; filter and gradient must find their voxels from there. Bricks hold three voxels around their own.

use super::slices_2d::{planes_per_slice, stack_axis};
use super::{Error, Filter, Mode, View};
use crate::shaders::FrameFields;
use glam::DVec3;

/// Voxels that a brick holds around its own, less the half that linear interpolation takes.
const LONGEST_REACH: f64 = 1.5;
/// Rays that run steeper beside a stack than this see covers as large as the picture.
const STEEPEST: f64 = 8.0;
/// A plane of a stack that the eye lies in this close has no picture of its own.
const EYE_IN_PLANE: f64 = 0.01;

/// How far a cover lies from what it covers.
pub(super) struct CoverReach {
    /// Voxels along each axis.
    pub voxels: DVec3,
    /// From the eye: voxels along a stack, world length for planes.
    pub eye: f32,
}

impl View<'_> {
    /// Half the longest slab, in voxels along each axis.
    pub(super) fn slab_reach(&self) -> DVec3 {
        let rays = self.rays();
        let [width, height] = self.extent_pixels.map(f64::from);
        let corners = [[0.0, 0.0], [width, 0.0], [0.0, height], [width, height]];
        // Of depth 1 along the forward direction; in a picture they lie between those of its corners.
        let corners =
            corners.map(|[x, y]| rays.direction + x * rays.direction_dx + y * rays.direction_dy);
        let rows = self.grid.voxel_rows();
        match self.base_plane() {
            Ok(Some(base)) => return base.slab_reach(self),
            Ok(None) => {}
            // What is refused is not drawn.
            Err(_) => return DVec3::INFINITY,
        }
        if !self.settings.technique.draws_stacks() {
            let is_on_planes = !self.settings.technique.casts_rays()
                || self.settings.lattice == super::Lattice::Planes;
            let longest = match is_on_planes {
                true => corners.map(DVec3::length).into_iter().fold(1.0, f64::max),
                false => 1.0,
            };
            let half = 0.5 * self.step_world() * longest;
            return half * DVec3::from_array(rows.map(|row| row.length()));
        }
        let axis = stack_axis(self);
        let half = 0.5 / f64::from(planes_per_slice(self, axis));
        let turned = corners.map(|ray| DVec3::from_array(rows.map(|row| row.dot(ray))));
        let rises = turned[0][axis] > 0.0;
        let steepness = |j: usize| {
            let of_ray = |ray: &DVec3| match (ray[axis] > 0.0) == rises && ray[axis] != 0.0 {
                true => (ray[j] / ray[axis]).abs(),
                false => f64::INFINITY,
            };
            turned.iter().map(of_ray).fold(0.0, f64::max)
        };
        DVec3::from_array([0, 1, 2].map(|j| half * if j == axis { 1.0 } else { steepness(j) }))
    }

    /// How many voxels away from its brick a value and its gradient find what they are made of: of the voxels around,
    /// one is for the gradient, and what is left is half a voxel less than the filter's own half width.
    fn longest_segment(&self) -> f64 {
        match self.settings.filter {
            Filter::Nearest => 2.0,
            Filter::Linear => 1.5,
            Filter::Quadratic | Filter::QuadraticSmooth => 1.0,
            Filter::Cubic | Filter::CubicSmooth | Filter::CatmullRom => 0.5,
        }
    }

    /// How much larger than the domain covers are.
    pub(super) fn cover_reach(&self) -> CoverReach {
        let is_stack = self.settings.technique.draws_stacks();
        if !self.settings.preintegrated {
            return CoverReach {
                voxels: DVec3::ZERO,
                eye: if is_stack { EYE_IN_PLANE as f32 } else { 0.0 },
            };
        }
        let voxels = self.slab_reach();
        let is_perspective = self.camera.projection.is_perspective();
        let eye = match (is_stack, is_perspective) {
            (true, _) if !voxels.cmplt(DVec3::splat(STEEPEST)).all() => f64::from(f32::MAX),
            (true, true) => voxels[stack_axis(self)] + EYE_IN_PLANE,
            // A little more than half a step, against rounding.
            (_, true) => 0.51 * self.step_world(),
            (_, false) => 0.0,
        };
        CoverReach {
            voxels: voxels.min(DVec3::splat(STEEPEST)),
            eye: eye as f32,
        }
    }

    /// Whether the bricks hold all that slabs reach.
    ///
    /// # Errors
    /// [`Error::SlabsTooLong`].
    pub(super) fn check_slabs(&self, brick_count: usize) -> Result<(), Error> {
        if brick_count < 2 {
            return Ok(());
        }
        let half = self.slab_reach().max_element();
        let (what, reach, limit) = match self.settings.mode {
            Mode::Iso => (
                "segments between samples",
                2.0 * half,
                self.longest_segment(),
            ),
            _ if self.settings.preintegrated => ("pre-integrated samples", half, LONGEST_REACH),
            _ => return Ok(()),
        };
        if reach <= limit {
            return Ok(());
        }
        Err(Error::SlabsTooLong { what, reach, limit })
    }

    /// Fills in what planes between the slices of a stack need.
    pub(super) fn set_between(&self, fields: &mut FrameFields) {
        let axis = stack_axis(self);
        fields.planes_per_slice = planes_per_slice(self, axis) as f32;
        fields.cover_offset = if self.settings.preintegrated {
            0.5
        } else {
            0.0
        };
    }
}
