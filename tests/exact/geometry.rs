//! Opaque geometry in a picture: rays end at it, and it is seen through what lies before it.

use crate::driver_faults::{END_FAULTS, alone, faulty, tell, told};
use crate::shared::{compare, device, ramps, volume_of, waves};
use glam::{DAffine3, DVec3, dvec3};
use std::sync::Arc;
use stratavox::camera::{Camera, Projection};
use stratavox::geometry::{Geometry, RoundCones, Vertex};
use stratavox::gpu::{DeviceChoice, Headless, Options, PipelineCache, Validation};
use stratavox::offscreen::{Renderer, check_geometry, reference};
use stratavox::picture::{ColorSpace, LayerKind};
use stratavox::scene::{Beside, Scene};
use stratavox::technique::splat::Splat;
use stratavox::technique::{ClipPlane, Level, Mode, Settings, Shading, Shadows, Technique};
use stratavox::transfer::{ColorPoint, Interpolation, OpacityPoint, TransferFunction};
use stratavox::volume::Volume;

/// What ends at geometry.
const ENDING: [Technique; 4] = [
    Technique::Raycast,
    Technique::Slices3d,
    Technique::Slices2d,
    Technique::Splat,
];

const SIDE: f64 = 8.0;
const EXTINCTION: f64 = 0.2;
const EXTENT: [u32; 2] = [40, 36];

fn fog() -> (Volume, TransferFunction) {
    let function = TransferFunction {
        color: vec![ColorPoint {
            value: 0.0,
            srgb: [0.2, 0.6, 1.0],
        }],
        opacity: vec![OpacityPoint {
            value: 0.0,
            opacity: -(-EXTINCTION).exp_m1(),
        }],
        reference_length: Some(1.0),
        interpolation: Interpolation::Linear,
        gradient_transfer: None,
        medium: None,
    };
    let volume = volume_of([SIDE as u32; 3], DAffine3::IDENTITY, |_| 1.0);
    (volume, function)
}

/// A tube that sticks out of the box on one side, and a sphere before it.
fn cones() -> Arc<Geometry> {
    let vertex = |place, radius, color| Vertex {
        place,
        radius,
        color,
    };
    let mut cones = RoundCones::default();
    cones.add_line([
        vertex(dvec3(-2.0, 3.0, 4.0), 0.8, [1.0, 0.5, 0.0]),
        vertex(dvec3(6.0, 5.0, 3.0), 0.4, [0.0, 0.5, 1.0]),
    ]);
    cones.add_line([vertex(dvec3(5.0, 2.0, 12.0), 0.7, [0.1, 0.9, 0.2])]);
    Arc::new(cones.into())
}

/// Some 40 slices, each of a few roundings of f32 of numbers up to 1.
const ROUNDED: f64 = 1e-5;

fn cameras() -> [Camera; 2] {
    let of = |projection| Camera {
        eye: dvec3(6.0, 2.0, 22.0),
        target: DVec3::splat(4.0),
        up: DVec3::Y,
        projection,
        zoom: 1.0,
    };
    [
        of(Projection::Orthographic { view_height: 11.0 }),
        of(Projection::Perspective { fov_degrees: 35.0 }),
    ]
}

fn scene<'a>(
    volume: &'a Volume,
    function: &'a TransferFunction,
    camera: &'a Camera,
    settings: &'a Settings,
) -> Scene<'a> {
    Scene {
        volume,
        transfer: Some(function),
        beside: Beside::Nothing,
        camera,
        extent_pixels: EXTENT,
        settings,
    }
}

/// Where the ray enters what planes that face it leave of the box, and where it leaves it.
fn interval(origin: DVec3, direction: DVec3, planes: &[ClipPlane]) -> Option<[f64; 2]> {
    let [a, b] = [0.0, SIDE].map(|side| (DVec3::splat(side) - origin) / direction);
    let (mut enter, leave) = (a.min(b).max_element(), a.max(b).min_element());
    for ClipPlane { normal, offset } in planes {
        assert!(normal.dot(direction) > 0.0);
        enter = enter.max((offset - normal.dot(origin)) / normal.dot(direction));
    }
    (enter < leave).then_some([enter, leave])
}

#[test]
fn fog_before_geometry_is_as_thick_as_it_is_deep() {
    assert_eq!(fog_before_geometry(device, &[], 60), Ok(()));
}

