// View-aligned slicing, the fragment: the sample of the pixel's ray on one plane, handed to the blending
// unit (Cabral, Cam and Foran 1994). The polygon is only a cover: what lies outside the domain is
// discarded here, by the functions of the ray caster, so both take the same samples.
// CPU reference: src/technique/slices_3d/reference.rs.

#import ray
#import ends_at_{end}
#import brick
#import filter_{filter}
#import nearest
#import mask
#import sample_{inputs}
#import blend_{blend}

@fragment
fn main(
    @builtin(position) position: vec4<f32>,
    @location(0) @interpolate(flat) plane: i32,
) -> @location(0) vec4<f32> {
    let world = pixel_ray(position.xy);
    let voxel = voxel_ray(world);
    let interval = visible_interval(domain_interval(world, voxel), world, position.xy);
    let t = plane_t(world, plane);
    if !(interval.x <= t && t < interval.y) {
        discard;
    }
    let place = voxel.origin + t * voxel.direction;
    if !is_in_brick(place) || !has_data(place) {
        discard;
    }
    return blend_source(sample_at(place, world.direction), plane_length(world));
}
