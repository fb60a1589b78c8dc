// All rays of a tile at once: see shaders/ray_tiles.wgsl.

#import frame
#import norm
#import ray_tile

// Every ray goes half a voxel and a part of its way beside where f32 says, at most.
const SLACK_VOXELS: f32 = 0.5;
const SLACK: f32 = 1e-6;
const ENDLESS: f32 = 3e38;

// In voxel space, s in lengths of a direction that is not a unit vector.
struct TileFrustum {
    origin: vec3<f32>,
    direction: vec3<f32>,
    width: vec3<f32>,
    widening: vec3<f32>,
    // World lengths of s = 1: the shortest and the longest of all rays.
    length: vec2<f32>,
}

fn tile_frustum_of(middle: vec2<f32>) -> TileFrustum {
    // Pixel centres lie half a pixel inside, and places in pixels up to half of their square around these.
    let half = 0.5 * f32(TILE_PIXELS) - 0.5 + 0.5 * frame.cell_pixels * f32(frame.is_uneven);
    let origin = frame.origin + middle.x * frame.origin_dx + middle.y * frame.origin_dy;
    let direction = frame.direction + middle.x * frame.direction_dx + middle.y * frame.direction_dy;
    let o = to_voxel(origin, 1.0);
    let d = to_voxel(direction, 0.0);
    let width = abs(to_voxel(frame.origin_dx, 0.0)) + abs(to_voxel(frame.origin_dy, 0.0));
    let widening = abs(to_voxel(frame.direction_dx, 0.0)) + abs(to_voxel(frame.direction_dy, 0.0));
    let moved = half * frame.direction_dx;
    let across = half * frame.direction_dy;
    // A length is convex: it lies over its tangent plane, and is largest at a corner.
    let there = norm(direction);
    let least = there - (abs(dot(direction, moved)) + abs(dot(direction, across))) / there;
    let most = max(
        max(norm(direction + moved + across), norm(direction + moved - across)),
        max(norm(direction - moved + across), norm(direction - moved - across)),
    );
    return TileFrustum(
        o,
        d,
        half * width + SLACK_VOXELS + SLACK * abs(o),
        half * widening + SLACK * abs(d),
        vec2(max(least, 0.0), most),
    );
}

fn to_voxel(world: vec3<f32>, w: f32) -> vec3<f32> {
    return vec4(world, w) * frame.voxel_from_world;
}

// World lengths between which all rays of the frustum have what lies between two s.
fn lengths(frustum: TileFrustum, s: vec2<f32>) -> vec2<f32> {
    return s * frustum.length * vec2(1.0 - SLACK, 1.0 + SLACK);
}

// Where in an interval some of the frustum may lie in a box.
fn meets(frustum: TileFrustum, interval: vec2<f32>, low: vec3<f32>, high: vec3<f32>) -> vec2<f32> {
    var within = interval;
    for (var k = 0u; k < 3u; k++) {
        let o = frustum.origin[k];
        let d = frustum.direction[k];
        within = not_over(within, o - frustum.width[k] - high[k], d - frustum.widening[k]);
        within = not_over(within, low[k] - o - frustum.width[k], -d - frustum.widening[k]);
    }
    return within;
}

// Where in an interval all of the frustum lies in a box.
fn inside_of(frustum: TileFrustum, interval: vec2<f32>, low: vec3<f32>, high: vec3<f32>) -> vec2<f32> {
    var within = interval;
    for (var k = 0u; k < 3u; k++) {
        let o = frustum.origin[k];
        let d = frustum.direction[k];
        within = not_over(within, o + frustum.width[k] - high[k], d + frustum.widening[k]);
        within = not_over(within, low[k] - o + frustum.width[k], -d + frustum.widening[k]);
    }
    return within;
}

// Where p + q s <= 0.
fn not_over(interval: vec2<f32>, p: f32, q: f32) -> vec2<f32> {
    if abs(q) < 1e-20 {
        return select(interval, vec2(ENDLESS, -ENDLESS), p > 0.0);
    }
    let root = -p / q;
    return select(vec2(max(interval.x, root), interval.y), vec2(interval.x, min(interval.y, root)), q > 0.0);
}

// Where samples of this recording may lie: in the domain and in its brick.
fn box_part(frustum: TileFrustum) -> vec2<f32> {
    // Splats reach out of the box.
    var low = frame.domain_min - frame.splat_halo;
    var high = frame.domain_max + frame.splat_halo;
    if frame.is_only_brick == 0u {
        low = max(low, frame.brick_min);
        high = min(high, frame.brick_max);
    }
    return meets(frustum, vec2(0.0, ENDLESS), low, high);
}
