// A few words of a large buffer: read, and each replaced by its complement.

struct Numbers {
    d: array<u32>,
}

@group(0) @binding(0) var<storage, read> places: Numbers;
@group(0) @binding(1) var<storage, read_write> large: Numbers;
@group(0) @binding(2) var<storage, read_write> found: Numbers;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&places.d) {
        return;
    }
    let word = large.d[places.d[id.x]];
    found.d[2u * id.x] = word;
    found.d[2u * id.x + 1u] = arrayLength(&large.d);
    large.d[places.d[id.x]] = ~word;
}
