// The walk along one ray from cell to cell, where a cell lies between eight voxel centres. In it the trilinear
// field along the ray is a cubic,
//
//     f(s) = A0 + A1 s + A2 s^2 + A3 s^3
//
// which has its extremes where the ray enters or leaves the cell or between (cell_cubic.wgsl). Everything of a cell
// follows from its index, so that bricks meet the same places.
// CPU reference: src/technique/projection/exact.rs.

#import ray
#import host_depth
#import brick
#import drawn_tile
#import filter_linear_fetch
#import cell_cubic
#import mask
#import holes_{holes}
#import mode_{mode}

struct Segment {
    t: f32,
    length: f32,
}

fn march(pixel: vec2<f32>, tile: RayTile, before: Accumulator) -> Accumulator {
    let world = pixel_ray(pixel);
    let voxel = voxel_ray(world);
    let interval = visible_interval(domain_interval(world, voxel), world, pixel);
    let inside = counted(brick_interval(voxel, interval), tile);
    var so_far = before;
    if !(interval.x < interval.y && inside.x < inside.y) {
        return so_far;
    }
    let tiny = vec3(1e-20);
    let direction = select(voxel.direction, tiny, abs(voxel.direction) < tiny);
    let forward = direction > vec3(0.0);
    var cell = vec3<i32>(floor(voxel.origin + inside.x * voxel.direction - 0.5));
    // A ray crosses no more planes between voxel centres than there are.
    let most = u32(frame.dims.x + frame.dims.y + frame.dims.z) + 8u;
    for (var i = 0u; i < most; i++) {
        let lower = (vec3<f32>(cell) + 0.5 - voxel.origin) / direction;
        let upper = (vec3<f32>(cell) + 1.5 - voxel.origin) / direction;
        let enter = select(upper, lower, forward);
        let leave = select(lower, upper, forward);
        let first = max(max(enter.x, enter.y), max(enter.z, interval.x));
        let next = min(min(leave.x, leave.y), leave.z);
        let last = min(next, interval.y);
        if first <= last {
            so_far = with_cell(so_far, voxel, cell, first, last);
        }
        if !(next < inside.y) {
            break;
        }
        let step = select(vec3(-1), vec3(1), forward);
        if leave.x == next {
            cell.x += step.x;
        } else if leave.y == next {
            cell.y += step.y;
        } else {
            cell.z += step.z;
        }
    }
    return so_far;
}

fn with_cell(before: Accumulator, voxel: Ray, cell: vec3<i32>, first: f32, last: f32) -> Accumulator {
    let start = voxel.origin + first * voxel.direction - 0.5 - vec3<f32>(cell);
    let grid = vec3<i32>(frame.dims) - 1;
    // Along an axis on which the ray stays at voxel centres the upper corner has no weight.
    let above = select(cell + 1, cell, (start == vec3(0.0)) & (voxel.direction == vec3(0.0)));
    let taps = Footprint(clamp(cell, vec3(0), grid), clamp(above, vec3(0), grid));
    let at = stored(taps);
    if !volume_is_valid(at) {
        return before;
    }
    let corners = corners_of(at);
    let roots = extremes(cubic_along(corners, start, voxel.direction));
    let ends = vec4(first, first + min(roots.x, roots.y), first + max(roots.x, roots.y), last);
    var so_far = before;
    so_far.samples += 1.0;
    for (var k = 0u; k < 4u; k++) {
        let t = ends[k];
        let place = voxel.origin + t * voxel.direction;
        if t >= first && t <= last && is_in_brick(place) {
            let code = mixed(corners, clamp(place - 0.5 - vec3<f32>(cell), vec3(0.0), vec3(1.0)));
            so_far = add(so_far, value_from_code(volume_coding(), code), Segment(t, 0.0));
        }
    }
    return so_far;
}

// No texel outside of the brick's texture is asked for: no place of the brick's own needs one.
fn stored(taps: Footprint) -> Footprint {
    let low = vec3<i32>(frame.brick_origin);
    let high = low + vec3<i32>(frame.brick_dims) - 1;
    return Footprint(clamp(taps.min, low, high), clamp(taps.max, low, high));
}

fn corners_of(taps: Footprint) -> Corners {
    return Corners(
        vec4(
            corner(taps.min.x, taps.min.y, taps.min.z),
            corner(taps.min.x, taps.max.y, taps.min.z),
            corner(taps.min.x, taps.min.y, taps.max.z),
            corner(taps.min.x, taps.max.y, taps.max.z),
        ),
        vec4(
            corner(taps.max.x, taps.min.y, taps.min.z),
            corner(taps.max.x, taps.max.y, taps.min.z),
            corner(taps.max.x, taps.min.y, taps.max.z),
            corner(taps.max.x, taps.max.y, taps.max.z),
        ),
    );
}

fn corner(x: i32, y: i32, z: i32) -> f32 {
    return decoded_at(volume, volume_coding(), vec3(x, y, z));
}
