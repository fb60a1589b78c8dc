//! How a surface reflects: CPU reference of `shaders/lib/surface.wgsl`, which has the formulas and their sources.

use super::elementary::around;
use crate::real::{Real, add, dot, scale};
use crate::shaders::Frame;
use std::f64::consts::PI;

/// The least chance that a direction is drawn by the coat.
const LEAST_OF_COAT: f64 = 0.25;

fn n<R: Real>(x: f64) -> R {
    R::from_f64(x)
}

fn fifth_power<R: Real>(x: R) -> R {
    let q = x * x;
    q * q * x
}

fn direction_of<R: Real>(v: [R; 3]) -> [R; 3] {
    scale(v, n::<R>(1.0) / dot(v, v).sqrt())
}

fn fresnel<R: Real>(frame: &Frame, cosine: R) -> R {
    let (f0, one) = (R::from_f32(frame.path_f0), n::<R>(1.0));
    f0 + (one - f0) * fifth_power((one - cosine).max(n(0.0)))
}

fn masking<R: Real>(frame: &Frame, cosine: R) -> R {
    let a = R::from_f32(frame.path_alpha);
    (a * a + (n::<R>(1.0) - a * a) * cosine * cosine).sqrt()
}

/// The density of half vectors by how far they lie off the normal.
fn half_vectors<R: Real>(frame: &Frame, cosine: R) -> R {
    let a = R::from_f32(frame.path_alpha);
    let d = cosine * cosine * (a * a - n(1.0)) + n(1.0);
    a * a / (n::<R>(PI) * d * d)
}

/// What of a light of colour 1 comes to the eye. For f0 = 0 without its albedo.
pub fn reflected<R: Real>(
    frame: &Frame,
    [normal, to_eye, to_light]: [[R; 3]; 3],
    albedo: [R; 3],
) -> [R; 3] {
    let (zero, one, half) = (n::<R>(0.0), n::<R>(1.0), n::<R>(0.5));
    let light = dot(normal, to_light);
    if frame.path_f0 == 0.0 {
        return [light.max(zero); 3];
    }
    let eye = dot(normal, to_eye);
    if light <= zero || eye <= zero {
        return [zero; 3];
    }
    let between = direction_of(add(to_eye, to_light));
    let coat = half_vectors(frame, dot(normal, between)) * half
        / (light * masking(frame, eye) + eye * masking(frame, light))
        * fresnel(frame, dot(to_eye, between));
    let of_cosine = |cosine: R| one - fifth_power(one - half * cosine);
    let f0 = R::from_f32(frame.path_f0);
    let below = n::<R>(28.0 / 23.0) * (one - f0) * of_cosine(eye) * of_cosine(light);
    albedo.map(|c| light * (below * c + n::<R>(PI) * coat))
}

/// How often a direction is drawn, per steradian.
pub fn reflection_density<R: Real>(frame: &Frame, [normal, to_eye, way]: [[R; 3]; 3]) -> R {
    let lambert = dot(normal, way).max(n(0.0)) / n(PI);
    if frame.path_f0 == 0.0 {
        return lambert;
    }
    let eye = dot(normal, to_eye);
    let by_coat = chance_of_coat(frame, eye);
    let between = direction_of(add(to_eye, way));
    let coat =
        n::<R>(0.5) * half_vectors(frame, dot(normal, between)) / (eye + masking(frame, eye));
    by_coat * coat + (n::<R>(1.0) - by_coat) * lambert
}

fn chance_of_coat<R: Real>(frame: &Frame, cosine: R) -> R {
    let least = n::<R>(LEAST_OF_COAT);
    least + (n::<R>(1.0) - least) * fresnel(frame, cosine)
}

/// A direction, and what a path that goes on there is multiplied by; of Lambert without its albedo.
pub fn reflection<R: Real>(
    frame: &Frame,
    [normal, to_eye]: [[R; 3]; 2],
    albedo: [R; 3],
    numbers: [R; 4],
) -> ([R; 3], [R; 3]) {
    let (zero, one) = (n::<R>(0.0), n::<R>(1.0));
    let [_, by, u, v] = numbers;
    if frame.path_f0 == 0.0 {
        return (around(normal, (one - u).sqrt(), v), [one; 3]);
    }
    let eye = dot(normal, to_eye);
    let by_coat = chance_of_coat(frame, eye);
    let way = match by < by_coat {
        true => mirrored(frame, normal, to_eye, [u, v]),
        false => around(normal, (one - u).sqrt(), v),
    };
    let light = dot(normal, way);
    if light <= zero || eye <= zero {
        return (way, [zero; 3]);
    }
    let density = reflection_density(frame, [normal, to_eye, way]);
    let seen = reflected(frame, [normal, to_eye, way], albedo);
    (way, seen.map(|c| c / (n::<R>(PI) * density)))
}

