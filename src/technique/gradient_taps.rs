//! Gradients as weights of the 64 voxels around, whatever filter makes the value: CPU reference of
//! `shaders/lib/gradient_taps.wgsl`, which has the weights in a table.
//!
//! ```text
//! g_x = sum of s(x) w(y) w(z) v(x, y, z)      and so on, w of the value and s of the slope along an axis
//! ```
//!
//! Central differences of the trilinear field are of this form: with fraction f from voxel i on, f(p + 1) - f(p - 1)
//! weights the voxels i-1 .. i+2 by -(1 - f), -f, 1 - f, f. So is Sobel's operator on it (Sobel and Feldman 1968, in
//! the plane), which smooths each difference across its axis by 1/4, 1/2, 1/4. Derivatives of B-splines: Unser,
//! "Splines: A Perfect Fit for Signal and Image Processing", 1999.

use super::gradient_filter::Operator;
use crate::real::{Real, add, scale};
use crate::shaders::Frame;
use crate::volume::{Volume, kernel::Kernel, sample::voxel_at};

/// What one axis contributes.
#[derive(Clone, Copy, Debug)]
struct Taps<R> {
    /// The voxel of the first weight, perhaps outside of the grid.
    first: i32,
    weights: [R; 4],
    slopes: [R; 4],
}

impl<R: Real> Taps<R> {
    fn new(operator: Operator, p: R, dim: u32) -> Self {
        let n = R::from_f64;
        let half = n(0.5);
        let is_quadratic = operator == Operator::Kernel(Kernel::Quadratic);
        let inside = match operator {
            Operator::Kernel(_) | Operator::Sobel => p.max(half).min(n(f64::from(dim)) - half),
            _ => p,
        };
        let base = if is_quadratic { inside } else { inside - half };
        let below = base.floor();
        let f = base - below;
        let g = n(1.0) - f;
        let differences = [-(half * g), -(half * f), half * g, half * f];
        let (weights, slopes) = match operator {
            Operator::Kernel(kernel) => (kernel.weights(f), slopes(kernel, f, g)),
            Operator::Sobel => {
                let smoothed = [g, n(1.0) + g, n(1.0) + f, f];
                (smoothed.map(|w| n(0.25) * w), differences)
            }
            Operator::Linear | Operator::Central => ([n(0.0), g, f, n(0.0)], differences),
        };
        Self {
            first: below.to_i32().saturating_sub(1),
            weights,
            slopes,
        }
    }
}

/// The derivatives of a kernel's weights by the position.
fn slopes<R: Real>(kernel: Kernel, f: R, g: R) -> [R; 4] {
    let n = R::from_f64;
    let half = n(0.5);
    match kernel {
        Kernel::Quadratic => [-g, g - f, f, n(0.0)],
        Kernel::Cubic => [
            -(half * g * g),
            half * f * (n(3.0) * f - n(4.0)),
            half * g * (n(4.0) - n(3.0) * g),
            half * f * f,
        ],
        Kernel::CatmullRom => [
            half * g * (n(3.0) * f - n(1.0)),
            half * f * (n(9.0) * f - n(10.0)),
            half * g * (n(10.0) - n(9.0) * g),
            half * f * (n(3.0) * f - n(2.0)),
        ],
    }
}

/// Value per world length along each world axis at `p` in voxel space. `source` holds voxels, or coefficients along
/// all three axes. Zero where a voxel with a weight has no data.
pub fn weighted_gradient<R: Real>(
    frame: &Frame,
    source: &Volume,
    operator: Operator,
    p: [R; 3],
) -> [R; 3] {
    let zero = R::from_f64(0.0);
    let taps: [Taps<R>; 3] = std::array::from_fn(|k| Taps::new(operator, p[k], source.dims[k]));
    let [tx, ty, tz] = &taps;
    let mut sum = [zero; 3];
    for k in 0..4 {
        for j in 0..4 {
            let has_slope = ty.weights[j] != zero && tz.weights[k] != zero;
            let has_value = (ty.slopes[j] != zero && tz.weights[k] != zero)
                || (ty.weights[j] != zero && tz.slopes[k] != zero);
            let (mut slope, mut value) = (zero, zero);
            for i in 0..4 {
                let at = [(tx, i), (ty, j), (tz, k)].map(|(t, n)| t.first.saturating_add(n as i32));
                let (code, is_valid) = voxel_at(source, at);
                let counts =
                    has_slope && tx.slopes[i] != zero || has_value && tx.weights[i] != zero;
                if counts && !is_valid {
                    return [zero; 3];
                }
                slope = slope + tx.slopes[i] * R::from_f32(code);
                value = value + tx.weights[i] * R::from_f32(code);
            }
            let row = [
                slope * ty.weights[j] * tz.weights[k],
                value * ty.slopes[j] * tz.weights[k],
                value * ty.weights[j] * tz.slopes[k],
            ];
            sum = add(sum, row);
        }
    }
    let per_code = R::from_f64(source.rescale.slope);
    let rows = frame.voxel_from_world.iter().zip(sum);
    rows.fold([zero; 3], |gradient, (row, slope)| {
        let row = [row[0], row[1], row[2]].map(R::from_f32);
        add(gradient, scale(row, per_code * slope))
    })
}
