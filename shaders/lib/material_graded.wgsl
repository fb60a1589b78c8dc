// What a sample is made of where gradients count: first classified, then lit.
// Twin: src/technique/shading.rs, src/transfer/widgets.rs.

#import transfer_{transfer}
#import widgets
#import shade

fn material_of(sample: Sample) -> Classified {
    if are_widgets() {
        let gradient = gradient_at(sample.place);
        let material = classify_by_gradient(sample.value, length(gradient));
        if material.extinction == 0.0 {
            return material;
        }
        return Classified(lit(material.color, gradient, sample), material.extinction);
    }
    let material = classify(sample.value);
    // What is transparent shows no light: no gradient is made for it.
    if material.extinction == 0.0 {
        return material;
    }
    var gradient = vec3(0.0);
    if frame.light_count != 0u {
        gradient = gradient_at(sample.place);
    }
    return Classified(lit(material.color, gradient, sample), material.extinction);
}

// Without lights all light is ambient.
fn lit(color: vec3<f32>, gradient: vec3<f32>, sample: Sample) -> vec3<f32> {
    let voxel = voxel_of(sample.place);
    if frame.light_count == 0u {
        return ambient_at(voxel, sample.ray_direction) * color;
    }
    return shade(color, gradient, sample.ray_direction, voxel);
}
