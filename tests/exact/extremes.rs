//! The exact maximum of the trilinear field against samples of it (exact answer A15).

use crate::shared::{
    PictureCase, compare, device, device_with, oblique_shots, straight_shots, volume_of,
};
use glam::{DAffine3, DVec3};
use stratavox::gpu::Caps;
use stratavox::offscreen::{Renderer, reference};
use stratavox::picture::{LayerKind, Picture};
use stratavox::technique::{Filter, Lattice, Mode, Technique};
use stratavox::volume::{Grid, Volume};

const GRID: Grid = Grid {
    dims: [13, 11, 12],
    world_from_voxel: DAffine3::IDENTITY,
};

/// Numbers from 0 to 1 with nothing in common from voxel to voxel.
fn random(p: DVec3) -> f64 {
    let n = (p.x as u64) + 100 * (p.y as u64) + 10_000 * (p.z as u64);
    let mut x = n.wrapping_mul(0x9E37_79B9_7F4A_7C15);
    x ^= x >> 29;
    x = x.wrapping_mul(0xBF58_476D_1CE4_E5B9);
    (x >> 40) as f64 / (1u64 << 24) as f64
}

fn volume() -> Volume {
    volume_of(GRID.dims, GRID.world_from_voxel, random)
}

fn shots(mode: Mode) -> Vec<PictureCase> {
    let on_rays = oblique_shots(GRID, mode).into_iter().filter(|shot| {
        shot.settings.technique == Technique::Raycast && shot.settings.lattice == Lattice::Ray
    });
    on_rays.collect()
}

fn layer(picture: &Picture, kind: LayerKind) -> Vec<f32> {
    let layer = picture.layers.iter().find(|layer| layer.kind == kind);
    layer.expect("the layer").values.clone()
}

#[test]
fn samples_come_as_near_to_the_exact_extreme_as_the_step_allows_and_never_over_it() {
    let volume = volume();
    // In a cell no slope is steeper than this along any ray.
    let steepest = {
        let mut most = 0.0_f64;
        for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
            for z in 0..12 {
                for y in 0..11 {
                    for x in 0..13 {
                        let p = DVec3::new(x.into(), y.into(), z.into()) + 0.5;
                        let q = p + axis;
                        if q.x < 13.0 && q.y < 11.0 && q.z < 12.0 {
                            most = most.max((random(q) - random(p)).abs());
                        }
                    }
                }
            }
        }
        most * 3.0_f64.sqrt()
    };
    for (mode, sign) in [(Mode::Mip, 1.0), (Mode::Minip, -1.0)] {
        for shot in shots(mode).into_iter().take(1) {
            let mut renderer = Renderer::new(device(), &volume).unwrap();
            let exact = shot.with(|s| s.per_mode.exact_maximum = true);
            let scene = exact.scene(&volume, None);
            let wanted = renderer
                .render(&scene, &[LayerKind::Value])
                .unwrap()
                .picture;
            let wanted = layer(&wanted, LayerKind::Value);
            for samples_per_voxel in [1.0, 4.0] {
                let sampled = shot.with(|s| s.samples_per_voxel = samples_per_voxel);
                let scene = sampled.scene(&volume, None);
                let found = renderer
                    .render(&scene, &[LayerKind::Value])
                    .unwrap()
                    .picture;
                let found = layer(&found, LayerKind::Value);
                let (mut checked, mut gap) = (0, 0.0_f64);
                for (exact, sampled) in wanted
                    .iter()
                    .zip(&found)
                    .filter(|(a, b)| !a.is_nan() && !b.is_nan())
                {
                    let under = sign * f64::from(exact - sampled);
                    let bound = 0.5 / samples_per_voxel * steepest;
                    assert!(
                        (-1e-6..=bound).contains(&under),
                        "{}: {under} of {bound}",
                        shot.what()
                    );
                    checked += 1;
                    gap = gap.max(under);
                }
                assert!(
                    checked > 300 && gap > 1e-4,
                    "{checked} pixels, at most {gap}"
                );
            }
        }
    }
}

