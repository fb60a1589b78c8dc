//! Slicer and caster on one lattice are one picture; 2D stacks follow their CPU reference through a full turn; finer
//! steps converge as they should; scales of density, length and resolution do not matter.

use crate::shared::{
    Chord, Matter, PictureCase, Reference, Way, Worst, device, oblique_camera, oblique_shots,
    projections, ramps, sheared_affine, straight_shots, volume_of, waves,
};
use glam::{DAffine3, DQuat, DVec3, dvec3};
use stratavox::camera::{Camera, Projection};
use stratavox::offscreen::{Renderer, reference};
use stratavox::picture::LayerKind;
use stratavox::technique::slices_2d::stack_axis;
use stratavox::technique::{Filter, Lattice, Mode, Order, Settings, Technique};
use stratavox::transfer::OpacityPoint;
use stratavox::volume::Grid;

const SHEARED: fn() -> Grid = || Grid {
    dims: [17, 21, 13],
    world_from_voxel: sheared_affine(),
};
const MODES: [Mode; 5] = [
    Mode::Composite,
    Mode::Mip,
    Mode::Minip,
    Mode::Average,
    Mode::Xray,
];

#[test]
fn slicer_and_caster_on_one_lattice_are_one_picture() {
    let volume = volume_of(SHEARED().dims, sheared_affine(), waves);
    let transfer = ramps();
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    let grid = SHEARED();
    let inside = Camera {
        eye: grid
            .world_from_voxel
            .transform_point3(dvec3(7.3, 12.1, 6.2)),
        ..oblique_camera(&grid, Projection::Perspective { fov_degrees: 120.0 })
    };
    for mode in MODES {
        for samples_per_voxel in [1.0, 2.6] {
            let cameras = projections(&grid).map(|projection| oblique_camera(&grid, projection));
            for camera in cameras.into_iter().chain([inside]) {
                let shot = |technique, order| PictureCase {
                    grid,
                    camera,
                    extent: [48, 40],
                    settings: Settings {
                        technique,
                        mode,
                        order,
                        lattice: Lattice::Planes,
                        samples_per_voxel,
                        conformance: true,
                        // All samples are counted.
                        skip: false,
                        ..Settings::default()
                    },
                };
                let caster = shot(Technique::Raycast, Order::BackToFront);
                let layers = [LayerKind::Samples];
                let scene = caster.scene(&volume, Some(&transfer));
                let wanted = renderer.render(&scene, &layers).unwrap().picture;
                for order in [Order::BackToFront, Order::FrontToBack] {
                    let slicer = shot(Technique::Slices3d, order);
                    let scene = slicer.scene(&volume, Some(&transfer));
                    let found = renderer.render(&scene, &layers).unwrap().picture;
                    assert_eq!(wanted.layers, found.layers, "{}", slicer.what());
                    let what = format!("one lattice, {}", slicer.what());
                    Worst::between(what, wanted.width, &wanted.pixels, &found.pixels, 2e-6)
                        .assert_holds();
                }
            }
        }
    }
}

#[test]
fn stacks_follow_their_reference_through_a_full_turn_and_switch_at_45_degrees() {
    let grid = Grid {
        dims: [14, 14, 14],
        world_from_voxel: DAffine3::from_translation(dvec3(5.0, -3.0, 40.0)),
    };
    let volume = volume_of(grid.dims, grid.world_from_voxel, waves);
    let transfer = ramps();
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    let mut angles: Vec<f64> = (0..72).map(|i| 5.0 * f64::from(i)).collect();
    angles.extend(
        [45.0, 135.0, 225.0, 315.0]
            .iter()
            .flat_map(|a| [a - 1e-6, a + 1e-6]),
    );
    // Around the second axis, and up and down around the first.
    let turns = [
        (DVec3::Y, dvec3(0.0, 0.0, -1.0), [0, 2]),
        (DVec3::X, dvec3(0.0, 0.0, -1.0), [1, 2]),
    ];
    let mut switched = 0;
    for (turn, start, [side, front]) in turns {
        for &angle in &angles {
            let direction = DQuat::from_axis_angle(turn, angle.to_radians()) * start;
            for projection in projections(&grid) {
                let camera = Camera {
                    eye: grid.center() - 40.0 * direction,
                    target: grid.center(),
                    up: turn,
                    projection,
                    zoom: 1.0,
                };
                let shot = PictureCase {
                    grid,
                    camera,
                    extent: [24, 22],
                    settings: Settings {
                        technique: Technique::Slices2d,
                        conformance: true,
                        ..Settings::default()
                    },
                };
                let axis = stack_axis(&shot.view());
                let from_front = angle.to_radians().cos().abs() - angle.to_radians().sin().abs();
                if from_front.abs() > 1e-9 {
                    let wanted = if from_front > 0.0 { front } else { side };
                    assert_eq!(axis, wanted, "at {angle} degrees around {turn}");
                    switched += usize::from(from_front.abs() < 1e-7);
                }
                let scene = shot.scene(&volume, Some(&transfer));
                let found = renderer.render(&scene, &[]).unwrap().picture;
                let reference = reference::render::<f32>(&scene).unwrap();
                let mut worst = Worst::new(format!("at {angle} degrees, {}", shot.what()));
                for (i, pixel) in shot.pixels().enumerate() {
                    if Chord::of(&shot, pixel).is_some_and(|chord| chord.hangs) {
                        worst.leave_out();
                        continue;
                    }
                    for c in 0..4 {
                        let error = found.pixels[i][c] - reference.pixels[i][c];
                        worst.take(pixel, error.into(), 2e-6);
                    }
                }
                worst.assert_holds();
            }
        }
    }
    assert_eq!(switched, 2 * 2 * 8, "both sides of every switch");
}

