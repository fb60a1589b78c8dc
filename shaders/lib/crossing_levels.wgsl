// Solid surfaces where the field has the value of a level, met by a walk cell by cell. In a cell f is a cubic along the walk
// (cell_cubic.wgsl), and goes up or down all the way between its ends and extremes: the first of these beyond a level has
// the surface before it, found by Newton's method, kept between the ends (Marmitt et al. 2004 split cells so). Which levels
// lie at or under the value a walk takes along from cell to cell, so that rounding opens no gap between them. Where a
// voxel has no data there is no surface. CPU reference: src/technique/pathtrace/levels.rs.

#import frame
#import ray
#import majorants
#import cell_cubic
#import cell_corners_{filter}
#import mask
#import holes_{holes}
#import among_levels

// What f32 may lose on the way to a value, as a part of it.
const LEVEL_ROUNDING: f32 = 1e-5;

// Takes a walk at t into its cell, where levels may be crossed there.
fn entered(before: AmongLevels, voxel: Ray, t: f32, may_cross: bool) -> AmongLevels {
    var at = before;
    if !may_cross {
        return from_rank(UNKNOWN);
    }
    if !at.is_in_cell {
        at.cell = vec3<i32>(floor(voxel.origin + t * voxel.direction - cell_begin()));
        at.is_in_cell = true;
        at.face = face_across(axis_of(abs(voxel.direction)));
    }
    let tiny = vec3(1e-20);
    let along = select(voxel.direction, tiny, abs(voxel.direction) < tiny);
    let planes = vec3<f32>(at.cell + select(vec3(0), vec3(1), along > vec3(0.0))) + cell_begin();
    at.leave = (planes - voxel.origin) / along;
    return at;
}

// Whether values of a macro cell may lie on both sides of a level.
fn may_cross_in(cell: vec3<i32>) -> bool {
    let range = cell_ranges.d[cell_index(cell)];
    let slack = LEVEL_ROUNDING * max(abs(range.x), abs(range.y));
    return rank_of(range.x - slack) != rank_of(range.y + slack);
}

// No farther than the end of the cell.
fn nearer_end(at: AmongLevels, t: f32, reach: f32, end: f32) -> f32 {
    let leave = min(at.leave.x, min(at.leave.y, at.leave.z));
    return select(reach, min(max(leave, t), end), at.is_in_cell);
}

// How many levels lie at or under a value. No loop, because some drivers count the turns of all loops.
fn rank_of(value: f32) -> i32 {
    return counted_level(0u, value) + counted_level(1u, value) + counted_level(2u, value) + counted_level(3u, value)
        + counted_level(4u, value) + counted_level(5u, value) + counted_level(6u, value) + counted_level(7u, value);
}

fn counted_level(i: u32, value: f32) -> i32 {
    return i32(i < frame.level_count && frame.level_values[i].x <= value);
}

// From start to end, or to the first surface between.
fn moved(before: AmongLevels, voxel: Ray, start: f32, end: f32) -> AmongLevels {
    var at = before;
    at.t = end;
    at.before = at.rank;
    if !at.is_in_cell {
        return at;
    }
    let place = voxel.origin + start * voxel.direction - cell_begin() - vec3<f32>(at.cell);
    let taps = taps_of(at.cell, (place == vec3(0.0)) & (voxel.direction == vec3(0.0)));
    if volume_is_valid(taps) {
        let corners = cell_corners(taps);
        let cubic = cubic_along(corners, place, voxel.direction);
        if at.rank == UNKNOWN {
            at.rank = rank_of(cubic.x);
            at.before = at.rank;
        }
        let above = u32(at.rank);
        let low = select(-3.4e38, frame.level_values[max(above, 1u) - 1u].x, above > 0u);
        let high = select(3.4e38, frame.level_values[min(above, MAX_LEVELS - 1u)].x, above < frame.level_count);
        let length = end - start;
        let roots = clamp(extremes(cubic), vec2(0.0), vec2(length));
        let ends = vec4(0.0, min(roots.x, roots.y), max(roots.x, roots.y), length);
        let values = cubic_at(cubic, ends);
        // Where the last surface was, rounding says on which side the value is.
        let are_behind = vec4(before.rank == before.before) | (ends > vec4(0.0));
        let are_beyond = are_behind & ((values < vec4(low)) | (values >= vec4(high)));
        if any(are_beyond) {
            // The first end beyond a level, and the one before it.
            let ending = select(select(select(3u, 2u, are_beyond.z), 1u, are_beyond.y), 0u, are_beyond.x);
            let begin = max(ending, 1u) - 1u;
            let is_up = values[ending] >= high;
            let level = select(low, high, is_up);
            at.t = start + crossing(cubic, level, vec2(ends[begin], ends[ending]), vec2(values[begin], values[ending]));
            at.rank += select(-1, 1, is_up);
            let part = place + (at.t - start) * voxel.direction;
            let slope = cell_slope(corners, clamp(part, vec3(0.0), vec3(1.0)));
            at.slope = select(slope, at.face, all(slope == vec3(0.0)));
            return at;
        }
    } else {
        at.rank = UNKNOWN;
        at.before = UNKNOWN;
    }
    let leave = min(at.leave.x, min(at.leave.y, at.leave.z));
    if end >= leave {
        at.face = face_across(axis_of(-at.leave));
        at.cell += vec3<i32>(at.face) * select(vec3(-1), vec3(1), voxel.direction > vec3(0.0));
    }
    return at;
}

// That of the largest.
fn axis_of(v: vec3<f32>) -> u32 {
    return select(select(2u, 1u, v.y >= v.z), 0u, v.x >= max(v.y, v.z));
}

fn face_across(axis: u32) -> vec3<f32> {
    return select(vec3(0.0), vec3(1.0), vec3(axis) == vec3(0u, 1u, 2u));
}

fn reached(at: AmongLevels, end: f32) -> f32 {
    return at.t;
}

fn has_crossed(at: AmongLevels) -> bool {
    return at.rank != at.before;
}

fn cubic_at(cubic: vec4<f32>, s: vec4<f32>) -> vec4<f32> {
    return cubic.x + s * (cubic.y + s * (cubic.z + s * (cubic.w / 3.0)));
}

// Between two ends on different sides of a level: both, and the best guess.
struct Between {
    near: f32,
    far: f32,
    guess: f32,
}

fn crossing(cubic: vec4<f32>, level: f32, ends: vec2<f32>, values: vec2<f32>) -> f32 {
    // Without a way between the ends, or a value, the first end is it.
    let part = select(0.0, (level - values.x) / (values.y - values.x), values.y != values.x);
    var between = Between(ends.x, ends.y, ends.x + clamp(part, 0.0, 1.0) * (ends.y - ends.x));
    let is_up = values.y >= level;
    // No loop, as above.
    between = closer(between, cubic, level, is_up);
    between = closer(between, cubic, level, is_up);
    between = closer(between, cubic, level, is_up);
    between = closer(between, cubic, level, is_up);
    between = closer(between, cubic, level, is_up);
    between = closer(between, cubic, level, is_up);
    return between.guess;
}

fn closer(before: Between, cubic: vec4<f32>, level: f32, is_up: bool) -> Between {
    let s = before.guess;
    let over = cubic_at(cubic, vec4(s)).x - level;
    let is_far = (over >= 0.0) == is_up;
    let near = select(s, before.near, is_far);
    let far = select(before.far, s, is_far);
    let newton = s - over / (cubic.y + s * (2.0 * cubic.z + s * cubic.w));
    return Between(near, far, select(0.5 * (near + far), newton, newton >= near && newton <= far));
}
