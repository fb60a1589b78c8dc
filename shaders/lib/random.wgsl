// Random numbers as a pure function of pixel, path, draw and seed: pcg4d (Jarzynski and Olano, "Hash Functions for GPU
// Rendering", JCGT 9(3), 2020). CPU reference: src/technique/pathtrace/random.rs.

fn pcg4d(key: vec4<u32>) -> vec4<u32> {
    var v = key * 1664525u + 1013904223u;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    v = v ^ (v >> vec4(16u));
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    return v;
}

// Four numbers from 0 (included) to 1 (excluded), multiples of 2^-24.
fn random_numbers(key: vec4<u32>) -> vec4<f32> {
    return vec4<f32>(pcg4d(key) >> vec4(8u)) * (1.0 / 16777216.0);
}
