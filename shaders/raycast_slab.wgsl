// Ray casting with pre-integrated classification: the samples are slabs, from front to back.
// CPU reference: src/technique/raycast/reference.rs.

#import {walk}
#import drawn_tile

// Premultiplied colour and alpha.
@group(0) @binding(6) var picture: texture_storage_2d<rgba32float, read_write>;
// What the mode keeps, depth (negative: none), transmittance, samples.
@group(0) @binding(7) var layers: texture_storage_2d<rgba32float, read_write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) own: vec3<u32>) {
    let tile = drawn_tile(group);
    let pixel = pixel_in(tile, own.xy);
    if any(pixel >= frame.extent_pixels) {
        return;
    }
    let found = march(vec2<f32>(pixel) + 0.5, tile, gathered_before(pixel));
    textureStore(picture, pixel, picture_of(found));
    textureStore(layers, pixel, beside_of(found));
}

// What nearer bricks have left in the images.
fn gathered_before(pixel: vec2<u32>) -> Accumulator {
    if frame.is_first_brick != 0u {
        return begin();
    }
    return resumed(textureLoad(picture, pixel), textureLoad(layers, pixel));
}
