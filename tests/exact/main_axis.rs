//! Samples along the main axis k of each ray, at the heights (j + 1/2) / D of its voxels, each for a length of 1 / (D |d_k|): they are as
//! long together as the ray to one of them, those of D = 1 lie in Bresenham's voxels, and other techniques have the same.

mod line;
mod seam;

use crate::shared::oracle::{constant_color, homogeneous, linear_density};
use crate::shared::{
    Chord, Device, Matter, PictureCase, Reference, Way, Worst, device, inner_box, oblique_camera,
    projections, ramps, sheared_affine, volume_of, waves,
};
use glam::{DAffine3, DMat3, DVec3, dvec3};
use stratavox::camera::{Camera, Projection};
use stratavox::offscreen::Renderer;
use stratavox::picture::{LayerKind, Picture};
use stratavox::technique::{Lattice, Mode, Order, Settings, Technique};
use stratavox::volume::{Grid, Volume};

const SHEARED: fn() -> Grid = || Grid {
    dims: [17, 21, 13],
    world_from_voxel: sheared_affine(),
};
const CUBES: fn() -> Grid = || Grid {
    dims: [16, 18, 20],
    world_from_voxel: DAffine3::from_translation(dvec3(5.0, -3.0, 40.0)),
};
const MODES: [Mode; 5] = [
    Mode::Composite,
    Mode::Mip,
    Mode::Minip,
    Mode::Average,
    Mode::Xray,
];

fn settings(mode: Mode, samples_per_voxel: f64) -> Settings {
    Settings {
        lattice: Lattice::Bresenham,
        mode,
        samples_per_voxel,
        conformance: true,
        // All samples are counted.
        skip: false,
        ..Settings::default()
    }
}

/// Both projections, from where no axis is.
fn shots(grid: Grid, mode: Mode, samples_per_voxel: f64) -> [PictureCase; 2] {
    projections(&grid).map(|projection| PictureCase {
        grid,
        camera: oblique_camera(&grid, projection),
        extent: [40, 36],
        settings: settings(mode, samples_per_voxel),
    })
}

/// From inside of the grid to all of the rays that there are: every axis is the main one of some, in both directions.
fn from_inside(grid: Grid, mode: Mode, samples_per_voxel: f64) -> [PictureCase; 2] {
    let [oblique, _] = shots(grid, mode, samples_per_voxel);
    let eye = grid
        .world_from_voxel
        .transform_point3(dvec3(7.3, 12.1, 6.2));
    [1.0, -1.0].map(|way| PictureCase {
        camera: Camera {
            eye,
            target: eye + way * dvec3(1.0, 1.1, 0.9),
            projection: Projection::Perspective { fov_degrees: 140.0 },
            ..oblique.camera
        },
        ..oblique.clone()
    })
}

fn drawn(renderer: &mut Renderer, shot: &PictureCase, volume: &Volume) -> Picture {
    let transfer = ramps();
    let layers: &[LayerKind] = match shot.settings.mode.is_projection() {
        true => &[LayerKind::Samples, LayerKind::Value],
        false => &[LayerKind::Samples],
    };
    let scene = shot.scene(volume, Some(&transfer));
    renderer.render(&scene, layers).unwrap().picture
}

#[test]
fn a_box_of_one_opacity_is_as_opaque_as_its_samples_are_long() {
    let ways: [Box<dyn Way>; 3] = [
        Box::new(Reference::<f64>::new()),
        Box::new(Reference::<f32>::new()),
        Box::new(Device),
    ];
    for way in ways {
        for per_voxel in [1.0, 2.6] {
            let inside = from_inside(SHEARED(), Mode::Composite, per_voxel);
            let outside = shots(SHEARED(), Mode::Composite, per_voxel);
            for shot in outside.into_iter().chain(inside) {
                homogeneous(&*way, &shot).assert_holds();
                constant_color(&*way, &shot).assert_holds();
                let crop = Some(inner_box(&shot.grid));
                linear_density(&*way, &shot.with(|s| s.crop = crop)).assert_holds();
            }
        }
    }
}

