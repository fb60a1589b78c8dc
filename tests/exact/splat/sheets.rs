//! Sheets of values, classified: matter of one value, all voxels in any order, a field that is linear.

use super::{
    DIMS, cubes, function, noise, of_sheets, over, pictures, ray_of, scene, settings, sheared,
    shots, values, voxels,
};
use crate::shared::oracle::constant_color;
use crate::shared::{Device, Matter, PictureCase, Reference, Way, Worst, device, volume_of};
use glam::{DAffine3, DMat3, DVec3, dvec3};
use stratavox::offscreen::{Renderer, reference};
use stratavox::picture::{ColorSpace, LayerKind, Picture};
use stratavox::technique::Mode;
use stratavox::technique::slices_2d::stack_axis;
use stratavox::technique::splat::kernel::Kernel;
use stratavox::technique::splat::{Sheets, oracle};
use stratavox::transfer::{Absorption, Points, classify_by_points};
use stratavox::volume::{Grid, Volume};

#[test]
fn a_box_of_one_value_is_as_opaque_as_it_is_long_and_of_one_colour() {
    let ways: [Box<dyn Way>; 3] = [
        Box::new(Reference::<f64>::new()),
        Box::new(Reference::<f32>::new()),
        Box::new(Device),
    ];
    for way in ways {
        for per_voxel in [1.0, 0.6] {
            for shot in shots(cubes(), &settings(Mode::Composite, Sheets::Image)) {
                let shot = shot.with(|s| s.samples_per_voxel = per_voxel);
                homogeneous(&*way, &shot);
                constant_color(&*way, &shot).assert_holds();
            }
        }
    }
}

/// One opacity, one colour: 1 - exp(-sigma L) with L all of the way through the box.
fn homogeneous(way: &dyn Way, shot: &PictureCase) {
    const SIGMA: f64 = 0.11;
    const COLOR: [f64; 3] = [0.8, 0.5, 0.1];
    let matter = Matter {
        value: &|_| 1.0,
        color: &|_| COLOR,
        extinction: &|_| SIGMA,
        range: [0.0, 2.0],
    };
    let mut worst = Worst::new(format!("{}: {}", way.name(), shot.what()));
    for (pixel, found) in shot.pixels().zip(way.picture(shot, &matter)) {
        let inside = ray_of(shot, pixel).inside(&shot.grid);
        let length = inside.map_or(0.0, |[enter, leave]| leave - enter);
        let opacity = -(-SIGMA * length).exp_m1();
        let [r, g, b] = COLOR.map(|c| c * opacity);
        for (wanted, found) in [r, g, b, opacity].into_iter().zip(found) {
            worst.take(pixel, found - wanted, 1e-5);
        }
    }
    worst.assert_holds();
}

/// A picture of classified sheets that face the eye, sheet by sheet over all voxels.
fn composite_of_all_voxels(
    shot: &PictureCase,
    volume: &Volume,
    pixel: [u32; 2],
) -> Option<[f64; 4]> {
    let ray = ray_of(shot, pixel);
    let [enter, leave] = ray.inside(&shot.grid)?;
    let kernel = Kernel::of(&shot.view());
    let points = Points::new(
        &function(),
        Absorption::Extinction {
            reference_length: 1.0,
        },
        ColorSpace::Display,
    );
    let step = shot.view().step_world();
    let sheet_at = |t: f64| ray.forward.dot(ray.origin + t * ray.direction) / step;
    let first = sheet_at(enter).floor();
    let count = (sheet_at(leave).ceil() - first) as usize;
    let edges: Vec<f64> = (0..=count)
        .map(|i| ray.edge((first + i as f64) * step))
        .collect();
    let sums = oracle::sheets(&kernel, &ray.line, voxels(volume), &edges);
    let cut = edges.windows(2).map(|e| e[1].min(leave) - e[0].max(enter));
    let sheets = cut.zip(&sums).filter_map(|(length, &[sum, weight, all])| {
        let is_there = weight > 0.0 && weight >= 0.5 * all && length > 0.0;
        is_there.then(|| (length, classify_by_points::<f64>(&points, sum / weight)))
    });
    Some(over(sheets))
}

