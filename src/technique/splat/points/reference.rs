//! Splats of scattered points on the CPU: CPU reference of `shaders/splat_points.wgsl` and
//! `shaders/splat_points_projection.wgsl`.
//!
//! ```text
//! t_s = d . (x_s - o)        b^2 = |x_s - o - t_s d|^2 / h'^2        behind the eye (t_s <= 0): nothing
//! ```

use super::view_points::{ViewPoint, ViewPoints};
use crate::lattice::Segment;
use crate::ray::{Ray, pixel_ray, vector};
use crate::real::{Real, dot};
use crate::technique::Mode;
use crate::technique::composite::Composite;
use crate::technique::projected::Projected;
use crate::technique::reference::{Gathered, Samples};

/// Standard deviations from its centre within which a point's value counts where extremes are looked for.
const EXTREME_STDS: f64 = 2.0;

/// What the points of a pixel gather.
pub(crate) fn pixel<R: Real>(
    of: &impl Samples<R>,
    points: &ViewPoints,
    pixel: [R; 2],
) -> Gathered<R> {
    let (frame, mode) = (of.frame(), of.settings().mode);
    let ray = pixel_ray(frame, pixel);
    let whole = pixel.map(|n| n.to_f64() as u32);
    let seen = points.of_pixel(whole, frame.extent_pixels[0]);
    let reach = R::from_f32(frame.splat_reach);
    let (zero, half) = (R::from_f64(0.0), R::from_f64(0.5));
    let mut composite = Composite::default();
    let mut projected = Projected::default();
    let mut count = 0;
    for point in seen {
        let Some(square) = square_of(point, &ray).filter(|square| *square <= reach * reach) else {
            continue;
        };
        let value = R::from_f32(point.value);
        let share = |most: f32| R::from_f32(most) * (zero - half * square).exp();
        let segment = |length| Segment { t: zero, length };
        match mode {
            Mode::Mip | Mode::Minip => {
                if square <= R::from_f64(EXTREME_STDS * EXTREME_STDS) {
                    let _goes_on = projected.add(frame, mode, value, segment(zero));
                    count += 1;
                }
                continue;
            }
            mode if mode.is_projection() => {
                let _goes_on = projected.add(frame, mode, value, segment(share(point.density)));
            }
            _ => composite.add(of.classify(value), share(point.length), zero),
        }
        count += 1;
        if composite.transmittance < R::from_f32(frame.termination) {
            break;
        }
    }
    let found = match mode.is_projection() {
        false => Gathered::of_composite((composite, count)),
        true => {
            let Projected { value, weight, .. } = projected;
            Gathered::of_blended([value, weight, zero, zero], count as f32)
        }
    };
    Gathered {
        depth: None,
        ..found
    }
}

/// How far from a point's centre a ray passes, in its standard deviations, squared; `None` where that is behind the eye.
pub(super) fn square_of<R: Real>(point: &ViewPoint, ray: &Ray<R>) -> Option<R> {
    let center: [R; 3] = vector(point.center);
    let from_eye: [R; 3] = std::array::from_fn(|k| center[k] - ray.origin[k]);
    let t = dot(from_eye, ray.direction);
    let off: [R; 3] = std::array::from_fn(|k| {
        (from_eye[k] - t * ray.direction[k]) * R::from_f32(point.inverse_std)
    });
    (t > R::from_f64(0.0)).then(|| dot(off, off))
}
