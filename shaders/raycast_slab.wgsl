// Ray casting with pre-integrated classification: the samples are slabs, from front to back.
// Twin: src/technique/raycast/reference.rs.

#import {walk}

// Premultiplied colour and alpha.
@group(0) @binding(6) var picture: texture_storage_2d<rgba32float, read_write>;
// What the mode keeps, depth (negative: none), transmittance, samples.
@group(0) @binding(7) var layers: texture_storage_2d<rgba32float, read_write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if any(id.xy >= frame.extent_pixels) {
        return;
    }
    let found = march(vec2<f32>(id.xy) + 0.5, gathered_before(id.xy));
    textureStore(picture, id.xy, picture_of(found));
    textureStore(layers, id.xy, beside_of(found));
}

// What nearer bricks have left in the images.
fn gathered_before(pixel: vec2<u32>) -> Accumulator {
    if frame.is_first_brick != 0u {
        return begin();
    }
    return resumed(textureLoad(picture, pixel), textureLoad(layers, pixel));
}
