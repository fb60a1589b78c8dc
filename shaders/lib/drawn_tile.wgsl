// The tile that a workgroup draws (shaders/ray_tiles.wgsl), and which of its pixels an invocation has. Drivers on CPUs
// put eight invocations that follow each other along x to work side by side: here they have a block of 4 x 2 pixels,
// whose rays are nearer to one another than those of a row of eight.

#import ray_tile

// The tile: across, down; and the part of its rays that counts, in world lengths: samples before and behind it show
// nothing.
@group(0) @binding(43) var ray_tiles: texture_2d<f32>;

struct RayTile {
    corner: vec2<u32>,
    within: vec2<f32>,
}

fn drawn_tile(group: vec3<u32>) -> RayTile {
    let entry = textureLoad(ray_tiles, entry_of(group.x), 0);
    return RayTile(TILE_PIXELS * vec2<u32>(entry.xy), entry.zw);
}

fn pixel_in(tile: RayTile, own: vec2<u32>) -> vec2<u32> {
    return tile.corner + vec2((own.x & 3u) + 4u * (own.y & 1u), (own.x >> 2u) + (own.y & 6u));
}

// The part of an interval of a ray that counts.
fn counted(interval: vec2<f32>, tile: RayTile) -> vec2<f32> {
    return vec2(max(interval.x, tile.within.x), min(interval.y, tile.within.y));
}
