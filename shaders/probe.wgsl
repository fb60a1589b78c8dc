// The most that a device's sampler gives: threads side by side in x and y walk along z of a 3D texture, voxel by
// voxel, through the corners between voxels, where all eight texels count; and nothing else. More threads in z than
// the texture is deep begin again at its front.
// CPU reference: none, it is a measurement (src/offscreen/probe.rs).

const PROBE_SAMPLES: u32 = 64u;

struct Sums {
    d: array<f32>,
}

@group(0) @binding(0) var probed: texture_3d<f32>;
@group(0) @binding(1) var probed_sampler: sampler;
@group(0) @binding(2) var<storage, read_write> sums: Sums;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let dims = vec3<f32>(textureDimensions(probed));
    let depth = textureDimensions(probed).z;
    var at = vec3<f32>(vec3(id.xy, (id.z * PROBE_SAMPLES) % depth)) / dims;
    let step = 1.0 / dims.z;
    var sum = 0.0;
    for (var i = 0u; i < PROBE_SAMPLES; i++) {
        sum += textureSampleLevel(probed, probed_sampler, at, 0.0).x;
        at.z += step;
    }
    // Every sum is kept, so that no sample can be left out.
    sums.d[id.x + 8u * groups.x * (id.y + 8u * groups.y * id.z)] = sum;
}
