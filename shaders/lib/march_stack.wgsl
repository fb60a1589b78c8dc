// The walk along one ray from slice to slice of a stack, from front to back: the samples of slices_2d.wgsl, for their
// depth.

#import host_depth
#import brick
#import faces
#import drawn_tile
#import stack_range
#import stack_{filter}
#import stack_at_nearest
#import stack_mask
#import sample_{inputs}
#import mode_{mode}

struct Segment {
    t: f32,
    length: f32,
}

// `before` is what bricks nearer to the eye have gathered.
fn march(pixel: vec2<f32>, tile: RayTile, before: Accumulator) -> Accumulator {
    let world = pixel_ray(pixel);
    let voxel = voxel_ray(world);
    let axis = frame.slice_axis;
    let slope = voxel.direction[axis];
    let interval = visible_interval(domain_interval(world, voxel), world, pixel);
    var so_far = before;
    // A ray inside the planes of the slices never crosses one.
    if abs(slope) < 1e-20 || !(interval.x < interval.y) {
        return so_far;
    }
    let slices = stack_range(voxel.origin[axis], slope, counted(interval, tile), 0, i32(frame.dims[axis]) - 1);
    for (var i = 0; i < slices.count && !is_finished(so_far); i++) {
        let slice = slices.first + i * slices.step;
        let t = (f32(slice) + 0.5 - voxel.origin[axis]) / slope;
        let place = Place(voxel.origin + t * voxel.direction, slice);
        if interval.x <= t && t < interval.y && is_in_brick(voxel_of(place)) {
            so_far.samples += 1.0;
            if has_data(place) {
                so_far = add(so_far, sample_at(place, world.direction), Segment(t, 1.0 / abs(slope)));
            }
        }
    }
    return so_far;
}
