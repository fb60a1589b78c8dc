//! Shadows by half-angle slices: the device against its twin, and both against closed forms and geometry.

mod embed_shared;
mod shared;

use ash::vk;
use embed_shared::{Host, HostImage, OnDevice, Stage, assert_close, over};
use glam::{DAffine3, DVec3, dvec3};
use shared::{
    Shot, Worst, compare, device, device_with, oblique_camera, projections, ramps, sheared_affine,
    volume_of, waves,
};
use stratavox::camera::{Camera, Projection};
use stratavox::gpu::{Blend, Caps, Use, image_barrier};
use stratavox::offscreen::{self, Renderer, reference};
use stratavox::picture::{LayerKind, Picture};
use stratavox::resolve::Resolve;
use stratavox::scene::{Beside, Scene};
use stratavox::technique::slices_3d::HalfAngleSlicer;
use stratavox::technique::slices_3d::half_angle::{HalfAngleSlices, light_buffer};
use stratavox::technique::{
    ClipPlane, Error, Filter, Inputs, Light, Mode, Order, Settings, Shading, Shadows, Technique,
    Words, accumulation, parameter_ring,
};
use stratavox::transfer::{
    ColorPoint, Graded, Interpolation, OpacityPoint, Shape, TransferFunction, Widget,
};
use stratavox::volume::{Grid, Rescale, Volume, Voxels};

const GRID: fn() -> Grid = || Grid {
    dims: [17, 21, 13],
    world_from_voxel: sheared_affine(),
};

/// The part of the colour that needs no light.
const AMBIENT: f64 = 0.1;

fn half_angle() -> Settings {
    Settings {
        technique: Technique::Slices3d,
        shading: Some(Shading {
            shadows: Shadows::HalfAngle,
            ..Shading::plain()
        }),
        conformance: true,
        ..Settings::default()
    }
}

/// One light, on matter as it is.
fn plain(towards: DVec3) -> Option<Shading> {
    let light = Light {
        towards,
        srgb: [1.0; 3],
    };
    Some(Shading {
        lights: vec![light],
        shadows: Shadows::HalfAngle,
        ..Shading::plain()
    })
}

/// Light from behind the eye, from the side, and from behind the volume.
fn ways_to_light(camera: &Camera) -> [DVec3; 3] {
    let axes = camera.frame();
    let at = |x: f64, y: f64, z: f64| x * axes.right + y * axes.up - z * axes.forward;
    [at(0.8, 0.5, 1.0), at(-1.0, 0.4, 0.2), at(0.3, 0.9, -0.8)]
}

/// In both projections, where half-angle slices can be.
fn shots() -> [Shot; 2] {
    projections(&GRID()).map(|projection| Shot {
        grid: GRID(),
        camera: oblique_camera(&GRID(), projection),
        extent: [40, 36],
        settings: half_angle(),
    })
}

/// Picture and layers of the device against those of the twin.
fn check(renderer: &mut Renderer, scene: &Scene, what: &str) -> Picture {
    let kinds = [LayerKind::Transmittance, LayerKind::Samples];
    let found = renderer.render(scene, &kinds).unwrap().picture;
    let double = reference::render::<f64>(scene).unwrap();
    let single = reference::render::<f32>(scene).unwrap();
    let all = [&double, &single, &found];
    let pixels = all.map(|p| p.pixels.as_flattened());
    compare(what, 4 * found.width, pixels, 1.0);
    for kind in kinds {
        let values = |picture: &'_ Picture| {
            let layer = picture.layers.iter().find(|layer| layer.kind == kind);
            layer.expect("a layer of slicers").values.clone()
        };
        let lists = all.map(values);
        let scale = lists[0].iter().copied().fold(1.0, f32::max);
        let lists = [&lists[0][..], &lists[1][..], &lists[2][..]];
        compare(&format!("{kind:?} of {what}"), found.width, lists, scale);
    }
    let unlit = Settings {
        shading: None,
        ..scene.settings.clone()
    };
    let unlit = Scene {
        settings: &unlit,
        ..*scene
    };
    let lit = reference::render::<f32>(&unlit).unwrap();
    let darker = found.pixels.iter().zip(&lit.pixels);
    let darker = darker
        .filter(|(found, lit)| found[1] < 0.8 * lit[1])
        .count();
    assert!(darker > 100, "{what}: only {darker} pixels are in shadow");
    found
}

