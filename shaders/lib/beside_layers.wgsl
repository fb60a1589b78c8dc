// What rays keep beside the picture.

// What the mode keeps, depth (negative: none), transmittance, samples.
@group(0) @binding(7) var layers: texture_storage_2d<rgba32float, read_write>;

fn leave_beside(pixel: vec2<u32>, found: Accumulator) {
    textureStore(layers, pixel, beside_of(found));
}

// What nearer bricks have left in the images.
fn gathered_before(pixel: vec2<u32>) -> Accumulator {
    if frame.is_first_brick != 0u {
        return begin();
    }
    return resumed(textureLoad(picture, pixel), textureLoad(layers, pixel));
}
