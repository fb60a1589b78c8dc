//! Isosurfaces where they must lie (exact answer A16), in their order, and on the device as their CPU reference has them.

use crate::shared::{
    Chord, PictureCase, Worst, compare, device, oblique_shots, sheared_affine, straight_shots,
    volume_of, waves,
};
use glam::{DAffine3, DVec3, dvec3};
use stratavox::gpu::Caps;
use stratavox::offscreen::{Renderer, reference};
use stratavox::picture::{ColorSpace, LayerKind, Picture};
use stratavox::scene::{Beside, Channel, Scene};
use stratavox::technique::isosurface::{Surfaces, surfaces};
use stratavox::technique::{Filter, Lattice, Level, Mode, Role, Shading, Technique};
use stratavox::transfer::{ColorPoint, Interpolation, OpacityPoint, TransferFunction};
use stratavox::volume::{Grid, Volume};

const GRID: fn() -> Grid = || Grid {
    dims: [17, 21, 13],
    world_from_voxel: sheared_affine(),
};
/// Voxels of 1/32 from -1 to 1, as the closed forms of A16 have them.
const CUBE: Grid = Grid {
    dims: [65; 3],
    world_from_voxel: DAffine3::IDENTITY,
};
const STRAIGHT: Grid = Grid {
    dims: [12, 12, 32],
    world_from_voxel: DAffine3::IDENTITY,
};

fn level(value: f64, srgb: [f64; 3], opacity: f64) -> Level {
    Level {
        value,
        srgb,
        opacity,
    }
}

fn opaque(values: &[f64]) -> Vec<Level> {
    values
        .iter()
        .map(|&value| level(value, [1.0; 3], 1.0))
        .collect()
}

fn shots(grid: Grid, levels: &[Level]) -> Vec<PictureCase> {
    let on_rays = oblique_shots(grid, Mode::Iso).into_iter().filter(|shot| {
        shot.settings.technique == Technique::Raycast && shot.settings.lattice == Lattice::Ray
    });
    on_rays
        .map(|shot| shot.with(|s| s.per_mode.levels = levels.to_vec()))
        .collect()
}

fn drawn(volume: &Volume, shot: &PictureCase, layers: &[LayerKind]) -> Picture {
    let mut renderer = Renderer::new(device(), volume).unwrap();
    renderer
        .render(&shot.scene(volume, None), layers)
        .unwrap()
        .picture
}

fn layer(picture: &Picture, kind: LayerKind) -> Vec<f32> {
    let layer = picture.layers.iter().find(|layer| layer.kind == kind);
    layer.expect("the layer").values.clone()
}

/// The f64 CPU reference on a formula.
fn on_formula(shot: &PictureCase, [x, y]: [u32; 2], value: impl Fn(DVec3) -> f64) -> Surfaces<f64> {
    let (frame, _) = shot.parameters();
    let pixel = [x, y].map(|n| f64::from(n) + 0.5);
    surfaces(
        &frame,
        pixel,
        |p: [f64; 3]| Some(value(p.into())),
        |color, _, _| color,
    )
}

/// The first depths of a shot: of the CPU reference on the formula, and of the device on voxels of it.
fn depths(shot: &PictureCase, value: impl Fn(DVec3) -> f64 + Copy) -> [Vec<f64>; 2] {
    let volume = volume_of(shot.grid.dims, shot.grid.world_from_voxel, value);
    let picture = drawn(&volume, shot, &[LayerKind::Depth]);
    let found = layer(&picture, LayerKind::Depth).into_iter().map(f64::from);
    let reference = shot.pixels().map(|pixel| {
        on_formula(shot, pixel, value)
            .first
            .map_or(f64::NAN, |(_, t)| t)
    });
    [reference.collect(), found.collect()]
}

