// Emission and absorption in which a new maximum takes from what lies before it (Bruckner and Groeller 2009),
// with u the value from 0 to 1, m the largest of those before, A = 1 - T the opacity so far:
//
//     beta = 1 - max(u - m, 0) (1 + gamma)
//     C = beta C + (1 - beta A) alpha c        A = beta A + (1 - beta A) alpha
//
// 1 - beta A is T + (1 - beta) (1 - T): where beta is 1, as it always is for gamma = -1, what follows are the
// operations of mode_composite.wgsl. Twin: src/technique/mida.rs.

#import opacity
#import material_{mix}
#import unit

struct Accumulator {
    color: vec3<f32>,
    transmittance: f32,
    // Where opacity last reached one half; negative where it is under that.
    depth: f32,
    samples: f32,
    // The largest value so far, from 0 to 1.
    largest: f32,
}

fn begin() -> Accumulator {
    return Accumulator(vec3(0.0), 1.0, -1.0, 0.0, 0.0);
}

// As it was left in the images of the picture and beside it.
fn resumed(picture: vec4<f32>, beside: vec4<f32>) -> Accumulator {
    return Accumulator(picture.xyz, beside.z, beside.y, beside.w, beside.x);
}

// Largest value, depth, transmittance, samples.
fn beside_of(found: Accumulator) -> vec4<f32> {
    return vec4(found.largest, found.depth, found.transmittance, found.samples);
}

fn add(so_far: Accumulator, sample: Sample, segment: Segment) -> Accumulator {
    let material = material_of(sample);
    let opacity = opacity_over(material.extinction, segment.length);
    let unit = unit_from_value(value_of(sample));
    let taken = max(unit - so_far.largest, 0.0) * frame.mida_fade;
    let transmittance = so_far.transmittance + taken * (1.0 - so_far.transmittance);
    var next = so_far;
    next.largest = max(unit, so_far.largest);
    next.color = (1.0 - taken) * so_far.color + transmittance * opacity * material.color;
    next.transmittance = transmittance * (1.0 - opacity);
    if next.transmittance > 0.5 {
        next.depth = -1.0;
    } else if transmittance > 0.5 {
        next.depth = segment.t;
    }
    return next;
}

// A ray may end as one of a composite does only where no larger value can come, or would take nothing.
fn is_finished(so_far: Accumulator) -> bool {
    let is_settled = so_far.largest >= 1.0 || frame.mida_fade == 0.0;
    return is_settled && so_far.transmittance < frame.termination;
}
