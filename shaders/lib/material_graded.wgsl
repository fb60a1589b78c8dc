// What a sample is made of where gradients count: first classified, then lit.
// Twin: src/technique/shading.rs.

#import transfer_{transfer}
#import shade

fn material_of(sample: Sample) -> Classified {
    let material = classify(sample.value);
    // What is transparent shows no light: no gradient is made for it.
    if material.extinction == 0.0 || frame.light_count == 0u {
        return material;
    }
    let gradient = gradient_at(sample.place);
    return Classified(shade(material.color, gradient, sample.ray_direction), material.extinction);
}
