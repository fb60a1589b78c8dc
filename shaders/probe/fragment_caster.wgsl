// What slicers are measured against: one fragment a pixel walks along all planes of its ray, and composites from front
// to back. The samples are those of view-aligned slices; nothing is left out, and no ray ends early.

#import ray
#import lattice_planes
#import filter_linear
#import sample_scalar
#import material_scalar
#import opacity

@fragment
fn main(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let world = pixel_ray(position.xy);
    let voxel = voxel_ray(world);
    let interval = domain_interval(world, voxel);
    var color = vec3(0.0);
    var transmittance = 1.0;
    if !(interval.x < interval.y) {
        return vec4(0.0);
    }
    let lattice = lattice_of(world, interval, position.xy);
    for (var i = 0; i < lattice.count; i++) {
        let segment = segment_of(lattice, world, lattice.first + i);
        let value = sample_at(voxel.origin + segment.t * voxel.direction, world.direction);
        let material = material_of(value);
        let opacity = opacity_over(material.extinction, segment.length);
        color += transmittance * opacity * material.color;
        transmittance *= 1.0 - opacity;
    }
    return vec4(color, 1.0 - transmittance);
}
