// Tiles that are drawn by rays, one after the other in the rows of an image that has a texel for each tile of the
// picture.

#import frame

const TILE_PIXELS: u32 = 8u;

// Where a tile stands in the list.
fn entry_of(index: u32) -> vec2<u32> {
    let across = (frame.extent_pixels.x + TILE_PIXELS - 1u) / TILE_PIXELS;
    return vec2(index % across, index / across);
}
