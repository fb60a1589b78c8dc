//! Where the eye is.

use super::settings::finite;
use super::status::{Failure, number};
use super::structure::{self, Versioned};
use crate::camera::{BoundingSphere, Camera, DepthConvention, HostDepth, Lens, Projection, View};
use crate::volume::Grid;
use glam::DMat4;
use std::ffi::c_void;

/// Where the eye is and what it sees, in the world. All zero: all of the volume from the front.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct sv_camera {
    /// `sizeof(sv_camera)`.
    pub struct_size: u32,
    /// NULL.
    pub next: *const c_void,
    /// sv_camera_kind.
    pub kind: u32,
    /// SV_CAMERA_MATRICES, not 0: the larger of two depths is nearer ("reverse Z").
    pub is_reversed: u32,
    /// SV_CAMERA_LOOK_AT: where rays start.
    pub eye: [f64; 3],
    /// SV_CAMERA_LOOK_AT: a point in the middle of the picture.
    pub target: [f64; 3],
    /// SV_CAMERA_LOOK_AT: what points up in the picture. All zero: z.
    pub up: [f64; 3],
    /// SV_CAMERA_LOOK_AT in perspective: the full vertical angle. 0 is 30.
    pub fov_degrees: f64,
    /// SV_CAMERA_LOOK_AT: the world height of the picture of parallel rays. 0: perspective.
    pub view_height: f64,
    /// SV_CAMERA_LOOK_AT: divides the picture plane. 0 is 1.
    pub zoom: f64,
    /// SV_CAMERA_MATRICES: a turn and a shift, as columns.
    pub view_from_world: [f64; 16],
    /// SV_CAMERA_MATRICES: perspective or orthographic, as columns, to Vulkan's clip space: y down, depth 0 to 1.
    pub clip_from_view: [f64; 16],
}

// SAFETY: as the trait wants it.
unsafe impl Versioned for sv_camera {
    const NAME: &'static str = "sv_camera";
}

const FOV_DEGREES: f64 = 30.0;

/// The camera, and of matrices what a depth buffer says.
///
/// # Safety
/// As [`structure::read`]; NULL is all zero.
pub(super) unsafe fn camera(
    pointer: *const sv_camera,
    grid: &Grid,
    extent: [u32; 2],
) -> Result<(Camera, Option<HostDepth>), Failure> {
    // SAFETY: the caller's promise.
    let c = unsafe { structure::read_or_zero(pointer)? };
    match c.kind {
        0 => Ok((fitted(grid, extent)?, None)),
        1 => Ok((look_at(&c)?, None)),
        2 => {
            let (camera, depth) = of_matrices(&c)?;
            Ok((camera, Some(depth)))
        }
        kind => Err(Failure::argument(format!(
            "sv_camera.kind: wanted 0 to 2, found {kind}"
        ))),
    }
}

/// The camera of matrices, and what its depth buffer says.
///
/// # Safety
/// As [`structure::read`].
pub(super) unsafe fn matrices(pointer: *const sv_camera) -> Result<(Camera, HostDepth), Failure> {
    // SAFETY: the caller's promise.
    let c = unsafe { structure::read_or_zero(pointer)? };
    match c.kind {
        2 => of_matrices(&c),
        kind => Err(Failure::argument(format!(
            "sv_camera.kind: geometry wants SV_CAMERA_MATRICES (2), found {kind}"
        ))),
    }
}

fn of_matrices(c: &sv_camera) -> Result<(Camera, HostDepth), Failure> {
    let nearer = match c.is_reversed {
        0 => DepthConvention::Standard,
        _ => DepthConvention::Reversed,
    };
    let [view, clip] = [c.view_from_world, c.clip_from_view];
    let [view, clip] = [view, clip].map(|columns| DMat4::from_cols_array(&columns));
    Ok(Camera::from_matrices(&view, &clip, nearer)?)
}

fn fitted(grid: &Grid, extent: [u32; 2]) -> Result<Camera, Failure> {
    let bounds = BoundingSphere::of_grid(&grid.world_from_voxel, grid.dims);
    let lens = Lens::Perspective {
        fov_degrees: FOV_DEGREES,
    };
    let front = View::Anterior.orbit();
    Ok(Camera::orbit(
        &bounds,
        bounds.center,
        front,
        None,
        lens,
        extent,
    )?)
}

fn look_at(c: &sv_camera) -> Result<Camera, Failure> {
    let or = |number: f64, default: f64| if number == 0.0 { default } else { number };
    let height = c.view_height;
    let is_height = height >= 0.0 && height.is_finite();
    number("sv_camera.view_height", "a length, or 0", height, is_height)?;
    let up = match c.up == [0.0; 3] {
        true => [0.0, 0.0, 1.0],
        false => c.up,
    };
    let camera = Camera {
        eye: finite("sv_camera.eye", c.eye)?,
        target: finite("sv_camera.target", c.target)?,
        up: finite("sv_camera.up", up)?,
        projection: match height > 0.0 {
            true => Projection::Orthographic {
                view_height: height,
            },
            false => Projection::Perspective {
                fov_degrees: or(c.fov_degrees, FOV_DEGREES),
            },
        },
        zoom: or(c.zoom, 1.0),
    };
    camera.check()?;
    Ok(camera)
}
