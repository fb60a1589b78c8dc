// 2D texture slicing, the fragment: the sample of the pixel's ray on one slice of the stack, bilinear
// inside it. A sample stands for the length 1 / |(voxel_from_world r)_k|.
// CPU reference: src/technique/slices_2d/reference.rs.

#import ray
#import ends_at_{end}
#import brick
#import stack_{filter}
#import stack_at_nearest
#import stack_mask
#import sample_{inputs}
#import blend_{blend}

@fragment
fn main(
    @builtin(position) position: vec4<f32>,
    @location(0) @interpolate(flat) slice: i32,
) -> @location(0) vec4<f32> {
    let world = pixel_ray(position.xy);
    let voxel = voxel_ray(world);
    let slope = voxel.direction[frame.slice_axis];
    // A ray inside the slice's plane never crosses it.
    if abs(slope) < 1e-20 {
        discard;
    }
    let interval = visible_interval(domain_interval(world, voxel), world, position.xy);
    let t = (f32(slice) + 0.5 - voxel.origin[frame.slice_axis]) / slope;
    if !(interval.x <= t && t < interval.y) {
        discard;
    }
    let place = Place(voxel.origin + t * voxel.direction, slice);
    if !is_in_brick(on_slice(place)) || !has_data(place) {
        discard;
    }
    return blend_source(sample_at(place, world.direction), 1.0 / abs(slope));
}

// The position with its coordinate along the stack as it is meant: no rounding takes it out of its slice.
fn on_slice(place: Place) -> vec3<f32> {
    var exact = place.voxel;
    exact[frame.slice_axis] = f32(place.slice) + 0.5;
    return exact;
}
