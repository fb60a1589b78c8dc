// Splats projected: one number a ray, which a resolve classifies once. Sums are exact integrals of the splatted field.
// CPU reference: src/technique/splat/reference.rs.

#import drawn_tile
#import splatted
#import splat_value

// Projected value, weight (0: nothing was met), depth (negative: none), splats.
@group(0) @binding(6) var accumulation: texture_storage_2d<rgba32float, read_write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) own: vec3<u32>) {
    let pixel = pixel_in(drawn_tile(group), own.xy);
    if any(pixel >= frame.extent_pixels) {
        return;
    }
    let found = splatted(vec2<f32>(pixel) + 0.5, gathered_before(pixel));
    textureStore(accumulation, pixel, vec4(found.value, found.weight, found.depth, found.samples));
}

// What the parts before have left in the image.
fn gathered_before(pixel: vec2<u32>) -> Accumulator {
    if frame.is_first_brick != 0u {
        return begin();
    }
    let before = textureLoad(accumulation, pixel);
    return Accumulator(before.x, before.y, before.z, before.w);
}
