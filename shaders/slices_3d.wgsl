// View-aligned slicing, the fragment: the sample of the pixel's ray on one plane, handed to the blending
// unit (Cabral, Cam and Foran 1994). The polygon is only a cover: what lies outside the domain is
// discarded here, by the functions of the ray caster, so both take the same samples.
// Twin: src/technique/slices_3d/reference.rs.

#import ray
#import brick
#import filter_{filter}
#import holes_{holes}
#import blend_{blend}

@fragment
fn main(
    @builtin(position) position: vec4<f32>,
    @location(0) @interpolate(flat) plane: i32,
) -> @location(0) vec4<f32> {
    let world = pixel_ray(position.xy);
    let voxel = voxel_ray(world);
    let interval = domain_interval(world, voxel);
    let t = plane_t(world, plane);
    if !(interval.x <= t && t < interval.y) {
        discard;
    }
    let sample = voxel.origin + t * voxel.direction;
    if !is_in_brick(sample) || !footprint_is_valid(footprint_of(sample)) {
        discard;
    }
    return blend_source(value_at(sample), plane_length(world));
}