/// So many samples that half a step is a 100th of a voxel: the exact extreme is nearly theirs.
#[test]
fn very_many_samples_find_the_exact_extreme() {
    let volume = volume();
    let shot = &shots(Mode::Mip)[0];
    let exact = shot.with(|s| s.per_mode.exact_maximum = true);
    let fine = shot.with(|s| s.samples_per_voxel = 50.0);
    let [exact, fine] =
        [exact, fine].map(|shot| reference::render::<f64>(&shot.scene(&volume, None)).unwrap());
    let pairs = layer(&exact, LayerKind::Value)
        .into_iter()
        .zip(layer(&fine, LayerKind::Value));
    let mut checked = 0;
    for (exact, fine) in pairs.filter(|(a, b)| !a.is_nan() && !b.is_nan()) {
        // Half a step of the steepest slope there can be, the square root of 3.
        assert!(
            (0.0..1.74e-2).contains(&(exact - fine)) || (exact - fine).abs() < 1e-6,
            "{exact} {fine}"
        );
        checked += 1;
    }
    assert!(checked > 300);
}

#[test]
fn exact_extremes_are_drawn_as_their_reference_computes_them_with_holes_and_in_bricks() {
    let mut volume = volume();
    for with_holes in [false, true] {
        if with_holes {
            let mask = (0..13 * 11 * 12).map(|i: u32| u8::from(!i.is_multiple_of(61)));
            volume.validity = Some(mask.collect());
        }
        let small = Caps {
            max_image_dimension_3d: 9,
            ..Caps::UNLIMITED
        };
        let mut whole = Renderer::new(device(), &volume).unwrap();
        let mut bricked = Renderer::new(device_with(small), &volume).unwrap();
        for mode in [Mode::Mip, Mode::Minip] {
            // One projection for each: the other is that of the other mode.
            let shot = shots(mode).swap_remove(usize::from(mode == Mode::Mip));
            {
                let shot = shot.with(|s| s.per_mode.exact_maximum = true);
                let scene = shot.scene(&volume, None);
                let kinds = [LayerKind::Value, LayerKind::Depth];
                let found = whole.render(&scene, &kinds).unwrap().picture;
                let double = reference::render::<f64>(&scene).unwrap();
                let single = reference::render::<f32>(&scene).unwrap();
                let all = [&double, &single, &found];
                for kind in kinds {
                    let lists = all.map(|picture| layer(picture, kind));
                    let scale = lists[0].iter().copied().fold(1.0, f32::max);
                    let what = format!("{kind:?}, holes {with_holes}, {}", shot.what());
                    compare(&what, found.width, [&lists[0], &lists[1], &lists[2]], scale);
                }
                let in_bricks = bricked.render(&scene, &[LayerKind::Value]).unwrap().picture;
                let pair = [&found, &in_bricks].map(|picture| layer(picture, LayerKind::Value));
                let differ = pair[0]
                    .iter()
                    .zip(&pair[1])
                    .filter(|(a, b)| a.to_bits() != b.to_bits());
                assert_eq!(differ.count(), 0, "bricks: {}", shot.what());
            }
        }
    }
}

/// Where rays run along the voxel centres, eight corners are one line of voxels: others' holes do not count.
#[test]
fn a_ray_along_voxel_centres_sees_its_own_line_of_voxels_alone() {
    let grid = Grid {
        dims: [12, 12, 32],
        world_from_voxel: DAffine3::IDENTITY,
    };
    let mut volume = volume_of(grid.dims, grid.world_from_voxel, random);
    let mask = (0..12 * 12 * 32).map(|i: usize| u8::from((i % 12 + i / 12 % 12).is_multiple_of(2)));
    volume.validity = Some(mask.collect());
    let shot = straight_shots(grid, Mode::Mip).remove(0);
    let shot = shot.with(|s| s.per_mode.exact_maximum = true);
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    let found = renderer
        .render(&shot.scene(&volume, None), &[LayerKind::Value])
        .unwrap();
    let values = layer(&found.picture, LayerKind::Value);
    assert_eq!(values.iter().filter(|v| !v.is_nan()).count(), 72);
}

#[test]
fn what_has_no_exact_extreme_is_refused_by_name() {
    let volume = volume();
    let exact = shots(Mode::Mip)
        .remove(0)
        .with(|s| s.per_mode.exact_maximum = true);
    for shot in [
        exact.with(|s| s.technique = Technique::Slices3d),
        exact.with(|s| s.mode = Mode::Average),
        exact.with(|s| s.filter = Filter::Nearest),
        exact.with(|s| s.lattice = Lattice::Planes),
    ] {
        let error = reference::render::<f32>(&shot.scene(&volume, None)).expect_err("refused");
        assert!(error.to_string().contains("exact extreme"), "{error}");
    }
}
