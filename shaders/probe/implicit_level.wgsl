// A picture whose texture coordinates grow by so much a pixel: the device finds the level by itself.

struct Frame {
    d: array<vec4<f32>>,
}

@group(0) @binding(2) var probed: texture_3d<f32>;
@group(0) @binding(3) var probed_sampler: sampler;
@group(0) @binding(4) var<storage, read> steps: Frame;

@fragment
fn main(@builtin(position) at: vec4<f32>, @location(0) @interpolate(flat) color: vec4<f32>) -> @location(0) vec4<f32> {
    // The first is what a pixel to the right adds, the second what a pixel down does.
    let place = steps.d[0].xyz * at.x + steps.d[1].xyz * at.y;
    return color * textureSample(probed, probed_sampler, place).x;
}
