// Bilinear inside the slice from four texel fetches: the same on every device. Across first, then down.

#import stack
#import stack_footprint

fn filtered(values: Values, coding: Coding, place: Place) -> f32 {
    let taps = footprint_of(place);
    let low = texel_of(taps.min);
    let high = texel_of(taps.max);
    let weight = fract(in_stack(place.voxel).xy - 0.5);
    let above = lerp(decoded_at(values, coding, low), decoded_at(values, coding, vec3(high.x, low.yz)), weight.x);
    let below = lerp(
        decoded_at(values, coding, vec3(low.x, high.y, low.z)),
        decoded_at(values, coding, high),
        weight.x,
    );
    return value_from_code(coding, lerp(above, below, weight.y));
}

fn decoded_at(values: Values, coding: Coding, texel: vec3<i32>) -> f32 {
    return code_from_texel(coding, textureLoad(values, texel.xy, texel.z, 0).x);
}