/// Values fade to 0, which is transparent, towards the box: whether rounding takes a sample at its faces in or leaves
/// it out changes no picture and no shadow.
fn fading(p: DVec3) -> f64 {
    let far = GRID().far_corner();
    let inside = (p - 0.5).min(far - 0.5 - p).min_element();
    (inside / 2.0).min(1.0) * waves(p)
}

#[test]
fn eye_and_light_draw_what_their_twins_compute() {
    let volume = volume_of(GRID().dims, sheared_affine(), fading);
    let transfer = ramps();
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    let mut orders = Vec::new();
    for (turn, shot) in shots().iter().enumerate() {
        for (i, towards) in ways_to_light(&shot.camera).into_iter().enumerate() {
            let mut shading = plain(towards).unwrap();
            // Surfaces now and then, in the light of a colour.
            shading.has_surfaces = i == 1;
            shading.lights[0].srgb = [1.0, 0.9, 0.7];
            let filter = [Filter::Linear, Filter::Nearest][(i + turn) % 2];
            let shot = shot.with(|settings| {
                settings.filter = filter;
                settings.shading = Some(shading);
            });
            let what = format!("light {i}, {filter:?}, {}", shot.what());
            check(&mut renderer, &shot.scene(&volume, Some(&transfer)), &what);
            orders.push(shot.view().half_angle().unwrap().order);
        }
    }
    assert!(orders.contains(&Order::FrontToBack) && orders.contains(&Order::BackToFront));
}

#[test]
fn holes_cuts_and_widgets_throw_the_shadows_of_their_twins() {
    let values = volume_of(GRID().dims, sheared_affine(), fading).voxels;
    let codes = (0..values.len()).map(|i| (values.stored(i) * 200.0) as u8);
    let rescale = Rescale {
        slope: 1.0 / 200.0,
        intercept: 0.0,
    };
    let voxels = Voxels::U8(codes.collect());
    let volume = Volume::from_voxels(GRID().dims, sheared_affine(), voxels, rescale, Some(120.0));
    let volume = volume.unwrap();
    let widget = Widget {
        srgb: Some([0.2, 0.9, 0.3]),
        opacity: 0.5,
        shape: Shape::Contour {
            value: 0.55,
            half_width: 2.0,
        },
    };
    let graded = TransferFunction {
        graded: Some(Graded {
            steepest: Some(0.3),
            share: Vec::new(),
            widgets: vec![widget],
        }),
        ..ramps()
    };
    let normal = dvec3(1.0, 0.4, -0.3).normalize();
    let plane = ClipPlane {
        normal,
        offset: normal.dot(GRID().center()) - 4.0,
    };
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    let [parallel, perspective] = shots();
    let cut = |shot: &Shot| {
        let towards = ways_to_light(&shot.camera)[0];
        shot.with(|settings| {
            settings.shading = plain(towards);
            settings.crop = Some([dvec3(1.0, 1.7, -4.0), dvec3(16.2, 99.0, 11.9)]);
            settings.clip_planes = vec![plane];
        })
    };
    let (cut, whole) = (cut(&parallel), perspective);
    let cut = cut.with(|settings| settings.filter = Filter::Nearest);
    check(&mut renderer, &cut.scene(&volume, Some(&ramps())), "cut");
    check(
        &mut renderer,
        &whole.scene(&volume, Some(&graded)),
        "widgets, headlight",
    );
}

/// Unit voxels full of one medium; rays through the middles of columns of voxels, along +z.
fn medium(samples_per_voxel: f64, towards: DVec3) -> (Volume, Shot) {
    const SIDE: u32 = 12;
    let volume = volume_of([SIDE; 3], DAffine3::IDENTITY, |_| 1.0);
    let grid = volume.grid();
    let shot = Shot {
        grid,
        camera: Camera {
            eye: grid.center() - dvec3(0.0, 0.0, 30.0),
            target: grid.center(),
            up: DVec3::Y,
            projection: Projection::Orthographic {
                view_height: SIDE.into(),
            },
            zoom: 1.0,
        },
        extent: [SIDE; 2],
        settings: Settings {
            samples_per_voxel,
            shading: plain(towards),
            ..half_angle()
        },
    };
    (volume, shot)
}

