// Classification by the law itself: sigma = -ln(1 - min(opacity, 1 - 2^-12)) / d0.

#import points

struct Classified {
    color: vec3<f32>,
    extinction: f32,
}

fn classify(value: f32) -> Classified {
    let opacity = min(opacity_at(value), 1.0 - 1.0 / 4096.0);
    return Classified(color_at(value), -log(1.0 - opacity) / frame.reference_length);
}
