//! Light that scatters, along random paths.

use super::renderer::{self, sv_renderer};
use super::settings::share;
use super::status::{Failure, guard, sv_diagnostic, sv_status};
use super::structure::{self, Versioned};
use crate::technique::Light;
use crate::technique::pathtrace::{PathTracing, Phase};
use std::ffi::c_void;

/// What SV_TECHNIQUE_PATHTRACE traces. All zero: one path a pixel and frame up to 64, light that is scattered as often as it is,
/// to all sides alike.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct sv_path_tracing {
    /// `sizeof(sv_path_tracing)`.
    pub struct_size: u32,
    /// NULL.
    pub next: *const c_void,
    /// Paths a pixel, at most: frames after it show the same. 0 is 64.
    pub samples: u32,
    /// So many more in each frame, at most 8, of a driver that counts the turns of loops 4 (through functions of gradients 2). 0 is 1.
    pub samples_per_frame: u32,
    /// Other numbers, other noise.
    pub seed: u32,
    /// How often light is scattered at most. 0: as often as it is.
    pub bounces: u32,
    /// Not 0: it is not scattered, and matter shines in its colours.
    pub is_unscattered: u32,
    /// Not 0: matter scatters light as particles far smaller than the wavelength do (Rayleigh).
    pub is_rayleigh: u32,
    /// What extinctions are multiplied by. 0 is 1.
    pub density: f64,
    /// What albedos are multiplied by, 0 to 1. 0 is 1.
    pub albedo: f64,
    /// The mean cosine of the phase function (Henyey and Greenstein), -0.99 to 0.99: positive forward.
    pub mean_cosine: f64,
    /// That of a second one.
    pub second_mean_cosine: f64,
    /// The part of light that is scattered by the second one, 0 to 1.
    pub second_part: f64,
    /// How wide lights look, in degrees, 0 to 90.
    pub light_size_degrees: f64,
    /// Radiance from all around, linear red, green and blue. Without it and without `sv_settings.lights` a white light is
    /// carried by the eye.
    pub sky: [f64; 3],
    /// How much of matter is surface: a collision is one with a surface by the chance 1 - exp(-surface g), g the gradient
    /// in ranges of values a smallest spacing.
    pub surface: f64,
    /// Reflectance of surfaces at right angles, 0 to 1. 0: they reflect as Lambert says.
    pub f0: f64,
    /// How rough the coat of surfaces is, 0.05 to 1. 0 is 0.4.
    pub roughness: f64,
}

// SAFETY: as the trait wants it.
unsafe impl Versioned for sv_path_tracing {
    const NAME: &'static str = "sv_path_tracing";
}

/// What paths are under these lights; NULL is all zero.
///
/// # Safety
/// What `pointer` points to is as long as it says.
pub(super) unsafe fn paths(
    pointer: *const sv_path_tracing,
    lights: Vec<Light>,
) -> Result<PathTracing, Failure> {
    // SAFETY: the caller's promise.
    let c = unsafe { structure::read_or_zero(pointer)? };
    let default = PathTracing::default();
    let or = |number: f64, default: f64| if number == 0.0 { default } else { number };
    let or_count = |count: u32, default: u32| if count == 0 { default } else { count };
    share("sv_path_tracing.second_part", c.second_part)?;
    let is_dark = lights.is_empty() && c.sky == [0.0; 3];
    Ok(PathTracing {
        samples: or_count(c.samples, default.samples),
        samples_per_frame: or_count(c.samples_per_frame, default.samples_per_frame),
        seed: c.seed,
        bounces: match (c.is_unscattered, c.bounces) {
            (0, 0) => None,
            (0, bounces) => Some(bounces),
            _ => Some(0),
        },
        density: or(c.density, default.density),
        albedo: or(c.albedo, default.albedo),
        phase: match c.is_rayleigh {
            0 => Phase::TwoLobes {
                part: 1.0 - c.second_part,
                g: [c.mean_cosine, c.second_mean_cosine],
            },
            _ => Phase::Rayleigh,
        },
        lights: match is_dark {
            true => vec![Light::of_eye()],
            false => lights,
        },
        light_size_degrees: c.light_size_degrees,
        sky: c.sky,
        surface: c.surface,
        f0: c.f0,
        roughness: or(c.roughness, default.roughness),
        ..default
    })
}

