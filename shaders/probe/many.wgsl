// A bit for each workgroup of a large dispatch, and how many there were.

struct Bits {
    d: array<atomic<u32>>,
}

struct Counter {
    groups: atomic<u32>,
}

@group(0) @binding(0) var<storage, read_write> bits: Bits;
@group(0) @binding(1) var<storage, read_write> counter: Counter;

@compute @workgroup_size(1)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let number = group.x + groups.x * (group.y + groups.y * group.z);
    atomicXor(&bits.d[number / 32u], 1u << (number % 32u));
    atomicAdd(&counter.groups, 1u);
}
