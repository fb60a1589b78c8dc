// Surfaces of one value or of several, front to back: one ray a pixel, a crossing wherever one end of a segment
// is under a level and the other is not, found by halving the segment ten times and a straight line between what
// is left (Hadwiger et al. 2005 refine so). A crossing is lit by the gradient there, and lets through what its
// opacity leaves. CPU reference: src/technique/isosurface.rs.

#import ray
#import host_depth
#import drawn_tile
#import brick
#import distance_map
#import filter_{filter}
#import nearest
#import mask
#import holes_{holes}
#import color_by_{color_by}
#import gradient
#import shade
#import light

// Premultiplied colour and alpha.
@group(0) @binding(6) var picture: texture_storage_2d<rgba32float, read_write>;
// Level of the first crossing, its depth (negative: none), transmittance, samples.
@group(0) @binding(7) var layers: texture_storage_2d<rgba32float, read_write>;

// Halvings of a segment: 2^-10 of a step.
const HALVINGS: u32 = 10u;

struct Surfaces {
    color: vec3<f32>,
    transmittance: f32,
    level: f32,
    depth: f32,
    samples: f32,
}

// One end of a segment.
struct End {
    t: f32,
    value: f32,
    has_data: bool,
}

struct Bracket {
    near: End,
    far: End,
}

@compute @workgroup_size(8, 8)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) own: vec3<u32>) {
    let tile = drawn_tile(group);
    let pixel = pixel_in(tile, own.xy);
    if any(pixel >= frame.extent_pixels) {
        return;
    }
    let found = surfaces(vec2<f32>(pixel) + 0.5, tile, met_before(pixel));
    textureStore(picture, pixel, vec4(found.color, 1.0 - found.transmittance));
    textureStore(layers, pixel, vec4(found.level, found.depth, found.transmittance, found.samples));
}

// What nearer bricks have left in the images.
fn met_before(pixel: vec2<u32>) -> Surfaces {
    if frame.is_first_brick != 0u {
        return Surfaces(vec3(0.0), 1.0, 0.0, -1.0, 0.0);
    }
    let beside = textureLoad(layers, pixel);
    return Surfaces(textureLoad(picture, pixel).xyz, beside.z, beside.x, beside.y, beside.w);
}

// A segment belongs to the brick that its far end lies in; its near end lies in the voxels around.
fn surfaces(pixel: vec2<f32>, tile: RayTile, before: Surfaces) -> Surfaces {
    let world = pixel_ray(pixel);
    let voxel = voxel_ray(world);
    let interval = visible_interval(domain_interval(world, voxel), world, pixel);
    var so_far = before;
    let inside = counted(brick_interval(voxel, interval), tile);
    if !(interval.x < interval.y && inside.x < inside.y) || is_finished(before) {
        return so_far;
    }
    let full = i32(floor((interval.y - interval.x) / frame.step_world));
    let first = max(0, i32(floor((inside.x - interval.x) / frame.step_world)) - 1);
    let last = min(full + 1, i32(ceil((inside.y - interval.x) / frame.step_world)) + 1);
    // A segment that comes from another brick begins in cells that are not known here.
    let known = select(0, full + 1, frame.is_only_brick != 0u);
    let line = sample_line(voxel, vec2(interval.x, frame.step_world), vec2(0, known));
    var near = End(0.0, 0.0, false);
    var far = near;
    // Whether the near end lies in a cell that no surface goes through, or there is none.
    var is_near_empty = true;
    var k = first;
    loop {
        var is_crossed = false;
        // On to the next segment that a surface crosses: a loop of its own, so that rays that are walked side by side
        // search together and shade together.
        loop {
            // Neighbouring cells without surface are on the same side of all levels, for they share voxels. The last
            // sample of a distance is the near end of the segment that leaves it.
            var distance = 0;
            loop {
                distance = 0;
                if !may_skip(line, k) {
                    break;
                }
                let cell = cell_of(line, k);
                distance = distance_to_occupied(cell);
                let landing = first_sample_beyond(line, k, cell, max(distance, 1)) - 1;
                if distance == 0 || !is_near_empty || landing <= k {
                    break;
                }
                k = landing;
                near.has_data = false;
            }
            if k > last {
                break;
            }
            let t = min(interval.x + f32(k) * frame.step_world, interval.y);
            let next = min(interval.x + f32(k + 1) * frame.step_world, interval.y);
            let is_own = is_in_brick(voxel.origin + t * voxel.direction);
            k++;
            // The segment behind may be the brick's own.
            if !is_own && !is_in_brick(voxel.origin + next * voxel.direction) {
                continue;
            }
            far = end_at(voxel, t);
            is_near_empty = distance > 0;
            so_far.samples += f32(is_own);
            // Between a value and no data there is no surface. Before the first end there is none.
            is_crossed = is_own && near.has_data && far.has_data && are_apart(near, far);
            if is_crossed {
                break;
            }
            near = far;
        }
        if !is_crossed {
            break;
        }
        so_far = crossed(so_far, world, voxel, near, far);
        if is_finished(so_far) {
            break;
        }
        near = far;
    }
    return so_far;
}

