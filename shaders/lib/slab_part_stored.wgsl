// As slab_part_table.wgsl, from a storage image: devices whose sampler is a program read that without looking up mip
// levels.

@group(0) @binding(47) var stored_slabs: texture_storage_2d<rgba32float, read>;

fn slab_part(cell: i32, part: i32) -> vec4<f32> {
    let texel = 4 * cell + part;
    return textureLoad(stored_slabs, vec2(texel & (SLAB_TABLE_WIDTH - 1), texel / SLAB_TABLE_WIDTH));
}