#[test]
fn classified_sheets_are_those_of_all_voxels_in_any_order() {
    for (grid, has_holes) in [(cubes(), false), (sheared(), false), (sheared(), true)] {
        let mut volume = volume_of(grid.dims, grid.world_from_voxel, noise);
        if has_holes {
            let count = DIMS.iter().product::<u32>();
            volume.validity = Some(
                (0..count)
                    .map(|i| u8::from(i % 7 != 3 && i % 200 < 150))
                    .collect(),
            );
        }
        for shot in shots(grid, &settings(Mode::Composite, Sheets::Image)) {
            let per_voxel = if grid == sheared() { 0.5 } else { 1.0 };
            let shot = shot.with(|s| s.samples_per_voxel = per_voxel);
            let f = function();
            for (name, picture) in pictures(&scene(&shot, &volume, &f), &[]) {
                let mut worst = Worst::new(format!("{name}: {}, holes {has_holes}", shot.what()));
                for (pixel, found) in shot.pixels().zip(&picture.pixels) {
                    let wanted = composite_of_all_voxels(&shot, &volume, pixel).unwrap_or_default();
                    for c in 0..4 {
                        worst.take(pixel, f64::from(found[c]) - wanted[c], of_sheets());
                    }
                }
                worst.assert_holds();
            }
        }
    }
}

/// The same of slices: each stands for as much of the ray as lies between two of them, where the ray meets it in the box.
/// Without an answer where it meets one at a face.
fn composite_of_slices(shot: &PictureCase, volume: &Volume, pixel: [u32; 2]) -> Option<[f64; 4]> {
    let ray = ray_of(shot, pixel);
    let Some([enter, leave]) = ray.inside(&shot.grid) else {
        return Some([0.0; 4]);
    };
    let kernel = Kernel::of(&shot.view());
    let absorption = Absorption::Extinction {
        reference_length: 1.0,
    };
    let points = Points::new(&function(), absorption, ColorSpace::Display);
    let k = stack_axis(&shot.view());
    let (o, d) = (ray.line.origin[k], ray.line.direction[k]);
    let mut sums = vec![[0.0; 3]; volume.dims[k] as usize];
    for (center, numbers) in voxels(volume) {
        if let Some(footprint) = oracle::Footprint::new(&kernel, &ray.line, center) {
            let sum = &mut sums[center[k] as usize];
            *sum = std::array::from_fn(|c| sum[c] + footprint.integral * numbers[c]);
        }
    }
    let mut met: Vec<(f64, [f64; 3])> = (0..)
        .zip(sums)
        .map(|(m, sum)| ((f64::from(m) + 0.5 - o) / d, sum))
        .collect();
    if met
        .iter()
        .any(|(t, _)| (t - enter).abs() < 1e-3 || (t - leave).abs() < 1e-3)
    {
        return None;
    }
    met.sort_by(|a, b| a.0.total_cmp(&b.0));
    let inside = met.into_iter().filter(|(t, [_, weight, all])| {
        enter < *t && *t < leave && *weight > 0.0 && *weight >= 0.5 * all
    });
    let sheets = inside.map(|(_, [sum, weight, _])| {
        (
            1.0 / d.abs(),
            classify_by_points::<f64>(&points, sum / weight),
        )
    });
    Some(over(sheets))
}

#[test]
fn classified_slices_are_those_of_all_voxels() {
    let f = function();
    for grid in [cubes(), sheared()] {
        let volume = volume_of(grid.dims, grid.world_from_voxel, noise);
        for shot in shots(grid, &settings(Mode::Composite, Sheets::Axis)) {
            for (name, picture) in pictures(&scene(&shot, &volume, &f), &[]) {
                let mut worst = Worst::new(format!("{name}: {}", shot.what()));
                for (pixel, found) in shot.pixels().zip(&picture.pixels) {
                    let Some(wanted) = composite_of_slices(&shot, &volume, pixel) else {
                        worst.leave_out();
                        continue;
                    };
                    for c in 0..4 {
                        worst.take(pixel, f64::from(found[c]) - wanted[c], of_sheets());
                    }
                }
                worst.assert_holds();
            }
        }
    }
}

#[test]
fn the_maximum_of_a_linear_field_is_that_of_the_middles_of_sheets() {
    let grid = cubes();
    let slope = dvec3(0.03, 0.05, -0.02);
    let field = |p: DVec3| 0.4 + slope.dot(p - 6.5);
    let volume = volume_of(DIMS, grid.world_from_voxel, field);
    let far = grid.far_corner();
    let f = function();
    for shot in shots(grid, &settings(Mode::Mip, Sheets::Image)) {
        // All voxels that a sheet is made of are there.
        let crop = [DVec3::splat(4.0), far - 4.0];
        let mut shot = shot.with(|s| (s.crop, s.splat.low_pass) = (Some(crop), 0.0));
        shot.extent = [72, 66];
        let step = shot.view().step_world();
        let law = 3f64.sqrt()
            * 4.0
            * std::f64::consts::PI
            * 0.36
            * (-2.0 * std::f64::consts::PI.powi(2) * 0.36).exp()
            * slope.length();
        for (name, picture) in pictures(&scene(&shot, &volume, &f), &[LayerKind::Value]) {
            let mut worst = Worst::new(format!("{name}: {}", shot.what()));
            let mut met = 0;
            for (pixel, &found) in shot.pixels().zip(values(&picture)) {
                let ray = ray_of(&shot, pixel);
                let middles = (-60..60).map(|k| ray.edge((f64::from(k) + 0.5) * step));
                let inside = middles.filter_map(|t| {
                    let p = ray.line.origin + t * ray.line.direction;
                    (p.cmpge(crop[0]).all() && p.cmplt(crop[1]).all()).then(|| field(p))
                });
                let wanted = inside.fold(f64::NAN, f64::max);
                if !wanted.is_nan() && !found.is_nan() {
                    met += 1;
                    worst.take(pixel, f64::from(found) - wanted, law + 1e-5);
                }
            }
            assert!(met > 20, "{met}");
            worst.assert_holds();
        }
    }
}

