//! Shear-warp on the CPU: CPU reference of `shaders/warp.wgsl` over that of the rays.

use crate::real::Real;
use crate::shaders::Frame;
use crate::technique::reference::{Gathered, Samples};

/// The mean of what the four base rays around a pixel gather, as it is blended; `ray` is what that of one base pixel does.
pub(crate) fn pixel<R: Real>(
    of: &impl Samples<R>,
    pixel: [R; 2],
    ray: impl Fn([R; 2]) -> Gathered<R>,
) -> Gathered<R> {
    let settings = of.settings();
    let zero = R::from_f64(0.0);
    let nothing = Gathered::of_blended([zero; 4], 0.0);
    let Some(around) = base_pixels(of.frame(), pixel) else {
        return nothing;
    };
    let is_extreme = settings.mode.projects_one_place();
    let mut sum = nothing;
    for (base_pixel, weight) in around {
        let found = ray(base_pixel);
        let mut given = found.accumulation;
        if is_extreme {
            // A ray without a value has no say, and leaves alpha to the others.
            given[0] = given[0] * given[1];
        }
        for (sum, given) in sum.accumulation.iter_mut().zip(given) {
            *sum = *sum + weight * given;
        }
        sum.samples += weight.to_f32() * found.samples;
    }
    if is_extreme && sum.accumulation[1] > zero {
        sum.accumulation[0] = sum.accumulation[0] / sum.accumulation[1];
    }
    sum
}

/// The base pixels around the place of a pixel, at their middles, with their weights; those outside of the image have nothing.
/// `None` where the pixel's ray does not meet the base plane before the eye.
fn base_pixels<R: Real>(frame: &Frame, [x, y]: [R; 2]) -> Option<Vec<([R; 2], R)>> {
    let row = |row: [f32; 4]| {
        let [a, b, c, _] = row.map(R::from_f32);
        x * a + y * b + c
    };
    let [u, v, w] = frame.base_from_pixel.map(row);
    // Not a number is nowhere either.
    if w.partial_cmp(&R::from_f64(0.0)) != Some(std::cmp::Ordering::Greater) {
        return None;
    }
    let (half, one) = (R::from_f64(0.5), R::from_f64(1.0));
    let place = [u / w - half, v / w - half];
    let low = place.map(R::floor);
    let part = [place[0] - low[0], place[1] - low[1]];
    let mut around = Vec::new();
    for [i, j] in [[0, 0], [1, 0], [0, 1], [1, 1]] {
        let weight = |k: usize, at: i32| if at == 0 { one - part[k] } else { part[k] };
        let index = [low[0].to_i32() + i, low[1].to_i32() + j];
        let is_inside = (0..2).all(|k| index[k] >= 0 && index[k] < frame.extent_pixels[k] as i32);
        if is_inside {
            let middle = index.map(|at| R::from_f64(f64::from(at)) + half);
            around.push((middle, weight(0, i) * weight(1, j)));
        }
    }
    Some(around)
}
