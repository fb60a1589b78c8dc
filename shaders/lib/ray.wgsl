// Rays and the part of them that lies in the domain (`sampling.md` 3).
//
// One parameter t, world length, in every space: directions are transformed and never normalized again.
// CPU reference: src/ray.rs.

#import frame
#import norm
#import in_pixel_{cuts=cut}
#import clipped_{cuts=cut}

struct Ray {
    origin: vec3<f32>,
    direction: vec3<f32>,
}

// The world ray of a pixel; the centre of pixel (0, 0) is (0.5, 0.5).
fn pixel_ray(pixel: vec2<f32>) -> Ray {
    let place = place_in_pixel(pixel);
    return Ray(
        frame.origin + place.x * frame.origin_dx + place.y * frame.origin_dy,
        direction_of(frame.direction + place.x * frame.direction_dx + place.y * frame.direction_dy),
    );
}

// The same ray in voxel space.
fn voxel_ray(world: Ray) -> Ray {
    return Ray(
        vec4(world.origin, 1.0) * frame.voxel_from_world,
        vec4(world.direction, 0.0) * frame.voxel_from_world,
    );
}

// Where the ray is in the domain: t from x (included) to y (excluded), x >= 0; empty unless x < y.
// Slabs: t = (face - origin) / direction on each axis (Kay and Kajiya 1986).
fn domain_interval(world: Ray, voxel: Ray) -> vec2<f32> {
    // 0 / 0 must not happen: a parallel ray gets a slope too small to matter.
    let tiny = vec3(1e-20);
    let direction = select(voxel.direction, tiny, abs(voxel.direction) < tiny);
    let at_min = (frame.domain_min - voxel.origin) / direction;
    let at_max = (frame.domain_max - voxel.origin) / direction;
    let enter = min(at_min, at_max);
    let leave = max(at_min, at_max);
    let interval = vec2(
        max(max(enter.x, enter.y), max(enter.z, 0.0)),
        min(min(leave.x, leave.y), leave.z),
    );
    return clipped(interval, world.origin, world.direction);
}

// How far the origin of a ray lies along the planes' normal, which they count from.
fn plane_height(world: Ray) -> f32 {
    return dot(frame.forward, world.origin) - frame.plane_offset;
}

// Where plane k of a lattice of planes meets the ray: forward . x = (k + 1/2) step + offset.
fn plane_t(world: Ray, k: i32) -> f32 {
    return ((f32(k) + 0.5) * frame.step_world - plane_height(world))
        / dot(frame.forward, world.direction);
}

// The length that a sample of the view-aligned lattice stands for.
fn plane_length(world: Ray) -> f32 {
    return frame.step_world / dot(frame.forward, world.direction);
}
