// Classification by table: the nearest of `table_count` entries between the first and the last control
// point; each holds colour and extinction at the middle of its cell. CPU reference: src/transfer/table.rs.

#import frame

// The table is folded into rows of this many entries.
const TABLE_WIDTH: u32 = 1024u;

@group(0) @binding(4) var transfer_table: texture_2d<f32>;

struct Classified {
    color: vec3<f32>,
    extinction: f32,
}

fn classify(value: f32) -> Classified {
    return classified_by(value, frame.table_first, frame.table_scale, f32(frame.table_count) - 1.0, 0u);
}

fn classified_by(value: f32, first: f32, scale: f32, last: f32, row: u32) -> Classified {
    // Clamped before it becomes a whole number: a float out of range has no defined one.
    let index = u32(clamp((value - first) * scale, 0.0, last));
    let entry = textureLoad(transfer_table, vec2(index % TABLE_WIDTH, row + index / TABLE_WIDTH), 0);
    return Classified(entry.xyz, entry.w);
}
