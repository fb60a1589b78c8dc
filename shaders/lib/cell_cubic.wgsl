// The trilinear field along a ray in a cell between eight voxel centres is a cubic,
//
//     f(s) = A0 + A1 s + A2 s^2 + A3 s^3
//
// which has its extremes where the ray enters or leaves the cell or where A1 + 2 A2 s + 3 A3 s^2 = 0 (Sakas,
// Grimm and Savopoulos 1995). CPU reference: src/technique/cell_cubic.rs.

#import value

// Numbers at the lower corner of a cell and at the upper one along x, by y and z.
struct Corners {
    low: vec4<f32>,
    high: vec4<f32>,
}

// At a part of the way along each axis.
fn mixed(corners: Corners, part: vec3<f32>) -> f32 {
    let x = corners.low + part.x * (corners.high - corners.low);
    return lerp(lerp(x.x, x.y, part.y), lerp(x.z, x.w, part.y), part.z);
}

// A0, A1, A2 and 3 A3 of a ray that is at p of the cell where it enters.
fn cubic_along(corners: Corners, p: vec3<f32>, d: vec3<f32>) -> vec4<f32> {
    let along_x = corners.high - corners.low;
    // f = k + kx x + ky y + kz z + kxy x y + kyz y z + kzx z x + kxyz x y z
    let kx = along_x.x;
    let ky = corners.low.y - corners.low.x;
    let kz = corners.low.z - corners.low.x;
    let kxy = along_x.y - along_x.x;
    let kzx = along_x.z - along_x.x;
    let kyz = corners.low.w - corners.low.z - ky;
    let kxyz = along_x.w - along_x.z - kxy;
    let a1 = kx * d.x + ky * d.y + kz * d.z
        + kxy * (p.x * d.y + p.y * d.x) + kyz * (p.y * d.z + p.z * d.y) + kzx * (p.z * d.x + p.x * d.z)
        + kxyz * (p.x * p.y * d.z + p.y * p.z * d.x + p.z * p.x * d.y);
    let a2 = kxy * d.x * d.y + kyz * d.y * d.z + kzx * d.z * d.x
        + kxyz * (p.x * d.y * d.z + p.y * d.z * d.x + p.z * d.x * d.y);
    let a3 = 3.0 * kxyz * d.x * d.y * d.z;
    return vec4(mixed(corners, p), a1, a2, a3);
}

// Where the derivative along the ray is zero, from where it enters; -1 where it is not.
fn extremes(cubic: vec4<f32>) -> vec2<f32> {
    let a1 = cubic.y;
    let a2 = cubic.z;
    let a3 = cubic.w;
    let inside = a2 * a2 - a3 * a1;
    if inside < 0.0 {
        return vec2(-1.0);
    }
    // The sum of equal signs: nothing cancels.
    let sum = -(a2 + select(-sqrt(inside), sqrt(inside), a2 >= 0.0));
    var roots = vec2(-1.0);
    if sum != 0.0 {
        roots.x = a1 / sum;
    }
    if a3 != 0.0 {
        roots.y = sum / a3;
    }
    return roots;
}
