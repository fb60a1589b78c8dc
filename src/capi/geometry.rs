//! Round cones and triangles that are drawn in the host's own rendering.

use super::camera::matrices;
use super::device::{Device, sv_device};
use super::handles::{self, Kind};
use super::images::{MOST_FRAMES, sv_target_class, target_class};
use super::record::sv_frame_info;
use super::renderer::extent;
use super::settings::finite;
use super::status::{Failure, guard, number, reserved, sv_diagnostic, sv_status};
use super::structure::{self, Versioned};
use super::volume::commands;
use super::words::word;
use crate::color::ColorSpace;
use crate::embed::{self, FrameInfo, GeometryDesc};
use crate::geometry::{Corner, Geometry, Vertex};
use crate::named::Named;
use std::ffi::c_void;
use std::sync::Mutex;

/// Round cones and triangles on a device. 0 is none.
pub type sv_geometry = u64;

/// The hull of two spheres: a piece of a tube, an arrow's head, a sphere where both ends are the same.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct sv_round_cone {
    /// Middle of the first sphere, world.
    pub first: [f64; 3],
    /// Of the second.
    pub second: [f64; 3],
    /// World length, over 0.
    pub first_radius: f64,
    /// Of the second.
    pub second_radius: f64,
    /// Linear red, green and blue; it is lit from the eye.
    pub first_color: [f32; 3],
    /// Of the second: colours go straight from one to the other.
    pub second_color: [f32; 3],
}

/// A triangle that is seen from both sides, in colours as they are.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct sv_triangle {
    /// Corners, world.
    pub corners: [[f64; 3]; 3],
    /// Linear red, green and blue of each.
    pub colors: [[f32; 3]; 3],
    /// 0.
    pub reserved: u32,
}

/// What geometry is made of and for.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct sv_geometry_desc {
    /// `sizeof(sv_geometry_desc)`.
    pub struct_size: u32,
    /// NULL.
    pub next: *const c_void,
    /// What is drawn into, with a depth attachment.
    pub target: *const sv_target_class,
    /// sv_color_space.
    pub color_space: u32,
    /// Frames of the host that may be unfinished at once, at most 64. 0 is 1.
    pub frames_in_flight: u32,
    /// They are copied before the call returns.
    pub cones: *const sv_round_cone,
    /// How many there are.
    pub cone_count: u64,
    /// They are copied before the call returns.
    pub triangles: *const sv_triangle,
    /// How many there are.
    pub triangle_count: u64,
}

// SAFETY: as the trait wants it.
unsafe impl Versioned for sv_geometry_desc {
    const NAME: &'static str = "sv_geometry_desc";
}

/// One thread at a time.
struct Held(Mutex<embed::Geometry>);

impl Kind for Held {
    const NUMBER: u64 = 8;
    const NAME: &'static str = "sv_geometry";
}

/// More shapes have no 32-bit numbers for their vertices.
const MOST_SHAPES: u64 = 1 << 29;

fn with(
    handle: sv_geometry,
    body: impl FnOnce(&Device, &mut embed::Geometry) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let (device, held) = handles::find::<Held>(handle)?;
    let mut geometry = handles::only(Held::NAME, &held.0)?;
    device.run(|| body(&device, &mut geometry))
}

/// Makes buffers, pipelines and all else that draws will need. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sv_geometry_create(
    device: sv_device,
    desc: *const sv_geometry_desc,
    geometry: *mut sv_geometry,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let body = || {
        structure::out("the place of the sv_geometry", geometry)?;
        let device = handles::device(device)?;
        device.run(|| {
            // SAFETY: the caller's promise.
            let made = unsafe { made(&device, &structure::read(desc)?)? };
            let handle = handles::add(&device, Held(Mutex::new(made)))?;
            // SAFETY: not NULL; the caller's promise.
            unsafe { geometry.write(handle) };
            Ok(())
        })
    };
    // SAFETY: the caller's promise.
    unsafe { guard(diagnostic, body) }
}

/// Records the upload, once. What it is staged in is freed by sv_device_retire, if sv_device_announce came before.
///
/// `command_buffer` (`VkCommandBuffer`) is recording, outside rendering, and is submitted before what draws the geometry.
/// Threads: one at a time for one geometry.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sv_geometry_record_upload(
    geometry: sv_geometry,
    command_buffer: *mut c_void,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let body = || {
        with(geometry, |_, geometry| {
            let cmd = commands(command_buffer)?;
            // SAFETY: the caller's promise.
            unsafe { Ok(geometry.record_upload(cmd)?) }
        })
    };
    // SAFETY: the caller's promise.
    unsafe { guard(diagnostic, body) }
}

