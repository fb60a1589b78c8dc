//! Rays and the part of them that lies in the domain: CPU reference of `shaders/lib/ray.wgsl` (`sampling.md` 3).
//!
//! One parameter t, world length, in every space: directions are transformed and never normalized again.

use crate::real::{Real, add, dot, scale};
use crate::shaders::Frame;

/// A ray; where `t` is world length the direction is whatever a unit vector of the world became.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs, reason = "the line above says it")]
pub struct Ray<R> {
    pub origin: [R; 3],
    pub direction: [R; 3],
}

impl<R: Real> Ray<R> {
    /// The point at `t`.
    pub fn at(&self, t: R) -> [R; 3] {
        add(self.origin, scale(self.direction, t))
    }
}

/// Where in a pixel its ray goes through: the centre that is given, or a place in a square around it that depends on
/// the pixel. CPU reference of `in_pixel.wgsl`.
pub fn place_in_pixel<R: Real>(frame: &Frame, pixel: [R; 2]) -> [R; 2] {
    if frame.is_uneven == 0 {
        return pixel;
    }
    let moved = in_cell(frame, pixel.map(|x| x.to_i32() as u32));
    std::array::from_fn(|k| pixel[k] + R::from_f32(moved[k]))
}

fn in_cell(frame: &Frame, [x, y]: [u32; 2]) -> [f32; 2] {
    let step = |v: u32| v.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
    let [mut x, mut y, mut z] = [x, y, frame.cell_seed].map(step);
    x = x.wrapping_add(y.wrapping_mul(z));
    y = y.wrapping_add(z.wrapping_mul(x));
    z = z.wrapping_add(x.wrapping_mul(y));
    [x, y, z] = [x, y, z].map(|v| v ^ v >> 16);
    x = x.wrapping_add(y.wrapping_mul(z));
    y = y.wrapping_add(z.wrapping_mul(x));
    [x, y].map(|v| ((v >> 8) as f32 / 16_777_216.0 - 0.5) * frame.cell_pixels)
}

/// The world ray of a pixel; the centre of pixel (0, 0) is (0.5, 0.5).
pub fn pixel_ray<R: Real>(frame: &Frame, pixel: [R; 2]) -> Ray<R> {
    let pixel = place_in_pixel(frame, pixel);
    let along = |start: [f32; 3], dx: [f32; 3], dy: [f32; 3]| {
        let moved = add(vector(start), scale(vector(dx), pixel[0]));
        add(moved, scale(vector(dy), pixel[1]))
    };
    let direction = along(frame.direction, frame.direction_dx, frame.direction_dy);
    Ray {
        origin: along(frame.origin, frame.origin_dx, frame.origin_dy),
        direction: scale(
            direction,
            R::from_f64(1.0) / dot(direction, direction).sqrt(),
        ),
    }
}

/// The same ray in voxel space.
pub fn voxel_ray<R: Real>(frame: &Frame, world: &Ray<R>) -> Ray<R> {
    let rows = frame.voxel_from_world;
    let turned = |v: [R; 3]| rows.map(|[x, y, z, _]| dot(v, vector([x, y, z])));
    let moved = rows.map(|row| R::from_f32(row[3]));
    Ray {
        origin: add(turned(world.origin), moved),
        direction: turned(world.direction),
    }
}

/// Where the ray is in the domain: t from the first (included) to the second (excluded), at least 0;
/// empty unless the first is less. Slabs on each axis (Kay and Kajiya 1986).
pub fn domain_interval<R: Real>(frame: &Frame, world: &Ray<R>, voxel: &Ray<R>) -> [R; 2] {
    let (low, high) = (vector::<R>(frame.domain_min), vector::<R>(frame.domain_max));
    let tiny = R::from_f32(1e-20);
    let mut interval = [R::from_f64(0.0), R::from_f64(f64::INFINITY)];
    for k in 0..3 {
        // 0 / 0 must not happen: a parallel ray gets a slope too small to matter.
        let slope = voxel.direction[k];
        let slope = if slope.abs() < tiny { tiny } else { slope };
        let at_min = (low[k] - voxel.origin[k]) / slope;
        let at_max = (high[k] - voxel.origin[k]) / slope;
        interval = [
            interval[0].max(at_min.min(at_max)),
            interval[1].min(at_min.max(at_max)),
        ];
    }
    let planes = &frame.clip_planes[..frame.clip_plane_count as usize];
    planes.iter().fold(interval, |interval, plane| {
        clip_interval(interval, plane, world)
    })
}

/// The parameters of a pixel whose ray ends where its depth is `depth`: `host_z` becomes the row z - depth w, which is 0 there.
pub fn before_depth(frame: &Frame, depth: f32) -> Frame {
    let [z, w] = [frame.host_z, frame.host_w];
    let mut own = *frame;
    own.host_z = std::array::from_fn(|k| z[k] - depth * w[k]);
    own
}

/// The part of an interval that ends there: CPU reference of `shaders/lib/host_depth.wgsl`, for a host whose near plane cuts
/// nothing.
pub fn visible_interval<R: Real>(frame: &Frame, [t0, t1]: [R; 2], world: &Ray<R>) -> [R; 2] {
    if frame.has_host_depth == 0 {
        return [t0, t1];
    }
    let [x, y, z, w] = frame.host_z;
    let rise = dot(vector([x, y, z]), world.direction);
    if rise == R::from_f64(0.0) {
        return [t0, t1];
    }
    let t = -(dot(vector([x, y, z]), world.origin) + R::from_f32(w)) / rise;
    [t0, t1.min(t)]
}

/// Keeps the part of the interval with dot(plane.xyz, point) >= plane.w.
fn clip_interval<R: Real>(interval: [R; 2], &[x, y, z, w]: &[f32; 4], world: &Ray<R>) -> [R; 2] {
    let height = dot(vector([x, y, z]), world.origin) - R::from_f32(w);
    let slope = dot(vector([x, y, z]), world.direction);
    let [t0, t1] = interval;
    if slope.abs() < R::from_f32(1e-20) {
        return if height >= R::from_f64(0.0) {
            interval
        } else {
            [t0, t0]
        };
    }
    let t = -height / slope;
    if slope > R::from_f64(0.0) {
        [t0.max(t), t1]
    } else {
        [t0, t1.min(t)]
    }
}

/// How far the origin of a ray lies along the planes' normal, which they count from.
pub fn plane_height<R: Real>(frame: &Frame, world: &Ray<R>) -> R {
    dot(vector(frame.forward), world.origin) - R::from_f32(frame.plane_offset)
}

/// Where plane k of a lattice of planes meets the ray: forward . x = (k + 1/2) step + offset.
pub fn plane_t<R: Real>(frame: &Frame, world: &Ray<R>, k: i32) -> R {
    let height = (R::from_f64(f64::from(k)) + R::from_f64(0.5)) * R::from_f32(frame.step_world);
    let forward = vector(frame.forward);
    (height - plane_height(frame, world)) / dot(forward, world.direction)
}

/// The length that a sample of the view-aligned lattice stands for.
pub fn plane_length<R: Real>(frame: &Frame, world: &Ray<R>) -> R {
    R::from_f32(frame.step_world) / dot(vector(frame.forward), world.direction)
}

/// A vector of the parameters, in the CPU reference's precision.
pub fn vector<R: Real>(v: [f32; 3]) -> [R; 3] {
    v.map(R::from_f32)
}
