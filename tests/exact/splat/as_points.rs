//! Splats of a volume are those of scattered points that lie where its voxels do, as wide and as heavy; and their colours are
//! added each by itself.

use super::{DIMS, function, noise, pictures, scene, settings, sheared, shots, values};
use crate::shared::{PictureCase, Worst, volume_of};
use glam::{DAffine3, DVec3, dvec3};
use stratavox::camera::Projection;
use stratavox::picture::{ColorSpace, LayerKind};
use stratavox::points::Points;
use stratavox::scene::{Beside, Scene};
use stratavox::technique::Mode;
use stratavox::technique::preclassified::preclassified;
use stratavox::technique::splat::{Sheets, Splat};
use stratavox::volume::{Grid, Volume};

/// Voxels of side 1.5.
const SPACING: f64 = 1.5;

fn large() -> Grid {
    Grid {
        dims: DIMS,
        world_from_voxel: DAffine3::from_translation(dvec3(5.0, -3.0, 40.0))
            * DAffine3::from_scale(DVec3::splat(SPACING)),
    }
}

/// Integrals are of world length: a voxel of value f is a point of value f that weighs as much as its side cubed. Points are not
/// given what is cut off them, 2^-20.
#[test]
fn an_x_ray_is_that_of_points_where_voxels_are() {
    let grid = large();
    let volume = volume_of(DIMS, grid.world_from_voxel, noise);
    let std = Splat::default().std * SPACING;
    let [nx, ny, nz] = DIMS;
    let voxels = (0..nz).flat_map(|z| (0..ny).flat_map(move |y| (0..nx).map(move |x| [x, y, z])));
    let centres = voxels.map(|v| {
        grid.world_from_voxel
            .transform_point3(DVec3::from_array(v.map(f64::from)) + 0.5)
    });
    let centres: Vec<_> = centres.collect();
    let count = centres.len();
    let list = (0..count).map(|i| volume.voxels.stored(i)).collect();
    let all = |number: f64| Some(vec![number as f32; count]);
    let points = Points::new(centres, list, all(std), all(SPACING.powi(3))).expect("points");
    let binned = points.binned();
    let f = function();
    for mode in [Mode::Xray, Mode::Average] {
        // Where a ray meets no more than the rim of a few, at b = R, their weights are off by R times as much as in the middle.
        let allowed = match mode {
            Mode::Average => 1e-5 * (1.0 + 5.27),
            _ => 1e-5,
        };
        let mut of_voxels = settings(mode, Sheets::Image);
        of_voxels.splat.low_pass = 0.0;
        let mut of_points = of_voxels.clone();
        of_points.splat.of_points = true;
        let mut near = shots(grid, &of_voxels);
        near[1].camera.projection = Projection::Perspective { fov_degrees: 50.0 };
        for shot in near {
            let other = PictureCase {
                grid: binned.grid(),
                settings: of_points.clone(),
                ..shot.clone()
            };
            let scene_of_points = Scene {
                beside: Beside::Points(&points),
                ..scene(&other, &binned, &f)
            };
            let layers = [LayerKind::Value];
            let both = [
                pictures(&scene(&shot, &volume, &f), &layers),
                pictures(&scene_of_points, &layers),
            ];
            for ((name, of_voxels), (_, of_points)) in both[0].iter().zip(&both[1]) {
                let mut worst = Worst::new(format!("{name}: {}", shot.what()));
                let largest = values(of_points).iter().filter(|v| !v.is_nan());
                let largest = f64::from(largest.fold(0.0f32, |a, &b| a.max(b)));
                for (i, pixel) in shot.pixels().enumerate() {
                    let [found, wanted] = [of_voxels, of_points].map(|p| values(p)[i]);
                    let number = |v: f32| if v.is_nan() { 0.0 } else { f64::from(v) };
                    // Where rays meet nothing there is no mean; at the rim of all of them, where one of both has cut it off.
                    if mode == Mode::Average && (found.is_nan() || wanted.is_nan()) {
                        if found.is_nan() != wanted.is_nan() {
                            worst.leave_out();
                        }
                        continue;
                    }
                    worst.take(pixel, number(found) - number(wanted), allowed * largest);
                }
                worst.assert_holds();
            }
        }
    }
}

/// Red, green and blue of a function in each other's place: so they are in the picture, to the bit.
#[test]
fn colours_that_change_places_change_them_in_the_picture() {
    let volume = volume_of(DIMS, sheared().world_from_voxel, noise);
    let plain = function();
    let mut turned = function();
    turned
        .color
        .iter_mut()
        .for_each(|point| point.srgb.rotate_left(1));
    let parts = [&plain, &turned]
        .map(|f| preclassified(&volume, f, 1.0, ColorSpace::Display).expect("four volumes"));
    for (sheets, is_classified) in [
        (Sheets::Image, false),
        (Sheets::Axis, false),
        (Sheets::Image, true),
        (Sheets::Axis, true),
        (Sheets::None, true),
    ] {
        let mut settings = settings(Mode::Composite, sheets);
        // A slice of a sheared grid reaches into fewer sheets than there is room for.
        settings.samples_per_voxel = 0.5;
        for shot in shots(sheared(), &settings) {
            let drawn = |n: usize| {
                let f = [&plain, &turned][n];
                let beside: Vec<&Volume> = parts[n][1..].iter().collect();
                let scene = match is_classified {
                    true => Scene {
                        beside: Beside::Classified(&beside),
                        ..scene(&shot, &parts[n][0], f)
                    },
                    false => scene(&shot, &volume, f),
                };
                pictures(&scene, &[]).map(|(_, picture)| picture)
            };
            let [plain, turned] = [0, 1].map(drawn);
            for (wanted, found) in plain.iter().zip(&turned) {
                let mut seen = 0;
                for ([r, g, b, a], found) in wanted.pixels.iter().zip(&found.pixels) {
                    assert_eq!(
                        [*g, *b, *r, *a],
                        *found,
                        "{sheets}, classified {is_classified}"
                    );
                    seen += usize::from(*a > 0.01 && r != g);
                }
                assert!(seen > 100, "only {seen} pixels of a colour");
            }
        }
    }
}
