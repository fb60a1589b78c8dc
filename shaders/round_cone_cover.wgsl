// A rectangle around all pixels that may see a round cone: the box of both of its spheres in the picture.
//
//     perspective   x / z of the two planes through the eye that touch a sphere:  (X Z -+ r sqrt(X^2 + Z^2 - r^2)) / (Z^2 - r^2)
//     parallel      X -+ r
//
// A sphere that comes near the plane of the eye may be seen anywhere. CPU reference: src/geometry/bounds.rs.

#import geometry_view
#import geometry_vertices

// What its corners hand to the fragments.
struct ConeCover {
    @builtin(position) position: vec4<f32>,
    // Centre and radius of both ends.
    @location(0) @interpolate(flat) first: vec4<f32>,
    @location(1) @interpolate(flat) second: vec4<f32>,
    @location(2) @interpolate(flat) first_color: vec3<f32>,
    @location(3) @interpolate(flat) second_color: vec3<f32>,
}

// Two triangles of low and high sides.
const CORNERS = array<vec2<u32>, 6>(
    vec2(0u, 0u),
    vec2(1u, 0u),
    vec2(0u, 1u),
    vec2(0u, 1u),
    vec2(1u, 0u),
    vec2(1u, 1u),
);
// What rounding may move a side by: pixels, and parts of its place.
const COVER_PIXELS: f32 = 1.0;
const COVER_PART: f32 = 1e-3;
// Where the plane of the eye is so near, in parts of all lengths there are, f32 does not tell where a sphere ends.
const LEAST_DEPTH_PART: f32 = 1e-3;

struct Sides {
    low: vec2<f32>,
    high: vec2<f32>,
    is_known: bool,
    is_behind: bool,
}

fn sides_of(sphere: vec4<f32>) -> Sides {
    let away = sphere.xyz - view.origin;
    let across = vec2(dot(away, view.right), dot(away, view.down));
    let scale = vec2(norm(view.right), norm(view.down));
    let start = vec2(view.right_start, view.down_start);
    if view.is_perspective == 0u {
        let reach = sphere.w * scale;
        return Sides(across - reach, across + reach, true, false);
    }
    let depth = dot(away, view.forward);
    let least = (depth - sphere.w) * (depth + sphere.w);
    let root = sphere.w * sqrt(max(across * across + least * scale * scale, vec2(0.0)));
    return Sides(
        (across * depth - root) / least - start,
        (across * depth + root) / least - start,
        depth - sphere.w > LEAST_DEPTH_PART * (norm(away) + sphere.w),
        depth + sphere.w <= 0.0,
    );
}

@vertex
fn main(@builtin(vertex_index) index: u32) -> ConeCover {
    let cone = index / 6u;
    let first = vertices.all[numbers.all[2u * cone]];
    let second = vertices.all[numbers.all[2u * cone + 1u]];
    let ends = array<vec4<f32>, 2>(
        vec4(first.place, first.radius),
        vec4(second.place, second.radius),
    );
    let a = sides_of(ends[0]);
    let b = sides_of(ends[1]);
    var low = min(a.low, b.low);
    var high = max(a.high, b.high);
    low = max(low - COVER_PIXELS - COVER_PART * abs(low), vec2(0.0));
    high = min(high + COVER_PIXELS + COVER_PART * abs(high), view.extent_pixels);
    if !(a.is_known && b.is_known) {
        low = vec2(0.0);
        high = view.extent_pixels;
    }
    if (a.is_behind && b.is_behind) || any(low >= high) {
        low = vec2(0.0);
        high = vec2(0.0);
    }
    let corner = CORNERS[index % 6u];
    let pixel = select(low, high, corner == vec2(1u));
    let clip = 2.0 * pixel / view.extent_pixels - 1.0;
    return ConeCover(vec4(clip, 0.5, 1.0), ends[0], ends[1], first.color, second.color);
}