/// White, of one extinction per world length for values from `value` on, none below.
fn white(steps: &[(f64, f64)]) -> TransferFunction {
    let point = |&(value, extinction): &(f64, f64)| OpacityPoint {
        value,
        opacity: -f64::exp_m1(-extinction),
    };
    TransferFunction {
        color: vec![ColorPoint {
            value: 0.0,
            srgb: [1.0; 3],
        }],
        opacity: steps.iter().map(point).collect(),
        reference_length: Some(1.0),
        interpolation: Interpolation::Step,
        graded: None,
    }
}

const SIGMA: f64 = 0.11;
const LENGTH: f64 = 12.0;

/// What twins in both precisions and the device make of a shot.
fn pictures(volume: &Volume, shot: &Shot, transfer: &TransferFunction) -> [Picture; 3] {
    let scene = shot.scene(volume, Some(transfer));
    [
        reference::render::<f64>(&scene).unwrap(),
        reference::render::<f32>(&scene).unwrap(),
        on_device(volume, shot, transfer),
    ]
}

fn on_device(volume: &Volume, shot: &Shot, transfer: &TransferFunction) -> Picture {
    let mut renderer = Renderer::new(device(), volume).unwrap();
    let scene = shot.scene(volume, Some(transfer));
    renderer.render(&scene, &[]).unwrap().picture
}

/// Texels of the light at the rim of the box see past it: the outermost pixels are left out.
fn inner_pixels(picture: &Picture) -> impl Iterator<Item = ([u32; 2], [f64; 4])> + '_ {
    let (width, height) = (picture.width, picture.height);
    let at = move |i: usize| [i as u32 % width, i as u32 / width];
    let pixels = picture.pixels.iter().enumerate();
    pixels
        .map(move |(i, p)| (at(i), p.map(f64::from)))
        .filter(move |([x, y], _)| (1..width - 1).contains(x) && (1..height - 1).contains(y))
}

/// With q = exp(-sigma h) and N slices: light from the eye reaches slice k as q^k, light from behind as q^(N-1-k).
#[test]
fn light_along_the_view_is_the_sum_of_a_power_series_and_converges_with_the_step() {
    for (towards, sum, limit) in [
        (
            DVec3::NEG_Z,
            (|q: f64, n: f64| (1.0 - q.powf(2.0 * n)) / (1.0 + q)) as fn(f64, f64) -> f64,
            0.5 * -f64::exp_m1(-2.0 * SIGMA * LENGTH),
        ),
        (
            DVec3::Z,
            |q, n| n * (1.0 - q) * q.powf(n - 1.0),
            SIGMA * LENGTH * (-SIGMA * LENGTH).exp(),
        ),
    ] {
        let mut errors = Vec::new();
        for samples in [1.0, 2.0, 4.0] {
            let (volume, shot) = medium(samples, towards);
            let (q, n) = ((-SIGMA / samples).exp(), LENGTH * samples);
            let alpha = -f64::exp_m1(-SIGMA * LENGTH);
            let color = |direct: f64| AMBIENT * alpha + (1.0 - AMBIENT) * direct;
            let mut error = 0.0;
            for (way, picture) in ["f64", "f32", "device"].iter().zip(pictures(
                &volume,
                &shot,
                &white(&[(0.0, SIGMA)]),
            )) {
                let mut worst = Worst::new(format!("light to {towards}, {samples}, {way}"));
                for (at, found) in inner_pixels(&picture) {
                    worst.take(at, found[0] - color(sum(q, n)), 5e-6);
                    worst.take(at, found[3] - alpha, 5e-6);
                    error = (found[0] - color(limit)).abs();
                }
                worst.assert_holds();
            }
            errors.push(error);
        }
        for pair in errors.windows(2) {
            let ratio = pair[0] / pair[1];
            println!("light to {towards}: errors {pair:?}, ratio {ratio}");
            assert!((1.9..2.1).contains(&ratio), "{ratio}");
        }
    }
}

