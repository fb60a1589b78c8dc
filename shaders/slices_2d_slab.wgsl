// 2D texture slicing with pre-integrated classification, the fragment: the slab of the pixel's ray between one plane
// and the next, cut to the domain (Engel, Kraus and Ertl 2001). Slabs touch: together they are the ray.
// CPU reference: src/technique/slices_2d/between.rs.

#import stack_slab
#import ends_at_{end}
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
    let interval = visible_interval(domain_interval(world, voxel), world, position.xy);
    let slab = stack_slab(world, voxel, slope, interval, plane);
    if !slab.has_data {
        discard;
    }
    return blend_source(slab.sample, slab.length);
}
