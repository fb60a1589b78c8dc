// 2D texture slicing with pre-integrated classification, the fragment: the slab of the pixel's ray between one plane
// and the next, cut to the domain (Engel, Kraus and Ertl 2001). Slabs touch: together they are the ray.
// Twin: src/technique/slices_2d/between.rs.

#import ray
#import brick
#import stack_{filter}
#import stack_at_nearest
#import stack_mask
#import sample_slab
#import between_{filter}
#import blend_{blend}

@fragment
fn main(
    @builtin(position) position: vec4<f32>,
    @location(0) @interpolate(flat) plane: i32,
) -> @location(0) vec4<f32> {
    let world = pixel_ray(position.xy);
    let voxel = voxel_ray(world);
    let slope = voxel.direction[frame.slice_axis];
    // A ray inside the planes never leaves a slab.
    if abs(slope) < 1e-20 {
        discard;
    }
    let interval = domain_interval(world, voxel);
    let start = voxel.origin[frame.slice_axis];
    // A ray that falls meets the upper plane first.
    let enter_plane = select(plane + 1, plane, slope > 0.0);
    let leave_plane = select(plane, plane + 1, slope > 0.0);
    let enter = (height_of_plane(f32(enter_plane)) - start) / slope;
    let leave = (height_of_plane(f32(leave_plane)) - start) / slope;
    let t_front = max(enter, interval.x);
    let t_back = min(leave, interval.y);
    if !(t_front < t_back) {
        discard;
    }
    let is_whole = t_front == enter && t_back == leave;
    var middle = voxel.origin + 0.5 * (t_front + t_back) * voxel.direction;
    if is_whole {
        middle[frame.slice_axis] = height_of_plane(f32(plane) + 0.5);
    }
    if !is_in_brick(middle) {
        discard;
    }
    let front = end_between(voxel.origin + t_front * voxel.direction, enter_plane, t_front == enter);
    let back = end_between(voxel.origin + t_back * voxel.direction, leave_plane, t_back == leave);
    if !front.is_valid || !back.is_valid {
        discard;
    }
    let length = select(t_back - t_front, 1.0 / (abs(slope) * frame.planes_per_slice), is_whole);
    return blend_source(Sample(front.value, back.value), length);
}

// An end on a plane, or where the domain cuts the slab.
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
