// Splatting: every voxel is a Gaussian, of which each ray takes the exact integral, composited in sheets from front to
// back (Westover 1990; Mueller and Crawfis 1998). One invocation a pixel, which goes through the voxels near its ray in
// object order. CPU reference: src/technique/splat/reference.rs.

#import drawn_tile
#import beside_layers
#import splatted
#import splat_{take}

// Premultiplied colour and alpha.
@group(0) @binding(6) var picture: texture_storage_2d<rgba32float, read_write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) own: vec3<u32>) {
    let pixel = pixel_in(drawn_tile(group), own.xy);
    if any(pixel >= frame.extent_pixels) {
        return;
    }
    let found = splatted(vec2<f32>(pixel) + 0.5, gathered_before(pixel));
    textureStore(picture, pixel, picture_of(found));
    leave_beside(pixel, found);
}
