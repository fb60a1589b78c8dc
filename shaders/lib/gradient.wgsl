// The gradient of the value, per world length: central differences of the chosen filter one voxel before and
// after along each grid axis, and the chain rule with voxel = A world,
//
//     g_k = (f(p + e_k) - f(p - e_k)) / 2        gradient = A^T g = sum of g_k (row k of A)
//
// so a grid that is oblique, sheared or not isotropic has the gradient of the field that was sampled on it
// (`algorithms.md` T7). Taps outside the grid are those of its edge, a tap without data makes it zero
// (`sampling.md` 2). Across the slices of a stack the taps lie in the slices beside. Twin: src/technique/gradient.rs.

fn gradient_at(place: Place) -> vec3<f32> {
    let x = vec3(1.0, 0.0, 0.0);
    let y = vec3(0.0, 1.0, 0.0);
    let z = vec3(0.0, 0.0, 1.0);
    if !(taps_have_data(place, x) && taps_have_data(place, y) && taps_have_data(place, z)) {
        return vec3(0.0);
    }
    let voxel = vec3(difference(place, x), difference(place, y), difference(place, z));
    return (frame.voxel_from_world * voxel).xyz;
}

fn difference(place: Place, step: vec3<f32>) -> f32 {
    return 0.5 * (volume_value(shifted(place, step)) - volume_value(shifted(place, -step)));
}

fn taps_have_data(place: Place, step: vec3<f32>) -> bool {
    return volume_is_valid(footprint_of(shifted(place, step))) && volume_is_valid(footprint_of(shifted(place, -step)));
}
