//! Single scattering on the CPU: CPU reference of `shaders/lib/material_scattered.wgsl` and `light_ray.wgsl`.

use crate::ray::{Ray, domain_interval, vector, voxel_ray};
use crate::real::{Real, add, dot, scale};
use crate::shaders::Frame;
use crate::technique::pathtrace::phase_value;
use crate::technique::shading::Lamps;

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
    for (i, (&[x, y, z, _], &[r, g, b, _])) in lights.take(frame.light_count as usize).enumerate() {
        let way = vector([x, y, z]);
        let through = match frame.scattering_depth == 0.0 {
            true if frame.has_shadows != 0 => in_volume(frame.shadow_bundle + i as u32),
            true => one,
            false => through_to(frame, lamps.voxel, way, &extinction_at),
        };
        let part = pi * phase_value(frame, dot(lamps.ray_direction, way)) * through;
        light = add(light, scale(vector([r, g, b]), part));
    }
    let factor = R::from_f32(frame.path_albedo);
    std::array::from_fn(|c| factor * albedo[c] * light[c])
}

/// What comes through from far away along `way` to a position in voxel space.
fn through_to<R: Real>(
    frame: &Frame,
    voxel: [R; 3],
    way: [R; 3],
    extinction_at: impl Fn([R; 3]) -> R,
) -> R {
    let n = |x: f64| R::from_f64(x);
    let rows = frame.world_from_voxel;
    let world = Ray {
        origin: rows.map(|[x, y, z, w]| dot(vector([x, y, z]), voxel) + R::from_f32(w)),
        direction: way,
    };
    let along = Ray {
        origin: voxel,
        direction: voxel_ray(frame, &world).direction,
    };
    let [_, reach] = domain_interval(frame, &world, &along);
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
