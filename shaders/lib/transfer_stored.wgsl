// As transfer_table.wgsl, from a storage image: devices whose sampler is a program read that without looking up mip
// levels.

#import frame

// The table is folded into rows of this many entries.
const TABLE_WIDTH: u32 = 1024u;

@group(0) @binding(4) var stored_table: texture_storage_2d<rgba32float, read>;

struct Classified {
    color: vec3<f32>,
    extinction: f32,
}

fn classify(value: f32) -> Classified {
    // Clamped before it becomes a whole number: a float out of range has no defined one.
    let index = u32(clamp((value - frame.table_first) * frame.table_scale, 0.0, f32(frame.table_count) - 1.0));
    let entry = textureLoad(stored_table, vec2(index % TABLE_WIDTH, index / TABLE_WIDTH));
    return Classified(entry.xyz, entry.w);
}
