// Half-angle slicing, the eye's fragment: the sample of the pixel's ray on one plane, in the light that the slices
// before it have left (Kniss, Premoze, Hansen, Shirley and McPherson, "A Model for Volume Lighting and Modeling",
// IEEE TVCG 9(2), 2003).
//
//     source = alpha (lit(T), 1)        alpha = 1 - exp(-sigma h / |s.r|),  T = 1 - A of the light's picture there
//
// The planes are those of the view-aligned slicer with another normal, s half way between view and light; where the
// light comes towards the eye, it points to the eye. The light's picture of the same slices is drawn by
// `slices_3d.wgsl`. CPU reference: src/technique/slices_3d/half_angle/reference.rs.

#import ray
#import brick
#import filter_{filter}
#import nearest
#import mask
#import sample_{inputs}
#import opacity
#import light_buffer
#import lit_{inputs}

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
    let place = voxel.origin + t * voxel.direction;
    if !is_in_brick(place) || !has_data(place) {
        discard;
    }
    let light = light_at(world.origin + t * world.direction);
    let material = lit_material_of(sample_at(place, world.direction), light);
    let opacity = opacity_over(material.extinction, abs(plane_length(world)));
    return vec4(opacity * material.color, opacity);
}
