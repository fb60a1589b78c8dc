//! What must not matter to a composite: the order of blending, a cut into two boxes, the order of the
//! channels, a slice drawn as two; and what early termination may leave out.

use crate::shared::{
    Chord, PictureCase, Worst, device, oblique_camera, oblique_shots, ramps, sheared_affine,
    straight_shots, volume_of, waves,
};
use glam::{DAffine3, DVec3};
use stratavox::camera::{Camera, Projection};
use stratavox::offscreen::{Renderer, reference};
use stratavox::picture::Picture;
use stratavox::technique::{Filter, Lattice, Mode, Order, Settings, Technique};
use stratavox::transfer::TransferFunction;
use stratavox::volume::{Grid, Volume};

const SHEARED: fn() -> Grid = || Grid {
    dims: [17, 21, 13],
    world_from_voxel: sheared_affine(),
};

/// Oblique from outside, and from inside with a wide lens.
fn shots() -> Vec<PictureCase> {
    let grid = SHEARED();
    let outside = oblique_shots(grid, Mode::Composite);
    let wide = Projection::Perspective { fov_degrees: 120.0 };
    let inside = Camera {
        eye: grid
            .world_from_voxel
            .transform_point3(DVec3::new(7.3, 12.1, 6.2)),
        ..oblique_camera(&grid, wide)
    };
    let from_inside = outside[..outside.len() / 2].iter().map(|shot| PictureCase {
        camera: inside,
        ..shot.clone()
    });
    let mut all: Vec<PictureCase> = from_inside.collect();
    all.extend(outside);
    all
}

