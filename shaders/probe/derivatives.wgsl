// How much two numbers grow to the right and down: both are the same, of numbers that stand here and that are loaded.

struct Numbers {
    d: array<vec4<f32>>,
}

@group(0) @binding(4) var<storage, read> steps: Numbers;

@fragment
fn main(@builtin(position) at: vec4<f32>, @location(0) @interpolate(flat) color: vec4<f32>) -> @location(0) vec4<f32> {
    // The colour is nothing.
    let computed = color.x + 0.25 * at.x + 2.0 * at.y;
    let loaded = color.x + steps.d[0].x * at.x + steps.d[0].y * at.y;
    return vec4(dpdx(computed), dpdy(computed), dpdx(loaded), dpdy(loaded));
}
