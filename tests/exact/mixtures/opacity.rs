//! Colour by one volume, opacity by another.

use super::*;
use crate::shared::{Chord, placements, straight_shots};
use stratavox::technique::Settings;

/// Voxels of side 1; every sample of [`straight_shots`] is one of their centres.
const DIMS: [u32; 3] = [8, 6, 10];

fn cubes() -> Grid {
    Grid {
        dims: DIMS,
        world_from_voxel: DAffine3::IDENTITY,
    }
}

fn without(mut volume: Volume, is_hole: impl Fn([u32; 3]) -> bool) -> Volume {
    let [nx, ny, nz] = volume.dims;
    let all = (0..nz).flat_map(|z| (0..ny).flat_map(move |y| (0..nx).map(move |x| [x, y, z])));
    volume.validity = Some(all.map(|v| u8::from(!is_hole(v))).collect());
    volume
}

/// Red or green by the first volume, whose own opacity is for nobody; 0.3 f per voxel by the second, so that with
/// samples at voxel centres alpha = 1 - product of (1 - 0.3 f_k) over the voxels of which neither is a hole.
#[test]
fn the_colour_is_that_of_one_volume_and_the_opacity_that_of_the_other() {
    let left = |x: f64| x < 4.0;
    let is_hole = |[x, y, z]: [u32; 3]| x == 2 && y > 2 && z == 3;
    let is_other_hole = |[x, y, z]: [u32; 3]| (x == 5 && z % 2 == 1) || (x == 6 && y == 1);
    let affine = DAffine3::IDENTITY;
    let first = volume_of(DIMS, affine, |p| if left(p.x) { 10.0 } else { 20.0 });
    let first = without(first, is_hole);
    let second = volume_of(DIMS, affine, |p| (p.z + p.y) / 20.0);
    let second = without(second, is_other_hole);
    let color = |value, srgb| ColorPoint { value, srgb };
    let opacity = |value, opacity| OpacityPoint { value, opacity };
    let (red, green) = ([1.0, 0.0, 0.2], [0.0, 1.0, 0.4]);
    let colors = TransferFunction {
        color: vec![color(10.0, red), color(20.0, green)],
        opacity: vec![opacity(0.0, 0.9)],
        ..fog([0.0; 3], 0.0)
    };
    let opacities = TransferFunction {
        color: vec![color(0.0, [1.0, 1.0, 1.0])],
        opacity: vec![opacity(0.0, 0.0), opacity(1.0, 0.3)],
        ..fog([0.0; 3], 0.0)
    };
    let channels = [channel(&second, &opacities, Role::Opacity)];
    let mut renderer = renderer(&[&first, &second]);
    let mut compared = 0;
    for shot in straight_shots(cubes(), Mode::Composite) {
        let shot = shot.with(|settings| settings.color_space = ColorSpace::Display);
        let scene = scene(&shot, &first, &colors, Beside::Channels(&channels));
        for picture in pictures(&mut renderer, &scene) {
            let mut worst = Worst::new(format!("opacity beside, {}", shot.what()));
            for (pixel, found) in shot.pixels().zip(&picture.pixels) {
                let Some(chord) = Chord::of(&shot, pixel) else {
                    continue;
                };
                let middle = chord.origin + 0.5 * (chord.enter + chord.leave) * chord.direction;
                let [x, y, _] = middle.floor().as_uvec3().to_array();
                let seen =
                    (0..DIMS[2]).filter(|&z| !is_hole([x, y, z]) && !is_other_hole([x, y, z]));
                let value = |z: u32| (f64::from(z + y) + 1.0) / 20.0;
                let through: f64 = seen.map(|z| 1.0 - 0.3 * value(z)).product();
                let srgb = if left(middle.x) { red } else { green };
                for c in 0..3 {
                    let wanted = srgb[c] * (1.0 - through);
                    worst.take(pixel, f64::from(found[c]) - wanted, 4e-6);
                }
                worst.take(pixel, f64::from(found[3]) - (1.0 - through), 4e-6);
                compared += 1;
            }
            worst.assert_holds();
        }
    }
    assert!(compared > 100, "only {compared} pixels are compared");
}

/// Between voxel centres, with holes, and beside another thing of its own.
#[test]
fn opacity_of_another_volume_is_drawn_as_the_reference_draws_it() {
    let first = with_holes(volume_of(GRID().dims, sheared_affine(), waves), 17);
    let (second, third) = (with_holes(ripples(), 23), ripples());
    let functions = [tinted([0.0, 0.9, 1.0]), tinted([1.0, 0.2, 0.9]), ramps()];
    let channels = [
        channel(&second, &functions[1], Role::Opacity),
        channel(&third, &functions[2], Role::Numbers),
    ];
    let beside = Beside::Channels(&channels);
    let mut renderer = renderer(&[&first, &second, &third]);
    let shots = small_shots(GRID(), Mode::Composite);
    for shot in shots.iter().step_by(2) {
        let scene = scene(shot, &first, &functions[0], beside);
        let all = pictures(&mut renderer, &scene);
        let what = format!("opacity beside, {}", shot.what());
        let drawn = all[1].pixels.iter().filter(|p| p[3] > 0.01).count();
        assert!(drawn > 100, "{what}: only {drawn} pixels are drawn");
        let lists = all.each_ref().map(|p| p.pixels.as_flattened());
        compare(&what, 4 * all[0].width, lists, 1.0);
    }
}

#[test]
fn opacity_of_another_volume_is_refused_where_it_has_no_colour_or_is_not_composited() {
    let volume = volume_of(DIMS, DAffine3::IDENTITY, waves);
    let transfer = ramps();
    let refused = |roles: &[Role], settings: Settings| {
        let channels: Vec<_> = roles
            .iter()
            .map(|&role| channel(&volume, &transfer, role))
            .collect();
        let shot = straight_shots(cubes(), settings.mode).swap_remove(0);
        let shot = PictureCase { settings, ..shot };
        let scene = scene(&shot, &volume, &transfer, Beside::Channels(&channels));
        scene.check().expect_err("refused")
    };
    let plain = placements().swap_remove(0);
    let twice = [Role::Opacity, Role::Opacity];
    assert_eq!(refused(&twice, plain.clone()), Error::OpacityOfNothing);
    let of_labels = [Role::Labels, Role::Opacity];
    assert_eq!(refused(&of_labels, plain.clone()), Error::OpacityOfNothing);
    let mode = Mode::Mip;
    let settings = Settings {
        mode,
        ..plain.clone()
    };
    assert_eq!(
        refused(&[Role::Opacity], settings),
        Error::NotMixed { mode }
    );
    let settings = Settings {
        preintegrated: true,
        ..plain
    };
    assert!(matches!(
        refused(&[Role::Opacity], settings),
        Error::NotFor { .. }
    ));
}
