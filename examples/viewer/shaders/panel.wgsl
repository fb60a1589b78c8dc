// The triangles of egui. Colours are premultiplied sRGB numbers and are blended as such, into a target of sRGB numbers:
// that is how egui is meant to look.

struct Corner {
    // Clip space: x right, y down.
    place: vec2<f32>,
    // Of the texture, 0 to 1.
    uv: vec2<f32>,
    // Red, green, blue and alpha in 8 bits each, red lowest.
    color: u32,
}

struct Corners {
    all: array<Corner>,
}

@group(0) @binding(0) var<storage, read> corners: Corners;
@group(0) @binding(1) var image: texture_2d<f32>;
@group(0) @binding(2) var smooth_sampler: sampler;

struct Seen {
    @builtin(position) place: vec4<f32>,
    @location(0) uv: vec2<f32>,
    @location(1) color: vec4<f32>,
}

// A mesh begins at the corner that its instance is numbered by.
@vertex
fn vertex(@builtin(vertex_index) index: u32, @builtin(instance_index) first: u32) -> Seen {
    let corner = corners.all[first + index];
    return Seen(vec4(corner.place, 0.0, 1.0), corner.uv, unpack4x8unorm(corner.color));
}

@fragment
fn fragment(seen: Seen) -> @location(0) vec4<f32> {
    return seen.color * textureSample(image, smooth_sampler, seen.uv);
}