#[test]
fn samples_are_the_heights_that_a_ray_meets_and_together_as_long_as_it_to_one_of_them() {
    let volume = volume_of(SHEARED().dims, sheared_affine(), waves);
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    let (mut all, mut whole) = (0, 0);
    for per_voxel in [1.0, 2.0, 2.6, 0.4] {
        let inside = from_inside(SHEARED(), Mode::Composite, per_voxel);
        let outside = shots(SHEARED(), Mode::Composite, per_voxel);
        for shot in outside.into_iter().chain(inside) {
            let picture = drawn(&mut renderer, &shot, &volume);
            for (pixel, &found) in shot.pixels().zip(&picture.layers[0].values) {
                let Some(chord) = Chord::of(&shot, pixel).filter(|chord| !chord.hangs) else {
                    continue;
                };
                let what = format!("{}, {per_voxel} at {pixel:?}", shot.what());
                assert_eq!(found, chord.samples.len() as f32, "{what}");
                let voxel = shot.grid.world_from_voxel.inverse();
                let d = voxel.transform_vector3(chord.direction).abs();
                let length = 1.0 / (per_voxel * d.max_element());
                let inside = chord.leave - chord.enter;
                let off = (f64::from(found) * length - inside).abs();
                assert!(off < length, "{what}: off by {off} of {length}");
                all += 1;
                // Through both faces across the main axis.
                let k = d.to_array().iter().position(|&x| x == d.max_element());
                let along = inside * d.max_element();
                let is_whole = (along - f64::from(shot.grid.dims[k.unwrap()])).abs() < 1e-9;
                if is_whole && per_voxel.fract() == 0.0 {
                    assert!(off < 1e-9, "{what}: off by {off}");
                    whole += 1;
                }
            }
        }
    }
    assert!(all > 8000 && whole > 50, "{all}, {whole} whole");
}

/// Two pictures that are the same but for rounding, but where the number of samples depends on it.
fn assert_same(
    what: &str,
    shot: &PictureCase,
    [wanted, found]: [&Picture; 2],
    allowed: f64,
    hangs: impl Fn([u32; 2]) -> bool,
) {
    let mut worst = Worst::new(format!("{what}, {}", shot.what()));
    for (i, pixel) in shot.pixels().enumerate() {
        if hangs(pixel) {
            worst.leave_out();
            continue;
        }
        for c in 0..4 {
            let error = f64::from(found.pixels[i][c] - wanted.pixels[i][c]);
            worst.take(pixel, error, allowed);
        }
        for (wanted, found) in wanted.layers.iter().zip(&found.layers) {
            let (wanted, found) = (wanted.values[i], found.values[i]);
            if !(wanted.is_nan() && found.is_nan()) {
                let size = f64::from(wanted.abs()).max(1.0);
                worst.take(pixel, f64::from(found - wanted) / size, allowed);
            }
        }
    }
    let seen = wanted.pixels.iter().filter(|pixel| pixel[3] > 0.01).count();
    assert!(seen > 40, "only {seen} pixels are drawn");
    worst.assert_holds();
}

fn hangs(shot: &PictureCase) -> impl Fn([u32; 2]) -> bool + '_ {
    |pixel| Chord::of(shot, pixel).is_some_and(|chord| chord.hangs)
}

#[test]
fn parallel_rays_through_cubes_have_the_samples_of_the_slices_of_a_stack() {
    let grid = CUBES();
    let volume = volume_of(grid.dims, grid.world_from_voxel, waves);
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    let directions = [
        dvec3(0.9, -1.3, 0.6),
        dvec3(-2.0, 0.7, 1.1),
        dvec3(0.5, 0.4, -1.0),
    ];
    for mode in MODES {
        for direction in directions {
            let [mut shot, _] = shots(grid, mode, 1.0);
            shot.camera.eye = grid.center() - 40.0 * direction.normalize();
            let found = drawn(&mut renderer, &shot, &volume);
            for order in [Order::BackToFront, Order::FrontToBack] {
                let stack = shot.with(|settings| {
                    settings.technique = Technique::Slices2d;
                    settings.lattice = Lattice::Ray;
                    settings.order = order;
                });
                let wanted = drawn(&mut renderer, &stack, &volume);
                assert_same("a stack", &stack, [&wanted, &found], 2e-6, hangs(&shot));
            }
        }
    }
}

#[test]
fn rays_along_an_axis_have_the_samples_of_planes_across_it() {
    let grid = CUBES();
    let volume = volume_of(grid.dims, grid.world_from_voxel, waves);
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    for mode in MODES {
        for (direction, up) in [
            (DVec3::X, DVec3::Z),
            (DVec3::NEG_Y, DVec3::X),
            (DVec3::Z, DVec3::Y),
            (DVec3::NEG_Z, DVec3::Y),
        ] {
            // Planes count from the middle of the grid: heights of an even number a side.
            for per_voxel in [1.0, 2.0, 3.0] {
                let [mut shot, _] = shots(grid, mode, per_voxel);
                shot.camera.eye = grid.center() - 40.0 * direction;
                shot.camera.up = up;
                let found = drawn(&mut renderer, &shot, &volume);
                let planes = shot.with(|settings| settings.lattice = Lattice::Planes);
                let wanted = drawn(&mut renderer, &planes, &volume);
                assert_same("planes", &planes, [&wanted, &found], 2e-6, hangs(&shot));
            }
        }
    }
}

