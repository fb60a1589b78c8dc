// The gradient of the value, per world length: how steep the field is along each grid axis, g, and the chain rule
// with voxel = A world,
//
//     gradient = A^T g = sum of g_k (row k of A)
//
// so a grid that is oblique, sheared or not isotropic has the gradient of the field that was sampled on it
// (`algorithms.md` T7). How steep: central differences of the chosen filter one voxel before and after,
//
//     g_k = (f(p + e_k) - f(p - e_k)) / 2
//
// or weights of the voxels around, `gradient_taps.wgsl`, or what was kept of either at the voxels. Taps outside the grid are those of its edge, a tap without
// data makes it zero (`sampling.md` 2). Across the slices of a stack the taps lie in the slices beside.
// Twin: src/technique/gradient.rs.

#import gradient_taps
#import gradient_kept

fn gradient_at(place: Place) -> vec3<f32> {
    var voxel = vec3(0.0);
    var have_data = true;
    if frame.gradient_operator >= GRADIENT_KEPT {
        voxel = kept_gradient(place);
    } else if frame.gradient_operator != GRADIENT_CENTRAL {
        voxel = weighted_gradient(voxel_of(place));
    } else {
        // One look-up in a loop, not six: LLVM takes exponential time over six wide kernels, which are loops themselves.
        for (var tap = 0u; tap < 6u; tap++) {
            let sign = select(1.0, -1.0, (tap & 1u) != 0u);
            var step = vec3(0.0);
            step[tap >> 1u] = sign;
            let at = shifted(place, step);
            have_data = have_data && volume_is_valid(footprint_of(at));
            voxel[tap >> 1u] += 0.5 * sign * volume_value(at);
        }
    }
    return select(vec3(0.0), (frame.voxel_from_world * voxel).xyz, have_data);
}
