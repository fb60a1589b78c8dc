// Kernels over three or four voxels of each axis, as weights of their taps. With p' = clamp(p, 1/2, dims - 1/2),
// g = 1 - f:
//
//     quadratic B-spline   b = p',        i = floor(b), f = b - i, taps i-1 .. i+1
//                          g^2/2,  1/2 + f g,  f^2/2
//     cubic B-spline       b = p' - 1/2,  i = floor(b), f = b - i, taps i-1 .. i+2
//                          g^3/6,  2/3 - f^2 (2 - f)/2,  2/3 - g^2 (2 - g)/2,  f^3/6
//     Catmull-Rom          as cubic
//                          -f g^2/2,  1 + f^2 (3f - 5)/2,  1 + g^2 (3g - 5)/2,  -f^2 g/2
//
// Which one it is stands in the parameters and not in a variant: the branch is taken alike by all, and is nothing
// beside the fetches. CPU reference: src/volume/kernel.rs.

#import frame
#import footprint

const KERNEL_QUADRATIC: u32 = 0u;
const KERNEL_CUBIC: u32 = 1u;
const KERNEL_CATMULL_ROM: u32 = 2u;

// The first voxel of each axis, perhaps outside of the grid, and the weights, a lane an axis; the last of the
// quadratic is 0.
struct Taps {
    first: vec3<i32>,
    fraction: vec3<f32>,
    weights: array<vec3<f32>, 4>,
}

fn kernel_taps(voxel: vec3<f32>) -> Taps {
    let inside = clamp(voxel, vec3(0.5), frame.dims - 0.5);
    let base = inside - select(0.5, 0.0, frame.kernel == KERNEL_QUADRATIC);
    let below = floor(base);
    let fraction = base - below;
    return Taps(vec3<i32>(below) - 1, fraction, kernel_weights(fraction));
}

fn kernel_weights(f: vec3<f32>) -> array<vec3<f32>, 4> {
    let g = 1.0 - f;
    switch frame.kernel {
        case KERNEL_QUADRATIC: {
            return array(0.5 * g * g, 0.5 + f * g, 0.5 * f * f, vec3(0.0));
        }
        case KERNEL_CUBIC: {
            let sixth = 1.0 / 6.0;
            return array(sixth * g * g * g, cubic_middle(f), cubic_middle(g), sixth * f * f * f);
        }
        default: {
            return array(-(0.5 * f * g * g), catmull_inner(f), catmull_inner(g), -(0.5 * g * f * f));
        }
    }
}

fn cubic_middle(f: vec3<f32>) -> vec3<f32> {
    return 2.0 / 3.0 - 0.5 * f * f * (2.0 - f);
}

fn catmull_inner(f: vec3<f32>) -> vec3<f32> {
    return 1.0 + 0.5 * f * f * (3.0 * f - 5.0);
}

// The voxels with a weight: at a fraction of 0 the outermost vanish.
fn kernel_footprint(voxel: vec3<f32>) -> Footprint {
    let taps = kernel_taps(voxel);
    let is_between = taps.fraction > vec3(0.0);
    let first = select(0, 1, frame.kernel == KERNEL_CATMULL_ROM);
    // Last taps where the fraction is 0, and elsewhere.
    let at = select(2, 1, frame.kernel != KERNEL_CUBIC);
    let between = select(3, 2, frame.kernel == KERNEL_QUADRATIC);
    let low = taps.first + select(vec3(first), vec3(0), is_between);
    let high = taps.first + select(vec3(at), vec3(between), is_between);
    let last = vec3<i32>(frame.dims) - 1;
    return Footprint(clamp(low, vec3(0), last), clamp(high, vec3(0), last));
}