#[test]
fn fog_sees_each_fault_of_the_ends_of_rays() {
    let _alone = alone();
    let options = Options {
        pipeline_cache: PipelineCache::Off,
        validation: Validation::Off,
        ..Options::default()
    };
    let with_fault = || {
        // SAFETY: its functions are Vulkan's, but for shaders that are others.
        let device = unsafe { Headless::through(faulty, &DeviceChoice::Default, &options) };
        device.expect("a device")
    };
    for (what, fault) in END_FAULTS {
        tell(Some(*fault));
        let found = fog_before_geometry(with_fault, &[], 60);
        assert!(told() > 0, "{what}: no shader has it");
        tell(None);
        println!("{what}: {}", found.expect_err(what));
    }
}

#[test]
fn clip_planes_cut_geometry_as_they_cut_the_fog() {
    // Through the tube, at an angle, and before the sphere that is nearer.
    let normal = dvec3(0.4, 0.2, -2.0);
    let offset = normal.dot(dvec3(2.0, 4.0, 3.5));
    let planes = [ClipPlane { normal, offset }];
    assert_eq!(fog_before_geometry(device, &planes, 12), Ok(()));
}

/// Of each slice a pixel has all or nothing: at the tube the fog is as deep as it is to half a slice, at its face too. Slabs
/// are cut where rays are, to the last part of a step.
#[test]
fn slices_before_geometry_are_as_many_as_there_is_room_for() {
    let (volume, function) = fog();
    let geometry = cones();
    let fog_color = function.color[0].srgb.map(stratavox::color::decode_srgb);
    let mut renderer = Renderer::new(device(), &volume).expect("a renderer");
    renderer.set_geometry(Some(Arc::clone(&geometry)));
    for (technique, preintegrated) in [
        (Technique::Slices3d, false),
        (Technique::Slices2d, false),
        (Technique::Slices3d, true),
    ] {
        for camera in cameras() {
            let settings = Settings {
                technique,
                preintegrated,
                color_space: ColorSpace::Linear,
                samples_per_voxel: 2.0,
                ..Settings::default()
            };
            let scene = scene(&volume, &function, &camera, &settings);
            let found = renderer.render(&scene, &[]).expect("a picture").picture;
            let seen = geometry.seen(&camera, EXTENT, [0.0; 2]);
            let rays = camera.rays(EXTENT);
            let forward = camera.frame().forward;
            let mut hidden = 0;
            for (i, found) in found.pixels.iter().enumerate() {
                let [x, y] = [i % EXTENT[0] as usize, i / EXTENT[0] as usize];
                let (origin, direction) = rays.at(x as f64 + 0.5, y as f64 + 0.5);
                let Some([enter, leave]) = interval(origin, direction, &[]) else {
                    continue;
                };
                // The stack is across z here, of one slice a voxel.
                let step = match technique {
                    Technique::Slices3d => 0.5 / direction.dot(forward),
                    _ => 1.0 / direction.z.abs(),
                };
                let length = (leave.min(seen.distances[i]) - enter).max(0.0);
                hidden += usize::from(seen.distances[i] < leave && length > 0.5);
                let off = match preintegrated {
                    true => 1.0 / 1024.0,
                    false => EXTINCTION * step + 1.0 / 1024.0,
                };
                let alpha = 1.0 - (-EXTINCTION * length).exp();
                for c in 0..4 {
                    let own = f64::from(seen.pixels[i][c]);
                    let fog = [fog_color[0], fog_color[1], fog_color[2], 1.0][c];
                    let wanted = alpha * fog + (1.0 - alpha) * own;
                    let error = (f64::from(found[c]) - wanted).abs();
                    // A slice more or less in place of what lies behind it.
                    let change = (fog - own).abs();
                    assert!(
                        error <= off * change + ROUNDED,
                        "{technique:?} {preintegrated}: pixel {i}, channel {c}: {error:e}"
                    );
                }
            }
            assert!(hidden > 60, "{hidden} rays end inside of the fog");
        }
    }
}

