// What a sample is made of where gradients count: first classified, then lit.
// Twin: src/technique/shading.rs, src/transfer/widgets.rs.

#import transfer_{transfer}
#import widgets
#import second
#import shade

// Not on a cut face, which is seen along no direction.
fn is_lit(sample: Sample) -> bool {
    return frame.light_count != 0u && any(sample.ray_direction != vec3(0.0));
}

fn material_of(sample: Sample) -> Classified {
    let has_widgets = are_widgets();
    var material = classify(sample.value);
    // What is transparent shows no light: no gradient is made for it.
    if !has_widgets && (material.extinction == 0.0 || !is_lit(sample)) {
        return material;
    }
    // In one place: look-ups of a wide filter take drivers long to compile.
    let gradient = gradient_at(sample.place);
    if has_widgets {
        var second = 0.0;
        if wants_second() {
            second = second_derivative_at(sample.place, gradient);
        }
        material = classify_by_gradient(material, sample.value, length(gradient), second);
        if material.extinction == 0.0 || !is_lit(sample) {
            return material;
        }
    }
    return Classified(shade(material.color, gradient, sample.ray_direction), material.extinction);
}
