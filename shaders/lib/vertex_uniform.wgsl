// What the vertices of slices hand over: which slice it is. Parameters are asked for by the fragments themselves.

struct Vertex {
    @invariant @builtin(position) position: vec4<f32>,
    @location(0) @interpolate(flat) slice: i32,
    // The size of a point, which WGSL has no word for (`shaders/point_size.rs`).
    @location(31) point_pixels: f32,
}

fn vertex_of(position: vec4<f32>, slice: i32, point_pixels: f32) -> Vertex {
    return Vertex(position, slice, point_pixels);
}
