// All push constants, as they are when the dispatch runs.

#import probe_push_{bytes}

struct Pushed {
    d: array<vec4<u32>, PUSHED>,
}

struct Numbers {
    d: array<vec4<u32>>,
}

var<immediate> pushed: Pushed;

@group(0) @binding(0) var<storage, read_write> found: Numbers;

@compute @workgroup_size(PUSHED)
fn main(@builtin(local_invocation_index) local: u32, @builtin(workgroup_id) group: vec3<u32>) {
    found.d[group.x * PUSHED + local] = pushed.d[local];
}
