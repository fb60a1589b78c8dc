// One step of a chain of dispatches: each number becomes what its left neighbour was, plus one. Without a barrier
// between them a step reads what the step before has not written.

struct Numbers {
    d: array<u32>,
}

@group(0) @binding(0) var<storage, read> before: Numbers;
@group(0) @binding(1) var<storage, read_write> after: Numbers;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let count = arrayLength(&before.d);
    if id.x < count {
        after.d[id.x] = before.d[(id.x + count - 1u) % count] + 1u;
    }
}
