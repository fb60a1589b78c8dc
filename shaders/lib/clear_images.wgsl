// No light, what the mode keeps (`kept`), no depth, all of the light behind, no sample.

#import frame
#import ray_tile

@group(0) @binding(6) var picture: texture_storage_2d<rgba32float, write>;
@group(0) @binding(7) var layers: texture_storage_2d<rgba32float, write>;

fn clear_tile(corner: vec2<u32>) {
    for (var k = 0u; k < TILE_PIXELS * TILE_PIXELS; k++) {
        let pixel = corner + vec2(k % TILE_PIXELS, k / TILE_PIXELS);
        if all(pixel < frame.extent_pixels) {
            textureStore(picture, pixel, vec4(0.0));
            textureStore(layers, pixel, vec4(kept(), -1.0, 1.0, 0.0));
        }
    }
}
