// What a sample is made of where gradients or light count: first classified, then lit.
// CPU reference: src/technique/shading.rs, src/transfer/widgets.rs.

#import transfer_{transfer}
#import gradient
#import widgets
#import second_derivative
#import norm
#import shade
#import light

fn material_of(sample: Sample) -> Classified {
    let has_widgets = are_widgets();
    var material = classify(sample.value);
    // What is transparent shows no light: no gradient is made for it.
    if !has_widgets && material.extinction == 0.0 {
        return material;
    }
    // In one place: look-ups of a wide filter take drivers long to compile.
    var gradient = vec3(0.0);
    if has_widgets || (frame.light_count != 0u && !is_on_face(sample)) {
        gradient = gradient_at(sample.place);
    }
    if has_widgets {
        var second = 0.0;
        if wants_second() {
            second = second_derivative_at(sample.place, gradient);
        }
        material = classify_by_gradient(material, sample.value, norm(gradient), second);
        if material.extinction == 0.0 {
            return material;
        }
    }
    return Classified(lit(material.color, gradient, sample), material.extinction);
}

// A cut face is seen along no direction, and in its own colour.
fn is_on_face(sample: Sample) -> bool {
    return all(sample.ray_direction == vec3(0.0));
}

// Without lights all light is ambient.
fn lit(color: vec3<f32>, gradient: vec3<f32>, sample: Sample) -> vec3<f32> {
    if is_on_face(sample) {
        return color;
    }
    let of_surface = select(vec3(0.0), gradient, frame.light_count != 0u);
    return shade(color, of_surface, sample.ray_direction, voxel_of(sample.place));
}