#[test]
fn a_plane_is_hit_where_it_lies_to_1e5_of_a_voxel() {
    // Through the middle of the box, oblique to everything; linear, so trilinear interpolation is the field.
    let normal = dvec3(0.48, 0.6, 0.64);
    let center = GRID().far_corner() / 2.0;
    let field = |p: DVec3| (p - center).dot(normal);
    for shot in shots(GRID(), &opaque(&[0.75])) {
        let shot = shot.with(|s| s.crop = Some(crate::shared::inner_box(&GRID())));
        let mut worst = [Worst::new("plane, reference"), Worst::new("plane, device")];
        let found = depths(&shot, field);
        let spacing = GRID().smallest_spacing();
        for (i, pixel) in shot.pixels().enumerate() {
            let Some(chord) = Chord::of(&shot, pixel) else {
                continue;
            };
            let voxel = shot.grid.world_from_voxel.inverse();
            let (o, d) = (
                voxel.transform_point3(chord.origin),
                voxel.transform_vector3(chord.direction),
            );
            let t = (0.75 - field(o)) / normal.dot(d);
            let margin = 4.0 * chord.blur + 1e-3;
            if t < chord.enter + margin || t > chord.leave - margin {
                continue;
            }
            // f32 rounds the ray itself; a slope of 1 a voxel leaves that as it is.
            let allowed = 1e-5 * spacing + 2.0 * chord.blur;
            for (worst, found) in worst.iter_mut().zip(&found) {
                worst.take(pixel, found[i] - t, allowed);
            }
        }
        worst.iter().for_each(Worst::assert_holds);
        // The end of the step, where nothing is refined, is caught.
        let mut unrefined = Worst::new("no refinement");
        for (i, pixel) in shot.pixels().enumerate() {
            let Some(chord) = Chord::of(&shot, pixel).filter(|_| !found[0][i].is_nan()) else {
                continue;
            };
            let step = shot.view().step_world();
            let end = chord.enter + ((found[0][i] - chord.enter) / step).ceil() * step;
            unrefined.take(pixel, end - found[0][i], 1e-5 * spacing + 2.0 * chord.blur);
        }
        unrefined.assert_caught();
    }
}

/// Trilinear interpolation is off by an eighth of the second derivatives: on a ball of radius R by 3 / (8 R) at most,
/// on a torus of .6 and .25 in a box of 2 by .08 voxel (A16).
#[test]
fn a_ball_and_a_torus_are_hit_within_what_interpolation_bends() {
    let center = CUBE.far_corner() / 2.0;
    let (radius, wide, thin) = (0.63 * 32.0, 0.6 * 32.0, 0.25 * 32.0);
    let ball = move |p: DVec3| p.distance(center) - radius;
    let torus = move |p: DVec3| {
        let p = p - center;
        let ring = f64::hypot(p.x, p.y) - wide;
        f64::hypot(ring, p.z) - thin
    };
    type Field<'a> = &'a (dyn Fn(DVec3) -> f64 + Sync);
    let fields: [(&str, Field, f64); 2] = [
        ("ball", &ball, 3.0 / (8.0 * radius)),
        ("torus", &torus, 0.08),
    ];
    for (name, field, bend) in fields {
        let shot = shots(CUBE, &opaque(&[0.0])).remove(1);
        let volume = volume_of(CUBE.dims, CUBE.world_from_voxel, field);
        let picture = drawn(
            &volume,
            &shot,
            &[LayerKind::Position, LayerKind::Depth, LayerKind::Value],
        );
        let found = layer(&picture, LayerKind::Position);
        let mut worst = Worst::new(name);
        for (pixel, at) in shot.pixels().zip(found.chunks(3)) {
            if at[0].is_nan() {
                continue;
            }
            let at = dvec3(at[0].into(), at[1].into(), at[2].into());
            worst.take(pixel, field(at), bend + 1e-4);
        }
        worst.assert_holds();
        let values = layer(&picture, LayerKind::Value);
        assert!(values.iter().all(|v| v.is_nan() || *v == 0.0));
        // No ray that goes deep under the surface misses it.
        for (i, pixel) in shot.pixels().enumerate() {
            let Some(chord) = Chord::of(&shot, pixel) else {
                continue;
            };
            let deep = chord
                .samples
                .iter()
                .any(|&(t, _)| field(chord.at(t)) < -1.0);
            let is_missed = deep && values[i].is_nan();
            assert!(!is_missed, "{name}: {pixel:?} is missed");
        }
    }
}

