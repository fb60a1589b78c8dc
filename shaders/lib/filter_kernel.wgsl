// A kernel's 27 or 64 voxels by texel fetches: the same on every device. Rows along x, then y, then z.

#import box
#import footprint_kernel

fn filtered(values: Values, coding: Coding, voxel: vec3<f32>) -> f32 {
    let taps = kernel_taps(voxel);
    let last = vec3<i32>(frame.dims) - 1;
    let origin = vec3<i32>(frame.brick_origin);
    // Texels of the four taps of each axis.
    var at = array<vec3<i32>, 4>();
    for (var i = 0; i < 4; i++) {
        at[i] = clamp(taps.first + i, vec3(0), last) - origin;
    }
    let w = taps.weights;
    let x = vec4(at[0].x, at[1].x, at[2].x, at[3].x);
    let wx = vec4(w[0].x, w[1].x, w[2].x, w[3].x);
    let wy = vec4(w[0].y, w[1].y, w[2].y, w[3].y);
    let wz = vec4(w[0].z, w[1].z, w[2].z, w[3].z);
    let count = select(4, 3, frame.kernel == KERNEL_QUADRATIC);
    var sum = 0.0;
    for (var k = 0; k < count; k++) {
        var plane = 0.0;
        for (var j = 0; j < count; j++) {
            plane += wy[j] * dot(wx, row(values, coding, x, at[j].y, at[k].z));
        }
        sum += wz[k] * plane;
    }
    return value_from_code(coding, sum);
}

fn row(values: Values, coding: Coding, x: vec4<i32>, y: i32, z: i32) -> vec4<f32> {
    return vec4(
        decoded_at(values, coding, vec3(x.x, y, z)),
        decoded_at(values, coding, vec3(x.y, y, z)),
        decoded_at(values, coding, vec3(x.z, y, z)),
        decoded_at(values, coding, vec3(x.w, y, z)),
    );
}

fn decoded_at(values: Values, coding: Coding, texel: vec3<i32>) -> f32 {
    return code_from_texel(coding, textureLoad(values, texel, 0).x);
}