/// Light across the view: exp(-sigma x) at the depth x. Slices lie d = sqrt(2) h apart along the light, and a sample has
/// those before its own in the light, floor(x / d); a texel of width w beside it may have one more or less. Samples of the
/// eye within w of the front and of the back of the box may see light that passes it by.
#[test]
fn light_across_the_view_falls_off_with_the_depth() {
    const PIXELS: u32 = 50;
    for samples in [1.0, 2.0, 4.0] {
        let (volume, mut shot) = medium(samples, DVec3::NEG_X);
        shot.extent = [PIXELS; 2];
        let d = 2f64.sqrt() / samples;
        let w = LENGTH / (f64::from(shot.view().light_extent()[0]) - 2.0);
        let taken = |length: f64| -f64::exp_m1(-SIGMA * length);
        let rims = taken(w + d) * (2.0 - taken(LENGTH - w - d)) / taken(LENGTH - d);
        for (way, picture) in
            ["f64", "f32", "device"]
                .iter()
                .zip(pictures(&volume, &shot, &white(&[(0.0, SIGMA)])))
        {
            let mut worst = Worst::new(format!("light across, {samples}, {way}"));
            let mut mean = 0.0;
            for (at, found) in inner_pixels(&picture) {
                // Right in the picture is against x: the camera looks along +z, up is +y.
                let x = LENGTH * (1.0 - (f64::from(at[0]) + 0.5) / f64::from(PIXELS));
                let left = (found[0] / found[3] - AMBIENT) / (1.0 - AMBIENT);
                let [low, high] = [x + w, x - w - d].map(|x| 1.0 - taken(x.max(0.0)));
                let high = high + (1.0 - low) * rims;
                // A way from the middle of what may be.
                worst.take(at, left - 0.5 * (low + high), 0.5 * (high - low));
                mean += (left - 1.0 + taken(x)) / f64::from((PIXELS - 2) * (PIXELS - 2));
            }
            println!("light across, {samples} samples a voxel, {way}: mean error {mean}");
            worst.assert_holds();
        }
    }
}

/// x against the middle of the box.
fn mirrored(p: DVec3, width: f64) -> DVec3 {
    dvec3(width - p.x, p.y, p.z)
}

#[test]
fn a_mirrored_scene_in_mirrored_light_is_the_mirrored_picture() {
    let dims = [17, 21, 13];
    let field = |p: DVec3| waves(p);
    let volume = volume_of(dims, DAffine3::IDENTITY, field);
    let mirror = volume_of(dims, DAffine3::IDENTITY, |p| field(mirrored(p, 17.0)));
    let grid = volume.grid();
    for projection in projections(&grid) {
        for side in [1.0, -1.0] {
            let camera = oblique_camera(&grid, projection);
            let towards = dvec3(-0.7, -0.9 * side, 0.8);
            let shot = Shot {
                grid,
                camera,
                extent: [40, 36],
                settings: Settings {
                    shading: plain(towards),
                    ..half_angle()
                },
            };
            let other = Shot {
                camera: Camera {
                    eye: mirrored(camera.eye, 17.0),
                    target: mirrored(camera.target, 17.0),
                    up: mirrored(camera.up, 0.0),
                    ..camera
                },
                ..shot.with(|settings| settings.shading = plain(mirrored(towards, 0.0)))
            };
            let wanted = on_device(&volume, &shot, &ramps());
            let mut found = on_device(&mirror, &other, &ramps());
            for row in found.pixels.chunks_mut(40) {
                row.reverse();
            }
            let what = format!("mirrored, {projection:?}, {side}");
            Worst::between(what, 40, &wanted.pixels, &found.pixels, 1e-3).assert_holds();
        }
    }
}

/// An opaque ball above a plate so thin that it hardly shades itself, seen from straight above.
const BALL: DVec3 = DVec3::new(11.0, 16.0, 14.0);
const RADIUS: f64 = 4.0;
const PLATE: f64 = 4.0;

