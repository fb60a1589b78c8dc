// Words of a buffer at places that may lie beyond what is bound.

struct Numbers {
    d: array<u32>,
}

@group(0) @binding(0) var<storage, read> places: Numbers;
@group(0) @binding(1) var<storage, read> bound: Numbers;
@group(0) @binding(2) var<storage, read_write> found: Numbers;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&places.d) {
        return;
    }
    found.d[id.x] = bound.d[places.d[id.x]];
}
