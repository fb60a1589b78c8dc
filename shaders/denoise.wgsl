// One pass of a noise filter over slices of numbers in a buffer, or over a part of them: one thread a voxel.
// CPU reference: src/volume/denoise.rs, which says what the kernels are.

#import denoise_{kernel}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if any(id >= denoise.part) {
        return;
    }
    let index = vec3<i32>(denoise.origin + id);
    after.d[place(index)] = filtered(index);
}
