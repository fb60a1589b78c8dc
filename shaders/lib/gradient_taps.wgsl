// Gradients as weights of the 64 voxels around, whatever filter makes the value. Along each axis there are weights w
// of the value and weights s of the slope; with v the voxels (or coefficients) i-1 .. i+2 of each axis,
//
//     g_x = sum of s(x) w(y) w(z) v(x, y, z)      and so on
//
//     linear        central differences of the trilinear field, one voxel before and after
//                   w  0, g, f, 0                   s  -g/2, -f/2, g/2, f/2
//     Sobel         of the same field, smoothed across each difference by 1/4, 1/2, 1/4
//                   w  g/4, (1+g)/4, (1+f)/4, f/4   s  as linear
//     quadratic     the derivative of the kernel of that name, weights of kernel.wgsl
//                   s  -g, g-f, f, 0
//     cubic         s  -g^2/2, f(3f-4)/2, g(4-3g)/2, f^2/2
//     Catmull-Rom   s  g(3f-1)/2, f(9f-10)/2, g(10-9g)/2, f(3f-2)/2
//
// f is the fraction of p - 1/2 (quadratic: of p), g = 1 - f. All but linear hold p at the outermost centres: beyond
// them the slope is that at the edge. CPU reference: src/technique/gradient_taps.rs.

#import frame
#import value

const GRADIENT_CENTRAL: u32 = 0u;
const GRADIENT_LINEAR: u32 = 1u;
const GRADIENT_SOBEL: u32 = 2u;
const GRADIENT_QUADRATIC: u32 = 3u;
const GRADIENT_CUBIC: u32 = 4u;
const GRADIENT_CATMULL_ROM: u32 = 5u;

// Voxels, coefficients or kept gradients, in the bricks of the volume; the volume itself where that is what is read.
@group(0) @binding(30) var gradient_source: Values;

// A lane an axis.
struct GradientTaps {
    first: vec3<i32>,
    weights: array<vec3<f32>, 4>,
    slopes: array<vec3<f32>, 4>,
}

fn gradient_taps(voxel: vec3<f32>) -> GradientTaps {
    let is_held = frame.gradient_operator >= GRADIENT_SOBEL;
    let inside = select(voxel, clamp(voxel, vec3(0.5), frame.dims - 0.5), is_held);
    let base = inside - select(0.5, 0.0, frame.gradient_operator == GRADIENT_QUADRATIC);
    let below = floor(base);
    let f = base - below;
    let g = 1.0 - f;
    let none = vec3(0.0);
    var taps = GradientTaps(
        vec3<i32>(below) - 1,
        array(none, g, f, none),
        array(-0.5 * g, -0.5 * f, 0.5 * g, 0.5 * f),
    );
    switch frame.gradient_operator {
        case GRADIENT_SOBEL: {
            taps.weights = array(0.25 * g, 0.25 * (1.0 + g), 0.25 * (1.0 + f), 0.25 * f);
        }
        case GRADIENT_QUADRATIC: {
            taps.weights = array(0.5 * g * g, 0.5 + f * g, 0.5 * f * f, none);
            taps.slopes = array(-g, g - f, f, none);
        }
        case GRADIENT_CUBIC: {
            let sixth = 1.0 / 6.0;
            taps.weights = array(sixth * g * g * g, spline_middle(f), spline_middle(g), sixth * f * f * f);
            taps.slopes = array(-0.5 * g * g, 0.5 * f * (3.0 * f - 4.0), 0.5 * g * (4.0 - 3.0 * g), 0.5 * f * f);
        }
        case GRADIENT_CATMULL_ROM: {
            taps.weights = array(-(0.5 * f * g * g), catmull_middle(f), catmull_middle(g), -(0.5 * g * f * f));
            taps.slopes = array(
                0.5 * g * (3.0 * f - 1.0),
                0.5 * f * (9.0 * f - 10.0),
                0.5 * g * (10.0 - 9.0 * g),
                0.5 * f * (3.0 * f - 2.0),
            );
        }
        default: {}
    }
    return taps;
}

fn spline_middle(f: vec3<f32>) -> vec3<f32> {
    return 2.0 / 3.0 - 0.5 * f * f * (2.0 - f);
}

fn catmull_middle(f: vec3<f32>) -> vec3<f32> {
    return 1.0 + 0.5 * f * f * (3.0 * f - 5.0);
}

// Value per voxel along each grid axis.
fn weighted_gradient(voxel: vec3<f32>) -> vec3<f32> {
    let taps = gradient_taps(voxel);
    let last = vec3<i32>(frame.dims) - 1;
    let w = taps.weights;
    let s = taps.slopes;
    let wx = vec4(w[0].x, w[1].x, w[2].x, w[3].x);
    let wy = vec4(w[0].y, w[1].y, w[2].y, w[3].y);
    let wz = vec4(w[0].z, w[1].z, w[2].z, w[3].z);
    let sx = vec4(s[0].x, s[1].x, s[2].x, s[3].x);
    let sy = vec4(s[0].y, s[1].y, s[2].y, s[3].y);
    let sz = vec4(s[0].z, s[1].z, s[2].z, s[3].z);
    let x = clamp(taps.first.x + vec4(0, 1, 2, 3), vec4(0), vec4(last.x));
    var sum = vec3(0.0);
    var have_data = true;
    for (var k = 0; k < 4; k++) {
        let z = clamp(taps.first.z + k, 0, last.z);
        for (var j = 0; j < 4; j++) {
            let y = clamp(taps.first.y + j, 0, last.y);
            let row = gradient_row(x, y, z);
            let slope = dot(sx, row);
            let value = dot(wx, row);
            sum += vec3(slope * wy[j] * wz[k], value * sy[j] * wz[k], value * wy[j] * sz[k]);
            // What counts is told by factors: their product may be too small for a float.
            let has_slope = wy[j] != 0.0 && wz[k] != 0.0;
            let has_value = (sy[j] != 0.0 && wz[k] != 0.0) || (wy[j] != 0.0 && sz[k] != 0.0);
            let counts = (vec4(has_slope) & (sx != vec4(0.0))) | (vec4(has_value) & (wx != vec4(0.0)));
            have_data = have_data && !any(counts & !valid_row(x, y, z));
        }
    }
    return select(vec3(0.0), frame.slope * sum, have_data);
}

fn gradient_row(x: vec4<i32>, y: i32, z: i32) -> vec4<f32> {
    return vec4(
        gradient_code(vec3(x.x, y, z)),
        gradient_code(vec3(x.y, y, z)),
        gradient_code(vec3(x.z, y, z)),
        gradient_code(vec3(x.w, y, z)),
    );
}

// Without the offset, which no difference has.
fn gradient_code(voxel: vec3<i32>) -> f32 {
    let code = texel_at(gradient_source, voxel).x * frame.gradient_scale;
    return select(code, round(code), frame.gradient_codes_are_integers != 0u);
}

fn valid_row(x: vec4<i32>, y: i32, z: i32) -> vec4<bool> {
    return vec4(
        voxel_is_valid(vec3(x.x, y, z)),
        voxel_is_valid(vec3(x.y, y, z)),
        voxel_is_valid(vec3(x.z, y, z)),
        voxel_is_valid(vec3(x.w, y, z)),
    );
}