fn ball_above_plate(towards: DVec3) -> (Volume, Shot, TransferFunction) {
    let field = |p: DVec3| match () {
        () if p.distance(BALL) < RADIUS => 2.0,
        () if (2.0..PLATE).contains(&p.z) => 1.0,
        () => 0.0,
    };
    let volume = volume_of([32, 32, 20], DAffine3::IDENTITY, field);
    let grid = volume.grid();
    let shot = Shot {
        grid,
        camera: Camera {
            eye: grid.center() + dvec3(0.0, 0.0, 40.0),
            target: grid.center(),
            up: DVec3::Y,
            projection: Projection::Orthographic { view_height: 32.0 },
            zoom: 1.0,
        },
        extent: [64; 2],
        settings: Settings {
            filter: Filter::Nearest,
            shading: plain(towards),
            ..half_angle()
        },
    };
    // Of the plate, 2e-4 over 2 voxels, sqrt(2) as long for slanting light: under 6e-4 of the light.
    let transfer = white(&[(0.0, 0.0), (1.0, 2e-4), (2.0, 8.0)]);
    (volume, shot, transfer)
}

/// The part of the light that is left on what a pixel shows, and where on the plate that is.
fn light_on_plate(picture: &Picture, shot: &Shot) -> Vec<([u32; 2], DVec3, f64)> {
    let rays = shot.camera.rays(shot.extent);
    let pixels = shot.pixels().zip(&picture.pixels);
    pixels
        .map(|([x, y], pixel)| {
            let (origin, direction) = rays.at(f64::from(x) + 0.5, f64::from(y) + 0.5);
            let place = origin + direction * ((PLATE - origin.z) / direction.z);
            let lit = f64::from(pixel[0]) / f64::from(pixel[3]);
            ([x, y], place, (lit - AMBIENT) / (1.0 - AMBIENT))
        })
        .collect()
}

#[test]
fn a_ball_throws_its_shadow_where_geometry_says() {
    let towards = dvec3(-1.0, 0.0, 1.0).normalize();
    let (volume, shot, transfer) = ball_above_plate(towards);
    // A voxel of the ball, a texel of the light, and a slice along the light.
    let texel = 45.0 / (f64::from(shot.view().light_extent()[0]) - 2.0);
    let blur = 0.5 * 3f64.sqrt() + 2f64.sqrt() * texel;
    for (way, picture) in ["f64", "f32", "device"]
        .iter()
        .zip(pictures(&volume, &shot, &transfer))
    {
        let mut worst = Worst::new(format!("shadow of a ball, {way}"));
        let [mut dark, mut beside] = [0, 0];
        for (at, place, light) in light_on_plate(&picture, &shot) {
            if place.truncate().distance(BALL.truncate()) < RADIUS + 1.0 {
                continue;
            }
            // How far the middle of the ball is from the way to the light.
            let to_ball = BALL - place;
            let off = (to_ball - towards * to_ball.dot(towards)).length();
            if off < RADIUS - blur {
                worst.take(at, light, 1e-3);
                dark += 1;
            } else if off > RADIUS + blur {
                worst.take(at, light - 1.0, 1e-3);
            } else {
                beside += 1;
            }
        }
        println!("{dark} pixels in the shadow, {beside} at its edge");
        assert!(dark > 60, "only {dark} pixels are in the shadow");
        worst.assert_holds();
    }
}

/// The light's texels lie on the rays of the picture: each is as bright as if there were no shadow at all.
#[test]
fn light_from_the_eye_shows_no_edge_of_a_shadow() {
    let (volume, mut shot, transfer) = ball_above_plate(DVec3::Z);
    let texels = f64::from(shot.view().light_extent()[0]);
    assert_eq!(texels, 64.0, "a texel a pixel");
    let view_height = 32.0 * texels / (texels - 2.0);
    shot.camera.projection = Projection::Orthographic { view_height };
    let headlight = shot.with(|settings| settings.shading = half_angle().shading);
    for shot in [shot, headlight] {
        for (way, picture) in ["f64", "f32", "device"]
            .iter()
            .zip(pictures(&volume, &shot, &transfer))
        {
            let mut worst = Worst::new(format!("light from the eye, {way}"));
            let drawn = light_on_plate(&picture, &shot).into_iter();
            for (at, _, light) in drawn.filter(|(.., light)| !light.is_nan()) {
                worst.take(at, light - 1.0, 1e-3);
            }
            worst.assert_holds();
        }
    }
}