#[test]
fn surfaces_of_several_values_lie_one_behind_the_other_from_both_sides() {
    let (red, green, blue) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]);
    // In no order; two of them within one step; one that is never reached.
    let levels = [
        level(20.25, blue, 1.0),
        level(8.25, red, 0.5),
        level(8.75, green, 0.5),
        level(90.0, green, 1.0),
    ];
    let shot = straight_shots(STRAIGHT, Mode::Iso).remove(0).with(|s| {
        s.per_mode.levels = levels.to_vec();
        s.color_space = ColorSpace::Display;
    });
    // The eye lies 16 before the box and looks along z: values rise, or fall.
    for (field, color, first, at) in [
        (
            (|p| p.z) as fn(DVec3) -> f64,
            [0.5, 0.25, 0.25],
            8.25_f32,
            8.25_f32,
        ),
        (|p| 32.0 - p.z, [0.0, 0.0, 1.0], 20.25, 11.75),
    ] {
        let volume = volume_of(STRAIGHT.dims, DAffine3::IDENTITY, field);
        let picture = drawn(&volume, &shot, &[LayerKind::Value, LayerKind::Depth]);
        for (i, pixel) in picture.pixels.iter().enumerate() {
            let wanted = [color[0], color[1], color[2], 1.0];
            let off = (0..4)
                .map(|c| (pixel[c] - wanted[c] as f32).abs())
                .fold(0.0, f32::max);
            assert!(off < 1e-6, "pixel {i}: {pixel:?}, not {wanted:?}");
            assert_eq!(layer(&picture, LayerKind::Value)[i], first);
            let depth = layer(&picture, LayerKind::Depth)[i];
            assert!(
                (depth - (16.0 + at)).abs() < 1e-4,
                "{depth}, not {}",
                16.0 + at
            );
        }
    }
}

#[test]
fn all_crossings_of_one_value_are_seen_through_each_other() {
    // Up and down through 0.5 at 4, 12, 20 and 28; opacity 1/4 each.
    let field = |p: DVec3| 0.5 - 0.5 * (p.z * std::f64::consts::TAU / 16.0 - 0.0).cos();
    let volume = volume_of(STRAIGHT.dims, DAffine3::IDENTITY, field);
    let shot = straight_shots(STRAIGHT, Mode::Iso).remove(0);
    let shot = shot.with(|s| s.per_mode.levels = vec![level(0.5, [1.0; 3], 0.25)]);
    let picture = drawn(&volume, &shot, &[LayerKind::Transmittance]);
    for left in layer(&picture, LayerKind::Transmittance) {
        assert!((left - 0.75_f32.powi(4)).abs() < 1e-6, "{left}");
    }
    // Early termination ends after the crossing at which transmittance falls under its threshold.
    let early = shot.with(|s| {
        s.termination = 0.6;
        s.conformance = false;
    });
    let picture = drawn(&volume, &early, &[LayerKind::Transmittance]);
    for left in layer(&picture, LayerKind::Transmittance) {
        assert!((left - 0.75_f32.powi(2)).abs() < 1e-6, "{left}");
    }
}

#[test]
fn between_a_value_and_no_data_there_is_no_surface() {
    let mut volume = volume_of(STRAIGHT.dims, DAffine3::IDENTITY, |p| {
        if p.z < 16.0 { 0.0 } else { 1.0 }
    });
    let shot = straight_shots(STRAIGHT, Mode::Iso).remove(0);
    let shot = shot.with(|s| s.per_mode.levels = opaque(&[0.5]));
    let hits = |volume: &Volume| {
        let picture = drawn(volume, &shot, &[LayerKind::Depth]);
        let reference = reference::render::<f32>(&shot.scene(volume, None)).unwrap();
        assert_eq!(
            layer(&picture, LayerKind::Depth).len(),
            layer(&reference, LayerKind::Depth).len()
        );
        let count = |picture: &Picture| {
            layer(picture, LayerKind::Depth)
                .iter()
                .filter(|t| !t.is_nan())
                .count()
        };
        assert_eq!(count(&picture), count(&reference), "device and reference");
        count(&picture)
    };
    assert_eq!(hits(&volume), 144, "with data everywhere");
    for (what, from, to) in [("behind", 16, 32), ("before", 0, 16), ("a gap", 15, 17)] {
        let mask = (0..32).flat_map(|z: u32| vec![u8::from(!(from..to).contains(&z)); 144]);
        volume.validity = Some(mask.collect());
        assert_eq!(hits(&volume), 0, "no data {what}");
    }
}

