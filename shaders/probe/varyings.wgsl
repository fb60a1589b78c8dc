// Corners in clip space, each with a number that is interpolated in three ways.

#import probe_varyings

struct Numbers {
    d: array<vec4<f32>>,
}

@group(0) @binding(0) var<storage, read> corners: Numbers;
@group(0) @binding(1) var<storage, read> numbers: Numbers;

@vertex
fn main(@builtin(vertex_index) vertex: u32) -> Varyings {
    let number = numbers.d[vertex].x;
    return Varyings(corners.d[vertex], number, number, number);
}