/// The first slice that is not transparent has all of the light, however much lies before it.
#[test]
fn matter_without_extinction_takes_no_light() {
    let field = |p: DVec3| if p.z as u32 == 9 { 1.0 } else { 0.0 };
    let volume = volume_of([12; 3], DAffine3::IDENTITY, field);
    let (_, shot) = medium(1.0, DVec3::NEG_Z);
    let shot = shot.with(|settings| settings.filter = Filter::Nearest);
    let transfer = white(&[(0.0, 0.0), (1.0, 0.7)]);
    for (way, picture) in ["f64", "f32", "device"]
        .iter()
        .zip(pictures(&volume, &shot, &transfer))
    {
        let mut worst = Worst::new(format!("nothing before a sheet, {way}"));
        for (at, found) in inner_pixels(&picture) {
            worst.take(at, found[0] - -f64::exp_m1(-0.7), 2e-6);
        }
        worst.assert_holds();
    }
}

/// s halves the angle of view and light, or of the way back and light; it points away from the light, and the eye sees
/// slices in the order in which they come from there.
#[test]
fn samples_are_as_far_apart_along_the_light_as_along_the_view() {
    let [parallel, _] = shots();
    let forward = parallel.camera.frame().forward;
    let mut farthest: f64 = 0.0;
    for i in 0..200 {
        let (turn, lift) = (2.399_963 * f64::from(i), (f64::from(i) + 0.5) / 100.0 - 1.0);
        let flat = (1.0 - lift * lift).sqrt();
        let light = dvec3(flat * turn.cos(), flat * turn.sin(), lift);
        let shot = parallel.with(|settings| settings.shading = plain(-light));
        let half = shot.view().half_angle().unwrap();
        let [along_view, along_light] = [forward, light].map(|r| 1.0 / half.normal.dot(r));
        assert!((along_view.abs() - along_light).abs() < 1e-9, "{light}");
        assert_eq!(
            along_view > 0.0,
            half.order == Order::FrontToBack,
            "{light}"
        );
        assert_eq!(forward.dot(light) >= 0.0, half.order == Order::FrontToBack);
        farthest = farthest.max(along_light);
    }
    let across = parallel.camera.frame().up;
    let shot = parallel.with(|settings| settings.shading = plain(across));
    let half = shot.view().half_angle().unwrap();
    let at_right_angles = 1.0 / half.normal.dot(-across);
    println!("spacing factor {farthest} of 200 lights, {at_right_angles} at a right angle");
    assert!((at_right_angles - 2f64.sqrt()).abs() < 1e-12);
    assert!(farthest <= at_right_angles + 1e-12 && farthest > 1.4);
}

#[test]
fn what_half_angle_slices_cannot_do_is_refused_by_name() {
    let volume = volume_of(GRID().dims, sheared_affine(), waves);
    let transfer = ramps();
    let [parallel, perspective] = shots();
    let refused = |shot: &Shot, beside: Beside| -> Error {
        let scene = Scene {
            beside,
            ..shot.scene(&volume, Some(&transfer))
        };
        let of_twin = reference::render::<f32>(&scene).unwrap_err();
        let mut renderer = Renderer::several(device(), scene.volumes()).unwrap();
        match renderer.render(&scene, &[]).unwrap_err() {
            offscreen::Error::Technique(of_device) => assert_eq!(of_device, of_twin),
            other => panic!("{other}"),
        }
        of_twin
    };
    let alone = |shot: &Shot| refused(shot, Beside::Nothing).to_string();
    for (change, wanted) in [
        (
            (|s: &mut Settings| s.technique = Technique::Raycast) as fn(&mut Settings),
            "half-angle slicing is for 3D slices, not for Raycast",
        ),
        (|s| s.technique = Technique::Slices2d, "not for Slices2d"),
        (|s| s.mode = Mode::Mip, "is for composite, not for Mip"),
        (|s| s.filter = Filter::Cubic, "nearest and linear filters"),
        (|s| s.preintegrated = true, "pre-integrated classification"),
        (
            |s| {
                let mut shading = plain(DVec3::X).unwrap();
                shading.lights.extend(shading.lights.clone());
                s.shading = Some(shading);
            },
            "one light, and 2 were given",
        ),
    ] {
        let text = alone(&parallel.with(change));
        assert!(text.contains(wanted), "{text}");
    }
    let green = [&volume, &volume];
    let text = refused(&parallel, Beside::Colors(&green)).to_string();
    assert!(text.contains("one volume of numbers"), "{text}");

    // The eye beside the box, light across the view: rays at the rim run along the slices.
    let wide = Shot {
        camera: Camera {
            eye: GRID().center() + dvec3(2.0, -14.0, 0.0),
            target: GRID().center(),
            projection: Projection::Perspective { fov_degrees: 120.0 },
            ..perspective.camera
        },
        ..perspective.with(|s| s.shading = plain(DVec3::X))
    };
    let text = alone(&wide);
    assert!(text.contains("degrees off the normal"), "{text}");

    let small = Caps {
        max_image_dimension_3d: 13,
        ..Caps::UNLIMITED
    };
    let mut renderer = Renderer::new(device_with(small), &volume).unwrap();
    let scene = parallel.scene(&volume, Some(&transfer));
    let error = renderer.render(&scene, &[]).unwrap_err().to_string();
    assert!(error.contains("one texture of the device"), "{error}");

    let blends_halves = Caps {
        float32_blend: false,
        ..Caps::UNLIMITED
    };
    let mut renderer = Renderer::new(device_with(blends_halves), &volume).unwrap();
    let error = renderer.render(&scene, &[]).unwrap_err().to_string();
    assert!(error.contains("blending"), "{error}");

    let mut renderer = Renderer::new(device(), &volume).unwrap();
    for layer in [LayerKind::Depth, LayerKind::Value, LayerKind::Position] {
        let error = renderer.render(&scene, &[layer]).unwrap_err().to_string();
        assert!(error.contains(&format!("{layer:?}")), "{error}");
    }
}

