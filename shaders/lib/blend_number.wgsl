// What a slice hands to the blending unit for a projection. For MAX (sign +1) and MIN (sign -1) blending over zeros in
// y, which stays 0 where no sample came; without a sign, for additive blending, v d and d.

fn blend_source(sample: Sample, length_world: f32) -> vec4<f32> {
    if frame.extreme_sign == 0.0 {
        return vec4(sample * length_world, length_world, 0.0, 0.0);
    }
    return vec4(sample, frame.extreme_sign, 0.0, 0.0);
}
