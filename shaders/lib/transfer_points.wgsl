// Classification by the specification itself: sigma = -ln(1 - min(opacity, 1 - 2^-12)) / d0, or what a medium's own points say.

#import points
#import medium

struct Classified {
    color: vec3<f32>,
    extinction: f32,
}

fn classify(value: f32) -> Classified {
    let extinctions = extinctions_at(value);
    // A mean, of three that are alike without rounding.
    let others = (extinctions.y - extinctions.x) / 3.0 + (extinctions.z - extinctions.x) / 3.0;
    return Classified(color_at(value), extinctions.x + others);
}
