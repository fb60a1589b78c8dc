// What a sample is made of where light falls on it unhindered, by central differences, and no more: most of what
// material_scalar_gradient.wgsl can do is not wanted most of the time, and drivers on CPUs go through it for each sample.
// CPU reference: that of material_scalar_gradient.wgsl.

#import transfer_{transfer}
#import gradient_central
#import shade
#import light_unhindered

fn material_of(sample: Sample) -> Classified {
    let material = classify(sample.value);
    // What is transparent shows no light, and a cut face, seen along no direction, its own colour.
    if material.extinction == 0.0 || all(sample.ray_direction == vec3(0.0)) {
        return material;
    }
    let gradient = gradient_of(central_slope(sample.place));
    let color = shade(material.color, gradient, sample.ray_direction, voxel_of(sample.place));
    return Classified(color, material.extinction);
}
