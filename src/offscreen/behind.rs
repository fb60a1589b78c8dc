//! Opaque geometry in a picture: what rays find in the volume before it, over its own colour.
//!
//! ```text
//! rays and slices end at it     picture = volume + (1 - alpha) geometry
//! modes that project            have no order along a ray: the geometry lies over the picture
//! clip planes                   cut the geometry too, and their cuts through it are seen
//! ```
//!
//! Where it is comes to a technique as the depth buffer of a host would. In perspective n / depth along the line of sight,
//! or (far - depth) / (far - near) in parallel, is what slices are tested against by the device: both lie in 0 to 1.

use crate::camera::{DepthConvention, HostDepth};
use crate::color::encode_srgb;
use crate::geometry::{Geometry, Seen};
use crate::named::Named;
use crate::picture::{ColorSpace, Layer, LayerKind, Picture};
use crate::real::Real;
use crate::scene::{Scene, positions_in_pixel};
use crate::technique::{self, ClipPlane, DepthAccess, InPixel, Settings};
use glam::{DVec3, DVec4, Vec3};

/// A depth that is as good as infinite, and that f32 can multiply.
const NOTHING: f64 = 1e30;

/// Of slices in perspective: the depth that is 1, as a part of that of the farthest corner.
const NEAREST: f64 = 1e-6;

/// Of slices in parallel projection: what lies between the depths 0 and 1 beyond both ends of the volume, as a part of it.
const MARGIN: f64 = 1.0 / 64.0;

/// Whether pictures of these settings can show geometry.
///
/// # Errors
/// [`technique::Error::NotFor`].
pub fn check_geometry(settings: &Settings) -> Result<(), technique::Error> {
    let refuse = |found: &str| {
        Err(technique::Error::NotFor {
            wanted: "geometry in the picture",
            of: "rays or slices that end where it is drawn",
            found: found.to_owned(),
        })
    };
    let technique = settings.technique;
    match () {
        () if technique.is_warped() || technique.traces_paths() => refuse(technique.name()),
        () if settings.has_balls() => refuse("splats of points"),
        () if settings.is_half_angle() => refuse("half-angle slices"),
        () if settings.uneven_rays => refuse("rays at uneven places"),
        () => Ok(()),
    }
}

/// What of the geometry is seen through this place in each pixel.
pub(super) fn seen(geometry: &Geometry, scene: &Scene, in_pixel: InPixel) -> Seen {
    let planes = scene.settings.clip_planes.iter().map(ClipPlane::unit);
    let planes: Vec<_> = planes.collect();
    geometry.seen_cut(scene.camera, scene.extent_pixels, in_pixel.at, &planes)
}

/// The depths that the technique of a scene asks for.
pub(super) fn host_depth(scene: &Scene) -> HostDepth {
    match access(scene.settings) {
        DepthAccess::Tested => in_unit_range(scene),
        DepthAccess::None | DepthAccess::Sampled => line_of_sight(scene),
    }
}

/// How a technique comes to know of them.
pub(super) fn access(settings: &Settings) -> DepthAccess {
    match settings.technique.casts_rays() {
        true => DepthAccess::Sampled,
        false => DepthAccess::behind(settings),
    }
}

/// Depths that are distances along the line of sight.
pub(super) fn line_of_sight(scene: &Scene) -> HostDepth {
    HostDepth {
        z: depth_row(scene),
        w: DVec4::W,
        nearer: DepthConvention::Standard,
    }
}

/// Depths between 0 and 1, the nearer the larger, everywhere in the volume before the eye.
fn in_unit_range(scene: &Scene) -> HostDepth {
    let row = depth_row(scene);
    let grid = scene.volume.grid();
    let corners = (0..8_u32).map(|corner| {
        let at = DVec3::from_array([0, 1, 2].map(|k| f64::from(corner >> k & 1)));
        let place = grid
            .world_from_voxel
            .transform_point3(at * grid.far_corner());
        row.dot(place.extend(1.0))
    });
    let (near, far) = corners.fold((f64::INFINITY, f64::NEG_INFINITY), |(near, far), depth| {
        (near.min(depth), far.max(depth))
    });
    let nearer = DepthConvention::Reversed;
    match scene.camera.rays(scene.extent_pixels).origin_dx == DVec3::ZERO {
        true => {
            let far = if far > 0.0 { far } else { 1.0 };
            let z = NEAREST * far * DVec4::W;
            HostDepth { z, w: row, nearer }
        }
        false => {
            let length = (1.0 + 2.0 * MARGIN) * (far - near);
            let far = far + MARGIN * (far - near);
            let z = (far * DVec4::W - row) / length;
            let w = DVec4::W;
            HostDepth { z, w, nearer }
        }
    }
}

