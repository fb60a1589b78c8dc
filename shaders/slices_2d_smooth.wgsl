// 2D texture slicing with slices interpolated between those of the stack, the fragment: the sample of the pixel's
// ray on one plane. It stands for the length 1 / (n |(voxel_from_world r)_k|), n planes a slice.
// CPU reference: src/technique/slices_2d/between.rs.

#import ray
#import brick
#import stack_{filter}
#import stack_at_nearest
#import stack_mask
#import sample_{inputs}
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
    // A ray inside the plane never crosses it.
    if abs(slope) < 1e-20 {
        discard;
    }
    let interval = domain_interval(world, voxel);
    let height = height_of_plane(f32(plane));
    let t = (height - voxel.origin[frame.slice_axis]) / slope;
    if !(interval.x <= t && t < interval.y) {
        discard;
    }
    var place = voxel.origin + t * voxel.direction;
    // No rounding takes it out of its plane.
    place[frame.slice_axis] = height;
    let level = level_of_plane(plane);
    if !is_in_brick(place) || !has_data_between(level, place) {
        discard;
    }
    let sample = Sample(value_between(level, place), place, world.direction);
    return blend_source(sample, 1.0 / (abs(slope) * frame.planes_per_slice));
}