#[test]
fn surfaces_are_drawn_as_their_reference_computes_them() {
    let levels = [
        level(0.35, [0.9, 0.3, 0.2], 0.4),
        level(0.5, [0.2, 0.8, 0.3], 0.4),
        level(0.62, [0.3, 0.4, 0.9], 1.0),
    ];
    let mut volume = volume_of(GRID().dims, sheared_affine(), waves);
    for with_holes in [false, true] {
        if with_holes {
            let mask = (0..17 * 21 * 13).map(|i: u32| u8::from(!i.is_multiple_of(97)));
            volume.validity = Some(mask.collect());
        }
        let mut renderer = Renderer::new(device(), &volume).unwrap();
        for shot in shots(GRID(), &levels) {
            let shot = shot.with(|s| {
                s.shading = Some(Shading::default());
                s.samples_per_voxel = 1.5;
            });
            let scene = shot.scene(&volume, None);
            let kinds = [
                LayerKind::Value,
                LayerKind::Depth,
                LayerKind::Transmittance,
                LayerKind::Samples,
            ];
            let found = renderer.render(&scene, &kinds).unwrap().picture;
            let double = reference::render::<f64>(&scene).unwrap();
            let single = reference::render::<f32>(&scene).unwrap();
            let all = [&double, &single, &found];
            let what = format!("holes {with_holes}, {}", shot.what());
            compare(
                &what,
                4 * found.width,
                all.map(|p| p.pixels.as_flattened()),
                1.0,
            );
            for kind in kinds {
                let lists = all.map(|picture| layer(picture, kind));
                let scale = lists[0].iter().copied().fold(1.0, f32::max);
                compare(
                    &format!("{kind:?} of {what}"),
                    found.width,
                    [&lists[0], &lists[1], &lists[2]],
                    scale,
                );
            }
        }
    }
}

#[test]
fn nearest_voxels_have_faces_and_the_device_finds_them() {
    let volume = volume_of(STRAIGHT.dims, DAffine3::IDENTITY, |p| {
        if p.z < 16.0 { 0.0 } else { 1.0 }
    });
    let shot = straight_shots(STRAIGHT, Mode::Iso).remove(0);
    let shot = shot.with(|s| {
        s.filter = Filter::Nearest;
        s.samples_per_voxel = 0.7;
        s.per_mode.levels = opaque(&[0.5]);
    });
    for depth in layer(
        &drawn(&volume, &shot, &[LayerKind::Depth]),
        LayerKind::Depth,
    ) {
        // 2^-10 of a step: a jump has no straight line.
        assert!((depth - 32.0).abs() < 1.0 / 700.0, "{depth}");
    }
}

#[test]
fn surfaces_that_cannot_be_are_refused_by_name() {
    let volume = volume_of(GRID().dims, sheared_affine(), waves);
    let refused = |levels: &[Level]| {
        let shot = shots(GRID(), levels).remove(0);
        let error = reference::render::<f32>(&shot.scene(&volume, None));
        error.expect_err("refused").to_string()
    };
    assert!(refused(&[]).contains("surfaces of 0 values, wanted 1 to 8"));
    assert!(refused(&opaque(&[0.5; 9])).contains("surfaces of 9 values"));
    assert!(refused(&opaque(&[f64::NAN])).contains("value of a surface is NaN"));
    assert!(refused(&[level(0.5, [1.0; 3], 1.5)]).contains("opacity of a surface is 1.5"));
    let small = Caps {
        max_image_dimension_3d: 11,
        ..Caps::UNLIMITED
    };
    let mut renderer = Renderer::new(crate::shared::device_with(small), &volume).unwrap();
    let shot = shots(GRID(), &opaque(&[0.5])).remove(0);
    renderer
        .render(&shot.scene(&volume, None), &[])
        .expect("segments of one voxel lie in a brick and what is around it");
    let long = shot.with(|s| s.samples_per_voxel = 0.5);
    let error = renderer
        .render(&long.scene(&volume, None), &[])
        .expect_err("refused");
    let said = error.to_string();
    let is_named = said.contains("bricks") && said.contains("segments between samples");
    assert!(is_named && said.contains("more samples"), "{said}");
}

