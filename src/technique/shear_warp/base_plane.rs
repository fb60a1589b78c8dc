//! The base plane of a view: a plane between the slices, whose points are the pixels of the intermediate image.
//!
//! ```text
//! base pixel (U, V)     u = (U + 1/2) / q, v = (V + 1/2) / q along the two axes of the plane, in voxels; U, V whole
//! its ray               perspective     from the eye e through b(u, v)
//!                       orthographic    along the view, from the plane through the eye
//! slices                n . x = (k + 1/2) h + c, n the unit normal of the slices away from the eye, h their distance
//! a picture's pixel     its ray v(t) = o + t d in voxel space meets the plane z at o + ((z - o_k) / d_k) d, so
//!                       (w U, w V, w) = s (q (d_k o_i + (z - o_k) d_i), .., d_k), linear in (x, y, 1), s the sign that
//!                       makes w positive before the eye
//! ```
//!
//! Both maps are projective, the second one is kept as a matrix. Lacroute and Levoy, "Fast Volume Rendering Using a
//! Shear-Warp Factorization of the Viewing Transformation", SIGGRAPH 1994.

use super::Intermediate;
use super::on_plane::{OnPlane, VoxelRays, whole_pixel_rays};
use crate::camera::Rays;
use crate::technique::stack_axis::{axes_across, stack_axis};
use crate::technique::{Error, Settings, View};
use crate::volume::Grid;
use glam::{DMat3, DVec2, DVec3};
use std::cmp::Ordering;

/// Base pixels around what a picture sees: of bilinear warps one, and one for rounding.
const MARGIN: f64 = 2.0;
/// What a host makes room for, beyond what parallel rays at any angle up to 45 degrees beside the slices need.
const ROOM: f64 = 1.25;
/// Base pixels along a side at most: rays that run beside the slices meet the plane anywhere.
const MOST_ACROSS: u32 = 1 << 14;

/// The rays of the intermediate image, its slices and its place in the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BasePlane {
    /// The axis across its slices.
    pub axis: usize,
    /// Base pixels per voxel.
    pub per_voxel: f64,
    /// The rays of base pixels in the centred world, as a camera has those of pixels.
    pub rays: Rays,
    /// Base pixels across and down.
    pub extent: [u32; 2],
    /// Where a pixel lies in the intermediate image: homogeneous, of (x, y, 1).
    pub base_from_pixel: DMat3,
    /// The distance of two heights with samples, world length.
    pub step_world: f64,
    /// Where they lie: n . x = (k + 1/2) `step_world` + this.
    pub offset_world: f64,
}

/// The base plane of a view.
///
/// # Errors
/// [`Error::EyeAmongSlices`], [`Error::IntermediateTooLarge`].
pub fn base_plane(view: &View) -> Result<BasePlane, Error> {
    let axis = stack_axis(view);
    let across = axes_across(axis);
    let [low, high] = view.domain();
    let height = 0.5 * (low[axis] + high[axis]);
    let of_pixels = VoxelRays::new(view, &whole_pixel_rays(view));
    of_pixels.check_eye(view, axis)?;
    let on_plane = OnPlane {
        axis,
        across,
        height,
    };
    let per_voxel = match view.settings.intermediate {
        Intermediate::PerVoxel(per_voxel) => per_voxel,
        Intermediate::Pixels => on_plane.pixels_per_voxel(&of_pixels, view.extent_pixels),
    };
    let seen = on_plane.seen(&of_pixels, [low, high], view.extent_pixels);
    let first = (seen[0] * per_voxel - 0.5).floor() - MARGIN;
    let last = (seen[1] * per_voxel - 0.5).ceil() + MARGIN;
    let extent = (last - first + 1.0).max(DVec2::ONE);
    if extent.max_element().partial_cmp(&MOST_ACROSS.into()) != Some(Ordering::Less) {
        return Err(Error::IntermediateTooLarge {
            wanted: extent.to_array(),
            limit: [MOST_ACROSS; 2],
        });
    }
    let in_pixel = VoxelRays::new(view, &view.rays());
    let rays = on_plane.rays(view, first, per_voxel);
    let (step_world, offset_world) = heights(view, axis, rays.forward);
    Ok(BasePlane {
        axis,
        per_voxel,
        rays,
        extent: extent.to_array().map(|n| n as u32),
        base_from_pixel: on_plane.base_from_pixel(&in_pixel, first, per_voxel),
        step_world,
        offset_world,
    })
}