/// Draws all of it where it is not behind what the host has drawn so far, and writes its depth: volumes whose renderers read
/// that depth (`has_host_depth`) end there. Its camera is of SV_CAMERA_MATRICES. Bound pipeline, descriptor set 0, viewport and
/// scissor are ours afterwards.
///
/// `command_buffer` is inside rendering to a target of the geometry's class, of so many pixels, after
/// sv_geometry_record_upload; depth may be written. Nothing unfinished was drawn with the same `frame` of `shot`.
/// Threads: one at a time for one geometry.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sv_geometry_draw(
    geometry: sv_geometry,
    command_buffer: *mut c_void,
    shot: *const sv_frame_info,
    width: u32,
    height: u32,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let body = || {
        with(geometry, |device, geometry| {
            let cmd = commands(command_buffer)?;
            let extent = extent(device, [width, height])?;
            // SAFETY: the caller's promise.
            let (shot, (camera, depth)) = unsafe {
                let shot = structure::read(shot)?;
                (shot, matrices(shot.camera)?)
            };
            reserved("sv_frame_info.reserved", shot.reserved)?;
            let shot = FrameInfo {
                frame: shot.frame,
                camera: &camera,
                depth: Some(depth),
            };
            // SAFETY: the caller's promise.
            unsafe { Ok(geometry.draw(cmd, &shot, extent)?) }
        })
    };
    // SAFETY: the caller's promise.
    unsafe { guard(diagnostic, body) }
}

/// Destroys the handle; what frames in flight use is freed by sv_device_retire. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sv_geometry_destroy(
    geometry: sv_geometry,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let body = || handles::remove::<Held>(geometry).map(drop);
    // SAFETY: the caller's promise.
    unsafe { guard(diagnostic, body) }
}

/// # Safety
/// As [`structure::read`] of all that `desc` points to.
unsafe fn made(device: &Device, desc: &sv_geometry_desc) -> Result<embed::Geometry, Failure> {
    // SAFETY: the caller's promise.
    let (target, cones, triangles) = unsafe {
        let target = structure::read(desc.target)?;
        let cones = ("sv_geometry_desc.cones", desc.cones, desc.cone_count);
        let triangles = (
            "sv_geometry_desc.triangles",
            desc.triangles,
            desc.triangle_count,
        );
        (
            target_class(&target)?,
            structure::array(cones.0, cones.1, cones.2, MOST_SHAPES)?,
            structure::array(triangles.0, triangles.1, triangles.2, MOST_SHAPES)?,
        )
    };
    let frames = desc.frames_in_flight.max(1);
    if frames > MOST_FRAMES {
        let doing = "keep frames in flight";
        return Err(Failure::limit(doing, frames.into(), MOST_FRAMES.into()));
    }
    let mut shapes = Geometry::default();
    for cone in cones {
        let end = |name: &str, place, radius: f64, color| {
            let name = format!("sv_round_cone.{name}");
            let is_length = radius > 0.0 && radius.is_finite();
            number(&format!("{name}_radius"), "over 0", radius, is_length)?;
            Ok::<_, Failure>(Vertex {
                place: finite(&name, place)?,
                radius,
                color,
            })
        };
        let first = end("first", cone.first, cone.first_radius, cone.first_color)?;
        let second = end("second", cone.second, cone.second_radius, cone.second_color)?;
        shapes.cones.add_line([first, second]);
    }
    for triangle in triangles {
        reserved("sv_triangle.reserved", triangle.reserved)?;
        let mut corners = [Corner {
            place: Default::default(),
            color: [0.0; 3],
        }; 3];
        for (k, corner) in corners.iter_mut().enumerate() {
            corner.place = finite("sv_triangle.corners", triangle.corners[k])?;
            corner.color = triangle.colors[k];
        }
        shapes.triangles.add(&corners, [[0, 1, 2]]);
    }
    let desc = GeometryDesc {
        target,
        color_space: word(
            "sv_geometry_desc.color_space",
            ColorSpace::ALL,
            desc.color_space,
        )?,
        frames_in_flight: frames,
    };
    Ok(embed::Geometry::new(&device.gpu, &shapes, desc)?)
}
