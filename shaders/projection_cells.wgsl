// The exact extreme of the trilinear field along each ray: no sample misses it.
// Twin: src/technique/projection/exact.rs.

#import march_cells

// Projected value, weight (0: no valid cell), depth (negative: none), cells.
@group(0) @binding(6) var accumulation: texture_storage_2d<rgba32float, read_write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if any(id.xy >= frame.extent_pixels) {
        return;
    }
    let found = march(vec2<f32>(id.xy) + 0.5, gathered_before(id.xy));
    textureStore(accumulation, id.xy, vec4(found.value, found.weight, found.depth, found.samples));
}

// What nearer bricks have left in the image.
fn gathered_before(pixel: vec2<u32>) -> Accumulator {
    if frame.is_first_brick != 0u {
        return begin();
    }
    let before = textureLoad(accumulation, pixel);
    return Accumulator(before.x, before.y, before.z, before.w);
}
