// Arithmetic of infinities, zeros of both signs and what is no number: compiled so that shaders preserve them.

struct Numbers {
    d: array<vec2<f32>>,
}

struct Found {
    d: array<vec4<f32>>,
}

@group(0) @binding(0) var<storage, read> pairs: Numbers;
@group(0) @binding(1) var<storage, read_write> found: Found;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&pairs.d) {
        return;
    }
    let a = pairs.d[id.x].x;
    let b = pairs.d[id.x].y;
    found.d[2u * id.x] = vec4(a + b, a - b, a * b, -a);
    found.d[2u * id.x + 1u] = vec4(min(a, b), max(a, b), abs(a), select(0.0, 1.0, a < b));
}