/// The depth of a point of the world along the line of sight.
fn depth_row(scene: &Scene) -> DVec4 {
    let forward = scene.camera.frame().forward;
    forward.extend(-forward.dot(scene.camera.eye))
}

/// The depth of each pixel.
pub(super) fn depths(depth: &HostDepth, scene: &Scene, in_pixel: InPixel, seen: &Seen) -> Vec<f32> {
    let extent = scene.extent_pixels;
    let rays = scene.camera.rays(extent);
    let of = |(i, &distance): (usize, &f64)| {
        if !distance.is_finite() {
            return match depth.nearer {
                DepthConvention::Standard => NOTHING as f32,
                DepthConvention::Reversed => 0.0,
            };
        }
        let [x, y] = [i % extent[0] as usize, i / extent[0] as usize].map(|n| n as f64 + 0.5);
        let (origin, direction) = rays.at(x + in_pixel.at[0], y + in_pixel.at[1]);
        let found = depth.of(origin + distance * direction);
        match depth.nearer {
            DepthConvention::Standard => found as f32,
            DepthConvention::Reversed => found.clamp(0.0, 1.0) as f32,
        }
    };
    seen.distances.iter().enumerate().map(of).collect()
}

/// Puts what is seen behind the pixels of a volume.
pub(super) fn put<R: Real>(seen: &Seen, pixels: &mut [[R; 4]], space: ColorSpace) {
    for (pixel, own) in pixels.iter_mut().zip(&seen.pixels) {
        if own[3] == 0.0 {
            continue;
        }
        let [r, g, b, a] = own.map(R::from_f32);
        let own = match space {
            ColorSpace::Linear => [r, g, b, a],
            ColorSpace::Display => [encode_srgb(r), encode_srgb(g), encode_srgb(b), a],
        };
        let through = R::from_f64(1.0) - pixel[3];
        *pixel = std::array::from_fn(|c| pixel[c] + through * own[c]);
    }
}

/// Which lines are seen through the middles of pixels.
pub(super) fn lines(geometry: &Geometry, scene: &Scene) -> Layer {
    let seen = seen(geometry, scene, InPixel::CENTER);
    Layer {
        kind: LayerKind::Line,
        values: seen.lines.iter().map(|&line| line as f32).collect(),
    }
}

/// Where geometry is met before what is seen of the volume, depths and positions become its own: the nearer of both.
pub(super) fn bring_nearer(geometry: &Geometry, scene: &Scene, layers: &mut [Layer]) {
    let is_place = |layer: &Layer| matches!(layer.kind, LayerKind::Depth | LayerKind::Position);
    if !layers.iter().any(is_place) {
        return;
    }
    let seen = seen(geometry, scene, InPixel::CENTER);
    let rays = scene.camera.rays(scene.extent_pixels);
    let width = scene.extent_pixels[0] as usize;
    for layer in layers.iter_mut().filter(|layer| is_place(layer)) {
        let numbers = layer.kind.numbers();
        let of_pixels = layer.values.chunks_exact_mut(numbers).zip(&seen.distances);
        for (i, (own, &distance)) in of_pixels.enumerate() {
            let [x, y] = [i % width, i / width].map(|n| n as f64 + 0.5);
            let (origin, direction) = rays.at(x, y);
            let of_volume = match *own {
                [depth] => f64::from(depth),
                _ => (Vec3::from_slice(own).as_dvec3() - origin).dot(direction),
            };
            // Nothing of the volume is NaN, which is not nearer; nothing of the geometry is infinite.
            if distance.is_finite() && (of_volume.is_nan() || of_volume > distance) {
                match own {
                    [depth] => *depth = distance as f32,
                    _ => (origin + distance * direction)
                        .as_vec3()
                        .write_to_slice(own),
                }
            }
        }
    }
}

/// Lays what `look` sees through each place in the pixels over a picture.
pub(super) fn put_over(scene: &Scene, picture: &mut Picture, look: impl Fn(InPixel) -> Seen) {
    let share = 1.0 / scene.settings.rays_per_side.pow(2) as f32;
    let mut over = vec![[0.0; 4]; picture.pixels.len()];
    for in_pixel in positions_in_pixel(scene.settings) {
        let mut own = vec![[0.0_f32; 4]; over.len()];
        put(&look(in_pixel), &mut own, scene.settings.color_space);
        for (sum, own) in over.iter_mut().zip(own) {
            *sum = std::array::from_fn(|c| sum[c] + share * own[c]);
        }
    }
    for (pixel, over) in picture.pixels.iter_mut().zip(over) {
        *pixel = std::array::from_fn(|c| over[c] + (1.0 - over[3]) * pixel[c]);
    }
}
