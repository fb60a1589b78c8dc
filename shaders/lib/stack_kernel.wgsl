// A kernel's 9 or 16 pixels of a slice by texel fetches: the same on every device. Rows across, then down.

#import stack
#import stack_footprint_kernel

fn filtered(values: Values, coding: Coding, place: Place) -> f32 {
    let taps = kernel_taps(place.voxel);
    let last = vec3<i32>(frame.dims) - 1;
    // Texels and weights of the four taps across and down.
    var at = array<vec3<i32>, 4>();
    var across = vec4(0.0);
    var down = vec4(0.0);
    for (var i = 0; i < 4; i++) {
        at[i] = texel_of(clamp(taps.first + i, vec3(0), last));
        let weight = in_stack(taps.weights[i]);
        across[i] = weight.x;
        down[i] = weight.y;
    }
    let layer = place.slice - i32(frame.brick_origin[frame.slice_axis]);
    let count = select(4, 3, frame.kernel == KERNEL_QUADRATIC);
    var sum = 0.0;
    for (var j = 0; j < count; j++) {
        let row = vec4(
            decoded_at(values, coding, vec2(at[0].x, at[j].y), layer),
            decoded_at(values, coding, vec2(at[1].x, at[j].y), layer),
            decoded_at(values, coding, vec2(at[2].x, at[j].y), layer),
            decoded_at(values, coding, vec2(at[3].x, at[j].y), layer),
        );
        sum += down[j] * dot(across, row);
    }
    return value_from_code(coding, sum);
}

fn decoded_at(values: Values, coding: Coding, texel: vec2<i32>, layer: i32) -> f32 {
    return code_from_texel(coding, textureLoad(values, texel, layer, 0).x);
}
