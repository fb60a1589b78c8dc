// The second derivative of the value along its gradient, per square of world length: with n the direction of the
// gradient, H the matrix of second derivatives and voxel = A world (Kindlmann & Durkin 1998, section 4),
//
//     f'' = g^T H g / |g|^2 = n^T H n = u^T H_voxel u        u = A n
//
// by second differences of the chosen filter over the voxels around,
//
//     H_kk = f(p + e_k) - 2 f(p) + f(p - e_k)        4 H_jk = sum of s t f(p + s e_j + t e_k) for s, t = 1, -1
//
// which is a sum of weighted taps. A tap without data makes it zero. CPU reference: src/technique/second_derivative.rs.

#import norm

fn second_derivative_at(place: Place, gradient: vec3<f32>) -> f32 {
    let magnitude = norm(gradient);
    if magnitude == 0.0 {
        return 0.0;
    }
    let u = (vec4(gradient / magnitude, 0.0) * frame.voxel_from_world).xyz;
    var sum = 0.0;
    var have_data = true;
    // One look-up in a loop: LLVM takes exponential time over several wide kernels, which are loops themselves.
    for (var tap = 0; tap < 27; tap++) {
        let step = vec3(f32(tap % 3 - 1), f32(tap / 3 % 3 - 1), f32(tap / 9 - 1));
        let away = dot(step, step);
        // The eight corners have no part in it.
        if away < 2.5 {
            let at = shifted(place, step);
            have_data = have_data && volume_is_valid(footprint_of(at));
            let along = step * u;
            let far = along.x + along.y + along.z;
            // Of two axes s t u_j u_k / 2, of one u_k^2.
            var weight = select(far * far, 0.5 * (along.x * along.y + along.y * along.z + along.z * along.x), away > 1.5);
            if away == 0.0 {
                weight = -2.0 * dot(u, u);
            }
            sum += weight * volume_value(at);
        }
    }
    return select(0.0, sum, have_data);
}
