//! A uniform medium: what is left of the light is an exponential.

use super::{AMBIENT, half_angle, pictures, plain, white};
use crate::shared::{PictureCase, Worst, volume_of};
use glam::{DAffine3, DVec3, dvec3};
use stratavox::camera::{Camera, Projection};
use stratavox::picture::Picture;
use stratavox::technique::{Filter, Settings};
use stratavox::volume::Volume;

const SIGMA: f64 = 0.11;
const LENGTH: f64 = 12.0;

/// Unit voxels full of one medium; rays through the middles of columns of voxels, along +z.
fn medium(samples_per_voxel: f64, towards: DVec3) -> (Volume, PictureCase) {
    const SIDE: u32 = 12;
    let volume = volume_of([SIDE; 3], DAffine3::IDENTITY, |_| 1.0);
    let grid = volume.grid();
    let shot = PictureCase {
        grid,
        camera: Camera {
            eye: grid.center() - dvec3(0.0, 0.0, 30.0),
            target: grid.center(),
            up: DVec3::Y,
            projection: Projection::Orthographic {
                view_height: SIDE.into(),
            },
            zoom: 1.0,
        },
        extent: [SIDE; 2],
        settings: Settings {
            samples_per_voxel,
            shading: plain(towards),
            ..half_angle()
        },
    };
    (volume, shot)
}

/// Texels of the light at the rim of the box see past it: the outermost pixels are left out.
fn inner_pixels(picture: &Picture) -> impl Iterator<Item = ([u32; 2], [f64; 4])> + '_ {
    let (width, height) = (picture.width, picture.height);
    let at = move |i: usize| [i as u32 % width, i as u32 / width];
    let pixels = picture.pixels.iter().enumerate();
    pixels
        .map(move |(i, p)| (at(i), p.map(f64::from)))
        .filter(move |([x, y], _)| (1..width - 1).contains(x) && (1..height - 1).contains(y))
}

/// With q = exp(-sigma h) and N slices: light from the eye reaches slice k as q^k, light from behind as q^(N-1-k).
#[test]
fn light_along_the_view_is_the_sum_of_a_power_series_and_converges_with_the_step() {
    for (towards, sum, limit) in [
        (
            DVec3::NEG_Z,
            (|q: f64, n: f64| (1.0 - q.powf(2.0 * n)) / (1.0 + q)) as fn(f64, f64) -> f64,
            0.5 * -f64::exp_m1(-2.0 * SIGMA * LENGTH),
        ),
        (
            DVec3::Z,
            |q, n| n * (1.0 - q) * q.powf(n - 1.0),
            SIGMA * LENGTH * (-SIGMA * LENGTH).exp(),
        ),
    ] {
        let mut errors = Vec::new();
        for samples in [1.0, 2.0, 4.0] {
            let (volume, shot) = medium(samples, towards);
            let (q, n) = ((-SIGMA / samples).exp(), LENGTH * samples);
            let alpha = -f64::exp_m1(-SIGMA * LENGTH);
            let color = |direct: f64| AMBIENT * alpha + (1.0 - AMBIENT) * direct;
            let mut error = 0.0;
            for (way, picture) in ["f64", "f32", "device"].iter().zip(pictures(
                &volume,
                &shot,
                &white(&[(0.0, SIGMA)]),
            )) {
                let mut worst = Worst::new(format!("light to {towards}, {samples}, {way}"));
                for (at, found) in inner_pixels(&picture) {
                    worst.take(at, found[0] - color(sum(q, n)), 5e-6);
                    worst.take(at, found[3] - alpha, 5e-6);
                    error = (found[0] - color(limit)).abs();
                }
                worst.assert_holds();
            }
            errors.push(error);
        }
        for pair in errors.windows(2) {
            let ratio = pair[0] / pair[1];
            println!("light to {towards}: errors {pair:?}, ratio {ratio}");
            assert!((1.9..2.1).contains(&ratio), "{ratio}");
        }
    }
}

/// Light across the view: exp(-sigma x) at the depth x. Slices lie d = sqrt(2) h apart along the light, and a sample
/// has those before its own in the light, floor(x / d); a texel of width w beside it may have one more or less. Samples
/// of the eye within w of the front and of the back of the box may see light that passes it by.
#[test]
fn light_across_the_view_falls_off_with_the_depth() {
    const PIXELS: u32 = 24;
    for samples in [1.0, 2.0, 4.0] {
        let (volume, mut shot) = medium(samples, DVec3::NEG_X);
        shot.extent = [PIXELS; 2];
        let d = 2f64.sqrt() / samples;
        let w = LENGTH / (f64::from(shot.view().light_extent()[0]) - 2.0);
        let taken = |length: f64| -f64::exp_m1(-SIGMA * length);
        let rims = taken(w + d) * (2.0 - taken(LENGTH - w - d)) / taken(LENGTH - d);
        for (way, picture) in
            ["f64", "f32", "device"]
                .iter()
                .zip(pictures(&volume, &shot, &white(&[(0.0, SIGMA)])))
        {
            let mut worst = Worst::new(format!("light across, {samples}, {way}"));
            let mut mean = 0.0;
            for (at, found) in inner_pixels(&picture) {
                // Right in the picture is against x: the camera looks along +z, up is +y.
                let x = LENGTH * (1.0 - (f64::from(at[0]) + 0.5) / f64::from(PIXELS));
                let left = (found[0] / found[3] - AMBIENT) / (1.0 - AMBIENT);
                let [low, high] = [x + w, x - w - d].map(|x| 1.0 - taken(x.max(0.0)));
                let high = high + (1.0 - low) * rims;
                // A way from the middle of what may be.
                worst.take(at, left - 0.5 * (low + high), 0.5 * (high - low));
                mean += (left - 1.0 + taken(x)) / f64::from((PIXELS - 2) * (PIXELS - 2));
            }
            println!("light across, {samples} samples a voxel, {way}: mean error {mean}");
            worst.assert_holds();
        }
    }
}

/// The first slice that is not transparent has all of the light, however much lies before it.
#[test]
fn matter_without_extinction_takes_no_light() {
    let field = |p: DVec3| if p.z as u32 == 9 { 1.0 } else { 0.0 };
    let volume = volume_of([12; 3], DAffine3::IDENTITY, field);
    let (_, shot) = medium(1.0, DVec3::NEG_Z);
    let shot = shot.with(|settings| settings.filter = Filter::Nearest);
    let transfer = white(&[(0.0, 0.0), (1.0, 0.7)]);
    for (way, picture) in ["f64", "f32", "device"]
        .iter()
        .zip(pictures(&volume, &shot, &transfer))
    {
        let mut worst = Worst::new(format!("nothing before a sheet, {way}"));
        for (at, found) in inner_pixels(&picture) {
            worst.take(at, found[0] - -f64::exp_m1(-0.7), 2e-6);
        }
        worst.assert_holds();
    }
}
