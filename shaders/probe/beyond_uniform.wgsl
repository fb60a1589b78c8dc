// Words of a slot of uniforms, and beyond it.

struct ProbeSlot {
    words: array<vec4<u32>, 16>,
}

struct Numbers {
    d: array<vec4<u32>>,
}

struct Places {
    d: array<u32>,
}

@group(0) @binding(0) var<uniform> slot: ProbeSlot;
@group(0) @binding(1) var<storage, read> places: Places;
@group(0) @binding(2) var<storage, read_write> found: Numbers;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&places.d) {
        return;
    }
    found.d[id.x] = slot.words[places.d[id.x]];
}