/// Root mean square over the pixels of how far opacity is from that of a step 64 times smaller.
fn error_of(way: &dyn Way, shot: &PictureCase, matter: &Matter, wanted: &[[f64; 4]]) -> f64 {
    let found = way.picture(shot, matter);
    let squares = found.iter().zip(wanted).map(|(f, w)| (f[3] - w[3]).powi(2));
    (squares.sum::<f64>() / found.len() as f64).sqrt()
}

#[test]
fn half_the_step_is_a_quarter_of_the_error_and_half_of_it_at_a_hard_edge() {
    let grid = SHEARED();
    let center = grid.center();
    let world_from_voxel = grid.world_from_voxel;
    let ball = |p: DVec3| {
        let off = world_from_voxel.transform_point3(p) - center;
        f64::from(u8::from(off.length() < 5.3))
    };
    type Field<'a> = &'a (dyn Fn(DVec3) -> f64 + Sync);
    let cases: [(&str, Field, f64, f64); 2] =
        [("smooth", &waves, 4.0, 0.4), ("hard", &ball, 2.0, 0.3)];
    let reference = Reference::<f64>::new();
    for (what, value, wanted_ratio, allowed) in cases {
        let matter = Matter {
            value,
            color: &|v| [v; 3],
            extinction: &|v| 0.15 * v.max(0.0),
            range: [0.0, 1.0],
        };
        let on_rays = oblique_shots(grid, Mode::Composite).into_iter();
        // On planes the ends of a chord are a hard edge of their own: they belong to neither case.
        let on_rays = on_rays.filter(|shot| {
            shot.settings.technique == Technique::Raycast && shot.settings.lattice == Lattice::Ray
        });
        for shot in on_rays {
            let shot = PictureCase {
                extent: [64, 56],
                ..shot
            };
            let every = |n: f64| shot.with(|settings| settings.samples_per_voxel = n);
            let wanted = reference.picture(&every(64.0), &matter);
            let [coarse, fine] =
                [1.0, 2.0].map(|n| error_of(&reference, &every(n), &matter, &wanted));
            let ratio = coarse / fine;
            println!(
                "{what}, {}: {coarse:.2e} / {fine:.2e} = {ratio:.3}",
                shot.what()
            );
            assert!(
                (ratio - wanted_ratio).abs() <= allowed,
                "{what}, {}: ratio {ratio}",
                shot.what()
            );
        }
    }
}

#[test]
fn density_times_k_and_length_over_k_is_the_same_picture() {
    for k in [2.0, 3.0, 0.1] {
        let small = DAffine3::from_scale(DVec3::splat(1.0 / k)) * sheared_affine();
        let volume = volume_of(SHEARED().dims, sheared_affine(), waves);
        let scaled = volume_of(SHEARED().dims, small, waves);
        let mut transfer = ramps();
        transfer.reference_length = Some(1.0);
        // sigma k times as large: opacity 1 - (1 - a)^k of the old length, here told for another length.
        let mut denser = transfer.clone();
        denser.reference_length = Some(1.0 / k);
        let mut of_volume = Renderer::new(device(), &volume).unwrap();
        let mut of_scaled = Renderer::new(device(), &scaled).unwrap();
        for shot in oblique_shots(SHEARED(), Mode::Composite) {
            let projection = match shot.camera.projection {
                Projection::Orthographic { view_height } => Projection::Orthographic {
                    view_height: view_height / k,
                },
                perspective => perspective,
            };
            let other = PictureCase {
                grid: scaled.grid(),
                camera: Camera {
                    eye: shot.camera.eye / k,
                    target: shot.camera.target / k,
                    projection,
                    ..shot.camera
                },
                ..shot.clone()
            };
            let scene = shot.scene(&volume, Some(&transfer));
            let wanted = of_volume.render(&scene, &[]).unwrap().picture;
            let scene = other.scene(&scaled, Some(&denser));
            let found = of_scaled.render(&scene, &[]).unwrap().picture;
            let what = format!("k = {k}, {}", shot.what());
            Worst::between(what, wanted.width, &wanted.pixels, &found.pixels, 1e-5).assert_holds();
        }
    }
}

