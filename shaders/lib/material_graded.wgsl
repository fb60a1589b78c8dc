// What a sample is made of where gradients count: first classified, then lit.
// Twin: src/technique/shading.rs, src/transfer/widgets.rs.

#import transfer_{transfer}
#import widgets
#import second
#import shade

fn material_of(sample: Sample) -> Classified {
    if are_widgets() {
        let gradient = gradient_at(sample.place);
        var second = 0.0;
        if wants_second() {
            second = second_derivative_at(sample.place, gradient);
        }
        let material = classify_by_gradient(sample.value, length(gradient), second);
        if material.extinction == 0.0 || frame.light_count == 0u {
            return material;
        }
        return Classified(shade(material.color, gradient, sample.ray_direction), material.extinction);
    }
    let material = classify(sample.value);
    // What is transparent shows no light: no gradient is made for it.
    if material.extinction == 0.0 || frame.light_count == 0u {
        return material;
    }
    let gradient = gradient_at(sample.place);
    return Classified(shade(material.color, gradient, sample.ray_direction), material.extinction);
}
