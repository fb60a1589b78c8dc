// What an invocation sees of its subgroup, and what an operation of the subgroup gives it.

#import probe_subgroup_{operation}

struct Numbers {
    d: array<u32>,
}

struct Found {
    d: array<vec4<u32>>,
}

@group(0) @binding(0) var<storage, read> numbers: Numbers;
@group(0) @binding(1) var<storage, read_write> found: Found;

@compute @workgroup_size(128)
fn main(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(subgroup_size) size: u32,
    @builtin(subgroup_invocation_id) lane: u32,
    @builtin(subgroup_id) subgroup: u32,
    @builtin(num_subgroups) subgroups: u32,
) {
    let number = numbers.d[id.x];
    found.d[2u * id.x] = vec4(size, lane, subgroup, subgroups);
    found.d[2u * id.x + 1u] = together(number, lane);
}
