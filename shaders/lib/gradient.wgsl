// The gradient of the value, per world length: how steep the field is along each grid axis, g, and the chain rule
// with voxel = A world,
//
//     gradient = A^T g = sum of g_k (row k of A)
//
// so a grid that is oblique, sheared or not isotropic has the gradient of the field that was sampled on it
// (`sampling.md` 7). How steep: central differences of the chosen filter one voxel before and after,
//
//     g_k = (f(p + e_k) - f(p - e_k)) / 2
//
// or weights of the voxels around, `gradient_taps.wgsl`, or what was kept of either at the voxels. Taps outside the
// grid are those of its edge, a tap without data makes it zero (`sampling.md` 2). Across the slices of a stack the taps
// lie in the slices beside. CPU reference: src/technique/gradient.rs.

#import gradient_central
#import gradient_taps
#import gradient_precomputed

fn gradient_at(place: Place) -> vec3<f32> {
    var slope = Slope(vec3(0.0), true);
    if frame.gradient_operator >= GRADIENT_KEPT {
        slope.voxel = kept_gradient(place);
    } else if frame.gradient_operator != GRADIENT_CENTRAL {
        slope.voxel = weighted_gradient(voxel_of(place));
    } else {
        slope = central_slope(place);
    }
    return gradient_of(slope);
}
