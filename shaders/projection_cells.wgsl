// The exact extreme of the trilinear field along each ray: no sample misses it.
// CPU reference: src/technique/projection/exact.rs.

#import march_cells
#import drawn_tile

// Projected value, weight (0: no valid cell), depth (negative: none), cells.
@group(0) @binding(6) var accumulation: texture_storage_2d<rgba32float, read_write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) own: vec3<u32>) {
    let tile = drawn_tile(group);
    let pixel = pixel_in(tile, own.xy);
    if any(pixel >= frame.extent_pixels) {
        return;
    }
    let found = march(vec2<f32>(pixel) + 0.5, tile, gathered_before(pixel));
    textureStore(accumulation, pixel, vec4(found.value, found.weight, found.depth, found.samples));
}

// What nearer bricks have left in the image.
fn gathered_before(pixel: vec2<u32>) -> Accumulator {
    if frame.is_first_brick != 0u {
        return begin();
    }
    let before = textureLoad(accumulation, pixel);
    return Accumulator(before.x, before.y, before.z, before.w);
}
