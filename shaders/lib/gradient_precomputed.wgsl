// Gradients that precompute_gradients.wgsl has made at the voxels, as parts of the range of values, between them by the
// device's sampler: as exact as half floats and the sampler's sub-texel bits.

#import gradient_taps

const GRADIENT_KEPT: u32 = 6u;
const GRADIENT_KEPT_SOBEL: u32 = 7u;

@group(0) @binding(31) var gradient_sampler: sampler;

// Value per voxel along each grid axis.
fn kept_gradient(place: Place) -> vec3<f32> {
    let kept = frame.gradient_scale * linear_texel_at(gradient_source, gradient_sampler, place).xyz;
    if frame.gradient_operator == GRADIENT_KEPT_SOBEL {
        return kept;
    }
    // Differences across the outermost centres grow less with every part of a voxel beyond: their far tap moves
    // towards the edge, their near one is the edge already.
    let voxel = voxel_of(place);
    let beyond = max(max(0.5 - voxel, voxel - (frame.dims - 0.5)), vec3(0.0));
    return (1.0 - beyond) * kept;
}
