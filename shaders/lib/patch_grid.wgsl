// Patches: squares of the picture on a few slices that follow each other. Where nothing is to be seen in one, it is not
// drawn. A batch is so many slices; the patches of each have a list of their own, of at most
//
//     BATCH_LAYERS ceil(width / side) ceil(height / side)        entries, square * BATCH_LAYERS + layer
//
// Blocks of BLOCK_SIDE x BLOCK_SIDE squares that are all drawn in a layer are one entry of the first of them and BLOCK:
// the fewer there are, the less is paid for each. CPU reference of the constants and of the size: src/technique/patches.rs.

#import slice_order

const LAYER_SLICES: u32 = 4u;
const BATCH_LAYERS: u32 = 16u;
const BLOCK_SIDE: u32 = 4u;
const BLOCK: u32 = 0x80000000u;

// Squares across and down.
fn patch_grid() -> vec2<u32> {
    return (frame.extent_pixels + frame.patch_pixels - 1u) / frame.patch_pixels;
}

fn batch_capacity() -> u32 {
    let grid = patch_grid();
    return BATCH_LAYERS * grid.x * grid.y;
}
