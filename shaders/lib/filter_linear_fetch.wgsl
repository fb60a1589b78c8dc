// Trilinear from eight texel fetches: the same on every device. x first, then y, then z.

#import box
#import footprint_linear

fn filtered(values: Values, coding: Coding, voxel: vec3<f32>) -> f32 {
    return filtered_between(values, coding, footprint_of(voxel), fract(voxel - 0.5));
}

fn filtered_between(values: Values, coding: Coding, taps: Footprint, weight: vec3<f32>) -> f32 {
    let front = lerp(
        row(values, coding, taps, weight.x, taps.min.y, taps.min.z),
        row(values, coding, taps, weight.x, taps.max.y, taps.min.z),
        weight.y,
    );
    let back = lerp(
        row(values, coding, taps, weight.x, taps.min.y, taps.max.z),
        row(values, coding, taps, weight.x, taps.max.y, taps.max.z),
        weight.y,
    );
    return value_from_code(coding, lerp(front, back, weight.z));
}

fn row(values: Values, coding: Coding, taps: Footprint, weight: f32, y: i32, z: i32) -> f32 {
    return lerp(
        decoded_at(values, coding, vec3(taps.min.x, y, z)),
        decoded_at(values, coding, vec3(taps.max.x, y, z)),
        weight,
    );
}

fn decoded_at(values: Values, coding: Coding, index: vec3<i32>) -> f32 {
    return code_from_texel(coding, textureLoad(values, index - vec3<i32>(frame.brick_origin), 0).x);
}
