//! A volume among a host's spinning meshes: a ring that goes through it and around it, and stream lines of a field of the
//! host's own around the ring's axis, each hiding what lies behind it.
//!
//! ```sh
//! cargo run --release --example meshes -- folder [rays|slices] [frames]
//! ```
//!
//! `host.rs` is plain Vulkan; here is all that has to do with stratavox.

mod host;

use glam::dcamera::rh::{proj::vulkan, view::look_at_mat4};
use glam::{DMat3, DMat4, DQuat, DVec3, dvec3};
use host::{Corner, DEPTH_FORMAT, DepthFor, FORMAT, Host, QUEUE_FAMILY};
use std::f64::consts::TAU;
use std::{env, error::Error, path::Path, sync::Arc};
use stratavox::camera::{Camera, DepthConvention};
use stratavox::embed::{FrameInfo, HostDepthImage, Renderer, RendererDesc, SliceBlending, Volume};
use stratavox::embed::{Geometry, GeometryDesc};
use stratavox::flow::{Absence, Direction, Limits as LineLimits, Line, VectorField, stream_lines};
use stratavox::geometry::{RoundCones, Vertex};
use stratavox::gpu::{API_VERSION, Caps, DepthClass, Features, Gpu, HostDevice, TargetClass};
use stratavox::picture::ColorSpace;
use stratavox::technique::{Lattice, Settings, Shading, Technique};
use stratavox::transfer::{ColorPoint, Interpolation, OpacityPoint, TransferFunction};
use stratavox::volume::{self, Limits, TimeComponent, phantom};

const EXTENT: [u32; 2] = [480, 360];
const BACKGROUND: [f32; 4] = [0.02, 0.03, 0.05, 1.0];

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = env::args().skip(1).collect();
    let word = |k: usize, or: &str| words.get(k).map_or(or, String::as_str).to_owned();
    let technique = match word(1, "rays").as_str() {
        "rays" => Technique::Raycast,
        "slices" => Technique::Slices3d,
        other => return Err(format!("wanted rays or slices, found {other}").into()),
    };
    let (folder, frames) = (word(0, "meshes"), word(2, "24").parse()?);
    std::fs::create_dir_all(&folder)?;
    run(Path::new(&folder), technique, frames)
}

/// Draws a film of `frames` pictures into a folder.
pub fn run(folder: &Path, technique: Technique, frames: u32) -> Result<(), Box<dyn Error>> {
    // SAFETY: the handles belong together, and `film` has let go of them when the host is closed.
    unsafe {
        let host = Host::new(EXTENT)?;
        let drawn = film(&host, folder, technique, frames);
        host.close();
        drawn
    }
}

/// # Safety
/// The host's handles are valid.
unsafe fn film(
    host: &Host,
    folder: &Path,
    technique: Technique,
    frames: u32,
) -> Result<(), Box<dyn Error>> {
    let limits = Limits::default();
    let source = phantom::open("phantom:head,n=96", &limits)?;
    let region = source.header().whole();
    let voxels = volume::Volume::read(source.as_ref(), TimeComponent::default(), region, &limits)?;
    let grid = voxels.grid();
    let size = (grid.world_from_voxel.matrix3 * grid.far_corner()).length();
    let center = grid.center();
    let settings = Settings {
        technique,
        // Rays take the samples of view-aligned slices, so that both draw the same picture.
        lattice: Lattice::Planes,
        shading: Some(Shading::default()),
        ..Settings::default()
    };

    // SAFETY: the caller's promise; every frame is waited for.
    unsafe {
        let gpu = Gpu::from_host(handles(host))?;
        let mut volume = Volume::new(&gpu, &voxels, &settings)?;
        host.frame(|cmd| Ok(volume.record_upload(&gpu, cmd)?))?;
        let target = TargetClass {
            depth: Some(DepthClass {
                format: DEPTH_FORMAT,
                has_stencil: false,
                is_reversed: true,
            }),
            ..FORMAT.into()
        };
        let desc = GeometryDesc {
            target,
            color_space: ColorSpace::Linear,
            frames_in_flight: 1,
        };
        let mut lines = Geometry::new(&gpu, &lines(Whirl { center, size }).into(), desc)?;
        let class = RendererDesc {
            settings,
            target,
            frames_in_flight: 1,
            host_depth: true,
            gives_depth: false,
            picks: false,
            slice_blending: SliceBlending::Float,
        };
        let layout = DepthFor::Reading.state().2;
        let read = [HostDepthImage::new(host.depth_view, layout, EXTENT)];
        let (volume, function) = (Arc::new(volume), function());
        let mut renderer = Renderer::new(&gpu, &volume, Some(&function), class, EXTENT, &read)?;

        for frame in 0..frames {
            let part = f64::from(frame) / f64::from(frames);
            // The host's own matrices: reverse Z without a far plane.
            let eye = center + size * dvec3(0.2 * (TAU * part).sin() - 0.4, 1.05, 0.35);
            let view = look_at_mat4(eye, center, DVec3::Z);
            let [width, height] = EXTENT.map(f64::from);
            let clip = vulkan::perspective_infinite_reverse(0.6, width / height, 0.01 * size);
            let (camera, depth) = Camera::from_matrices(&view, &clip, DepthConvention::Reversed)?;
            let shot = FrameInfo {
                frame: 0,
                camera: &camera,
                depth: Some(depth),
            };
            let corners = ring(clip * view, center, size, part);
            host.frame(|cmd| {
                if frame == 0 {
                    lines.record_upload(cmd)?;
                }
                host.depth_barrier(cmd, DepthFor::Nothing, DepthFor::Rendering);
                host.begin_rendering(cmd, Some(BACKGROUND));
                host.draw(cmd, &corners);
                lines.draw(cmd, &shot, EXTENT)?;
                host.device.cmd_end_rendering(cmd);
                // The volume is seen as far as the meshes.
                host.depth_barrier(cmd, DepthFor::Rendering, DepthFor::Reading);
                renderer.record(cmd, &shot)?;
                host.depth_barrier(cmd, DepthFor::Reading, DepthFor::Rendering);
                host.begin_rendering(cmd, None);
                renderer.draw(cmd, 0)?;
                host.finish(cmd);
                Ok(())
            })?;
            let path = folder.join(format!("{frame:03}.png"));
            let color = image::ExtendedColorType::Rgba8;
            image::save_buffer(path, host.texels(), EXTENT[0], EXTENT[1], color)?;
        }
    }
    Ok(())
}