/// Of how many paths a pixel the picture of the last recorded frame is the mean (SV_TECHNIQUE_PATHTRACE). Another camera,
/// function, volume, size or settings, and an update of the volume begin anew.
/// Threads: one at a time for one renderer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sv_renderer_paths_traced(
    renderer: sv_renderer,
    paths: *mut u32,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let body = || {
        structure::out("the place of the number", paths)?;
        renderer::with(renderer, |_, inner| {
            // SAFETY: not NULL; the caller's promise.
            unsafe { paths.write(inner.renderer.paths_traced()) };
            Ok(())
        })
    };
    // SAFETY: the caller's promise.
    unsafe { guard(diagnostic, body) }
}

/// How noisy that picture was `frames_in_flight` frames before: the root of the sum of the variances of its pixels' luminances
/// over that of their squares. It halves with four times as many paths, and nothing waits for it. SV_E_STATE while nothing is
/// known: of the first frames, and of a picture that has begun anew. Threads: one at a time for one renderer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sv_renderer_noise(
    renderer: sv_renderer,
    noise: *mut f64,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let body = || {
        structure::out("the place of the number", noise)?;
        renderer::with(renderer, |_, inner| {
            let known = inner.renderer.noise();
            let known = known.ok_or_else(|| Failure::state(UNKNOWN))?;
            // SAFETY: not NULL; the caller's promise.
            unsafe { noise.write(known) };
            Ok(())
        })
    };
    // SAFETY: the caller's promise.
    unsafe { guard(diagnostic, body) }
}

const UNKNOWN: &str = "cannot tell the noise: wanted two frames of paths that are done and one after them, found fewer";

/// The next frame begins with the first path: where what the host has drawn has moved before the volume, and where a frame
/// that was recorded will not be submitted. Threads: one at a time for one renderer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sv_renderer_restart_paths(
    renderer: sv_renderer,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let body = || {
        renderer::with(renderer, |_, inner| {
            inner.renderer.restart_paths();
            Ok(())
        })
    };
    // SAFETY: the caller's promise.
    unsafe { guard(diagnostic, body) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::mem::{MaybeUninit, size_of};

    fn zero() -> sv_path_tracing {
        // SAFETY: all bits are right for the type.
        let zero: sv_path_tracing = unsafe { MaybeUninit::zeroed().assume_init() };
        sv_path_tracing {
            struct_size: size_of::<sv_path_tracing>() as u32,
            ..zero
        }
    }

    fn of(c: &sv_path_tracing) -> PathTracing {
        // SAFETY: it is as long as it says.
        let made = unsafe { paths(c, Vec::new()) };
        made.unwrap_or_else(|_| panic!("refused"))
    }

    #[test]
    fn zero_is_the_default_under_the_light_of_the_eye() {
        let wanted = PathTracing {
            lights: vec![Light::of_eye()],
            phase: Phase::TwoLobes {
                part: 1.0,
                g: [0.0; 2],
            },
            ..PathTracing::default()
        };
        assert_eq!(of(&zero()), wanted);
        let lit_by_sky = sv_path_tracing {
            sky: [0.0, 0.0, 0.5],
            ..zero()
        };
        assert_eq!(of(&lit_by_sky).lights, []);
    }

    #[test]
    fn each_field_says_what_its_name_does() {
        let c = sv_path_tracing {
            samples: 9,
            samples_per_frame: 3,
            seed: 7,
            bounces: 5,
            density: 2.0,
            albedo: 0.5,
            mean_cosine: 0.6,
            second_mean_cosine: -0.2,
            second_part: 0.25,
            light_size_degrees: 12.0,
            sky: [0.1, 0.2, 0.3],
            surface: 8.0,
            f0: 0.04,
            roughness: 0.3,
            ..zero()
        };
        let wanted = PathTracing {
            samples: 9,
            samples_per_frame: 3,
            seed: 7,
            bounces: Some(5),
            density: 2.0,
            albedo: 0.5,
            phase: Phase::TwoLobes {
                part: 0.75,
                g: [0.6, -0.2],
            },
            light_size_degrees: 12.0,
            sky: [0.1, 0.2, 0.3],
            surface: 8.0,
            f0: 0.04,
            roughness: 0.3,
            ..PathTracing::default()
        };
        assert_eq!(of(&c), wanted);
        let others = sv_path_tracing {
            is_unscattered: 1,
            is_rayleigh: 1,
            ..c
        };
        let others = of(&others);
        assert_eq!((others.bounces, others.phase), (Some(0), Phase::Rayleigh));
    }
}
