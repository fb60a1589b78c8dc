//! Light that matter takes away: closed forms on the coarse grid, and the device against its CPU reference.

use crate::shared::{
    PictureCase, compare, device, device_with, oblique_camera, oblique_shots, ramps,
    sheared_affine, volume_of, waves,
};
use glam::{DAffine3, DVec3, dvec3};
use stratavox::camera::{Camera, Projection};
use stratavox::gpu::Caps;
use stratavox::offscreen::{self, Renderer, reference};
use stratavox::picture::{ColorSpace, Picture};
use stratavox::scene::{Beside, Scene};
use stratavox::technique::{
    AmbientOcclusion, ClipPlane, Error, Filter, Level, Light, LightField, LightPlan, Mode,
    Settings, Shading, Shadows, Technique, View,
};
use stratavox::transfer::{
    ColorPoint, GradientTransfer, Interpolation, OpacityPoint, Shape, TransferFunction, Widget,
};
use stratavox::volume::{Grid, Volume};

/// Extinction of what nothing comes through: exp(-12) of it would be 6e-6.
const OPAQUE: f64 = 1e6;
/// Light is followed to a depth of 12 and lengths are kept in f32: 2^-24 of them.
const DARKEST: f64 = 6.2e-6;

fn cube(side: u32) -> Grid {
    Grid {
        dims: [side; 3],
        world_from_voxel: DAffine3::from_scale(DVec3::splat(2.0)),
    }
}

fn occlusion(radius_world: f64) -> Settings {
    Settings {
        ambient_occlusion: Some(AmbientOcclusion {
            strength: 1.0,
            radius_world: Some(radius_world),
        }),
        ..Settings::default()
    }
}

fn lamp(towards: DVec3) -> Light {
    let srgb = [1.0; 3];
    Light::of_world(towards, srgb)
}

fn shadows(lights: &[DVec3], light_size_degrees: f64) -> Settings {
    let shading = Shading {
        lights: lights.iter().copied().map(lamp).collect(),
        shadows: Shadows::Volume { light_size_degrees },
        ..Shading::default()
    };
    Settings {
        shading: Some(shading),
        ..Settings::default()
    }
}

/// What comes through matter whose extinction is given at the centres of cells, in voxel space.
struct Found {
    plan: LightPlan,
    open: Vec<f64>,
}

impl Found {
    fn of(grid: &Grid, settings: &Settings, extinction: impl Fn(DVec3) -> f64) -> Self {
        let camera = oblique_camera(grid, Projection::Orthographic { view_height: 9.0 });
        let view = View {
            grid,
            camera: &camera,
            extent_pixels: [4, 4],
            in_pixel: [0.0; 2].into(),
            settings,
        };
        let plan = view.light_plan().unwrap().expect("light is asked for");
        assert_eq!(plan.cells, grid.dims, "cells are voxels in small volumes");
        let [nx, ny, nz] = plan.cells;
        let centers =
            (0..nz).flat_map(|z| (0..ny).flat_map(move |y| (0..nx).map(move |x| [x, y, z])));
        let cells: Vec<f64> = centers
            .map(|center| extinction(DVec3::from_array(center.map(f64::from)) + 0.5))
            .collect();
        let open = LightField::through(&plan, &cells).open().to_vec();
        assert_eq!(open.len() as u64, plan.node_count());
        Self { plan, open }
    }

    fn nodes(&self) -> impl Iterator<Item = ([u32; 3], f64)> {
        let [nx, ny, nz] = self.plan.cells.map(|n| n + 1);
        let nodes =
            (0..nz).flat_map(move |z| (0..ny).flat_map(move |y| (0..nx).map(move |x| [x, y, z])));
        nodes.zip(self.open.iter().copied())
    }

    fn at(&self, node: [u32; 3]) -> f64 {
        let found = self.nodes().find(|(at, _)| *at == node);
        found.expect("a node").1
    }
}

#[track_caller]
fn assert_near(found: f64, wanted: f64, tolerance: f64, what: &str) {
    let off = (found - wanted).abs();
    assert!(
        off <= tolerance,
        "{what}: {found}, wanted {wanted}, off by {off:.2e}"
    );
}