/// Flesh that bone shines through, in Hounsfield units; opacities are for the side of a voxel.
fn function() -> TransferFunction {
    let color = |value, srgb| ColorPoint { value, srgb };
    let opacity = |value, opacity| OpacityPoint { value, opacity };
    TransferFunction {
        color: vec![
            color(-200.0, [0.6, 0.3, 0.2]),
            color(150.0, [0.85, 0.5, 0.4]),
            color(500.0, [0.95, 0.9, 0.8]),
        ],
        opacity: vec![
            opacity(-300.0, 0.0),
            opacity(0.0, 0.03),
            opacity(200.0, 0.04),
            opacity(600.0, 0.6),
        ],
        reference_length: None,
        interpolation: Interpolation::Linear,
        gradient_transfer: None,
        medium: None,
    }
}

/// A field of the host's own: a whirl around a vertical axis, in a ball as large as the volume.
struct Whirl {
    center: DVec3,
    size: f64,
}

impl VectorField for Whirl {
    fn velocity(&self, _: f64, place: DVec3) -> Result<DVec3, Absence> {
        let from = place - self.center;
        let turning = DVec3::Z.cross(from) + 0.06 * self.size * DVec3::Z;
        let is_inside = from.length() < 0.5 * self.size;
        is_inside.then_some(turning).ok_or(Absence::Domain)
    }

    fn cells_from_world(&self) -> DMat3 {
        DMat3::from_diagonal(DVec3::splat(100.0 / self.size))
    }
}

/// Tubes along its lines through some places.
fn lines(field: Whirl) -> RoundCones {
    let seeds = [0.17, 0.25, 0.33, 0.41].map(|part| field.center + part * field.size * DVec3::X);
    let followed = stream_lines(&field, 0.0, &seeds, Direction::Both, &LineLimits::default());
    let mut cones = RoundCones::default();
    for piece in followed.iter().flat_map(Line::pieces) {
        cones.add_line(piece.iter().map(|vertex| Vertex {
            place: vertex.place,
            radius: 0.006 * field.size,
            color: [0.1, 0.6, 0.3],
        }));
    }
    cones
}

/// Triangles of a ring that turns around an axis through it, in clip space.
fn ring(clip_from_world: DMat4, center: DVec3, size: f64, part: f64) -> Vec<Corner> {
    const AROUND: u32 = 96;
    const ACROSS: u32 = 24;
    let turn = DQuat::from_rotation_z(TAU * part) * DQuat::from_rotation_x(0.9);
    let (radius, thickness) = (0.3 * size, 0.035 * size);
    let towards_light = dvec3(0.4, -0.7, 0.8).normalize();
    let corner = |i: u32, j: u32| {
        let [u, v] = [(i, AROUND), (j, ACROSS)].map(|(k, of)| TAU * f64::from(k) / f64::from(of));
        let out = dvec3(u.cos(), u.sin(), 0.0);
        let normal = turn * (v.cos() * out + v.sin() * DVec3::Z);
        let point = center + turn * (radius * out) + thickness * normal;
        let light = 0.15 + 0.85 * normal.dot(towards_light).max(0.0);
        let stripe = if (i / 8).is_multiple_of(2) {
            dvec3(0.8, 0.25, 0.05)
        } else {
            dvec3(0.1, 0.4, 0.7)
        };
        Corner {
            clip: (clip_from_world * point.extend(1.0)).as_vec4().to_array(),
            color: (light * stripe).as_vec3().to_array(),
        }
    };
    let square = |(i, j): (u32, u32)| {
        let corners = [(0, 0), (1, 0), (1, 1), (0, 0), (1, 1), (0, 1)];
        corners.map(|(a, b)| corner(i + a, j + b))
    };
    let squares = (0..AROUND).flat_map(|i| (0..ACROSS).map(move |j| (i, j)));
    squares.flat_map(square).collect()
}

/// What stratavox must know of the host's device. Vulkan cannot be asked what was enabled on it.
fn handles(host: &Host) -> HostDevice<'static> {
    HostDevice {
        get_instance_proc_addr: host.entry.static_fn().get_instance_proc_addr,
        instance: host.instance.handle(),
        physical_device: host.physical_device,
        device: host.device.handle(),
        queue_family: QUEUE_FAMILY,
        api_version: API_VERSION,
        features: Features {
            dynamic_rendering: true,
            synchronization2: true,
            ..Features::default()
        },
        debug_utils: false,
        caps: Caps::UNLIMITED,
        pipeline_cache: &[],
    }
}
