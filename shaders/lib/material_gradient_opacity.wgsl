// What a sample is made of where its opacity is weighed by how steep it is there, by central differences, and light
// falls on it unhindered: of what material_scalar_gradient.wgsl can do, what is wanted most of the time. CPU reference: that
// of material_scalar_gradient.wgsl.

#import transfer_{transfer}
#import gradient_central
#import gradient_opacity
#import norm
#import shade
#import light_unhindered

fn material_of(sample: Sample) -> Classified {
    let material = classify(sample.value);
    if material.extinction == 0.0 {
        return material;
    }
    let gradient = gradient_of(central_slope(sample.place));
    let extinction = weighted_extinction(material.extinction, norm(gradient) * widget_entry(0).x);
    // A cut face, seen along no direction, has its own colour, and without lights all light is ambient.
    if all(sample.ray_direction == vec3(0.0)) {
        return Classified(material.color, extinction);
    }
    let of_surface = select(vec3(0.0), gradient, frame.light_count != 0u);
    let color = shade(material.color, of_surface, sample.ray_direction, voxel_of(sample.place));
    return Classified(color, extinction);
}