#[test]
fn in_uniform_matter_what_comes_in_is_the_exponential_of_the_radius() {
    // A cell is 2 long, and the first of them is left out.
    for (extinction, radius) in [(0.0, 10.0), (0.03, 10.0), (0.2, 7.3), (0.1, 15.9)] {
        let found = Found::of(&cube(16), &occlusion(radius), |_| extinction);
        let wanted = (-extinction * (radius - 2.0)).exp();
        let what = format!("extinction {extinction}, radius {radius}");
        assert_near(found.at([8, 8, 8]), wanted, 1e-6, &what);
    }
}

#[test]
fn half_of_the_sky_is_seen_from_a_wall_all_from_the_open_and_none_from_inside() {
    for axis in 0..3 {
        let found = Found::of(&cube(12), &occlusion(6.0), |p| {
            if p[axis] < 6.0 { OPAQUE } else { 0.0 }
        });
        for (node, open) in found.nodes() {
            // Where no face of the grid is within the radius, of three cells, but that across the axis.
            let is_middle = (0..3).all(|k| k == axis || (3..=9).contains(&node[k]));
            let what = format!("wall across {axis}, {node:?}");
            match node[axis] {
                6 if is_middle => assert_near(open, 0.5, DARKEST, &what),
                9..=12 => assert_eq!(open, 1.0, "{what}"),
                3..=4 if is_middle => assert_near(open, 0.0, DARKEST, &what),
                _ => {}
            }
        }
    }
    let center = DVec3::splat(6.0);
    let ball = |radius: f64| {
        move |p: DVec3| {
            if p.distance(center) < radius {
                OPAQUE
            } else {
                0.0
            }
        }
    };
    let inside = Found::of(&cube(12), &occlusion(6.0), ball(4.0));
    assert_near(inside.at([6; 3]), 0.0, DARKEST, "in the middle of a ball");
    // One voxel fills an eighth of the sky of its corner, 4 or 5 of 32 paths.
    let alone = Found::of(&cube(12), &occlusion(6.0), |p| {
        if p == DVec3::splat(6.5) { OPAQUE } else { 0.0 }
    });
    let nearest = (1.0 - alone.at([6; 3])).abs();
    assert!(
        nearest <= 5.0 / 32.0,
        "a corner of a voxel alone: {nearest}"
    );
    assert_eq!(alone.at([2; 3]), 1.0, "far from it");
    let empty = Found::of(&cube(12), &occlusion(6.0), |_| 0.0);
    assert!(
        empty.open.iter().all(|&open| open == 1.0),
        "nothing is in the way of anything"
    );
}

#[test]
fn light_fades_in_a_slab_as_its_depth_along_the_light_says() {
    let extinction = 0.11;
    for towards in [DVec3::Z, DVec3::NEG_X, DVec3::Y, dvec3(0.3, -0.2, 1.0)] {
        let found = Found::of(&cube(14), &shadows(&[towards], 0.0), |_| extinction);
        let way = towards.normalize();
        let (mut faces, mut inner) = (0, 0);
        for (node, open) in found.nodes() {
            // World length to where the way to the light leaves the box of side 28.
            let p = 2.0 * DVec3::from_array(node.map(f64::from));
            let exits = (0..3).filter(|&k| way[k] != 0.0).map(|k| {
                let face = if way[k] > 0.0 { 28.0 } else { 0.0 };
                (face - p[k]) / way[k]
            });
            let depth = exits.fold(f64::INFINITY, f64::min);
            // A way along the faces of the box is half outside.
            let is_on_edge = (0..3).any(|k| way[k] == 0.0 && [0, 14].contains(&node[k]));
            if is_on_edge {
                continue;
            }
            if depth == 0.0 {
                assert_eq!(open, 1.0, "{towards}: at the entry face {node:?}");
                faces += 1;
            }
            // Pieces are in f32, 28 of them at most.
            assert_near(
                open,
                (-extinction * depth).exp(),
                2e-6,
                &format!("{towards} {node:?}"),
            );
            inner += 1;
        }
        assert!(
            faces >= 169 && inner > 2000,
            "{faces} and {inner} nodes tell nothing"
        );
    }
}

