// What every noise filter reads: numbers of some slices, x fastest. Outside, the nearest of them stands in.

const MAX_DENOISE_WEIGHTS: u32 = 32u;

struct Denoise {
    // Voxels across and down, and slices.
    dims: vec3<u32>,
    // Where the voxels of this dispatch begin, and how many they are.
    origin: vec3<u32>,
    part: vec3<u32>,
    // Voxels that the kernel reaches to each side.
    radius: i32,
    // Along which axis a pass in one direction goes.
    axis: u32,
    // 1 / (2 sigma^2) of differences of numbers.
    difference_factor: f32,
    // Of a distance of 0, 1, 2, ... voxels, four to a vector.
    weights: array<vec4<f32>, 8>,
}

struct Numbers {
    d: array<f32>,
}

@group(0) @binding(0) var<uniform> denoise: Denoise;
@group(0) @binding(1) var<storage, read> before: Numbers;
@group(0) @binding(2) var<storage, read_write> after: Numbers;

fn place(index: vec3<i32>) -> u32 {
    let i = vec3<u32>(clamp(index, vec3(0), vec3<i32>(denoise.dims) - 1));
    return i.x + denoise.dims.x * (i.y + denoise.dims.y * i.z);
}

fn number_at(index: vec3<i32>) -> f32 {
    return before.d[place(index)];
}

fn weight_of(distance: i32) -> f32 {
    let i = abs(distance);
    return denoise.weights[i / 4][i % 4];
}