#[test]
fn half_the_distance_is_a_quarter_of_the_error() {
    let grid = SHEARED();
    // Nothing at the faces of the grid, where a ray ends between two samples.
    let value = |p: DVec3| {
        let u = p / grid.far_corner();
        let [x, y, z] = (4.0 * u * (1.0 - u)).max(DVec3::ZERO).to_array();
        x * y * z * (1.0 + 0.3 * waves(p))
    };
    let matter = Matter {
        value: &value,
        color: &|v| [v, 1.0 - v, 0.5],
        extinction: &|v| 0.3 * v.max(0.0),
        range: [0.0, 1.5],
    };
    let reference = Reference::<f64>::new();
    for mode in [Mode::Composite, Mode::Xray] {
        for shot in shots(grid, mode, 1.0) {
            let every = |n: f64| shot.with(|settings| settings.samples_per_voxel = n);
            let numbers = |n: f64| match mode {
                Mode::Xray => reference.values(&every(n), &matter),
                _ => {
                    let picture = reference.picture(&every(n), &matter);
                    picture.iter().map(|pixel| pixel[3]).collect()
                }
            };
            let wanted = numbers(64.0);
            let [coarse, fine] = [2.0, 4.0].map(|n| {
                let pairs = numbers(n).into_iter().zip(&wanted);
                let of_rays = pairs.filter(|(a, b)| !a.is_nan() && !b.is_nan());
                of_rays.map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
            });
            let ratio = coarse / fine;
            println!("{}: {coarse:.2e} / {fine:.2e} = {ratio:.3}", shot.what());
            assert!((ratio - 4.0).abs() <= 0.4, "{}: {ratio}", shot.what());
        }
    }
}

/// What was axis i is axis i + `turn`, and the world as it was.
fn turned(shot: &PictureCase, turn: usize) -> (PictureCase, DAffine3) {
    let mut old_from_new = DMat3::ZERO;
    let mut dims = [0; 3];
    for old in 0..3 {
        let new = (old + turn) % 3;
        old_from_new.col_mut(new)[old] = 1.0;
        dims[new] = shot.grid.dims[old];
    }
    let old_from_new = DAffine3::from_mat3(old_from_new);
    let grid = Grid {
        dims,
        world_from_voxel: shot.grid.world_from_voxel * old_from_new,
    };
    let shot = PictureCase {
        grid,
        ..shot.clone()
    };
    (shot, old_from_new)
}

#[test]
fn axes_in_another_order_make_the_same_picture() {
    let volume = volume_of(SHEARED().dims, sheared_affine(), waves);
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    for mode in [Mode::Composite, Mode::Xray] {
        let inside = from_inside(SHEARED(), mode, 1.3);
        for shot in shots(SHEARED(), mode, 1.3).into_iter().chain(inside) {
            let wanted = drawn(&mut renderer, &shot, &volume);
            for turn in [1, 2] {
                let (other, old) = turned(&shot, turn);
                let field = |p: DVec3| waves(old.transform_point3(p));
                let moved = volume_of(other.grid.dims, other.grid.world_from_voxel, field);
                let mut of_moved = Renderer::new(device(), &moved).unwrap();
                let found = drawn(&mut of_moved, &other, &moved);
                assert_same("axes in turn", &shot, [&wanted, &found], 1e-5, hangs(&shot));
            }
        }
    }
}

#[test]
fn on_a_flat_grid_the_main_axis_is_that_of_voxels_and_not_that_of_the_world() {
    let grid = Grid {
        dims: [18, 18, 4],
        world_from_voxel: DAffine3::from_scale(dvec3(1.0, 1.0, 5.0)),
    };
    let volume = volume_of(grid.dims, grid.world_from_voxel, |_| 1.0);
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    let [mut shot, _] = shots(grid, Mode::Xray, 1.0);
    // Longest along z in the world; in voxels (.6, .1, .16).
    let direction = dvec3(0.6, 0.1, 0.8).normalize();
    shot.camera.eye = grid.center() - 60.0 * direction;
    shot.camera.up = DVec3::Y;
    shot.extent = [41, 37];
    let picture = drawn(&mut renderer, &shot, &volume);
    let middle = 18 * 41 + 20;
    let [samples, value] = [0, 1].map(|layer| f64::from(picture.layers[layer].values[middle]));
    // Along z from face to face: 20 / .8 of world length, on which x goes by 15 voxels.
    let length = 1.0 / direction.x;
    assert!((14.0..=16.0).contains(&samples), "{samples} samples");
    let off = (value - samples * length).abs();
    assert!(off < 1e-5 * value, "{value} of {samples} times {length}");
}
