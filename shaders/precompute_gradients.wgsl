// Gradients at the voxels, made once and kept: central differences
//
//     g_x = (v[x+1] - v[x-1]) / 2        and so on
//
// or Sobel's operator, which smooths each across its axis by 1/4, 1/2, 1/4. Both are linear in the voxels, so what is
// interpolated between kept gradients is the gradient of the trilinear field (`sampling.md` 7). One thread a voxel
// that the brick stores; the outermost of its halo are not those of the grid, and nothing reads them.
// CPU reference: the linear and Sobel's operator of src/technique/gradient_taps.rs at voxel centres.

#import precompute_{layout}
#import holes_none
#import gradient_taps

@compute @workgroup_size(4, 4, 4)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if any(id >= vec3<u32>(frame.brick_dims)) {
        return;
    }
    let voxel = vec3<i32>(id) + vec3<i32>(frame.brick_origin);
    keep(voxel, frame.slope * slope_at(voxel));
}

fn slope_at(voxel: vec3<i32>) -> vec3<f32> {
    let last = vec3<i32>(frame.dims) - 1;
    let x = clamp(voxel.x + vec3(-1, 0, 1), vec3(0), vec3(last.x));
    let is_sobel = frame.gradient_operator == GRADIENT_SOBEL;
    // What a row on this side, in the middle and on that side counts for.
    let across = select(vec3(0.0, 1.0, 0.0), vec3(0.25, 0.5, 0.25), is_sobel);
    var sum = vec3(0.0);
    for (var k = -1; k <= 1; k++) {
        for (var j = -1; j <= 1; j++) {
            if !is_sobel && j != 0 && k != 0 {
                continue;
            }
            let y = clamp(voxel.y + j, 0, last.y);
            let z = clamp(voxel.z + k, 0, last.z);
            let row = vec3(
                gradient_code(vec3(x.x, y, z)),
                gradient_code(vec3(x.y, y, z)),
                gradient_code(vec3(x.z, y, z)),
            );
            let value = dot(across, row);
            let wy = across[j + 1];
            let wz = across[k + 1];
            sum += vec3(0.5 * (row.z - row.x) * wy * wz, 0.5 * f32(j) * value * wz, 0.5 * f32(k) * value * wy);
        }
    }
    return sum;
}
