// The extinction of one volume at a place: 0 for no data. CPU reference: src/offscreen/reference/light.rs.

#import gradient
#import sample_scalar_gradient
#import transfer_{transfer}
#import widgets
#import norm
#import second_derivative

fn extinction_at(place: Place) -> f32 {
    if !has_data(place) {
        return 0.0;
    }
    let value = volume_value(place);
    var material = classify(value);
    if are_widgets() {
        let gradient = gradient_at(place);
        var second = 0.0;
        if wants_second() {
            second = second_derivative_at(place, gradient);
        }
        material = classify_by_gradient(material, value, norm(gradient), second);
    }
    return material.extinction;
}
