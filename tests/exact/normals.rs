//! The layer of normals: the gradient's direction at the hit, in world space, towards lower values.

use crate::shared::{PictureCase, Worst, device, oblique_shots, sheared_affine, volume_of};
use glam::{DAffine3, DVec3, dvec3};
use stratavox::offscreen::{self, Renderer, reference};
use stratavox::picture::{LayerKind, Picture};
use stratavox::scene::{Beside, Scene};
use stratavox::technique::{GradientFilter, Lattice, Level, Mode, Technique};
use stratavox::volume::field::{Ball, Field};
use stratavox::volume::{Grid, Volume};

fn iso_shots(grid: Grid, value: f64) -> Vec<PictureCase> {
    let on_rays = oblique_shots(grid, Mode::Iso).into_iter().filter(|shot| {
        shot.settings.technique == Technique::Raycast && shot.settings.lattice == Lattice::Ray
    });
    let level = Level {
        value,
        srgb: [1.0; 3],
        opacity: 1.0,
    };
    on_rays
        .map(|shot| shot.with(|s| s.per_mode.levels = vec![level]))
        .collect()
}

/// The picture of the device and that of the CPU reference.
fn drawn(volume: &Volume, shot: &PictureCase) -> [Picture; 2] {
    let mut renderer = Renderer::new(device(), volume).unwrap();
    let layers = [LayerKind::Position, LayerKind::Normal];
    let scene = shot.scene(volume, None);
    let found = renderer.render(&scene, &layers).unwrap().picture;
    [found, reference::render::<f32>(&scene).unwrap()]
}

fn vectors(picture: &Picture, kind: LayerKind) -> Vec<DVec3> {
    let layer = picture.layers.iter().find(|layer| layer.kind == kind);
    let numbers = layer.expect("the layer").values.chunks(3);
    numbers
        .map(|v| dvec3(v[0].into(), v[1].into(), v[2].into()))
        .collect()
}

/// With voxels of side h and rho = |p - c| at least r, the interpolated field of 1 - rho / edge is off by 0 to
/// 3 h^2 / (8 r edge), because rho is convex and no second derivative is over 1 / r; half of the difference of two such
/// errors, per h, and a sixth of the third derivative, 2 / (sqrt(3) r^2) at most, leave each component of the gradient of
/// rho off by 3 h / (16 r) + h^2 / (3 sqrt(3) r^2).
#[test]
fn normals_of_a_ball_are_radial_outward_within_what_differences_bend() {
    // As `phantom:sphere,n=64,edge=20`; the ramp reaches farther than the differences do.
    let side = 100.0 / 64.0;
    let grid = Grid {
        dims: [64; 3],
        world_from_voxel: DAffine3::from_scale_rotation_translation(
            DVec3::splat(side),
            glam::DQuat::IDENTITY,
            DVec3::splat(-50.0),
        ),
    };
    let ball = Ball {
        center: dvec3(4.0, -6.0, 5.0),
        radius: 35.0,
        edge: 20.0,
    };
    let world = |p| grid.world_from_voxel.transform_point3(p);
    let volume = volume_of(grid.dims, grid.world_from_voxel, |p| ball.value(world(p)));
    // Two voxels' differences and a cell's diagonal inward of the surface.
    let least = ball.radius - side * (1.0 + 3.0f64.sqrt() + 0.1);
    let component = 3.0 * side / (16.0 * least) + side * side / (27.0f64.sqrt() * least * least);
    let sine = 3.0f64.sqrt() * component;
    let bound = 2.0 * (0.5 * sine.asin()).sin() + 1e-5;
    assert!(bound < 0.03, "{bound}");
    for shot in iso_shots(grid, 0.5) {
        for picture in drawn(&volume, &shot) {
            let mut worst = Worst::new("normals of a ball");
            let mut hits = 0;
            let places = vectors(&picture, LayerKind::Position);
            let normals = vectors(&picture, LayerKind::Normal);
            for ((pixel, p), n) in shot.pixels().zip(places).zip(normals) {
                assert_eq!(p.is_nan(), n.is_nan(), "{pixel:?}: {p} {n}");
                if p.is_nan() {
                    continue;
                }
                hits += 1;
                assert!((n.length() - 1.0).abs() < 1e-6, "{pixel:?}: {n}");
                let radial = (p - ball.center).normalize();
                worst.take(pixel, n.distance(radial), bound);
            }
            assert!(hits > 100, "{hits}");
            worst.assert_holds();
        }
    }
}

