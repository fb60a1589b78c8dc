//! Splats of voxels that are classified before: optical depths are added.

use super::{
    DIMS, DIRECTIONS, cubes, function, noise, pictures, scene, seen_from, settings, values,
};
use crate::shared::{Worst, volume_of};
use glam::{DVec3, dvec3};
use stratavox::offscreen::reference;
use stratavox::picture::ColorSpace;
use stratavox::scene::{Beside, Scene};
use stratavox::technique::Mode;
use stratavox::technique::preclassified::preclassified;
use stratavox::technique::splat::Sheets;
use stratavox::transfer::ColorPoint;
use stratavox::volume::Volume;

fn classified(volume: &Volume) -> [Volume; 4] {
    preclassified(volume, &function(), 1.0, ColorSpace::Display).expect("four volumes")
}

#[test]
fn alpha_of_classified_voxels_is_the_x_ray_of_their_extinction_in_all_sheets() {
    let grid = cubes();
    let volume = volume_of(DIMS, grid.world_from_voxel, noise);
    let parts = classified(&volume);
    let f = function();
    let of_extinction = settings(Mode::Xray, Sheets::Image);
    let ways = [
        (Sheets::Image, 1.0),
        (Sheets::Image, 0.7),
        (Sheets::Axis, 1.0),
        (Sheets::None, 1.0),
    ];
    for towards in DIRECTIONS {
        let shot = seen_from(grid, towards, &of_extinction);
        let x_ray = reference::render::<f64>(&scene(&shot, &parts[3], &f)).unwrap();
        for (sheets, per_voxel) in ways {
            let mut settings = settings(Mode::Composite, sheets);
            settings.samples_per_voxel = per_voxel;
            let shot = seen_from(grid, towards, &settings);
            let beside: Vec<&Volume> = parts[1..].iter().collect();
            let scene = Scene {
                beside: Beside::Classified(&beside),
                ..scene(&shot, &parts[0], &f)
            };
            for (name, picture) in pictures(&scene, &[]) {
                let mut worst = Worst::new(format!("{name}: {sheets}, {per_voxel}, {towards}"));
                for (pixel, (found, &depth)) in
                    shot.pixels().zip(picture.pixels.iter().zip(values(&x_ray)))
                {
                    let depth = if depth.is_nan() {
                        0.0
                    } else {
                        f64::from(depth)
                    };
                    worst.take(pixel, f64::from(found[3]) + (-depth).exp_m1(), 5e-6);
                }
                worst.assert_holds();
            }
        }
    }
}

#[test]
fn matter_of_one_colour_has_it_in_all_sheets() {
    let grid = cubes();
    let volume = volume_of(DIMS, grid.world_from_voxel, noise);
    let mut f = function();
    f.color = vec![ColorPoint {
        value: 0.0,
        srgb: [0.3, 0.6, 0.9],
    }];
    let parts = preclassified(&volume, &f, 1.0, ColorSpace::Display).expect("four volumes");
    let beside: Vec<&Volume> = parts[1..].iter().collect();
    for (sheets, is_pre) in [
        (Sheets::Image, false),
        (Sheets::Axis, false),
        (Sheets::Image, true),
        (Sheets::Axis, true),
        (Sheets::None, true),
    ] {
        let shot = seen_from(grid, DIRECTIONS[2], &settings(Mode::Composite, sheets));
        let scene = match is_pre {
            true => Scene {
                beside: Beside::Classified(&beside),
                ..scene(&shot, &parts[0], &f)
            },
            false => scene(&shot, &volume, &f),
        };
        for (name, picture) in pictures(&scene, &[]) {
            let mut worst = Worst::new(format!("{name}: {sheets}, {is_pre}"));
            for (pixel, [r, g, b, a]) in shot.pixels().zip(&picture.pixels) {
                for (c, wanted) in [(r, 0.3), (g, 0.6), (b, 0.9)] {
                    worst.take(pixel, f64::from(*c) - wanted * f64::from(*a), 2e-6);
                }
            }
            worst.assert_holds();
        }
    }
}

#[test]
fn voxels_in_two_volumes_let_through_the_product() {
    let grid = cubes();
    let volume = volume_of(DIMS, grid.world_from_voxel, noise);
    let parts = classified(&volume);
    let f = function();
    let settings = settings(Mode::Composite, Sheets::Image);
    let shot = seen_from(grid, DIRECTIONS[2], &settings);
    let mut through = Vec::new();
    for share in 0..3 {
        let is_in = |p: DVec3| share == 2 || (noise(dvec3(p.z, p.x, p.y)) < 0.5) == (share == 0);
        let part = |n: usize| {
            let whole = &parts[n];
            let [nx, ny, _] = DIMS.map(|n| n as usize);
            volume_of(DIMS, grid.world_from_voxel, |p| {
                let i = p.floor().as_uvec3();
                let i = i.x as usize + nx * (i.y as usize + ny * i.z as usize);
                if is_in(p) {
                    f64::from(whole.voxels.stored(i))
                } else {
                    0.0
                }
            })
        };
        let parts = [0, 1, 2, 3].map(part);
        let beside: Vec<&Volume> = parts[1..].iter().collect();
        let scene = Scene {
            beside: Beside::Classified(&beside),
            ..scene(&shot, &parts[0], &f)
        };
        through.push(pictures(&scene, &[]).map(|(_, picture)| picture));
    }
    let ways = ["f64", "f32", "device"];
    for (way, name) in ways.into_iter().enumerate() {
        let mut worst = Worst::new(name.to_owned());
        let [a, b, both] = [0, 1, 2].map(|n| &through[n][way].pixels);
        for (i, pixel) in shot.pixels().enumerate() {
            let t = |p: &[[f32; 4]]| 1.0 - f64::from(p[i][3]);
            worst.take(pixel, t(a) * t(b) - t(both), 5e-6);
        }
        worst.assert_holds();
    }
}
