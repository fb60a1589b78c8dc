// A batch of slices that was blended into a target of its own, laid onto what earlier batches have left.
//
// Blending in 16-bit floats loses thin slices after some hundred of them (`sampling.md` 5); batches of at
// most 64, put together here in f32, do not.

#import merge_{operator}

@group(0) @binding(1) var batch: texture_2d<f32>;
@group(0) @binding(6) var accumulation: texture_storage_2d<rgba32float, read_write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if any(id.xy >= textureDimensions(batch)) {
        return;
    }
    let added = textureLoad(batch, id.xy, 0);
    textureStore(accumulation, id.xy, merged(textureLoad(accumulation, id.xy), added));
}
