// What the vertices of slices hand over: which slice it is. Parameters are asked for by the fragments themselves.

struct Vertex {
    @builtin(position) position: vec4<f32>,
    @location(0) @interpolate(flat) slice: i32,
}

fn vertex_of(position: vec4<f32>, slice: i32) -> Vertex {
    return Vertex(position, slice);
}
