// How an entry of the lists of patches (patch_grid.wgsl) is drawn.

#import patch_grid
#import patch_{topology}

// Those of a square (or a block) on each slice of its layer.
fn entry_vertices() -> u32 {
    return square_vertices() * LAYER_SLICES;
}
