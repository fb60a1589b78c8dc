// Emission and absorption, front to back (Max 1995), of sheets: they are thick, and have no depth. CPU reference:
// src/technique/composite.rs.

#import opacity

struct Accumulator {
    color: vec3<f32>,
    transmittance: f32,
    samples: f32,
}

fn begin() -> Accumulator {
    return Accumulator(vec3(0.0), 1.0, 0.0);
}

// As it was left in the images of the picture and beside it.
fn resumed(picture: vec4<f32>, beside: vec4<f32>) -> Accumulator {
    return Accumulator(picture.xyz, beside.z, beside.w);
}

fn picture_of(found: Accumulator) -> vec4<f32> {
    return vec4(found.color, 1.0 - found.transmittance);
}

// No value, no depth, transmittance, samples.
fn beside_of(found: Accumulator) -> vec4<f32> {
    return vec4(0.0, -1.0, found.transmittance, found.samples);
}

fn with_matter(so_far: Accumulator, color: vec3<f32>, extinction: f32, length: f32) -> Accumulator {
    let opacity = opacity_over(extinction, length);
    var next = so_far;
    next.color += so_far.transmittance * opacity * color;
    next.transmittance *= 1.0 - opacity;
    return next;
}

fn is_finished(so_far: Accumulator) -> bool {
    return so_far.transmittance < frame.termination;
}
