// Texture coordinates that grow by so much a pixel, of corners that are given.

struct Numbers {
    d: array<vec4<f32>>,
}

@group(0) @binding(0) var<storage, read> corners: Numbers;
// What a pixel to the right adds, what a pixel down does, and the pixels of the picture.
@group(0) @binding(4) var<storage, read> steps: Numbers;

struct Corner {
    @builtin(position) position: vec4<f32>,
    @location(0) @interpolate(linear) place: vec3<f32>,
}

@vertex
fn main(@builtin(vertex_index) vertex: u32) -> Corner {
    let corner = corners.d[vertex];
    let at = 0.5 * (corner.xy + 1.0) * steps.d[2].xy;
    return Corner(corner, steps.d[0].xyz * at.x + steps.d[1].xyz * at.y);
}
