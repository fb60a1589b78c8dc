// Matter in a light of which this part is left, where gradients count: for what it is made of, and where there are
// lights on surfaces, for these. CPU reference: src/offscreen/reference/half_angle.rs.

#import transfer_{transfer}
#import gradient
#import widgets
#import second_derivative
#import norm
#import shade
#import light
#import shadowed

fn lit_material_of(sample: Sample, light: f32) -> Classified {
    var material = classify(sample.value);
    let is_plain = frame.light_count == 0u;
    if !are_widgets() && (is_plain || material.extinction == 0.0) {
        return Classified(shadowed(material.color, plainly_lit(material.color), light), material.extinction);
    }
    let gradient = gradient_at(sample.place);
    if are_widgets() {
        var second = 0.0;
        if wants_second() {
            second = second_derivative_at(sample.place, gradient);
        }
        material = classify_by_gradient(material, sample.value, norm(gradient), second);
    }
    var lit = plainly_lit(material.color);
    if !is_plain {
        lit = shade(material.color, gradient, sample.ray_direction, voxel_of(sample.place));
    }
    return Classified(shadowed(material.color, lit, light), material.extinction);
}
