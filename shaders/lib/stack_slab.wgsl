// The slab of a ray between one plane of a stack and the next, cut to an interval: CPU reference of
// src/technique/slices_2d/between.rs.

#import ray
#import brick
#import stack_{filter}
#import stack_at_nearest
#import stack_mask
#import sample_slab
#import between_{filter}

struct StackSlab {
    // Whether it is this brick's, and whether there are values at both ends.
    is_ours: bool,
    has_data: bool,
    sample: Sample,
    // Its middle and its length; the first is only where it is ours.
    t: f32,
    length: f32,
}

// `slope` along the stack is not 0.
fn stack_slab(world: Ray, voxel: Ray, slope: f32, interval: vec2<f32>, plane: i32) -> StackSlab {
    let nothing = StackSlab(false, false, Sample(0.0, 0.0, vec3(0.0), vec3(0.0)), 0.0, 0.0);
    let start = voxel.origin[frame.slice_axis];
    // A ray that falls meets the upper plane first.
    let enter_plane = select(plane + 1, plane, slope > 0.0);
    let leave_plane = select(plane, plane + 1, slope > 0.0);
    let enter = (height_of_plane(f32(enter_plane)) - start) / slope;
    let leave = (height_of_plane(f32(leave_plane)) - start) / slope;
    let t_front = max(enter, interval.x);
    let t_back = min(leave, interval.y);
    if !(t_front < t_back) {
        return nothing;
    }
    let is_whole = t_front == enter && t_back == leave;
    let t = 0.5 * (t_front + t_back);
    var middle = voxel.origin + t * voxel.direction;
    if is_whole {
        middle[frame.slice_axis] = height_of_plane(f32(plane) + 0.5);
    }
    if !is_in_brick(middle) {
        return nothing;
    }
    let front = end_between(voxel.origin + t_front * voxel.direction, enter_plane, t_front == enter);
    let back = end_between(voxel.origin + t_back * voxel.direction, leave_plane, t_back == leave);
    let length = select(t_back - t_front, 1.0 / (abs(slope) * frame.planes_per_slice), is_whole);
    let sample = Sample(front.value, back.value, middle, world.direction);
    return StackSlab(true, front.is_valid && back.is_valid, sample, t, length);
}

// An end on a plane, or where the interval cuts the slab.
fn end_between(place: vec3<f32>, plane: i32, is_on_plane: bool) -> End {
    var level = level_at(place[frame.slice_axis]);
    if is_on_plane {
        level = level_of_plane(plane);
    }
    if !has_data_between(level, place) {
        return End(0.0, false);
    }
    return End(value_between(level, place), true);
}
