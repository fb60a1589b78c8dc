// Atomics at places that may lie beyond what is bound.

struct Numbers {
    d: array<u32>,
}

struct Bound {
    d: array<atomic<u32>>,
}

@group(0) @binding(0) var<storage, read> places: Numbers;
@group(0) @binding(1) var<storage, read_write> bound: Bound;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&places.d) {
        return;
    }
    let place = places.d[id.x];
    atomicOr(&bound.d[place], 0xffffffffu);
}
