// A square (or a block of them) as one point as large as it is, for drivers that shade twice what two triangles share:
// on llvmpipe all that lies on a diagonal, which is a quarter of 16 x 16 pixels. A point whose middle is out of sight
// is not drawn, and squares reach over the edge of the picture: the viewport is a multiple of the largest block
// (src/technique/patch_slicer.rs).

#import patch_grid

fn square_vertices() -> u32 {
    return 1u;
}
// Points may be so large: a device that has less draws triangles.
const MOST_POINT_PIXELS: u32 = 128u;
const LARGEST_BLOCK: u32 = 512u;

fn blocks_can_be_drawn() -> bool {
    return BLOCK_SIDE * frame.patch_pixels <= MOST_POINT_PIXELS;
}

fn square_vertex(corner: u32, first: vec2<u32>, pixels: u32) -> vec2<f32> {
    let blocks = (frame.extent_pixels + LARGEST_BLOCK - 1u) / LARGEST_BLOCK;
    let middle = vec2<f32>(first) + 0.5 * f32(pixels);
    return 2.0 * middle / vec2<f32>(LARGEST_BLOCK * blocks) - 1.0;
}