/// The ball that is painted by x, and a function of that in sRGB numbers.
fn painted_ball() -> (Volume, Volume, TransferFunction) {
    let center = CUBE.far_corner() / 2.0;
    let ball = volume_of(CUBE.dims, CUBE.world_from_voxel, |p| {
        p.distance(center) - 20.0
    });
    let other = volume_of(CUBE.dims, CUBE.world_from_voxel, |p| p.x);
    let color = [(0.0, [0.0, 1.0, 0.25]), (65.0, [1.0, 0.0, 0.25])];
    let function = TransferFunction {
        color: color.map(|(value, srgb)| ColorPoint { value, srgb }).into(),
        // Opacity does not count: that of the surface does.
        opacity: vec![OpacityPoint {
            value: 0.0,
            opacity: 0.0,
        }],
        reference_length: None,
        interpolation: Interpolation::Linear,
        gradient_transfer: None,
        medium: None,
    };
    (ball, other, function)
}

#[test]
fn a_ball_is_coloured_by_another_variable_where_it_is_hit() {
    let (ball, other, function) = painted_ball();
    let center = CUBE.far_corner() / 2.0;
    let beside = [Channel {
        volume: &other,
        transfer: Some(&function),
        role: Role::Numbers,
    }];
    let mut renderer = Renderer::several(device(), vec![&ball, &other]).unwrap();
    let mut of_formula = Worst::new("of the formula");
    for shot in shots(CUBE, &[level(0.0, [1.0, 0.0, 1.0], 0.5)]) {
        let shot = shot.with(|s| s.color_space = ColorSpace::Display);
        let scene = Scene {
            beside: Beside::Channels(&beside),
            ..shot.scene(&ball, None)
        };
        let one_hit = shot.with(|s| s.per_mode.levels[0].opacity = 1.0);
        let one_hit = Scene {
            settings: &one_hit.settings,
            ..scene
        };
        let picture = renderer.render(&one_hit, &[LayerKind::Position]).unwrap();
        let positions = layer(&picture.picture, LayerKind::Position);
        let rays = shot.camera.rays(shot.extent);
        let mut of_hit = Worst::new("of the hit");
        let mut seen = 0;
        for (i, [x, y]) in shot.pixels().enumerate() {
            let at = f64::from(positions[3 * i]);
            let pixel = picture.picture.pixels[i].map(f64::from);
            if at.is_nan() {
                assert_eq!(pixel, [0.0; 4]);
                continue;
            }
            seen += 1;
            // The position is one of f32, and so is what the device reads there.
            let wanted = [at / 65.0, 1.0 - at / 65.0, 0.25, 1.0];
            for c in 0..4 {
                of_hit.take([x, y], pixel[c] - wanted[c], 1e-5);
            }
            let (origin, direction) = rays.at(f64::from(x) + 0.5, f64::from(y) + 0.5);
            let (to_center, radius) = (center - origin, 20.0_f64);
            let middle = to_center.dot(direction);
            let aside = (to_center - middle * direction).length();
            // Where the ray meets the ball at 30 degrees or more, what interpolation bends (3 / (8 R)) moves the hit
            // by no more than twice as much.
            if aside > radius * (0.75_f64).sqrt() {
                continue;
            }
            let t = middle - (radius * radius - aside * aside).sqrt();
            let analytic = (origin + t * direction).x / 65.0;
            let bend = 2.0 * 3.0 / (8.0 * radius) / 65.0;
            of_formula.take([x, y], pixel[0] - analytic, bend + 1e-5);
        }
        of_hit.assert_holds();
        assert!(seen > 100, "{seen} pixels");
        // Two surfaces through each other, light on them: as the CPU reference has it.
        let lit = shot.with(|s| s.shading = Some(Shading::default()));
        let lit = Scene {
            settings: &lit.settings,
            ..scene
        };
        let found = renderer.render(&lit, &[]).unwrap().picture;
        let all = [
            &reference::render::<f64>(&lit).unwrap(),
            &reference::render::<f32>(&lit).unwrap(),
            &found,
        ];
        let lists = all.map(|p| p.pixels.as_flattened());
        compare(&shot.what(), 4 * found.width, lists, 1.0);
    }
    of_formula.assert_holds();
}

