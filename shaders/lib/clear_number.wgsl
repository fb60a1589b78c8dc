// What rays of projections leave that meet nothing: no value, no depth, no sample.

#import frame
#import ray_tile

@group(0) @binding(6) var accumulation: texture_storage_2d<rgba32float, write>;

fn clear_tile(corner: vec2<u32>) {
    for (var k = 0u; k < TILE_PIXELS * TILE_PIXELS; k++) {
        let pixel = corner + vec2(k % TILE_PIXELS, k / TILE_PIXELS);
        if all(pixel < frame.extent_pixels) {
            textureStore(accumulation, pixel, vec4(0.0, 0.0, -1.0, 0.0));
        }
    }
}
