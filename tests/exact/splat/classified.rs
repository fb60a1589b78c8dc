//! Splats of voxels that are classified before: optical depths are added.

use super::{
    DIMS, DIRECTIONS, VOXELS, cubes, function, noise, of_roundings, of_sheets, of_splats, over,
    pictures, ray_of, scene, seen_from, settings, sheared, shots, values, voxels,
};
use crate::shared::{PictureCase, Worst, volume_of};
use glam::{DVec3, dvec3};
use stratavox::offscreen::reference;
use stratavox::picture::ColorSpace;
use stratavox::scene::{Beside, Scene};
use stratavox::technique::Mode;
use stratavox::technique::preclassified::preclassified;
use stratavox::technique::slices_2d::stack_axis;
use stratavox::technique::splat::Sheets;
use stratavox::technique::splat::kernel::Kernel;
use stratavox::technique::splat::oracle::{self, Footprint};
use stratavox::transfer::ColorPoint;
use stratavox::volume::Volume;

/// The middle of the grid.
const CENTER: DVec3 = dvec3(7.0, 6.0, 6.5);

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
                    let through = (-depth).exp();
                    // Opacity is off by as much of the depth as comes through; it, what is left and the depth are rounded for
                    // each voxel.
                    let far = (ray_of(&shot, pixel).line.origin - CENTER).length() + 14.0;
                    let allowed = through * depth * of_splats(far) + of_roundings(3.0 * VOXELS);
                    worst.take(pixel, f64::from(found[3]) - (1.0 - through), allowed);
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
            // Of light and of depth of each voxel the product, its sum in a sheet and that of the sheets.
            let allowed = of_roundings(6.0 * VOXELS);
            for (pixel, [r, g, b, a]) in shot.pixels().zip(&picture.pixels) {
                for (c, wanted) in [(r, 0.3), (g, 0.6), (b, 0.9)] {
                    worst.take(pixel, f64::from(*c) - wanted * f64::from(*a), allowed);
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
        // Splats are the same in all three: only what is added and multiplied is rounded, thrice a voxel.
        let allowed = of_roundings(9.0 * VOXELS);
        for (i, pixel) in shot.pixels().enumerate() {
            let t = |p: &[[f32; 4]]| 1.0 - f64::from(p[i][3]);
            worst.take(pixel, t(a) * t(b) - t(both), allowed);
        }
        worst.assert_holds();
    }
}

/// Light and depth of sheets of all voxels, front to back.
fn sheets_of_all_voxels(
    shot: &PictureCase,
    parts: &[Volume; 4],
    pixel: [u32; 2],
    sheets: Sheets,
) -> Vec<[f64; 4]> {
    let ray = ray_of(shot, pixel);
    let kernel = Kernel::of(&shot.view());
    let stored = |of: &Volume| voxels(of).map(|(_, [value, ..])| value).collect();
    let [red, green, blue, depth] = parts.each_ref().map(stored) as [Vec<f64>; 4];
    let all = voxels(&parts[0])
        .enumerate()
        .map(|(i, (center, _))| (center, [red[i], green[i], blue[i], depth[i]]));
    if sheets == Sheets::Image {
        let step = shot.view().step_world();
        let edges: Vec<f64> = (-90..=90).map(|k| ray.edge(f64::from(k) * step)).collect();
        return oracle::sheets(&kernel, &ray.line, all, &edges);
    }
    // Slices, rows and columns, each from front to back.
    let k = stack_axis(&shot.view());
    let [i, j] = [[1, 2], [0, 2], [0, 1]][k];
    let place = |center: DVec3| {
        [k, j, i].map(|axis| (ray.line.direction[axis].signum() * 2.0 * center[axis]) as i32)
    };
    let mut splats: Vec<_> = all
        .filter_map(|(center, numbers)| {
            let integral = Footprint::new(&kernel, &ray.line, center)?.integral;
            Some((place(center), numbers.map(|n| n * integral)))
        })
        .collect();
    splats.sort_by_key(|&(place, _)| place);
    let is_same = |a: &[i32; 3], b: &[i32; 3]| match sheets {
        Sheets::Axis => a[0] == b[0],
        _ => a == b,
    };
    let sums = splats.chunk_by(|(a, _), (b, _)| is_same(a, b));
    sums.map(|sheet| {
        let add = |sum: [f64; 4], (_, more): &([i32; 3], [f64; 4])| {
            std::array::from_fn(|c| sum[c] + more[c])
        };
        sheet.iter().fold([0.0; 4], add)
    })
    .collect()
}

#[test]
fn colours_of_classified_voxels_are_those_of_all_voxels_in_their_order() {
    let f = function();
    for grid in [cubes(), sheared()] {
        let volume = volume_of(DIMS, grid.world_from_voxel, noise);
        let parts = classified(&volume);
        let beside: Vec<&Volume> = parts[1..].iter().collect();
        for sheets in [Sheets::Image, Sheets::Axis, Sheets::None] {
            let mut settings = settings(Mode::Composite, sheets);
            settings.samples_per_voxel = 0.5;
            let [_, perspective] = shots(grid, &settings);
            for shot in [perspective, seen_from(grid, DIRECTIONS[0], &settings)] {
                let scene = Scene {
                    beside: Beside::Classified(&beside),
                    ..scene(&shot, &parts[0], &f)
                };
                for (name, picture) in pictures(&scene, &[]) {
                    let mut worst = Worst::new(format!("{name}: {sheets}, {}", shot.what()));
                    for (pixel, found) in shot.pixels().zip(&picture.pixels).step_by(5) {
                        let matter = sheets_of_all_voxels(&shot, &parts, pixel, sheets);
                        let wanted = over(matter.into_iter().filter(|sums| sums[3] > 0.0).map(
                            |[r, g, b, depth]| (1.0, [r / depth, g / depth, b / depth, depth]),
                        ));
                        for c in 0..4 {
                            worst.take(pixel, f64::from(found[c]) - wanted[c], of_sheets());
                        }
                    }
                    worst.assert_holds();
                }
            }
        }
    }
}
