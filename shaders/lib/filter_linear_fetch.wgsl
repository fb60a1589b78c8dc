// Trilinear from eight texel fetches: the same on every device. x first, then y, then z.

#import value
#import footprint_linear

@group(0) @binding(1) var volume: texture_3d<f32>;

fn value_at(voxel: vec3<f32>) -> f32 {
    let taps = footprint_of(voxel);
    let weight = fract(voxel - 0.5);
    let front = lerp(
        row(taps, weight.x, taps.min.y, taps.min.z),
        row(taps, weight.x, taps.max.y, taps.min.z),
        weight.y,
    );
    let back = lerp(
        row(taps, weight.x, taps.min.y, taps.max.z),
        row(taps, weight.x, taps.max.y, taps.max.z),
        weight.y,
    );
    return value_from_code(lerp(front, back, weight.z));
}

fn row(taps: Footprint, weight: f32, y: i32, z: i32) -> f32 {
    return lerp(code_at(vec3(taps.min.x, y, z)), code_at(vec3(taps.max.x, y, z)), weight);
}

fn code_at(index: vec3<i32>) -> f32 {
    return code_from_texel(textureLoad(volume, index - vec3<i32>(frame.brick_origin), 0).x);
}