#[test]
fn a_linear_ramp_in_twice_as_many_voxels_is_the_same_picture() {
    // Away from the edges, where half a voxel has the edge's value. The caster keeps its step; stacks have twice
    // as many slices, whose sum over whole voxels is the same.
    let grid = Grid {
        dims: [16, 18, 20],
        world_from_voxel: DAffine3::IDENTITY,
    };
    let half = DAffine3::from_scale(DVec3::splat(0.5));
    let ramp = |p: DVec3| 0.02 * p.x + 0.01 * p.y + 0.015 * p.z;
    let coarse = volume_of(grid.dims, grid.world_from_voxel, ramp);
    let fine = volume_of(grid.dims.map(|n| 2 * n), half, |p| ramp(0.5 * p));
    let mut transfer = ramps();
    transfer.opacity = vec![
        OpacityPoint {
            value: 0.0,
            opacity: 0.0,
        },
        OpacityPoint {
            value: 1.0,
            opacity: 0.4,
        },
    ];
    transfer.reference_length = Some(1.0);
    let mut of_coarse = Renderer::new(device(), &coarse).unwrap();
    let mut of_fine = Renderer::new(device(), &fine).unwrap();
    let crop = [DVec3::ONE, grid.far_corner() - 1.0];
    let oblique = oblique_shots(grid, Mode::Composite).into_iter();
    let oblique = oblique.filter(|shot| shot.settings.technique != Technique::Slices2d);
    for shot in oblique.chain(straight_shots(grid, Mode::Xray)) {
        let shot = shot.with(|settings| settings.crop = Some(crop));
        let finer = PictureCase {
            grid: fine.grid(),
            ..shot.with(|settings| {
                settings.crop = Some(crop.map(|corner| 2.0 * corner));
                settings.samples_per_voxel = 0.5;
            })
        };
        let layers: &[LayerKind] = match shot.settings.mode {
            Mode::Xray => &[LayerKind::Value],
            _ => &[],
        };
        let wanted = of_coarse
            .render(&shot.scene(&coarse, Some(&transfer)), layers)
            .unwrap()
            .picture;
        let found = of_fine
            .render(&finer.scene(&fine, Some(&transfer)), layers)
            .unwrap()
            .picture;
        let what = format!("doubled resolution, {}", shot.what());
        let mut worst = Worst::between(what, wanted.width, &wanted.pixels, &found.pixels, 1e-5);
        for (wanted, found) in wanted.layers.iter().zip(&found.layers) {
            let pairs = wanted.values.iter().zip(&found.values).zip(shot.pixels());
            for ((wanted, found), pixel) in pairs.filter(|((wanted, _), _)| !wanted.is_nan()) {
                worst.take(pixel, f64::from(found - wanted), 1e-5);
            }
        }
        worst.assert_holds();
    }
}

#[test]
fn slices_of_a_volume_seen_without_a_filter_are_its_voxels() {
    // Straight along an axis, a MIP of one slice is that slice: whichever stack shows it, nothing is turned.
    let grid = Grid {
        dims: [16, 18, 20],
        world_from_voxel: DAffine3::IDENTITY,
    };
    let volume = volume_of(grid.dims, grid.world_from_voxel, waves);
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    for shot in straight_shots(grid, Mode::Mip) {
        for slice in [0u32, 7, 19] {
            let z = f64::from(slice);
            let shot = shot.with(|settings| {
                settings.filter = Filter::Nearest;
                settings.crop = Some([dvec3(0.0, 0.0, z), dvec3(16.0, 18.0, z + 1.0)]);
            });
            let transfer = ramps();
            let scene = shot.scene(&volume, Some(&transfer));
            let picture = renderer
                .render(&scene, &[LayerKind::Value])
                .unwrap()
                .picture;
            for ([x, y], &found) in shot.pixels().zip(&picture.layers[0].values) {
                // Seen along +z with y up, x runs to the left and y up.
                let (x, y) = (f64::from(15 - x), f64::from(17 - y));
                let wanted = waves(dvec3(x + 0.5, y + 0.5, z + 0.5)) as f32;
                assert_eq!(found, wanted, "{} slice {slice} at {x}, {y}", shot.what());
            }
        }
    }
}