#[test]
fn a_host_records_eye_and_light_into_its_own_commands() {
    let host = Host::new();
    let gpu = host.gpu();
    let mut stage = Stage::new(half_angle());
    stage.settings.shading = plain(ways_to_light(&stage.camera)[1]);
    let there = OnDevice::new(&host, &stage);
    let view = stage.view();
    let slicer = HalfAngleSlicer::new(gpu, &Words::of(&stage.settings, &there.volume)).unwrap();
    let ring = parameter_ring(gpu, 2).unwrap();
    let seen = light_buffer(gpu, view.light_extent()).unwrap();
    let picture = accumulation(gpu, stage.extent, "picture").unwrap();
    let inputs = Inputs {
        beside: &[],
        ring: &ring,
        volume: &there.volume,
        brick: &there.volume.bricks()[0],
        transfer: Some(&there.transfer),
    };
    let bound = slicer.bind(&inputs, &seen).unwrap();
    let format = vk::Format::R32G32B32A32_SFLOAT;
    let resolve = Resolve::new(gpu, Mode::Composite, Blend::Over, format).unwrap();
    let resolved = resolve
        .bind(&ring, &picture, Some(&there.transfer))
        .unwrap();
    let image = HostImage::new(&host, format, stage.extent);

    let recordings = view
        .recordings(&there.volume, Some(&there.transfer))
        .unwrap();
    let [eye, light] = &recordings[..] else {
        panic!("{} recordings", recordings.len());
    };
    let slices = HalfAngleSlices {
        offsets: [eye.write(&ring, 0).unwrap(), light.write(&ring, 1).unwrap()],
        count: eye.slices,
        order: eye.order,
    };
    const DRAWN: [f32; 4] = [0.25, 0.0, 1.0, 1.0];
    // SAFETY: barriers stand between the passes, and all of it lives until `run` has waited.
    host.run(|cmd| unsafe {
        for target in [&picture, &seen] {
            image_barrier(gpu, cmd, target, Use::Nothing, Use::ColorTarget);
        }
        slicer.record(cmd, &bound, slices, (&picture, stage.extent), &seen);
        image_barrier(gpu, cmd, &picture, Use::ColorTarget, Use::FragmentSampled);
        image.make_target(cmd);
        host.begin_rendering(cmd, image.view, stage.extent, DRAWN);
        resolve.record(cmd, &resolved, slices.offsets[0], stage.extent);
        host.device.cmd_end_rendering(cmd);
        image.fetch_drawn(cmd);
    });
    let wanted: Vec<_> = stage.twin().iter().map(|&p| over(p, DRAWN)).collect();
    assert_close(&image, &wanted, slices.count, "half-angle slices of a host");
}
