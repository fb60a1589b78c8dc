// Classification by the specification itself: sigma = -ln(1 - min(opacity, 1 - 2^-12)) / d0.

#import points
#import extinction

struct Classified {
    color: vec3<f32>,
    extinction: f32,
}

fn classify(value: f32) -> Classified {
    return Classified(color_at(value), extinction_of(opacity_at(value), frame.reference_length));
}
