//! What maxima and sums must obey: a MIP is at least any sample, sums and monotone functions pass through,
//! X-rays are linear, and all techniques see one Gaussian alike.

use crate::shared::{
    Chord, Device, Matter, PictureCase, Reference, Way, Worst, device, oblique_shots, ramps,
    sheared_affine, volume_of, waves,
};
use glam::{DAffine3, DVec3};
use stratavox::offscreen::Renderer;
use stratavox::picture::LayerKind;
use stratavox::technique::{Filter, Mode, Order};
use stratavox::volume::sample::linear;
use stratavox::volume::{Grid, Volume};

const SHEARED: fn() -> Grid = || Grid {
    dims: [15, 18, 13],
    world_from_voxel: sheared_affine(),
};

/// Another field than `waves`.
fn ripples(p: DVec3) -> f64 {
    0.4 + 0.25 * (0.7 * p.x - 0.3 * p.y).cos() + 0.2 * (0.45 * p.z + 0.1 * p.y * p.x).sin()
}

fn of_values(value: &(dyn Fn(DVec3) -> f64 + Sync)) -> Matter<'_> {
    Matter {
        value,
        color: &|v| [v; 3],
        extinction: &|v| v.max(0.0),
        range: [0.0, 2.0],
    }
}

fn ways() -> [Box<dyn Way>; 3] {
    [
        Box::new(Reference::<f64>::new()),
        Box::new(Reference::<f32>::new()),
        Box::new(Device),
    ]
}

/// One order: both were compared elsewhere.
fn shots(mode: Mode) -> impl Iterator<Item = PictureCase> {
    let all = oblique_shots(SHEARED(), mode).into_iter();
    all.filter(|shot| shot.settings.order == Order::BackToFront)
}

#[test]
fn a_maximum_is_at_least_every_sample_and_a_minimum_at_most() {
    let volume = volume_of(SHEARED().dims, sheared_affine(), waves);
    let on_volume = |p: DVec3| linear::<f64>(&volume, p.to_array()).unwrap();
    for way in ways() {
        for (mode, sign) in [(Mode::Mip, 1.0), (Mode::Minip, -1.0)] {
            for shot in shots(mode) {
                let found = way.values(&shot, &of_values(&on_volume));
                let voxel_from_world = shot.grid.world_from_voxel.inverse();
                let mut worst = Worst::new(format!("extremes, {}, {}", way.name(), shot.what()));
                for (pixel, found) in shot.pixels().zip(found) {
                    let Some(chord) = Chord::of(&shot, pixel) else {
                        continue;
                    };
                    if chord.hangs {
                        worst.leave_out();
                        continue;
                    }
                    let values = chord.samples.iter().map(|&(t, _)| {
                        sign * on_volume(voxel_from_world.transform_point3(chord.at(t)))
                    });
                    let largest = values.fold(f64::NEG_INFINITY, f64::max);
                    if largest.is_finite() {
                        // A sample moves by `blur`, the field by at most 1 a world length.
                        worst.take(pixel, sign * found - largest, 1e-6 + 2.0 * chord.blur);
                    }
                }
                worst.assert_holds();
            }
        }
    }
}

#[test]
fn the_maximum_of_a_sum_is_at_most_the_sum_of_maxima() {
    let sum = |p: DVec3| waves(p) + ripples(p);
    for way in ways() {
        for shot in shots(Mode::Mip) {
            let of = |value: &(dyn Fn(DVec3) -> f64 + Sync)| way.values(&shot, &of_values(value));
            let (f, g, both) = (of(&waves), of(&ripples), of(&sum));
            let mut worst = Worst::new(format!("maxima, {}, {}", way.name(), shot.what()));
            for (i, pixel) in shot.pixels().enumerate().filter(|&(i, _)| !f[i].is_nan()) {
                worst.take(pixel, (both[i] - f[i] - g[i]).max(0.0), 1e-6);
            }
            worst.assert_holds();
        }
    }
}

#[test]
fn the_maximum_of_the_larger_field_is_the_larger_maximum() {
    // Exact where a value is a voxel's: without a filter.
    let larger = |p: DVec3| f64::from(waves(p) as f32).max(f64::from(ripples(p) as f32));
    for way in ways() {
        for shot in shots(Mode::Mip) {
            let shot = shot.with(|settings| settings.filter = Filter::Nearest);
            let of = |value: &(dyn Fn(DVec3) -> f64 + Sync)| way.values(&shot, &of_values(value));
            let (f, g, both) = (of(&waves), of(&ripples), of(&larger));
            let mut worst = Worst::new(format!("larger, {}, {}", way.name(), shot.what()));
            for (i, pixel) in shot.pixels().enumerate().filter(|&(i, _)| !f[i].is_nan()) {
                worst.take(pixel, both[i] - f[i].max(g[i]), 1e-6);
            }
            worst.assert_holds();
        }
    }
}