#[test]
fn every_technique_ends_at_geometry_where_its_reference_does() {
    let affine = DAffine3::IDENTITY;
    let volume = volume_of([SIDE as u32; 3], affine, waves);
    let function = ramps();
    let geometry = cones();
    let mut renderer = Renderer::new(device(), &volume).expect("a renderer");
    renderer.set_geometry(Some(Arc::clone(&geometry)));
    for camera in cameras() {
        for technique in ENDING {
            for (mode, preintegrated) in [
                (Mode::Composite, false),
                (Mode::Composite, true),
                (Mode::Iso, false),
                (Mode::Mida, false),
                (Mode::Mip, false),
            ] {
                let is_sliced = technique != Technique::Raycast;
                let is_splat = technique == Technique::Splat;
                if is_sliced && !matches!(mode, Mode::Composite | Mode::Mip)
                    || is_splat && preintegrated
                {
                    continue;
                }
                let levels = vec![Level {
                    value: 0.5,
                    srgb: [1.0, 0.8, 0.6],
                    opacity: 0.6,
                }];
                let mut settings = Settings {
                    technique,
                    mode,
                    preintegrated,
                    color_space: ColorSpace::Linear,
                    conformance: true,
                    skip: false,
                    ..Settings::default()
                };
                settings.per_mode.levels = levels;
                let scene = scene(&volume, &function, &camera, &settings);
                let kinds = [LayerKind::Samples];
                let found = renderer.render(&scene, &kinds).expect("a picture").picture;
                let with = Some(&*geometry);
                let double = reference::render_with::<f64>(&scene, with).expect("a picture");
                let single = reference::render_with::<f32>(&scene, with).expect("a picture");
                let all = [&double, &single, &found];
                let what = format!("{technique:?} {mode:?} {preintegrated}");
                let pixels = all.map(|picture| picture.pixels.as_flattened());
                compare(&what, 4 * EXTENT[0], pixels, 1.0);
                let samples = all.map(|picture| {
                    let layers = picture.layers.iter();
                    let mut samples = layers.filter(|layer| layer.kind == LayerKind::Samples);
                    &samples.next().expect("counted").values[..]
                });
                compare(&format!("samples of {what}"), EXTENT[0], samples, 16.0);
                // Splats reach some two voxels beyond the sheets that they are of, a half of this volume.
                if mode != Mode::Mip && !is_splat {
                    let whole = reference::render::<f32>(&scene).expect("a picture");
                    let samples = &samples[1];
                    let layers = whole.layers.iter();
                    let mut of_whole = layers.filter(|layer| layer.kind == LayerKind::Samples);
                    let of_whole = &of_whole.next().expect("counted").values;
                    let fewer = samples.iter().zip(of_whole).filter(|(a, b)| a < b).count();
                    assert!(fewer > 60, "{what}: {fewer} rays end");
                }
            }
        }
    }
}

/// The first pixel that is off, in words.
fn fog_before_geometry(
    device: impl Fn() -> Headless,
    planes: &[ClipPlane],
    least_hidden: usize,
) -> Result<(), String> {
    let (volume, function) = fog();
    let cones = cones();
    let units: Vec<_> = planes
        .iter()
        .map(|plane| {
            let length = plane.normal.length();
            (plane.normal / length, plane.offset / length)
        })
        .collect();
    for camera in cameras() {
        for rays_per_side in [1, 2] {
            let settings = Settings {
                rays_per_side,
                clip_planes: planes.to_vec(),
                color_space: ColorSpace::Linear,
                samples_per_voxel: 4.0,
                ..Settings::default()
            };
            let scene = scene(&volume, &function, &camera, &settings);
            let mut renderer = Renderer::new(device(), &volume).expect("a renderer");
            let fog_alone = renderer.render(&scene, &[]).expect("a picture").picture;
            renderer.set_geometry(Some(Arc::clone(&cones)));
            let found = renderer.render(&scene, &[]).expect("a picture").picture;
            renderer.set_geometry(None);
            let again = renderer.render(&scene, &[]).expect("a picture").picture;
            assert_eq!(again.pixels, fog_alone.pixels, "geometry is gone");

            let rays = camera.rays(EXTENT);
            let [r, g, b] = function.color[0].srgb.map(stratavox::color::decode_srgb);
            let offsets: &[f64] = if rays_per_side == 1 {
                &[0.0]
            } else {
                &[-0.25, 0.25]
            };
            let mut wanted = vec![[0.0_f64; 4]; found.pixels.len()];
            let mut hidden = 0;
            for (dx, dy) in offsets
                .iter()
                .flat_map(|&dy| offsets.iter().map(move |&dx| (dx, dy)))
            {
                let seen = cones.seen_cut(&camera, EXTENT, [dx, dy], &units);
                for (i, wanted) in wanted.iter_mut().enumerate() {
                    let [x, y] = [i % EXTENT[0] as usize, i / EXTENT[0] as usize];
                    let (origin, direction) = rays.at(x as f64 + 0.5 + dx, y as f64 + 0.5 + dy);
                    let [enter, leave] = interval(origin, direction, planes).unwrap_or([0.0; 2]);
                    let length = (leave.min(seen.distances[i]) - enter).max(0.0);
                    hidden += usize::from(seen.distances[i] < leave && length > 0.5);
                    let alpha = 1.0 - (-EXTINCTION * length).exp();
                    for c in 0..4 {
                        let own = f64::from(seen.pixels[i][c]);
                        let color = alpha * [r, g, b, 1.0][c] + (1.0 - alpha) * own;
                        wanted[c] += color / (offsets.len() * offsets.len()) as f64;
                    }
                }
            }
            assert!(hidden > least_hidden, "{hidden} rays end inside of the fog");
            for (i, (found, wanted)) in found.pixels.iter().zip(&wanted).enumerate() {
                for c in 0..4 {
                    // The depth of f32 (22 of 1e-7) and the last part of a step, in fog of at most 1.6 depths.
                    let off = f64::from(found[c]) - wanted[c];
                    if off.abs() >= 1.0 / 1024.0 || off.is_nan() {
                        return Err(format!("pixel {i}, channel {c} is off by {off:.1e}"));
                    }
                }
            }
        }
    }
    Ok(())
}

