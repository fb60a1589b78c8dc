// Which tiles of 8 x 8 pixels are drawn by rays, and which part of their rays: one thread a tile.
//
// With D not made a unit vector, the rays of a tile are a frustum around that of its middle: in voxel space
//
//     x(s) = O + s D + e(s),    |e_i(s)| <= w_i + s v_i
//
// so where all of it lies on one side of an axis-aligned plane follows from linear inequalities in s, and where it may
// be in a box is an interval. From its ends the frustum goes from cube to cube of empty macro cells, as each ray does in
// empty_space.wgsl; what is left is handed on. A tile of which nothing is left gets what a ray finds in no volume, and
// is not drawn. What is left out would have added nothing: the picture is the same to the bit (`sampling.md` 5).

#import tile_frustum
#import tile_bounds_{bounds}
#import clear_{output}
#import ray_tile

// Tiles along the side of a block, which a workgroup looks through.
const BLOCK_TILES: u32 = 8u;
// Along an axis of any picture there are fewer blocks.
const MOST_BLOCKS: u32 = 1024u;

struct RayList {
    // A dispatch, as Vulkan reads it: a workgroup a tile.
    tiles: atomic<u32>,
    down: u32,
    deep: u32,
}

@group(0) @binding(42) var<storage, read_write> ray_list: RayList;
@group(0) @binding(43) var ray_tiles: texture_storage_2d<rgba32float, write>;

@compute @workgroup_size(BLOCK_TILES, BLOCK_TILES)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) own: vec3<u32>) {
    // The place of a workgroup says which block it has, and how many of its tiles are left out before and behind. Its
    // first number is 0: indirect dispatches of lavapipe (Mesa 22.3) begin where the dispatch before did.
    let left_out = group.yz / MOST_BLOCKS;
    let before = left_out % BLOCK_TILES;
    let behind = left_out / BLOCK_TILES;
    let tile = BLOCK_TILES * (group.yz % MOST_BLOCKS) + own.xy;
    if any(own.xy < before) || any(own.xy + behind >= vec2(BLOCK_TILES)) || any(TILE_PIXELS * tile >= frame.extent_pixels) {
        return;
    }
    let frustum = tile_frustum_of(vec2<f32>(TILE_PIXELS * tile) + 0.5 * f32(TILE_PIXELS));
    let within = tile_bounds(frustum, box_part(frustum));
    if within.x < within.y || frame.draws_all_tiles != 0u {
        let index = atomicAdd(&ray_list.tiles, 1u);
        textureStore(ray_tiles, entry_of(index), vec4(vec2<f32>(tile), lengths(frustum, within)));
    } else if frame.is_first_brick != 0u {
        clear_tile(TILE_PIXELS * tile);
    }
}
