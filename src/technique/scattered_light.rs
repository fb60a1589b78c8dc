//! Single scattering on the CPU: CPU reference of `shaders/lib/material_scattered.wgsl`, `light_ray.wgsl` and
//! `point_light.wgsl`.

use crate::ray::{Ray, domain_interval, vector, voxel_ray};
use crate::real::{Real, add, dot, scale, sub};
use crate::shaders::Frame;
use crate::technique::pathtrace::{phase_value, turn_of};
use crate::technique::shading::Lamps;

/// Optical depth of a step of matter that only shines: so little that its light is E d, and that nothing is in the way.
const LEAST_DEPTH: f64 = 1.0 / 16_777_216.0;

/// How near a ray passes by a point at least, in steps.
const LEAST_OF_STEP: f64 = 0.01;

/// The source of a sample of this albedo, before the scale of albedos. `extinction_at` says how much is in the way of light
/// at a position in voxel space.
pub fn scattered<R: Real>(
    frame: &Frame,
    albedo: [R; 3],
    lamps: &Lamps<R>,
    extinction_at: impl Fn([R; 3]) -> R,
) -> [R; 3] {
    let pi = R::from_f64(std::f64::consts::PI);
    let one = R::from_f64(1.0);
    let rows = frame.world_from_voxel;
    let place = rows.map(|[x, y, z, w]| dot(vector([x, y, z]), lamps.voxel) + R::from_f32(w));
    let in_volume = |bundle: u32| {
        let found = lamps
            .field
            .map(|field| field.scattered_at(frame, bundle, lamps.voxel));
        found.unwrap_or(one)
    };
    let of_sky = match frame.occlusion_strength != 0.0 {
        true => in_volume(0),
        false => one,
    };
    let mut light = scale(vector(frame.path_sky), of_sky);
    let lights = frame.light_directions.iter().zip(&frame.light_colors);
    for (i, (&[x, y, z, w], &[r, g, b, _])) in lights.take(frame.light_count as usize).enumerate() {
        let (way, reach, falloff) = match w == 0.0 {
            true => (vector([x, y, z]), R::from_f32(f32::MAX), one),
            false => {
                let to_light = sub(vector([x, y, z]), place);
                let reach = dot(to_light, to_light).sqrt().max(R::from_f64(1e-15));
                let falloff = mean_of_falloff(frame, to_light, lamps.ray_direction);
                (scale(to_light, one / reach), reach, falloff)
            }
        };
        let through = match frame.scattering_depth == 0.0 {
            true if frame.has_shadows != 0 => in_volume(frame.shadow_bundle + i as u32),
            true => one,
            false => {
                let along = Ray {
                    origin: place,
                    direction: way,
                };
                through_to(frame, &along, lamps.voxel, reach, &extinction_at)
            }
        };
        let phase = phase_value(frame, dot(lamps.ray_direction, way));
        let part = pi * falloff * through * phase;
        light = add(light, scale(vector([r, g, b]), part));
    }
    let factor = R::from_f32(frame.path_albedo);
    std::array::from_fn(|c| factor * albedo[c] * light[c])
}

/// A source of light that is scattered once, and what matter sends out by itself, E / sigma.
pub fn shining<R: Real>(
    frame: &Frame,
    [r, g, b, extinction]: [R; 4],
    emission: impl FnOnce() -> [R; 3],
) -> [R; 4] {
    if frame.emission_point_count == 0 {
        return [r, g, b, extinction];
    }
    let sigma = extinction.max(R::from_f64(LEAST_DEPTH) / R::from_f32(frame.step_world));
    let [red, green, blue] = emission().map(|e| e / sigma);
    [r + red, g + green, b + blue, sigma]
}

/// Of a point's light, the mean of 1 / r^2 over the segment of a ray, from whose middle the point lies at `to_light`.
fn mean_of_falloff<R: Real>(frame: &Frame, to_light: [R; 3], ray_direction: [R; 3]) -> R {
    let n = |x: f64| R::from_f64(x);
    let slope = dot(vector(frame.forward), ray_direction).abs();
    let h = R::from_f32(frame.step_world) / slope.max(R::from_f32(frame.least_slope));
    let along = dot(to_light, ray_direction);
    let beside = sub(to_light, scale(ray_direction, along));
    let d = dot(beside, beside).sqrt().max(n(LEAST_OF_STEP) * h);
    let product = along * along - n(0.25) * h * h;
    n(std::f64::consts::TAU) * turn_of([d * d + product, d * h]) / (d * h)
}

/// What comes through to a position in voxel space along a ray of the world that begins there, `far` long at most.
fn through_to<R: Real>(
    frame: &Frame,
    world: &Ray<R>,
    voxel: [R; 3],
    far: R,
    extinction_at: impl Fn([R; 3]) -> R,
) -> R {
    let n = |x: f64| R::from_f64(x);
    let along = Ray {
        origin: voxel,
        direction: voxel_ray(frame, world).direction,
    };
    let [_, reach] = domain_interval(frame, world, &along);
    let reach = reach.min(far);
    let one = n(1.0);
    if reach <= n(0.0) {
        return one;
    }
    let step = R::from_f32(frame.step_world);
    let whole = (reach / step).floor().to_i32();
    let mut depth = n(0.0);
    for k in 0..=whole {
        if depth > R::from_f32(frame.scattering_depth) {
            break;
        }
        let start = n(k.into()) * step;
        let (t, length) = match k < whole {
            true => ((n(k.into()) + n(0.5)) * step, step),
            false => (start + n(0.5) * (reach - start), reach - start),
        };
        depth = depth + extinction_at(along.at(t)) * length;
    }
    (-depth).exp()
}
