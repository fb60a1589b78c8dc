// What a collision finds in one volume by its value and how steep that is there, by central differences. CPU reference: that of
// material_scalar_gradient.wgsl.

#import path_matter
#import transfer_{transfer}
#import holes_{holes}
#import gradient_central
#import widgets
#import second_derivative
#import norm

fn is_matter(place: vec3<f32>) -> bool {
    return volume_is_valid(footprint_of(place));
}

fn matter_at(place: vec3<f32>) -> Matter {
    let value = volume_value(place);
    let gradient = gradient_of(central_slope(place));
    var second = 0.0;
    if wants_second() {
        second = second_derivative_at(place, gradient);
    }
    let found = classify_by_gradient(classify(value), value, norm(gradient), second);
    return Matter(found.color, vec3(found.extinction), vec3(0.0));
}

fn gradient_met(place: vec3<f32>, u: f32) -> vec3<f32> {
    return gradient_of(central_slope(place));
}
