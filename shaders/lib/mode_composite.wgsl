// Emission and absorption, front to back (Max 1995; `sampling.md` 5), with T the transmittance so far:
//
//     C += T alpha c        T *= 1 - alpha
//
// CPU reference: src/technique/composite.rs.

#import opacity
#import material_{inputs}
#import face_grey
#import skip_empty

struct Accumulator {
    color: vec3<f32>,
    transmittance: f32,
    // Where opacity reached one half; negative before that.
    depth: f32,
    samples: f32,
    // That of the sample there.
    value: f32,
}

fn begin() -> Accumulator {
    return Accumulator(vec3(0.0), 1.0, -1.0, 0.0, 0.0);
}

// As it was left in the images of the picture and beside it.
fn resumed(picture: vec4<f32>, beside: vec4<f32>) -> Accumulator {
    return Accumulator(picture.xyz, beside.z, beside.y, beside.w, beside.x);
}

// What the picture gets.
fn picture_of(found: Accumulator) -> vec4<f32> {
    return vec4(face_color(found.color), 1.0 - found.transmittance);
}

// The value at that depth, the depth, transmittance, samples.
fn beside_of(found: Accumulator) -> vec4<f32> {
    return vec4(found.value, found.depth, found.transmittance, found.samples);
}

fn add(so_far: Accumulator, sample: Sample, segment: Segment) -> Accumulator {
    return with_material(so_far, material_of(sample), value_of(sample), segment);
}

// With a sample of this value and matter.
fn with_material(so_far: Accumulator, own: Classified, value: f32, segment: Segment) -> Accumulator {
    var material = own;
    if segment.length == FACE_LENGTH {
        material = on_face(material, value);
    }
    let opacity = opacity_over(material.extinction, segment.length);
    var next = so_far;
    next.color += so_far.transmittance * opacity * material.color;
    next.transmittance *= 1.0 - opacity;
    if so_far.depth < 0.0 && next.transmittance <= 0.5 {
        next.depth = segment.t;
        next.value = value;
    }
    return next;
}

// The ray ends after the sample at which transmittance falls under the threshold, and at a cut face that is opaque.
fn is_finished(so_far: Accumulator) -> bool {
    return so_far.transmittance < frame.termination || (frame.cut_faces != 0u && so_far.transmittance == 0.0);
}