/// Linear fields are exact, whatever takes the difference; a gradient of voxel space alone would point elsewhere.
#[test]
fn normals_of_a_plane_are_those_of_the_world_and_none_where_there_is_no_data() {
    let grid = Grid {
        dims: [17, 21, 13],
        world_from_voxel: sheared_affine(),
    };
    let slope = dvec3(0.48, 0.6, 0.64);
    let middle = grid.far_corner() / 2.0;
    let mut volume = volume_of(grid.dims, grid.world_from_voxel, |p| {
        (p - middle).dot(slope)
    });
    let to_world = grid.world_from_voxel.matrix3.inverse().transpose();
    let wanted = -(to_world * slope).normalize();
    for with_hole in [false, true] {
        if with_hole {
            let hole = (6 * 21 + 10) * 17 + 8;
            let mask = (0..17 * 21 * 13).map(|i| u8::from(i != hole));
            volume.validity = Some(mask.collect());
        }
        for filter in [
            GradientFilter::Central,
            GradientFilter::Linear,
            GradientFilter::Sobel,
        ] {
            let shot = iso_shots(grid, 0.75).remove(0).with(|s| {
                // Differences reach one voxel to either side, and values no farther than the outermost centres.
                s.crop = Some([DVec3::splat(1.6), grid.far_corner() - 1.6]);
                s.gradient_filter = filter;
            });
            for picture in drawn(&volume, &shot) {
                let places = vectors(&picture, LayerKind::Position);
                let normals = vectors(&picture, LayerKind::Normal);
                let hits = places.iter().zip(&normals).filter(|(p, _)| !p.is_nan());
                let (some, none): (Vec<_>, Vec<_>) = hits.partition(|(_, n)| !n.is_nan());
                assert_eq!(none.is_empty(), !with_hole, "{filter:?}");
                assert!(some.len() > 100, "{filter:?}: {}", some.len());
                for (p, n) in some {
                    assert!(
                        n.distance(wanted) < 2e-5,
                        "{filter:?} at {p}: {n}, not {wanted}"
                    );
                }
            }
        }
    }
}

#[test]
fn normals_are_refused_where_no_ray_or_no_one_volume_has_a_hit() {
    let grid = Grid {
        dims: [8; 3],
        world_from_voxel: DAffine3::IDENTITY,
    };
    let volume = volume_of(grid.dims, grid.world_from_voxel, |p| p.x / 8.0);
    let transfer = crate::shared::ramps();
    let shots = oblique_shots(grid, Mode::Composite);
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    let slicer = shots
        .iter()
        .find(|shot| shot.settings.technique != Technique::Raycast);
    let scene = slicer.unwrap().scene(&volume, Some(&transfer));
    let refused = renderer.render(&scene, &[LayerKind::Normal]).unwrap_err();
    assert!(
        matches!(refused, offscreen::Error::NoLayer { .. }),
        "{refused}"
    );
    let rays = shots
        .iter()
        .find(|shot| shot.settings.technique == Technique::Raycast);
    let rays = rays.unwrap();
    let others = [&volume, &volume];
    let colors = Scene {
        beside: Beside::Colors(&others),
        ..rays.scene(&volume, Some(&transfer))
    };
    let mut renderer = Renderer::several(device(), vec![&volume; 3]).unwrap();
    let refused = renderer.render(&colors, &[LayerKind::Normal]).unwrap_err();
    assert!(matches!(refused, offscreen::Error::NoNormals), "{refused}");
    assert!(refused.to_string().contains("normal"));
}