/// Nodes below a ball of radius 4 cells about the middle of the upper half; the light looks `size` degrees wide.
fn assert_shadow_of_a_ball(towards: DVec3, size: f64) {
    let (center, radius) = (dvec3(11.0, 11.0, 15.0), 4.0);
    let found = Found::of(&cube(22), &shadows(&[towards], size), |p| {
        if p.distance(center) < radius {
            OPAQUE
        } else {
            0.0
        }
    });
    let way = towards.normalize();
    // Cells whose middles lie in the ball: no point of its edge is off by more than half a diagonal.
    let rough = 0.75f64.sqrt();
    let spread = (0.5 * size).to_radians().tan();
    let mut counts = [0; 3];
    for (node, open) in found.nodes() {
        let from_ball = center - DVec3::from_array(node.map(f64::from));
        let distance = from_ball.dot(way);
        if distance < radius + rough {
            continue;
        }
        let aside = (from_ball - distance * way).length();
        let reach = spread * (distance + radius);
        let (umbra, penumbra) = (radius - rough - reach, radius + rough + reach);
        let what = format!("light {towards} of {size} degrees, {node:?}");
        if aside < umbra {
            assert_near(open, 0.0, DARKEST, &what);
            counts[0] += 1;
        } else if aside > penumbra {
            assert_eq!(open, 1.0, "{what}");
            counts[1] += 1;
        } else {
            counts[2] += usize::from(open > 0.01 && open < 0.99);
        }
    }
    let [dark, lit, between] = counts;
    assert!(
        dark > 60 && lit > 2000,
        "{dark} and {lit} nodes tell nothing"
    );
    // A way along faces of cells has its own half shadow.
    if way != DVec3::Z {
        assert_eq!(between > 0, size > 0.0, "{between} nodes in half shadow");
    }
}

#[test]
fn the_shadow_of_a_ball_lies_where_geometry_says() {
    for towards in [DVec3::Z, dvec3(0.31, 0.2, 1.0), dvec3(-0.5, 0.13, 1.0)] {
        for size in [0.0, 12.0] {
            assert_shadow_of_a_ball(towards, size);
        }
    }
}

const GRID: fn() -> Grid = || Grid {
    dims: [17, 21, 13],
    world_from_voxel: sheared_affine(),
};

fn lights() -> Vec<Light> {
    let light = |towards, srgb| Light::of_world(towards, srgb);
    vec![
        light(dvec3(1.0, -2.0, 0.7), [1.0, 0.9, 0.8]),
        light(dvec3(-0.3, 0.2, 3.0), [0.2, 0.3, 0.6]),
    ]
}

/// Occlusion, shadows, and both with everything that light is cut by.
pub fn dim(settings: &mut Settings, turn: usize) {
    let shading = Shading {
        ambient: 0.6,
        lights: lights(),
        shadows: Shadows::Volume {
            light_size_degrees: 8.0,
        },
        ..Shading::default()
    };
    settings.ambient_occlusion = (turn != 1).then_some(AmbientOcclusion {
        strength: 0.9,
        radius_world: None,
    });
    settings.shading = (turn != 0).then_some(shading);
    if turn == 2 {
        settings.crop = Some([dvec3(1.3, 0.0, 2.0), dvec3(14.0, 19.6, 13.0)]);
        let normal = dvec3(0.6, -0.7, 0.4);
        let offset = normal.dot(GRID().center()) - 3.0;
        settings.clip_planes = vec![ClipPlane { normal, offset }];
    }
}

/// The device as its CPU reference in f32 and f64, and unlike `bright`.
fn assert_references(renderer: &mut Renderer, scene: &Scene, bright: &Settings, what: &str) {
    let found = renderer.render(scene, &[]).unwrap().picture;
    let double = reference::render::<f64>(scene).unwrap();
    let single = reference::render::<f32>(scene).unwrap();
    let all = [&double, &single, &found].map(|p| p.pixels.as_flattened());
    compare(what, 4 * found.width, all, 1.0);
    let bright = Scene {
        settings: bright,
        ..*scene
    };
    let bright = reference::render::<f32>(&bright).unwrap();
    let pixels = || bright.pixels.iter().zip(&single.pixels);
    let darker = pixels().filter(|(a, b)| a[1] - b[1] > 0.02).count();
    assert!(darker > 100, "{what}: {darker} pixels are darker");
    assert!(pixels().all(|(a, b)| a[3] == b[3]), "{what}: opacity");
}

