// One look at a texture: the device finds the level by itself.

@group(0) @binding(2) var probed: texture_3d<f32>;
@group(0) @binding(3) var probed_sampler: sampler;

@fragment
fn main(@location(0) @interpolate(linear) place: vec3<f32>) -> @location(0) vec4<f32> {
    return vec4(textureSample(probed, probed_sampler, place).x);
}
