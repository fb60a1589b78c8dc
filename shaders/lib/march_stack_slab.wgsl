// The same walk in slabs between the slices, those of slices_2d_slab.wgsl, for their depth.

#import host_depth
#import faces
#import drawn_tile
#import stack_range
#import stack_slab
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
    // A ray inside the planes never leaves a slab.
    if abs(slope) < 1e-20 || !(interval.x < interval.y) {
        return so_far;
    }
    // A slab is named by its lower plane; the outermost reach half a voxel beyond the slices.
    let slabs = stack_range(voxel.origin[axis], slope, counted(interval, tile), -1, i32(frame.dims[axis]) - 1);
    for (var i = 0; i < slabs.count && !is_finished(so_far); i++) {
        let slab = stack_slab(world, voxel, slope, interval, slabs.first + i * slabs.step);
        so_far.samples += select(0.0, 1.0, slab.is_ours);
        if slab.has_data {
            so_far = add(so_far, slab.sample, Segment(slab.t, slab.length));
        }
    }
    return so_far;
}