#[test]
fn where_the_other_variable_has_no_data_a_surface_keeps_its_own_colour() {
    let (mut ball, mut other, function) = painted_ball();
    let half: Vec<u8> = (0..65 * 65 * 65).map(|i| u8::from(i % 65 < 32)).collect();
    for holes_in_the_other in [true, false] {
        let with_holes = if holes_in_the_other {
            &mut other
        } else {
            &mut ball
        };
        with_holes.validity = Some(half.clone());
        let beside = [Channel {
            volume: &other,
            transfer: Some(&function),
            role: Role::Numbers,
        }];
        let mut renderer = Renderer::several(device(), vec![&ball, &other]).unwrap();
        let shot = shots(CUBE, &[level(0.0, [1.0, 0.0, 1.0], 1.0)]).remove(0);
        let shot = shot.with(|s| {
            s.color_space = ColorSpace::Display;
            s.filter = Filter::Nearest;
            s.shading = Some(Shading::default());
        });
        let scene = Scene {
            beside: Beside::Channels(&beside),
            ..shot.scene(&ball, None)
        };
        let found = renderer.render(&scene, &[]).unwrap().picture;
        let references = [
            &reference::render::<f64>(&scene).unwrap(),
            &reference::render::<f32>(&scene).unwrap(),
        ];
        let lists = [references[0], references[1], &found].map(|p| p.pixels.as_flattened());
        compare("holes", 4 * found.width, lists, 1.0);
        let plain = shot.with(|s| s.shading = None);
        let plain = Scene {
            settings: &plain.settings,
            ..scene
        };
        let found = renderer.render(&plain, &[]).unwrap().picture;
        let own = found
            .pixels
            .iter()
            .filter(|p| **p == [1.0, 0.0, 1.0, 1.0])
            .count();
        let painted = found.pixels.iter().filter(|p| p[1] > 0.1).count();
        assert!(
            painted > 20,
            "{painted} pixels have the colour of the other"
        );
        assert_eq!(own > 20, holes_in_the_other, "{own} pixels have their own");
        drop(renderer);
        ball.validity = None;
        other.validity = None;
    }
}

#[test]
fn what_cannot_colour_a_surface_is_refused_by_name() {
    let (ball, other, function) = painted_ball();
    let of = |role, transfer| Channel {
        volume: &other,
        transfer,
        role,
    };
    let numbers = of(Role::Numbers, Some(&function));
    let shot = shots(CUBE, &opaque(&[0.0])).remove(0);
    let wide = shot.with(|s| s.filter = Filter::Cubic);
    for (shot, channels, wanted) in [
        (&shot, vec![numbers; 2], "iso shows one volume"),
        (
            &shot,
            vec![of(Role::Opacity, Some(&function))],
            "iso shows one volume",
        ),
        (
            &shot,
            vec![of(Role::Numbers, None)],
            "needs a transfer function",
        ),
        (&wide, vec![numbers], "cubic reads one volume"),
    ] {
        let scene = Scene {
            beside: Beside::Channels(&channels),
            ..shot.scene(&ball, None)
        };
        let said = reference::render::<f32>(&scene).unwrap_err().to_string();
        assert!(said.contains(wanted), "{said}");
    }
}