fn without(settings: &Settings) -> Settings {
    let mut bright = settings.clone();
    bright.ambient_occlusion = None;
    if let Some(shading) = &mut bright.shading {
        shading.shadows = Shadows::Off;
    }
    bright
}

#[test]
fn every_technique_and_filter_is_dimmed_as_its_reference() {
    let mut volume = volume_of(GRID().dims, sheared_affine(), waves);
    for has_holes in [false, true] {
        if has_holes {
            let count = volume.dims.iter().product::<u32>();
            volume.validity = Some((0..count).map(|i| u8::from(i % 211 != 7)).collect());
        }
        let transfer = ramps();
        let mut renderer = Renderer::new(device(), &volume).unwrap();
        let filters = [Filter::Nearest, Filter::Linear, Filter::Cubic];
        for (i, shot) in oblique_shots(GRID(), Mode::Composite).iter().enumerate() {
            // One projection; of holes one filter.
            if i >= 6 || (has_holes && i % 3 != 1) {
                continue;
            }
            let filter = filters[i % 3];
            let shot = shot.with(|settings| {
                settings.filter = filter;
                dim(settings, (i + i / 3) % 3);
            });
            let what = format!("holes {has_holes}, {filter:?}, {}", shot.what());
            let scene = shot.scene(&volume, Some(&transfer));
            assert_references(&mut renderer, &scene, &without(&shot.settings), &what);
        }
    }
}

#[test]
fn surfaces_and_mida_are_dimmed_as_their_references() {
    let volume = volume_of(GRID().dims, sheared_affine(), waves);
    let transfer = ramps();
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    for mode in [Mode::Iso, Mode::Mida] {
        let shot = &oblique_shots(GRID(), mode)[0];
        for turn in 0..3 {
            let shot = shot.with(|settings| {
                let level = |value, opacity| Level {
                    value,
                    srgb: [0.9, 0.8, 0.7],
                    opacity,
                };
                settings.per_mode.levels = vec![level(0.7, 1.0), level(0.4, 0.3)];
                dim(settings, turn);
            });
            let scene = shot.scene(&volume, Some(&transfer));
            let what = format!("turn {turn}, {}", shot.what());
            assert_references(&mut renderer, &scene, &without(&shot.settings), &what);
        }
    }
}

#[test]
fn functions_of_the_gradient_cast_what_they_draw() {
    let volume = volume_of(GRID().dims, sheared_affine(), waves);
    let widget = Widget {
        srgb: Some([0.9, 0.6, 0.3]),
        opacity: 0.7,
        second: None,
        shape: Shape::Contour {
            value: 0.6,
            half_width: 1.5,
        },
    };
    let transfer = TransferFunction {
        opacity: vec![OpacityPoint {
            value: 0.0,
            opacity: 0.0,
        }],
        medium: None,
        gradient_transfer: Some(GradientTransfer {
            steepest: Some(1.0),
            share: Vec::new(),
            widgets: vec![widget],
        }),
        ..ramps()
    };
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    for (turn, nth) in [(0, 0), (1, 3), (2, 4)] {
        let shot = oblique_shots(GRID(), Mode::Composite)[nth].with(|s| dim(s, turn));
        let scene = shot.scene(&volume, Some(&transfer));
        let what = format!("widgets, {}", shot.what());
        assert_references(&mut renderer, &scene, &without(&shot.settings), &what);
    }
}

#[test]
fn no_strength_and_a_light_at_the_eye_leave_every_bit() {
    let volume = volume_of(GRID().dims, sheared_affine(), waves);
    let transfer = ramps();
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    for shot in oblique_shots(GRID(), Mode::Composite).iter().step_by(2) {
        for shading in [None, Some(Shading::default())] {
            let bright = shot.with(|settings| settings.shading = shading.clone());
            let dim = bright.with(|settings| {
                settings.ambient_occlusion = Some(AmbientOcclusion {
                    strength: 0.0,
                    radius_world: None,
                });
                if let Some(shading) = &mut settings.shading {
                    shading.shadows = Shadows::Volume {
                        light_size_degrees: 3.0,
                    };
                }
            });
            let mut drawn = |shot: &PictureCase| {
                let scene = shot.scene(&volume, Some(&transfer));
                renderer.render(&scene, &[]).unwrap().picture.pixels
            };
            assert!(drawn(&bright) == drawn(&dim), "{}", shot.what());
        }
    }
}