/// On the device and on the CPU in f32.
fn rendered(
    renderer: &mut Renderer,
    volume: &Volume,
    transfer: &TransferFunction,
    shot: &PictureCase,
) -> [(&'static str, Picture); 2] {
    let scene = shot.scene(volume, Some(transfer));
    [
        ("device", renderer.render(&scene, &[]).unwrap().picture),
        ("reference", reference::render::<f32>(&scene).unwrap()),
    ]
}

#[test]
fn front_to_back_is_back_to_front() {
    let volume = volume_of(SHEARED().dims, sheared_affine(), waves);
    let transfer = ramps();
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    let slicers = shots().into_iter().filter(|shot| {
        shot.settings.technique != Technique::Raycast && shot.settings.order == Order::BackToFront
    });
    for shot in slicers {
        let other = shot.with(|settings| settings.order = Order::FrontToBack);
        let wanted = rendered(&mut renderer, &volume, &transfer, &shot);
        let found = rendered(&mut renderer, &volume, &transfer, &other);
        for ((way, wanted), (_, found)) in wanted.iter().zip(&found) {
            let what = format!("both orders, {way}, {}", shot.what());
            Worst::between(what, wanted.width, &wanted.pixels, &found.pixels, 2e-6).assert_holds();
        }
    }
}

#[test]
fn two_boxes_one_over_the_other_are_one_box() {
    // On planes every sample lies in one of two boxes. On the ray lattice the boxes meet where a step ends.
    let volume = volume_of(SHEARED().dims, sheared_affine(), waves);
    let transfer = ramps();
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    let on_planes = shots().into_iter().filter(|shot| {
        shot.settings.technique != Technique::Raycast || shot.settings.lattice == Lattice::Planes
    });
    for shot in on_planes {
        check_split(&mut renderer, &volume, &transfer, &shot, [8.0, 10.3, 6.25]);
    }
    let grid = Grid {
        dims: [16, 18, 20],
        world_from_voxel: DAffine3::IDENTITY,
    };
    let volume = volume_of(grid.dims, grid.world_from_voxel, waves);
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    for shot in straight_shots(grid, Mode::Composite) {
        check_split(&mut renderer, &volume, &transfer, &shot, [8.0, 9.0, 7.0]);
    }
}

fn check_split(
    renderer: &mut Renderer,
    volume: &Volume,
    transfer: &TransferFunction,
    shot: &PictureCase,
    at: [f64; 3],
) {
    let far = shot.grid.far_corner();
    let voxel_from_world = shot.grid.world_from_voxel.inverse();
    for axis in 0..3 {
        let part = |low: f64, high: f64| {
            let (mut min, mut max) = (DVec3::ZERO, far);
            (min[axis], max[axis]) = (low, high);
            shot.with(|settings| settings.crop = Some([min, max]))
        };
        let (low, high) = (part(0.0, at[axis]), part(at[axis], far[axis]));
        let whole = rendered(renderer, volume, transfer, shot);
        let lows = rendered(renderer, volume, transfer, &low);
        let highs = rendered(renderer, volume, transfer, &high);
        for i in 0..2 {
            let way = whole[i].0;
            let what = format!("cut along {axis}, {way}, {}", shot.what());
            let mut worst = Worst::new(what);
            for (p, pixel) in shot.pixels().enumerate() {
                let Some(chord) = Chord::of(shot, pixel) else {
                    continue;
                };
                let hangs =
                    |part: &PictureCase| Chord::of(part, pixel).is_some_and(|chord| chord.hangs);
                if hangs(&low) || hangs(&high) {
                    worst.leave_out();
                    continue;
                }
                let rises = voxel_from_world.transform_vector3(chord.direction)[axis] >= 0.0;
                let (low, high) = (lows[i].1.pixels[p], highs[i].1.pixels[p]);
                let (front, back) = if rises { (low, high) } else { (high, low) };
                for c in 0..4 {
                    let over = front[c] + (1.0 - front[3]) * back[c];
                    worst.take(pixel, f64::from(over - whole[i].1.pixels[p][c]), 2e-6);
                }
            }
            worst.assert_holds();
        }
    }
}

#[test]
fn exchanged_channels_of_the_transfer_function_are_exchanged_in_the_picture() {
    let volume = volume_of(SHEARED().dims, sheared_affine(), waves);
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    let transfer = ramps();
    let mut turned = transfer.clone();
    for point in &mut turned.color {
        point.srgb.rotate_left(1);
    }
    for shot in shots() {
        for mode in [Mode::Composite, Mode::Mip] {
            let shot = shot.with(|settings| settings.mode = mode);
            let wanted = rendered(&mut renderer, &volume, &transfer, &shot);
            let found = rendered(&mut renderer, &volume, &turned, &shot);
            for ((way, wanted), (_, found)) in wanted.into_iter().zip(found) {
                let turned = wanted.pixels.iter().map(|&[r, g, b, a]| [g, b, r, a]);
                let is_same = turned.eq(found.pixels);
                assert!(is_same, "exchanged channels, {way}, {}", shot.what());
            }
        }
    }
}

#[test]
fn every_slice_drawn_as_two_of_half_the_depth_is_the_same_picture() {
    // alpha -> 1 - sqrt(1 - alpha): voxels doubled along the view, each half as deep, seen without a filter.
    let grid = Grid {
        dims: [16, 18, 10],
        world_from_voxel: DAffine3::IDENTITY,
    };
    let half_depth = DAffine3::from_scale(DVec3::new(1.0, 1.0, 0.5));
    let single = volume_of(grid.dims, grid.world_from_voxel, waves);
    let double = volume_of([16, 18, 20], half_depth, |p| {
        waves(DVec3::new(p.x, p.y, (0.5 * p.z).floor() + 0.5))
    });
    let mut transfer = ramps();
    transfer.reference_length = Some(1.0);
    let mut of_single = Renderer::new(device(), &single).unwrap();
    let mut of_double = Renderer::new(device(), &double).unwrap();
    for shot in straight_shots(grid, Mode::Composite) {
        let shot = shot.with(|settings| settings.filter = Filter::Nearest);
        // The smallest spacing is now 1/2: two samples where there was one.
        let doubled = PictureCase {
            grid: double.grid(),
            ..shot.clone()
        };
        let wanted = rendered(&mut of_single, &single, &transfer, &shot);
        let found = rendered(&mut of_double, &double, &transfer, &doubled);
        for ((way, wanted), (_, found)) in wanted.iter().zip(&found) {
            let what = format!("doubled slices, {way}, {}", shot.what());
            Worst::between(what, wanted.width, &wanted.pixels, &found.pixels, 2e-6).assert_holds();
        }
    }
}

#[test]
fn early_termination_leaves_out_no_more_than_its_threshold() {
    let volume = volume_of(SHEARED().dims, sheared_affine(), waves);
    let mut transfer = ramps();
    transfer.opacity.last_mut().unwrap().opacity = 0.95;
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    for shot in shots()
        .into_iter()
        .filter(|s| s.settings.technique == Technique::Raycast)
    {
        let full = shot.with(|settings| settings.conformance = false);
        let wanted = rendered(&mut renderer, &volume, &transfer, &full);
        for termination in [0.1f32, 1.0 / 512.0, 1.0 / 8192.0] {
            let ended = full.with(|settings| settings.termination = termination);
            let found = rendered(&mut renderer, &volume, &transfer, &ended);
            for ((way, wanted), (_, found)) in wanted.iter().zip(&found) {
                let what = format!("terminated at {termination}, {way}, {}", shot.what());
                let allowed = f64::from(termination);
                let worst =
                    Worst::between(what, wanted.width, &wanted.pixels, &found.pixels, allowed);
                worst.assert_holds();
                assert!(worst.error() > 0.0, "{termination}: nothing was left out");
            }
        }
    }
}

#[test]
fn a_conformance_picture_ends_no_ray_early() {
    let volume = volume_of(SHEARED().dims, sheared_affine(), waves);
    let mut transfer = ramps();
    transfer.opacity.last_mut().unwrap().opacity = 0.95;
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    let shot = &oblique_shots(SHEARED(), Mode::Composite)[0];
    let asked = shot.with(|settings: &mut Settings| settings.termination = 0.25);
    let wanted = rendered(&mut renderer, &volume, &transfer, shot);
    let found = rendered(&mut renderer, &volume, &transfer, &asked);
    for ((way, wanted), (_, found)) in wanted.iter().zip(&found) {
        assert_eq!(wanted.pixels, found.pixels, "{way}");
    }
}