/// A grid with its axes in another order and direction, and what of the old voxels lies where: the same matter in the
/// same place.
fn turned(grid: &Grid, order: [usize; 3], flips: [bool; 3]) -> (Grid, impl Fn(DVec3) -> DVec3) {
    let (dims, old) = (order.map(|k| grid.dims[k]), grid.dims);
    let old_of = move |p: DVec3| {
        let mut found = DVec3::ZERO;
        for (n, &k) in order.iter().enumerate() {
            found[k] = if flips[n] {
                f64::from(old[k]) - p[n]
            } else {
                p[n]
            };
        }
        found
    };
    let origin = old_of(DVec3::ZERO);
    let column = |n: usize| old_of(DVec3::AXES[n]) - origin;
    let matrix = DMat3::from_cols(column(0), column(1), column(2));
    let world_from_voxel = grid.world_from_voxel * DAffine3::from_mat3_translation(matrix, origin);
    (
        Grid {
            dims,
            world_from_voxel,
        },
        old_of,
    )
}

#[test]
fn matter_looks_the_same_whatever_the_order_and_direction_of_its_axes() {
    let grid = sheared();
    let f = function();
    let [_, shot] = shots(grid, &settings(Mode::Composite, Sheets::Image));
    let shot = shot.with(|s| s.samples_per_voxel = 0.5);
    let volume = volume_of(grid.dims, grid.world_from_voxel, noise);
    let wanted = reference::render::<f64>(&scene(&shot, &volume, &f)).unwrap();
    let orders = [
        [0, 1, 2],
        [1, 2, 0],
        [2, 0, 1],
        [0, 2, 1],
        [2, 1, 0],
        [1, 0, 2],
    ];
    for (nth, order) in orders.into_iter().enumerate() {
        for flip in 0..8 {
            let flips = [0, 1, 2].map(|n| flip >> n & 1 == 1);
            let (grid, old_of) = turned(&grid, order, flips);
            let volume = volume_of(grid.dims, grid.world_from_voxel, |p| noise(old_of(p)));
            let shot = PictureCase {
                grid,
                ..shot.clone()
            };
            let scene = scene(&shot, &volume, &f);
            let found = match flip == nth {
                true => {
                    Renderer::new(device(), &volume)
                        .unwrap()
                        .render(&scene, &[])
                        .unwrap()
                        .picture
                }
                false => reference::render::<f32>(&scene).unwrap(),
            };
            let what = format!("{order:?} {flips:?}");
            Worst::between(
                what,
                shot.extent[0],
                &wanted.pixels,
                &found.pixels,
                of_sheets(),
            )
            .assert_holds();
        }
    }
}

#[test]
fn slices_that_are_passed_by_leave_the_picture_as_it_is() {
    // A ball, and nothing for several macro cells to all sides.
    let dims = [192, 40, 40];
    let ball = |p: DVec3| 1.2 - 0.1 * p.distance(dvec3(20.0, 20.0, 20.0));
    let grid = Grid { dims, ..cubes() };
    let volume = volume_of(dims, grid.world_from_voxel, ball);
    let f = function();
    for sheets in [Sheets::Image, Sheets::Axis] {
        for shot in shots(grid, &settings(Mode::Composite, sheets)) {
            let pictures = [true, false].map(|skip| {
                // As an 8-bit picture has them: they reach less far.
                let shot =
                    shot.with(|s| (s.skip, s.splat.cut_bits, s.splat.low_pass) = (skip, 8, 0.0));
                let mut renderer = Renderer::new(device(), &volume).unwrap();
                let found = renderer.render(&scene(&shot, &volume, &f), &[LayerKind::Samples]);
                found.unwrap().picture
            });
            let [skipped, whole] = &pictures;
            assert!(skipped.pixels == whole.pixels, "{sheets}: {}", shot.what());
            let met = |picture: &Picture| picture.layers[0].values.iter().sum::<f32>();
            assert!(
                met(skipped) < 0.8 * met(whole),
                "{} of {}",
                met(skipped),
                met(whole)
            );
        }
    }
}
