//! What shear-warp leaves of waves across a ray, by their frequency. Slices are interpolated by a tent one voxel wide, the
//! intermediate image by one of 1/q, and the Fourier transform of a tent is the square of a sinc:
//!
//! ```text
//! amplitude = sinc^2(f) sinc^2(f / q)      f cycles a voxel along an axis of the base plane, sinc x = sin(pi x) / (pi x)
//! ```

use super::{cubes, drawn, settings};
use crate::shared::{PictureCase, volume_of};
use glam::DVec3;
use std::f64::consts::{PI, SQRT_2, TAU};
use stratavox::camera::{Camera, Projection};
use stratavox::technique::{Filter, Intermediate, Mode, Settings};

const SIDE: u32 = 16;
/// Voxels that a ray moves by from slice to slice: in 16 of them it meets each sixteenth of a voxel once.
const SHEAR: f64 = 5.0 / 16.0;
const PIXELS_PER_VOXEL: u32 = 32;
/// Whole waves of all frequencies.
const VOXELS: u32 = 8;
const MEAN: f64 = 0.5;
const AMPLITUDE: f64 = 0.4;

/// The amplitude of the mean of rays through waves along `axis`, which lie in each slice of the axis `across` as rays meet it.
fn amplitude(settings: Settings, frequency: f64, axis: usize, across: usize) -> f64 {
    let grid = cubes([SIDE; 3]);
    let half = 0.5 * f64::from(SIDE);
    let wave = |p: DVec3| {
        let on_plane = p[axis] - half - SHEAR * (p[across] - half);
        MEAN + AMPLITUDE * (TAU * frequency * on_plane).cos()
    };
    let volume = volume_of(grid.dims, grid.world_from_voxel, wave);
    let towards = DVec3::AXES[across] + SHEAR * DVec3::AXES[axis];
    // A step of one pixel is so much shorter than on the plane.
    let slope = (1.0 + SHEAR * SHEAR).sqrt();
    let height = 4;
    let shot = PictureCase {
        grid,
        camera: Camera {
            eye: grid.center() - 40.0 * towards,
            target: grid.center(),
            up: DVec3::AXES[3 - axis - across],
            projection: Projection::Orthographic {
                view_height: f64::from(height) / f64::from(PIXELS_PER_VOXEL) / slope,
            },
            zoom: 1.0,
        },
        extent: [VOXELS * PIXELS_PER_VOXEL, height],
        settings,
    };
    let picture = drawn(&shot, &volume);
    let mut sums = [0.0; 2];
    for ([x, _], &value) in shot.pixels().zip(&picture.layers[1].values) {
        let place = (f64::from(x) + 0.5) / f64::from(PIXELS_PER_VOXEL) - 0.5 * f64::from(VOXELS);
        let (sin, cos) = (TAU * frequency * place).sin_cos();
        sums[0] += f64::from(value) * cos;
        sums[1] += f64::from(value) * sin;
    }
    let count = f64::from(shot.extent[0] * shot.extent[1]);
    // Each of the slices adds its length times what it has there.
    sums[0].hypot(sums[1]) * 2.0 / count / (f64::from(SIDE) * slope) / AMPLITUDE
}

/// The square of sinc x.
fn of_tent(x: f64) -> f64 {
    ((PI * x).sin() / (PI * x)).powi(2)
}

/// What a tent leaves of waves that look alike at `steps` places a unit: those of k `steps` + x, k not 0.
///
/// ```text
/// sum over k of sinc^2(x + k n) < sin^2(pi x) 2 sum over k > 0 of (pi (k - 1/2) n)^-2 = sin^2(pi x) / n^2
/// ```
fn alike(x: f64, steps: f64) -> f64 {
    ((PI * x).sin() / steps).powi(2)
}

#[test]
fn a_wave_is_left_as_two_tents_leave_it() {
    for across in [0, 1, 2] {
        for axis in [(across + 1) % 3, (across + 2) % 3] {
            for per_voxel in [1.0, 2.0, 4.0] {
                for frequency in [0.125, 0.25, 0.375] {
                    let [slices, warp] = [1.0, per_voxel].map(|q| of_tent(frequency / q));
                    let settings = settings(Mode::Xray, per_voxel);
                    let found = amplitude(settings, frequency, axis, across);
                    let in_slices = alike(frequency, SIDE.into());
                    let in_pixels = f64::from(PIXELS_PER_VOXEL) / per_voxel;
                    let in_warp = alike(frequency / per_voxel, in_pixels);
                    // An X-ray of 16 slices is off by as many roundings of it, which is more than SQRT_2 AMPLITUDE.
                    let rounded = 16.0 * SQRT_2 / AMPLITUDE / f64::from(1 << 24);
                    let allowed = in_slices + in_warp + rounded;
                    let what = format!("{frequency} along {axis}, {per_voxel} a voxel");
                    let wanted = slices * warp;
                    println!("{what}: {found}, wanted {wanted} +- {allowed:.1e}");
                    assert!(
                        (found - wanted).abs() < allowed,
                        "{what}: {found}, {wanted}"
                    );
                }
            }
        }
    }
}

/// The B-spline that goes through the voxels leaves sinc^4(f) / ((2 + cos(2 pi f)) / 3) of a wave; base pixels as fine as those of
/// the picture leave all but sinc^2(f / 32). At a quarter of a cycle that is what is asked, 0.95, and more, along both axes of the
/// slices, whichever way rays lean.
#[test]
fn by_cubics_and_base_pixels_as_fine_as_pixels_waves_of_four_voxels_are_kept() {
    const FREQUENCY: f64 = 0.25;
    let spline = of_tent(FREQUENCY).powi(2) / ((2.0 + (TAU * FREQUENCY).cos()) / 3.0);
    let wanted = spline * of_tent(FREQUENCY / f64::from(PIXELS_PER_VOXEL));
    let fine = Settings {
        filter: Filter::Cubic,
        intermediate: Intermediate::Pixels,
        ..settings(Mode::Xray, 1.0)
    };
    for across in [0, 1, 2] {
        for axis in [(across + 1) % 3, (across + 2) % 3] {
            let found = amplitude(fine.clone(), FREQUENCY, axis, across);
            let coarse = amplitude(settings(Mode::Xray, 1.0), FREQUENCY, axis, across);
            println!(
                "along {axis}: {found} of a wave of 4 voxels, {wanted} by the law; {coarse} by tents"
            );
            assert!(found >= 0.95, "along {axis}: {found}, by the law {wanted}");
            assert!(coarse < 0.7, "along {axis}: {coarse} by tents");
        }
    }
}
