// The gradient at a position in voxel space between the slices of a stack: central differences of what is interpolated
// there, one voxel before and after (`gradient.wgsl`). CPU reference: src/technique/slices_2d/reference.rs.

#import gradient_central

fn gradient_in(voxel: vec3<f32>) -> vec3<f32> {
    var slope = Slope(vec3(0.0), true);
    for (var tap = 0u; tap < 6u; tap++) {
        let sign = select(1.0, -1.0, (tap & 1u) != 0u);
        var at = voxel;
        at[tap >> 1u] += sign;
        let level = level_at(at[frame.slice_axis]);
        slope.have_data = slope.have_data && has_data_between(level, at);
        slope.voxel[tap >> 1u] += 0.5 * sign * value_between(level, at);
    }
    return gradient_of(slope);
}
