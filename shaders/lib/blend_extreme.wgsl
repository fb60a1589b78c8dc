// For MAX (sign +1) and MIN (sign -1) blending over zeros in y: y stays 0 where no sample came.

fn blend_source(value: f32, length_world: f32) -> vec4<f32> {
    return vec4(value, frame.extreme_sign, 0.0, 0.0);
}
