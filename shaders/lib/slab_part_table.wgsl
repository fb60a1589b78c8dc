// The integrals of slabs, from a texture.

@group(0) @binding(16) var slab_table: texture_2d<f32>;

fn slab_part(cell: i32, part: i32) -> vec4<f32> {
    let texel = 4 * cell + part;
    return textureLoad(slab_table, vec2(texel & (SLAB_TABLE_WIDTH - 1), texel / SLAB_TABLE_WIDTH), 0);
}
