// A host's camera and depths, for geometry that it draws itself. Places count from a middle of the geometry's own, so that
// f32 keeps the same precision wherever it lies.
//
//     ray      o + x o_dx + y o_dy,  d + x d_dx + y d_dy made a unit vector, at (x, y) of the picture
//     pixel    of a place p:  (right . (p - o) / depth - right_start,  the same down),  depth forward . (p - o), or 1
//     depth    of the place t along a ray:  (z_0 + t z . d) / (w_0 + t w . d)
//
// z_0 and w_0 are the same for all rays, which begin at the eye, or on the near plane where they are parallel. The
// parameters are made in src/embed/geometry/view.rs.

#import color
#import norm

struct GeometryView {
    origin: vec3<f32>,
    is_perspective: u32,
    origin_dx: vec3<f32>,
    z_origin: f32,
    origin_dy: vec3<f32>,
    w_origin: f32,
    direction: vec3<f32>,
    // The row z - near w, which is 0 on the host's near plane, of all origins; and of directions.
    near_origin: f32,
    direction_dx: vec3<f32>,
    // The depth of the far plane.
    far: f32,
    direction_dy: vec3<f32>,
    color_space_is_display: u32,
    near: vec3<f32>,
    right_start: f32,
    forward: vec3<f32>,
    down_start: f32,
    right: vec3<f32>,
    down: vec3<f32>,
    z: vec3<f32>,
    w: vec3<f32>,
    extent_pixels: vec2<f32>,
    // Rows.
    clip_from_place: mat4x4<f32>,
}

@group(0) @binding(0) var<uniform> view: GeometryView;

struct Ray {
    origin: vec3<f32>,
    direction: vec3<f32>,
}

fn ray_at(pixel: vec2<f32>) -> Ray {
    return Ray(
        view.origin + pixel.x * view.origin_dx + pixel.y * view.origin_dy,
        direction_of(view.direction + pixel.x * view.direction_dx + pixel.y * view.direction_dy),
    );
}

// Where the host's near plane lies along a ray; 0 where that is behind its origin.
fn near_distance(ray: Ray) -> f32 {
    let rise = dot(view.near, ray.direction);
    return select(max(-view.near_origin / rise, 0.0), 0.0, rise == 0.0);
}

fn depth_at(ray: Ray, distance: f32) -> f32 {
    return (view.z_origin + distance * dot(view.z, ray.direction))
        / (view.w_origin + distance * dot(view.w, ray.direction));
}

// Whether a depth lies behind the far plane.
fn is_beyond_far(depth: f32) -> bool {
    return (depth - view.far) * (2.0 * view.far - 1.0) > 0.0;
}

// A linear colour as the target blends it.
fn opaque(linear: vec3<f32>) -> vec4<f32> {
    return vec4(select(linear, srgb_from_linear(linear), view.color_space_is_display != 0u), 1.0);
}
