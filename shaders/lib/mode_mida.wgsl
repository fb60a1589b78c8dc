// Emission and absorption in which a new maximum takes from what lies before it (Bruckner and Groeller 2009),
// with u the value from 0 to 1, m the largest of those before, A = 1 - T the opacity so far:
//
//     beta = 1 - max(u - m, 0) (1 + gamma)
//     C = beta C + (1 - beta A) alpha c        A = beta A + (1 - beta A) alpha
//
// For gamma over 0 beta is that of 0, and at the end of the ray what was gathered and the picture of the maximum M
// (colour c_M, opacity a0_M) are mixed, which for gamma = 1 is all that is left:
//
//     C = C + gamma (a0_M c_M - C)        A = A + gamma (a0_M - A)
//
// 1 - beta A is T + (1 - beta) (1 - T): where beta is 1, as it always is for gamma = -1, what follows are the
// operations of mode_composite.wgsl. CPU reference: src/technique/mida.rs.

#import opacity
#import material_{inputs}
#import unit
#import skip_passed_over
#import no_value

struct Accumulator {
    color: vec3<f32>,
    transmittance: f32,
    // Where opacity last reached one half; negative where it is under that.
    depth: f32,
    samples: f32,
    // The largest value so far.
    largest: f32,
}

// That of the largest extinction, which stands for opacity 1.
const CAP: f32 = 0.999755;

fn begin() -> Accumulator {
    return Accumulator(vec3(0.0), 1.0, -1.0, 0.0, NO_VALUE);
}

// As it was left in the images of the picture and beside it.
fn resumed(picture: vec4<f32>, beside: vec4<f32>) -> Accumulator {
    return Accumulator(picture.xyz, beside.z, beside.y, beside.w, beside.x);
}

// The largest value, depth, transmittance, samples.
fn beside_of(found: Accumulator) -> vec4<f32> {
    return vec4(found.largest, found.depth, found.transmittance, found.samples);
}

fn add(so_far: Accumulator, sample: Sample, segment: Segment) -> Accumulator {
    let material = material_of(sample);
    let opacity = opacity_over(material.extinction, segment.length);
    let unit = unit_from_value(value_of(sample));
    let taken = max(unit - largest_unit(so_far), 0.0) * frame.mida_fade;
    let transmittance = so_far.transmittance + taken * (1.0 - so_far.transmittance);
    var next = so_far;
    next.largest = max(value_of(sample), so_far.largest);
    next.color = (1.0 - taken) * so_far.color + transmittance * opacity * material.color;
    next.transmittance = transmittance * (1.0 - opacity);
    if next.transmittance > 0.5 {
        next.depth = -1.0;
    } else if transmittance > 0.5 {
        next.depth = segment.t;
    }
    return next;
}

// What is not seen counts as a new maximum alone.
fn is_passed_over(so_far: Accumulator, most: f32) -> bool {
    return most <= so_far.largest;
}

// A ray may end as one of a composite does only where no larger value can come, or would take nothing.
fn is_finished(so_far: Accumulator) -> bool {
    let is_settled = largest_unit(so_far) >= 1.0 || frame.mida_fade == 0.0;
    return is_settled && frame.mida_mip == 0.0 && so_far.transmittance < frame.termination;
}

fn largest_unit(so_far: Accumulator) -> f32 {
    return select(unit_from_value(so_far.largest), 0.0, so_far.largest == NO_VALUE);
}

// What the picture gets: behind the last brick the maximum is mixed in.
fn picture_of(found: Accumulator) -> vec4<f32> {
    let gathered = vec4(found.color, 1.0 - found.transmittance);
    if frame.mida_mip == 0.0 || frame.is_last_brick == 0u || found.largest == NO_VALUE {
        return gathered;
    }
    let material = classify(found.largest);
    let opacity = opacity_over(material.extinction, frame.reference_length);
    let shown = select(opacity, 1.0, opacity > CAP);
    return gathered + frame.mida_mip * (vec4(shown * material.color, shown) - gathered);
}