#[test]
fn over_a_projection_geometry_lies_whole() {
    let (volume, _) = fog();
    let cones = cones();
    let camera = cameras()[0];
    let settings = Settings {
        mode: Mode::Average,
        ..Settings::default()
    };
    let function = {
        let mut function = fog().1;
        function.opacity[0].opacity = 1.0;
        function
    };
    let scene = scene(&volume, &function, &camera, &settings);
    let mut renderer = Renderer::new(device(), &volume).expect("a renderer");
    let alone = renderer.render(&scene, &[]).expect("a picture").picture;
    renderer.set_geometry(Some(Arc::clone(&cones)));
    let found = renderer.render(&scene, &[]).expect("a picture").picture;
    let seen = cones.seen(&camera, EXTENT, [0.0; 2]);
    for (i, own) in seen.pixels.iter().enumerate() {
        let wanted = if own[3] == 1.0 { own } else { &alone.pixels[i] };
        assert_eq!(&found.pixels[i], wanted, "pixel {i}");
    }
}

#[test]
fn the_layer_of_lines_has_the_number_of_the_nearest() {
    let (volume, function) = fog();
    let vertex = |x: f64, y: f64, z: f64| Vertex {
        place: dvec3(x, y, z),
        radius: 0.5,
        color: [1.0; 3],
    };
    let mut cones = RoundCones::default();
    // Across each other, the second before the first; a third without a number lies beside them.
    cones.add_line_of(1, [vertex(0.0, 4.0, 2.0), vertex(8.0, 4.0, 2.0)]);
    cones.add_line_of(7, [vertex(4.0, 0.0, 5.0), vertex(4.0, 8.0, 5.0)]);
    cones.add_line([vertex(0.0, 7.0, 2.0), vertex(2.0, 7.0, 2.0)]);
    let geometry = Arc::new(Geometry::from(cones));
    let camera = Camera {
        eye: dvec3(4.0, 4.0, 20.0),
        ..cameras()[0]
    };
    let is_on = |x: f64, y: f64| match () {
        () if (x - 4.0).abs() < 0.5 && (-0.5..8.5).contains(&y) => 7.0,
        () if (y - 4.0).abs() < 0.5 && (-0.5..8.5).contains(&x) => 1.0,
        () => 0.0,
    };
    let mut renderer = Renderer::new(device(), &volume).expect("a renderer");
    for technique in [Technique::Raycast, Technique::Slices3d] {
        for mode in [Mode::Composite, Mode::Mip] {
            let settings = Settings {
                technique,
                mode,
                ..Settings::default()
            };
            let scene = scene(&volume, &function, &camera, &settings);
            let kinds = [LayerKind::Line, LayerKind::Samples];
            renderer.set_geometry(None);
            let said = renderer.render(&scene, &kinds).expect_err("no lines");
            assert!(said.to_string().contains("`line`"), "{said}");
            renderer.set_geometry(Some(Arc::clone(&geometry)));
            let found = renderer.render(&scene, &kinds).expect("a picture").picture;
            let on_cpu = reference::render_with::<f32>(&scene, Some(&geometry));
            let on_cpu = on_cpu.expect("a picture").layers;
            let on_cpu = on_cpu.iter().find(|layer| layer.kind == LayerKind::Line);
            assert_eq!(on_cpu, found.layers.first());
            assert_eq!(found.layers[1].kind, LayerKind::Samples);
            let rays = camera.rays(EXTENT);
            let mut told = 0;
            for (i, &line) in found.layers[0].values.iter().enumerate() {
                let [x, y] = [i % EXTENT[0] as usize, i / EXTENT[0] as usize];
                let (origin, _) = rays.at(x as f64 + 0.5, y as f64 + 0.5);
                // Round ends are in their corners alone.
                let is_end = |n: f64| !(0.0..8.0).contains(&n);
                if is_end(origin.x) || is_end(origin.y) {
                    continue;
                }
                assert_eq!(line, is_on(origin.x, origin.y), "pixel {i}");
                told += usize::from(line > 0.0);
            }
            assert!(told > 100, "{told}");
        }
    }
}