/// A floor in the lower third and a ball over it, seen from above; the light is above too.
fn ball_over_floor(p: DVec3) -> f64 {
    let is_ball = p.distance(dvec3(12.0, 12.0, 15.0)) < 4.0;
    f64::from(is_ball || p.z < 5.0)
}

/// White above 0.5.
fn white() -> TransferFunction {
    TransferFunction {
        color: vec![ColorPoint {
            value: 0.0,
            srgb: [1.0; 3],
        }],
        opacity: [(0.5, 0.0), (0.5, 1.0)]
            .map(|(value, opacity)| OpacityPoint { value, opacity })
            .to_vec(),
        reference_length: None,
        interpolation: Interpolation::Linear,
        gradient_transfer: None,
        medium: None,
    }
}

/// A pixel a voxel, nearest, against the last axis.
pub fn seen_from_above(
    volume: &Volume,
    transfer: &TransferFunction,
    beside: Beside,
    change: impl FnOnce(&mut Settings),
) -> Picture {
    let mut settings = shadows(&[dvec3(0.5, 0.0, 1.0)], 0.0);
    settings.color_space = ColorSpace::Display;
    settings.filter = Filter::Nearest;
    change(&mut settings);
    let grid = volume.grid();
    let camera = Camera {
        eye: grid.center() + 60.0 * DVec3::Z,
        target: grid.center(),
        up: DVec3::Y,
        projection: Projection::Orthographic { view_height: 24.0 },
        zoom: 1.0,
    };
    let scene = Scene {
        volume,
        transfer: Some(transfer),
        beside,
        camera: &camera,
        extent_pixels: [24, 24],
        settings: &settings,
    };
    let mut renderer = Renderer::several(device(), scene.volumes()).unwrap();
    renderer.render(&scene, &[]).unwrap().picture
}

fn balls_from_above(volume: &Volume, change: impl FnOnce(&mut Settings)) -> Picture {
    seen_from_above(volume, &white(), Beside::Nothing, change)
}

/// The floor where the shadow of the ball falls: ten below it, five to the side.
fn in_shadow(picture: &Picture) -> f32 {
    picture.pixels[12 * 24 + 6][0]
}

#[test]
fn what_is_cut_away_or_no_data_casts_no_shadow() {
    let volume = volume_of([24; 3], DAffine3::IDENTITY, ball_over_floor);
    let floor = volume_of([24; 3], DAffine3::IDENTITY, |p| f64::from(p.z < 5.0));
    let bright = in_shadow(&balls_from_above(&floor, |_| ()));
    let dark = in_shadow(&balls_from_above(&volume, |_| ()));
    assert!(
        dark < 0.3 * bright,
        "the ball casts a shadow: {dark} of {bright}"
    );
    let clipped = balls_from_above(&volume, |settings| {
        let (normal, offset) = (DVec3::NEG_Z, -10.0);
        settings.clip_planes = vec![ClipPlane { normal, offset }];
    });
    assert_eq!(
        in_shadow(&clipped),
        bright,
        "a clip plane takes the ball away"
    );
    let cropped = balls_from_above(&volume, |settings| {
        settings.crop = Some([DVec3::ZERO, dvec3(24.0, 24.0, 10.0)]);
    });
    assert_eq!(in_shadow(&cropped), bright, "a crop takes the ball away");
    let mut hollow = volume;
    let is_there = |i: u32| u8::from(i / (24 * 24) < 10);
    hollow.validity = Some((0..24 * 24 * 24).map(is_there).collect());
    let hollow = balls_from_above(&hollow, |_| ());
    assert_eq!(in_shadow(&hollow), bright, "a ball without data is none");
}

