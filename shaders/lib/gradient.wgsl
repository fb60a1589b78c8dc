// The gradient of the value, per world length: central differences of the chosen filter one voxel before and
// after along each grid axis, and the chain rule with voxel = A world,
//
//     g_k = (f(p + e_k) - f(p - e_k)) / 2        gradient = A^T g = sum of g_k (row k of A)
//
// or Sobel's operator over the 26 voxels around, which smooths each difference across its axis by 1/4, 1/2, 1/4,
//
//     g = sum of n 2^(-2 - |n_x| - |n_y| - |n_z|) f(p + n)        n in {-1, 0, 1}^3
//
// so a grid that is oblique, sheared or not isotropic has the gradient of the field that was sampled on it
// (`algorithms.md` T7). Taps outside the grid are those of its edge, a tap without data makes it zero
// (`sampling.md` 2). Across the slices of a stack the taps lie in the slices beside. Twin: src/technique/gradient.rs.

const GRADIENT_CENTRAL: u32 = 0u;
const GRADIENT_SOBEL: u32 = 1u;

fn gradient_at(place: Place) -> vec3<f32> {
    if frame.gradient_stencil == GRADIENT_SOBEL {
        return (frame.voxel_from_world * sobel(place)).xyz;
    }
    return (frame.voxel_from_world * central(place)).xyz;
}

// Along the grid axes.
fn central(place: Place) -> vec3<f32> {
    let x = vec3(1.0, 0.0, 0.0);
    let y = vec3(0.0, 1.0, 0.0);
    let z = vec3(0.0, 0.0, 1.0);
    if !(taps_have_data(place, x) && taps_have_data(place, y) && taps_have_data(place, z)) {
        return vec3(0.0);
    }
    return vec3(difference(place, x), difference(place, y), difference(place, z));
}

fn difference(place: Place, step: vec3<f32>) -> f32 {
    return 0.5 * (volume_value(shifted(place, step)) - volume_value(shifted(place, -step)));
}

fn taps_have_data(place: Place, step: vec3<f32>) -> bool {
    return volume_is_valid(footprint_of(shifted(place, step))) && volume_is_valid(footprint_of(shifted(place, -step)));
}

fn sobel(place: Place) -> vec3<f32> {
    var sum = vec3(0.0);
    for (var i = 0; i < 27; i++) {
        let step = vec3<f32>(vec3(i % 3, i / 3 % 3, i / 9) - 1);
        let around = abs(step.x) + abs(step.y) + abs(step.z);
        if around == 0.0 {
            continue;
        }
        let near = shifted(place, step);
        if !volume_is_valid(footprint_of(near)) {
            return vec3(0.0);
        }
        sum += exp2(-2.0 - around) * volume_value(near) * step;
    }
    return sum;
}