// Whether a level lies between two ends.
fn are_apart(near: End, far: End) -> bool {
    var are = false;
    for (var i = 0u; i < frame.level_count; i++) {
        let level = frame.level_values[i].x;
        are = are || is_under(near, level) != is_under(far, level);
    }
    return are;
}

// Nothing is seen behind what is opaque.
fn is_finished(so_far: Surfaces) -> bool {
    return so_far.transmittance < frame.termination || so_far.transmittance == 0.0;
}

fn end_at(voxel: Ray, t: f32) -> End {
    let place = voxel.origin + t * voxel.direction;
    return End(t, volume_value(place), volume_is_valid(footprint_of(place)));
}

// All levels between two ends, in the order in which the ray meets them.
fn crossed(before: Surfaces, world: Ray, voxel: Ray, near: End, far: End) -> Surfaces {
    var so_far = before;
    var start = near;
    for (var i = 0u; i < frame.level_count; i++) {
        let index = select(frame.level_count - 1u - i, i, far.value > near.value);
        let level = frame.level_values[index].x;
        if is_under(start, level) == is_under(far, level) || frame.level_colors[index].w == 0.0 {
            continue;
        }
        let bracket = narrowed(voxel, level, start, far);
        if !bracket.near.has_data {
            continue;
        }
        let t = crossing(bracket, level);
        so_far = passed(so_far, world, voxel, index, t);
        // The next level lies behind.
        start = bracket.near;
    }
    return so_far;
}

fn is_under(end: End, level: f32) -> bool {
    return end.value < level;
}

// The 2^-10 of the segment that a crossing lies in; without data where a half has none.
fn narrowed(voxel: Ray, level: f32, near: End, far: End) -> Bracket {
    var bracket = Bracket(near, far);
    for (var i = 0u; i < HALVINGS; i++) {
        let middle = end_at(voxel, 0.5 * (bracket.near.t + bracket.far.t));
        if !middle.has_data {
            bracket.near.has_data = false;
            return bracket;
        }
        if is_under(middle, level) == is_under(bracket.near, level) {
            bracket.near = middle;
        } else {
            bracket.far = middle;
        }
    }
    return bracket;
}

// Where a straight line between the ends meets the level.
fn crossing(bracket: Bracket, level: f32) -> f32 {
    let part = (level - bracket.near.value) / (bracket.far.value - bracket.near.value);
    return bracket.near.t + clamp(part, 0.0, 1.0) * (bracket.far.t - bracket.near.t);
}

fn passed(before: Surfaces, world: Ray, voxel: Ray, index: u32, t: f32) -> Surfaces {
    let opacity = frame.level_colors[index].w;
    let place = voxel.origin + t * voxel.direction;
    var color = surface_color(index, place);
    var gradient = vec3(0.0);
    if frame.light_count != 0u {
        gradient = gradient_at(place);
    }
    color = shade(color, gradient, world.direction, place);
    var next = before;
    next.color += before.transmittance * opacity * color;
    next.transmittance *= 1.0 - opacity;
    if before.depth < 0.0 {
        next.depth = t;
        next.level = frame.level_values[index].x;
    }
    return next;
}