#[test]
fn light_is_followed_anew_when_what_it_depends_on_changes() {
    let volume = volume_of(GRID().dims, sheared_affine(), waves);
    let (transfer, other) = (ramps(), {
        let mut other = ramps();
        other.opacity[1].opacity = 0.6;
        other
    });
    let shot = &oblique_shots(GRID(), Mode::Composite)[0];
    let base = shot.with(|settings| dim(settings, 2));
    let turned = base.with(|settings| {
        settings.shading.as_mut().unwrap().lights[0].towards = DVec3::X;
    });
    let wider = base.with(|settings| settings.crop = None);
    let clipped = base.with(|settings| settings.clip_planes[0].offset += 2.0);
    let nearer = base.with(|settings| {
        settings.ambient_occlusion.as_mut().unwrap().radius_world = Some(2.5);
    });
    let stack = base.with(|settings| settings.technique = Technique::Slices2d);
    let pictures = [
        (&base, &transfer),
        (&turned, &transfer),
        (&wider, &transfer),
        (&clipped, &transfer),
        (&nearer, &transfer),
        (&base, &other),
        (&stack, &transfer),
        (&base, &transfer),
    ];
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    let mut before = Vec::new();
    for (nth, (shot, transfer)) in pictures.into_iter().enumerate() {
        let scene = shot.scene(&volume, Some(transfer));
        let found = renderer.render(&scene, &[]).unwrap().picture.pixels;
        let wanted = reference::render::<f32>(&scene).unwrap().pixels;
        let pairs = wanted.as_flattened().iter().zip(found.as_flattened());
        let apart = pairs.filter(|(a, b)| (*a - *b).abs() > 1e-4).count();
        // Few numbers jump where a plane ends in a pixel.
        assert!(
            apart < 20,
            "picture {nth}: {apart} numbers are not those of the reference"
        );
        assert!(found != before, "picture {nth} is the one before");
        before = found;
    }
}

#[test]
fn light_goes_through_bricks_as_through_one_piece() {
    let volume = volume_of(GRID().dims, sheared_affine(), waves);
    let transfer = ramps();
    let small = Caps {
        max_image_dimension_3d: 11,
        max_image_array_layers: 8,
        ..Caps::UNLIMITED
    };
    let mut whole = Renderer::new(device(), &volume).unwrap();
    let mut bricks = Renderer::new(device_with(small), &volume).unwrap();
    for nth in [0, 4] {
        let shot = oblique_shots(GRID(), Mode::Composite)[nth].with(|s| dim(s, 2));
        let scene = shot.scene(&volume, Some(&transfer));
        let wanted = whole.render(&scene, &[]).unwrap().picture;
        let found = bricks.render(&scene, &[]).unwrap().picture;
        let pairs = wanted
            .pixels
            .as_flattened()
            .iter()
            .zip(found.pixels.as_flattened());
        let worst = pairs.fold(0.0f32, |worst, (a, b)| worst.max((a - b).abs()));
        // One look a cell here, and a look is in one brick: only what other bricks leave is added to and rounded.
        assert!(worst < 2e-6, "{}: {worst}", shot.what());
    }
}

#[test]
fn what_has_no_light_to_take_is_refused_by_name() {
    let volume = volume_of(GRID().dims, sheared_affine(), waves);
    let transfer = ramps();
    let shot = &oblique_shots(GRID(), Mode::Composite)[0];
    let refused = |change: &dyn Fn(&mut Settings)| {
        let shot = shot.with(|settings| {
            dim(settings, 0);
            change(settings);
        });
        let scene = shot.scene(&volume, Some(&transfer));
        let mut renderer = Renderer::new(device(), &volume).unwrap();
        let found = renderer.render(&scene, &[]).expect_err("refused");
        let reference = reference::render::<f32>(&scene).expect_err("refused");
        match found {
            offscreen::Error::Technique(found) => {
                assert_eq!(found.to_string(), reference.to_string());
            }
            other => panic!("{other}"),
        }
        reference
    };
    let of_mip = refused(&|settings| settings.mode = Mode::Mip);
    assert_eq!(of_mip, Error::NotOccluded { mode: Mode::Mip });
    let of_runs = refused(&|settings| settings.adaptive_steps = Some(0.1));
    assert!(matches!(of_runs, Error::NotFor { .. }), "{of_runs}");
    for radius in [0.0, -1.0, f64::NAN, 1e6] {
        let found = refused(&|settings| {
            settings.ambient_occlusion.as_mut().unwrap().radius_world = Some(radius);
        });
        assert!(found.to_string().contains("radius"), "{found}");
    }
    let found = refused(&|settings| {
        settings.ambient_occlusion.as_mut().unwrap().strength = 1.5;
    });
    assert!(found.to_string().contains("strength"), "{found}");
}