fn nearest_values(renderer: &mut Renderer, volume: &Volume, shot: &PictureCase) -> Vec<f32> {
    let transfer = ramps();
    let scene = shot.scene(volume, Some(&transfer));
    let picture = renderer
        .render(&scene, &[LayerKind::Value])
        .unwrap()
        .picture;
    picture.layers[0].values.clone()
}

#[test]
fn a_monotone_function_passes_through_a_maximum_exactly() {
    let steepened = |v: f32| v * v * v - 0.25;
    let volume = volume_of(SHEARED().dims, sheared_affine(), waves);
    let mapped = volume_of(SHEARED().dims, sheared_affine(), |p| {
        steepened(waves(p) as f32).into()
    });
    let mut of_volume = Renderer::new(device(), &volume).unwrap();
    let mut of_mapped = Renderer::new(device(), &mapped).unwrap();
    for mode in [Mode::Mip, Mode::Minip] {
        for shot in shots(mode) {
            let shot = shot.with(|settings| settings.filter = Filter::Nearest);
            let before = nearest_values(&mut of_volume, &volume, &shot);
            let after = nearest_values(&mut of_mapped, &mapped, &shot);
            let mut seen = 0;
            for (before, after) in before.into_iter().zip(after) {
                assert_eq!(before.is_nan(), after.is_nan(), "{}", shot.what());
                if !before.is_nan() {
                    assert_eq!(steepened(before), after, "{}", shot.what());
                    seen += 1;
                }
            }
            assert!(seen > 200, "{}: only {seen} pixels", shot.what());
        }
    }
}

#[test]
fn an_xray_of_a_sum_is_the_sum_of_xrays() {
    let sum = |p: DVec3| waves(p) + ripples(p);
    for way in ways() {
        for shot in shots(Mode::Xray) {
            let of = |value: &(dyn Fn(DVec3) -> f64 + Sync)| way.values(&shot, &of_values(value));
            let (f, g, both) = (of(&waves), of(&ripples), of(&sum));
            let mut worst = Worst::new(format!("X-rays, {}, {}", way.name(), shot.what()));
            for (i, pixel) in shot.pixels().enumerate().filter(|&(i, _)| !f[i].is_nan()) {
                worst.take(pixel, both[i] - f[i] - g[i], 1e-5 * (f[i] + g[i]));
            }
            worst.assert_holds();
        }
    }
}

#[test]
fn an_average_is_the_xray_over_the_length() {
    for way in ways() {
        for (average, xray) in shots(Mode::Average).zip(shots(Mode::Xray)) {
            let of = |shot: &PictureCase| way.values(shot, &of_values(&waves));
            let mut worst = Worst::new(format!("average, {}, {}", way.name(), average.what()));
            let (means, sums) = (of(&average), of(&xray));
            for (i, pixel) in average.pixels().enumerate() {
                let Some(chord) =
                    Chord::of(&average, pixel).filter(|chord| !chord.samples.is_empty())
                else {
                    continue;
                };
                if chord.hangs {
                    worst.leave_out();
                    continue;
                }
                // A short chord is known to its blur only.
                let length = chord.length();
                let allowed = 1e-5 + 4.0 * chord.blur / length;
                worst.take(pixel, means[i] - sums[i] / length, allowed);
            }
            worst.assert_holds();
        }
    }
}

#[test]
fn all_techniques_see_one_gaussian_alike() {
    // Width 6 voxels, allowed: 1.5 % of the peak between any two.
    let grid = Grid {
        dims: [64; 3],
        world_from_voxel: DAffine3::IDENTITY,
    };
    let center = grid.center() + DVec3::new(0.7, -0.4, 0.2);
    let value = |p: DVec3| (-0.5 * (p - center).length_squared() / 36.0).exp();
    let peak = 6.0 * (2.0 * std::f64::consts::PI).sqrt();
    let shots = oblique_shots(grid, Mode::Xray);
    let found: Vec<_> = shots
        .iter()
        .map(|shot| Device.values(shot, &of_values(&value)))
        .collect();
    for (i, one) in shots.iter().enumerate() {
        for (j, other) in shots.iter().enumerate().skip(i + 1) {
            if one.camera != other.camera {
                continue;
            }
            let mut worst = Worst::new(format!("{} and {}", one.what(), other.what()));
            for (p, pixel) in one.pixels().enumerate() {
                let (a, b) = (found[i][p], found[j][p]);
                // A ray along the edge meets a sample or none, both of next to nothing.
                let apart = [a, b].map(|v| if v.is_nan() { 0.0 } else { v });
                worst.take(pixel, apart[0] - apart[1], 0.015 * peak);
            }
            worst.assert_holds();
        }
    }
}
