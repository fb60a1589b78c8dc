//! The second derivative of the value along its gradient: CPU reference of `shaders/lib/second_derivative.wgsl`.
//!
//! ```text
//! f'' = g^T H g / |g|^2 = u^T H_voxel u,        u = A g / |g|,  voxel = A world
//! H_kk = f(p + e_k) - 2 f(p) + f(p - e_k)        4 H_jk = sum of s t f(p + s e_j + t e_k) for s, t = 1, -1
//! ```
//!
//! (Kindlmann & Durkin 1998, section 4). Exact for a field that is cubic along the grid axes: second differences are
//! off by h^2 / 12 of the fourth derivative. Of an edge f = (1 + erf(x / (s sqrt 2))) / 2 it tells how far its middle
//! is, -s^2 f'' / f' = x.

use crate::real::{Real, dot};
use crate::shaders::Frame;

/// Value per square of world length, along `gradient`, from nineteen taps: `tap` filters the volume so many voxels
/// away from the sample. Zero where one of them has no data, and where nothing is steep.
pub fn second_derivative_of<R: Real>(
    frame: &Frame,
    gradient: [R; 3],
    tap: impl Fn([i32; 3]) -> Option<R>,
) -> R {
    let n = R::from_f64;
    let zero = n(0.0);
    let magnitude = dot(gradient, gradient).sqrt();
    if magnitude == zero {
        return zero;
    }
    let u = frame.voxel_from_world.map(|row| {
        let row = [row[0], row[1], row[2]].map(R::from_f32);
        dot(row, gradient) / magnitude
    });
    let mut sum = zero;
    for z in -1..=1 {
        for y in -1..=1 {
            for x in -1..=1 {
                let step: [i32; 3] = [x, y, z];
                let axes = step.iter().filter(|&&s| s != 0).count();
                if axes == 3 {
                    continue;
                }
                let Some(value) = tap(step) else { return zero };
                let [a, b, c] = std::array::from_fn(|k| n(step[k].into()) * u[k]);
                let weight = match axes {
                    0 => n(-2.0) * dot(u, u),
                    1 => (a + b + c) * (a + b + c),
                    _ => n(0.5) * (a * b + b * c + c * a),
                };
                sum = sum + weight * value;
            }
        }
    }
    sum
}