/// Room for the intermediate images of a grid and a picture from wherever they are seen, base pixels across and down. Few
/// views ask for more: in perspective those from very near, and those of a stack that is not the one that faces the eye.
///
/// A parallel ray runs beside its main axis by at most as much as along it, in world lengths, so that the shadow of n_k
/// slices on the plane is longer than that by n_k times the ratio of spacings.
pub(crate) fn intermediate_room(
    grid: &Grid,
    settings: &Settings,
    extent_pixels: [u32; 2],
) -> [u32; 2] {
    let rows = grid.voxel_rows().map(|row| row.length());
    let of_axis = |axis: usize| {
        let slices = f64::from(grid.dims[axis]) / rows[axis];
        axes_across(axis).map(|i| f64::from(grid.dims[i]) + slices * rows[i])
    };
    let voxels = [0, 1, 2].map(of_axis);
    let largest = [0, 1].map(|side| voxels.iter().map(|v| v[side]).fold(0.0, f64::max));
    let room = match settings.intermediate {
        Intermediate::PerVoxel(per_voxel) => largest.map(|n| n * per_voxel),
        // As many as the picture has, whose diagonal may lie along either side.
        Intermediate::Pixels => {
            let [width, height] = extent_pixels.map(f64::from);
            [2.0 * width.hypot(height); 2]
        }
    };
    room.map(|n| ((ROOM * n + 2.0 * MARGIN + 2.0).ceil() as u32).min(MOST_ACROSS))
}

impl BasePlane {
    /// Half the longest piece of a base ray between two heights with samples, in voxels along each axis. In voxel space rays
    /// are affine in the base pixel, and all as steep along the axis: the longest is one of a corner.
    pub(crate) fn slab_reach(&self, view: &View) -> DVec3 {
        let voxel_from_world = view.world_from_voxel().inverse();
        let [width, height] = self.extent.map(f64::from);
        let corners = [[0.0, 0.0], [width, 0.0], [0.0, height], [width, height]];
        let steepness = corners.map(|[x, y]| {
            let rays = &self.rays;
            let world = rays.direction + x * rays.direction_dx + y * rays.direction_dy;
            let voxel = voxel_from_world.transform_vector3(world);
            (voxel / voxel[self.axis]).abs()
        });
        let steepest = steepness.into_iter().fold(DVec3::ZERO, DVec3::max);
        0.5 / view.settings.samples_per_voxel * steepest
    }

    /// Whether its image lies in one of so many base pixels.
    ///
    /// # Errors
    /// [`Error::IntermediateTooLarge`].
    pub(crate) fn check_room(&self, limit: [u32; 2]) -> Result<(), Error> {
        match self.extent[0] <= limit[0] && self.extent[1] <= limit[1] {
            true => Ok(()),
            false => Err(Error::IntermediateTooLarge {
                wanted: self.extent.map(f64::from),
                limit,
            }),
        }
    }
}

/// World distance of heights with samples, and their offset: slices lie at m + 1/2 in voxel space, the centre of the
/// world at n_k / 2. Slabs end at slices, and their middles lie half way between.
fn heights(view: &View, axis: usize, forward: DVec3) -> (f64, f64) {
    let per_slice = view.settings.samples_per_voxel;
    let row = view.grid.voxel_rows()[axis];
    let step = 1.0 / (row.length() * per_slice);
    let half_way = 0.5 * per_slice * f64::from(view.grid.dims[axis]);
    let between = if view.settings.preintegrated {
        0.5
    } else {
        0.0
    };
    // Heights (j + 1/2) / D are mirrored where the normal is.
    let offset = match row.dot(forward) > 0.0 {
        true => between - half_way,
        false => between + half_way,
    };
    (step, (offset - offset.floor()) * step)
}
