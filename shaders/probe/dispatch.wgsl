// Each workgroup of a large dispatch leaves its number, plus one.

struct Numbers {
    d: array<u32>,
}

@group(0) @binding(0) var<storage, read_write> found: Numbers;

@compute @workgroup_size(8)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    if local == 0u {
        let number = group.x + groups.x * (group.y + groups.y * group.z);
        found.d[number] += number + 1u;
    }
}