/// In fog of an even value the volume's own hit is where half of the light is left, ln 2 / extinction behind the face.
#[test]
fn layers_of_places_have_the_nearer_of_volume_and_geometry() {
    let (volume, function) = fog();
    let settings = Settings::default();
    let kinds = [LayerKind::Depth, LayerKind::Position];
    let geometry = cones();
    let mut renderer = Renderer::new(device(), &volume).expect("a renderer");
    renderer.set_geometry(Some(Arc::clone(&geometry)));
    let half = std::f64::consts::LN_2 / EXTINCTION;
    for camera in cameras() {
        let scene = scene(&volume, &function, &camera, &settings);
        let found = renderer.render(&scene, &kinds).expect("a picture").picture;
        let seen = geometry.seen(&camera, EXTENT, [0.0; 2]);
        let on_cpu = reference::render_with::<f64>(&scene, Some(&geometry)).expect("a picture");
        let rays = camera.rays(EXTENT);
        // Of geometry, of fog before geometry, of fog alone, of nothing.
        let mut told = [0_u32; 4];
        for (i, &distance) in seen.distances.iter().enumerate() {
            let [x, y] = [i % EXTENT[0] as usize, i / EXTENT[0] as usize].map(|n| n as f64 + 0.5);
            let (origin, direction) = rays.at(x, y);
            let hit = interval(origin, direction, &[])
                .filter(|[from, to]| to - from > half)
                .map(|[from, _]| from + half);
            let depth = f64::from(found.layers[0].values[i]);
            let step = 1.0;
            let is_near = |wanted: f64| (depth - wanted).abs() <= step;
            let is_close = |wanted: f64| (depth - wanted).abs() <= 1e-6 * wanted.max(1.0);
            // Where the fog's hit falls within a step of something else either may be told.
            let is_open = hit.is_some_and(|hit| (hit - distance).abs() <= step)
                || interval(origin, direction, &[])
                    .is_some_and(|[from, to]| (to - from - half).abs() <= step);
            if !is_open {
                let case = match hit {
                    Some(hit) if hit < distance => {
                        assert!(is_near(hit), "pixel {i}: {depth} for the fog's {hit}");
                        1 + usize::from(distance.is_infinite())
                    }
                    _ if distance.is_finite() => {
                        assert!(is_close(distance), "pixel {i}: {depth} for {distance}");
                        0
                    }
                    _ => {
                        assert!(depth.is_nan(), "pixel {i}: {depth} for nothing");
                        3
                    }
                };
                told[case] += 1;
            }
            let place = DVec3::from_slice(
                &found.layers[1].values[3 * i..3 * i + 3]
                    .iter()
                    .map(|&n| f64::from(n))
                    .collect::<Vec<_>>(),
            );
            let wanted = origin + depth * direction;
            assert!(
                depth.is_nan() && place.is_nan() || (place - wanted).length() <= 1e-5,
                "pixel {i}: {place} for {wanted}"
            );
            let of_cpu = on_cpu
                .layers
                .iter()
                .find(|layer| layer.kind == LayerKind::Depth);
            let of_cpu = f64::from(of_cpu.expect("depths").values[i]);
            assert!(
                is_open || is_near(of_cpu) || depth.is_nan() && of_cpu.is_nan(),
                "pixel {i}: {depth}, and {of_cpu} on the CPU"
            );
        }
        assert!(told.iter().all(|&of| of > 10), "{told:?}");
    }
}

#[test]
fn what_cannot_show_geometry_says_so() {
    let of = |technique| Settings {
        technique,
        ..Settings::default()
    };
    let of_points = Settings {
        splat: Splat::of_points(),
        ..of(Technique::Splat)
    };
    let half_angle = Settings {
        shading: Some(Shading {
            shadows: Shadows::HalfAngle,
            ..Shading::default()
        }),
        ..of(Technique::Slices3d)
    };
    let uneven = Settings {
        uneven_rays: true,
        ..Settings::default()
    };
    for settings in [
        of(Technique::ShearWarp),
        of(Technique::Pathtrace),
        of_points,
        half_angle,
        uneven,
    ] {
        let said = check_geometry(&settings).expect_err("refused").to_string();
        assert!(said.contains("geometry"), "{said}");
    }
    for technique in ENDING {
        assert!(check_geometry(&of(technique)).is_ok(), "{technique:?}");
    }
}
