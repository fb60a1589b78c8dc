//! Opaque geometry in a picture: rays end at it, and it is seen through what lies before it.

use crate::shared::{device, volume_of};
use glam::{DAffine3, DVec3, dvec3};
use std::sync::Arc;
use stratavox::camera::{Camera, Projection};
use stratavox::geometry::{Geometry, RoundCones, Vertex};
use stratavox::offscreen::{Renderer, check_geometry};
use stratavox::picture::ColorSpace;
use stratavox::scene::{Beside, Scene};
use stratavox::technique::{ClipPlane, Mode, Settings, Technique};
use stratavox::transfer::{ColorPoint, Interpolation, OpacityPoint, TransferFunction};
use stratavox::volume::Volume;

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
    assert_fog_before_geometry(&[], 60);
}

#[test]
fn clip_planes_cut_geometry_as_they_cut_the_fog() {
    // Through the tube, at an angle, and before the sphere that is nearer.
    let normal = dvec3(0.4, 0.2, -2.0);
    let offset = normal.dot(dvec3(2.0, 4.0, 3.5));
    assert_fog_before_geometry(&[ClipPlane { normal, offset }], 12);
}

fn assert_fog_before_geometry(planes: &[ClipPlane], least_hidden: usize) {
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
            let scene = Scene {
                volume: &volume,
                transfer: Some(&function),
                beside: Beside::Nothing,
                camera: &camera,
                extent_pixels: EXTENT,
                settings: &settings,
            };
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
                    assert!(off.abs() < 1.0 / 1024.0, "pixel {i}, channel {c}: {off:e}");
                }
            }
        }
    }
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
    let scene = Scene {
        volume: &volume,
        transfer: Some(&function),
        beside: Beside::Nothing,
        camera: &camera,
        extent_pixels: EXTENT,
        settings: &settings,
    };
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
fn what_cannot_show_geometry_says_so() {
    for (technique, uneven_rays) in [
        (Technique::Slices3d, false),
        (Technique::ShearWarp, false),
        (Technique::Splat, false),
        (Technique::Pathtrace, false),
        (Technique::Raycast, true),
    ] {
        let settings = Settings {
            technique,
            uneven_rays,
            ..Settings::default()
        };
        let said = check_geometry(&settings).expect_err("refused").to_string();
        assert!(said.contains("geometry"), "{said}");
    }
    assert!(check_geometry(&Settings::default()).is_ok());
}