/// By a half vector of those that the eye sees.
fn mirrored<R: Real>(frame: &Frame, normal: [R; 3], to_eye: [R; 3], [u, v]: [R; 2]) -> [R; 3] {
    let flattened = |w: [R; 3]| {
        let up = dot(normal, w);
        let flat = add(w, scale(normal, -up));
        direction_of(add(
            scale(flat, R::from_f32(frame.path_alpha)),
            scale(normal, up),
        ))
    };
    let one = n::<R>(1.0);
    let stretched = flattened(to_eye);
    let height = dot(normal, stretched);
    let cosine = (one - u) * (one + height) - height;
    let between = flattened(add(around(normal, cosine, v), stretched));
    let mirror = scale(between, n::<R>(2.0) * dot(to_eye, between));
    add(mirror, scale(to_eye, -one))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::technique::pathtrace::random::random_numbers;

    fn coat(f0: f32, roughness: f32) -> Frame {
        let mut frame: Frame = bytemuck::Zeroable::zeroed();
        (frame.path_f0, frame.path_alpha) = (f0, roughness * roughness);
        frame
    }

    fn view(cosine: f64) -> [f64; 3] {
        [(1.0 - cosine * cosine).sqrt(), 0.0, cosine]
    }

    /// The mean over drawn directions is the integral over the half sphere, by the midpoint rule; and none of them is
    /// larger than what comes in.
    #[test]
    fn drawn_directions_bring_the_integral_of_what_is_reflected() {
        let up = [0.0, 0.0, 1.0];
        let most: f64 = [
            (0.04, 0.45, 0.2, 0.8),
            (0.04, 0.2, 0.9, 0.8),
            (1.0, 0.7, 0.6, 1.0),
            (0.5, 0.6, 0.35, 1.0),
        ]
        .into_iter()
        .map(|(f0, roughness, cosine, albedo)| {
            let frame = coat(f0, roughness);
            let eye = view(cosine);
            let rows = 600;
            let columns = 1200;
            let mut wanted = 0.0;
            for i in 0..rows {
                let cosine = (f64::from(i) + 0.5) / f64::from(rows);
                for j in 0..columns {
                    let way = around(up, cosine, (f64::from(j) + 0.5) / f64::from(columns));
                    wanted += reflected(&frame, [up, eye, way], [albedo; 3])[0];
                }
            }
            // Solid angle 2 pi, and the pi of a light of colour 1.
            wanted *= 2.0 / f64::from(rows * columns);
            let count = 200_000;
            let (mut sum, mut squares) = (0.0, 0.0);
            for i in 0..count {
                let numbers = random_numbers::<f64>([i, 0, 1, 7]);
                let (_, weight) = reflection(&frame, [up, eye], [albedo; 3], numbers);
                sum += weight[0];
                squares += weight[0] * weight[0];
            }
            let count = f64::from(count);
            let mean = sum / count;
            let error = ((squares / count - mean * mean) / count).sqrt();
            assert!(
                (mean - wanted).abs() < 4.0 * error + 1e-4,
                "{f0} {roughness} {cosine}: {mean} +- {error}, wanted {wanted}"
            );
            mean
        })
        .fold(0.0, f64::max);
        assert!(most <= 1.0, "{most}");
    }

    /// Helmholtz: light may go either way.
    #[test]
    fn light_and_eye_may_change_places() {
        let up = [0.0, 0.0, 1.0];
        let frame = coat(0.04, 0.3);
        let (a, b) = (view(0.3), around(up, 0.8, 0.3));
        let there = reflected(&frame, [up, a, b], [0.5; 3])[0] / b[2];
        let back = reflected(&frame, [up, b, a], [0.5; 3])[0] / a[2];
        assert!((there - back).abs() < 1e-12, "{there} {back}");
    }
}
