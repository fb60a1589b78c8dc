//! A15: the MIP of a trilinear random volume against its exact maximum along each ray.
//!
//! Inside a cell a trilinear field along a ray is a cubic of t, known by four of its values; its maximum is at
//! an end or where its derivative, a quadratic, is zero.

use crate::shared::{
    Chord, Device, Matter, PictureCase, Reference, Way, Worst, oblique_shots, sheared_affine,
    volume_of,
};
use glam::{DAffine3, DVec3};
use stratavox::technique::{Mode, Settings};
use stratavox::volume::sample::linear;
use stratavox::volume::{Grid, Volume};

/// Numbers from 0 to 1 without a pattern.
fn noise(p: DVec3) -> f64 {
    let mut bits = p.x as u64 | (p.y as u64) << 16 | (p.z as u64) << 32;
    // The finalizer of splitmix64 (Steele, Lea, Flood 2014).
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((bits ^ (bits >> 31)) >> 40) as f64 / (1u64 << 24) as f64
}

/// The largest value on a chord and the largest |df/dt|.
fn exact(volume: &Volume, voxel_from_world: &DAffine3, chord: &Chord) -> (f64, f64) {
    let origin = voxel_from_world.transform_point3(chord.origin);
    let direction = voxel_from_world.transform_vector3(chord.direction);
    let value = |t: f64| linear::<f64>(volume, (origin + t * direction).to_array()).unwrap();
    // Cells end where a coordinate is a whole number and a half.
    let mut ends = vec![chord.enter, chord.leave];
    for k in 0..3 {
        let walls = (0..volume.dims[k]).map(|i| (f64::from(i) + 0.5 - origin[k]) / direction[k]);
        ends.extend(walls.filter(|t| (chord.enter..chord.leave).contains(t)));
    }
    ends.sort_by(f64::total_cmp);
    let (mut largest, mut steepest) = (f64::NEG_INFINITY, 0.0f64);
    for cell in ends.windows(2) {
        let (start, length) = (cell[0], cell[1] - cell[0]);
        // f(u) = a + b u + c u^2 + d u^3 on [0, 1], by its values at 0, 1/3, 2/3 and 1.
        let [f0, f1, f2, f3] = [0.0, 1.0, 2.0, 3.0].map(|i| value(start + length * i / 3.0));
        let b = (-11.0 * f0 + 18.0 * f1 - 9.0 * f2 + 2.0 * f3) / 2.0;
        let c = (18.0 * f0 - 45.0 * f1 + 36.0 * f2 - 9.0 * f3) / 2.0;
        let d = (-9.0 * f0 + 27.0 * f1 - 27.0 * f2 + 9.0 * f3) / 2.0;
        let cubic = |u: f64| f0 + u * (b + u * (c + u * d));
        let slope = |u: f64| b + u * (2.0 * c + u * 3.0 * d);
        let root = (c * c - 3.0 * b * d).max(0.0).sqrt();
        // Where the derivative is zero, without cancellation and without a division by zero.
        let q = -c - c.signum() * root;
        let tops = [q / (3.0 * d), b / q];
        let inside = |u: &f64| (0.0..=1.0).contains(u);
        for u in [0.0, 1.0]
            .into_iter()
            .chain(tops.into_iter().filter(inside))
        {
            largest = largest.max(cubic(u));
        }
        let bend = -c / (3.0 * d);
        for u in [0.0, 1.0].into_iter().chain(Some(bend).filter(inside)) {
            steepest = steepest.max((slope(u) / length).abs());
        }
    }
    (largest, steepest)
}

/// The maximum over samples is no more than the maximum, and no less than it by what the field can rise
/// between a sample and any place of the chord.
fn sampled_maximum(way: &dyn Way, shot: &PictureCase, volume: &Volume) -> Worst {
    let value = |p: DVec3| linear::<f64>(volume, p.to_array()).unwrap();
    let matter = Matter {
        value: &value,
        color: &|v| [v; 3],
        extinction: &|v| v,
        range: [0.0, 1.0],
    };
    let voxel_from_world = shot.grid.world_from_voxel.inverse();
    let mut worst = Worst::new(format!("A15, {}, {}", way.name(), shot.what()));
    for (pixel, found) in shot.pixels().zip(way.values(shot, &matter)) {
        let Some(chord) = Chord::of(shot, pixel) else {
            continue;
        };
        if chord.hangs || chord.samples.is_empty() {
            worst.leave_out();
            continue;
        }
        let (largest, steepest) = exact(volume, &voxel_from_world, &chord);
        // A sample may be moved by rounding: see `Chord::blur`.
        let moved = 1e-6 + 2.0 * chord.blur * steepest;
        worst.take(pixel, (found - largest).max(0.0), moved);
        worst.take(
            pixel,
            (largest - found).max(0.0),
            steepest * chord.widest_gap() + moved,
        );
    }
    worst
}

#[test]
fn a_sampled_maximum_is_below_the_exact_one_by_no_more_than_a_half_step_rises() {
    let grid = Grid {
        dims: [9, 11, 8],
        world_from_voxel: sheared_affine(),
    };
    let volume = volume_of(grid.dims, grid.world_from_voxel, noise);
    let ways: [&dyn Way; 3] = [&Reference::<f64>::new(), &Reference::<f32>::new(), &Device];
    for way in ways {
        for shot in oblique_shots(grid, Mode::Mip) {
            for samples_per_voxel in [1.0, 16.0] {
                let settings = Settings {
                    samples_per_voxel,
                    ..shot.settings.clone()
                };
                let shot = PictureCase {
                    settings,
                    ..shot.clone()
                };
                sampled_maximum(way, &shot, &volume).assert_holds();
            }
        }
    }
}
