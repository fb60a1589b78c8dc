// Central differences by six look-ups of whatever filter there is.

// In a loop: LLVM takes exponential time over six wide kernels, which are loops themselves.
fn central_slope(place: Place) -> Slope {
    var slope = Slope(vec3(0.0), true);
    for (var tap = 0u; tap < 6u; tap++) {
        let sign = select(1.0, -1.0, (tap & 1u) != 0u);
        var step = vec3(0.0);
        step[tap >> 1u] = sign;
        let at = shifted(place, step);
        slope.have_data = slope.have_data && volume_is_valid(footprint_of(at));
        slope.voxel[tap >> 1u] += 0.5 * sign * volume_value(at);
    }
    return slope;
}
