// View-aligned slicing with pre-integrated classification, the fragment: the slab of the pixel's ray around one
// plane, cut to the domain (Engel, Kraus and Ertl 2001). Slabs touch: together they are the ray.
// CPU reference: src/technique/slices_3d/reference.rs.

#import ray
#import ends_at_{end}
#import brick
#import slab
#import filter_{filter}
#import nearest
#import mask
#import sample_slab
#import blend_{blend}

@fragment
fn main(
    @builtin(position) position: vec4<f32>,
    @location(0) @interpolate(flat) plane: i32,
) -> @location(0) vec4<f32> {
    let world = pixel_ray(position.xy);
    let voxel = voxel_ray(world);
    let interval = visible_interval(domain_interval(world, voxel), world, position.xy);
    let slab = plane_slab(world, interval, plane);
    let t = 0.5 * (slab.front + slab.back);
    let middle = voxel.origin + t * voxel.direction;
    if !(slab.length > 0.0) || !is_in_brick(middle) {
        discard;
    }
    let front = end_at(voxel.origin + slab.front * voxel.direction);
    let back = end_at(voxel.origin + slab.back * voxel.direction);
    if !front.is_valid || !back.is_valid {
        discard;
    }
    return blend_source(Sample(front.value, back.value, middle, world.direction), slab.length);
}
