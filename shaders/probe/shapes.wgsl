// Triangles as they are given, and a colour for each: that of the triangle's number and the instance's together.

struct Numbers {
    d: array<vec4<f32>>,
}

@group(0) @binding(0) var<storage, read> corners: Numbers;
@group(0) @binding(1) var<storage, read> colors: Numbers;

struct Corner {
    @builtin(position) position: vec4<f32>,
    @location(0) @interpolate(flat) color: vec4<f32>,
}

@vertex
fn main(@builtin(vertex_index) vertex: u32, @builtin(instance_index) instance: u32) -> Corner {
    let number = (vertex / 3u + instance) % arrayLength(&colors.d);
    return Corner(corners.d[vertex], colors.d[number]);
}
