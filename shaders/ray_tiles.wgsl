// Which tiles of 8 x 8 pixels are drawn by rays, and which part of their rays: one thread a tile.
//
// With D not made a unit vector, the rays of a tile are a pencil around that of its middle: in voxel space
//
//     x(s) = O + s D + e(s),    |e_i(s)| <= w_i + s v_i
//
// so where all of it lies on one side of an axis-aligned plane follows from linear inequalities in s, and where it may
// be in a box is an interval. From its ends the pencil goes from cube to cube of empty macro cells, as each ray does in
// empty_space.wgsl; what is left is handed on. A tile of which nothing is left gets what a ray finds in no volume, and
// is not drawn. What is left out would have added nothing: the picture is the same to the bit (`sampling.md` 5).

#import pencil
#import known_{known}
#import nothing_{left}
#import ray_tile

// Parts of a picture that are looked through at once.
const MAX_PARTS: u32 = 256u;

struct RayList {
    // A dispatch, as Vulkan reads it: a workgroup a tile.
    tiles: atomic<u32>,
    down: u32,
    deep: u32,
    nothing: u32,
    // In tiles: the first and how many, across and down.
    parts: array<vec4<u32>, MAX_PARTS>,
}

@group(0) @binding(42) var<storage, read_write> ray_list: RayList;
@group(0) @binding(43) var ray_tiles: texture_storage_2d<rgba32float, write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let part = ray_list.parts[id.z];
    if any(id.xy >= part.zw) {
        return;
    }
    let tile = part.xy + id.xy;
    let pencil = pencil_of(vec2<f32>(TILE_PIXELS * tile) + 0.5 * f32(TILE_PIXELS));
    let within = known_part(pencil, box_part(pencil));
    if within.x < within.y {
        let index = atomicAdd(&ray_list.tiles, 1u);
        textureStore(ray_tiles, entry_of(index), vec4(vec2<f32>(tile), lengths(pencil, within)));
    } else if frame.is_first_brick != 0u {
        leave_nothing(TILE_PIXELS * tile);
    }
}
