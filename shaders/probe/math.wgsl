// Functions of one number, which shaders of pictures call.

struct Numbers {
    d: array<f32>,
}

struct Found {
    d: array<vec4<f32>>,
}

@group(0) @binding(0) var<storage, read> numbers: Numbers;
@group(0) @binding(1) var<storage, read_write> found: Found;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&numbers.d) {
        return;
    }
    let x = numbers.d[id.x];
    found.d[3u * id.x] = vec4(exp(-x), log(x), sqrt(x), inverseSqrt(x));
    found.d[3u * id.x + 1u] = vec4(1.0 / x, pow(x, 2.4), exp2(x), log2(x));
    found.d[3u * id.x + 2u] = vec4(floor(x), ceil(x), fract(x), round(x));
}
