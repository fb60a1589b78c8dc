//! What a picture leaves out, makes faint and names: labels that are dimmed, the layer of labels, and faces of cuts.

use crate::shared::{
    PictureCase, Worst, compare, device, oblique_shots, ramps, sheared_affine, straight_shots,
    volume_of, waves,
};
use glam::{DAffine3, DVec3, dvec3};
use stratavox::camera::{Camera, Projection};
use stratavox::offscreen::{self, Renderer, reference};
use stratavox::picture::{ColorSpace, LayerKind, Picture};
use stratavox::scene::{Beside, Channel, Scene};
use stratavox::technique::{
    ClipPlane, CutFaces, Filter, Lattice, Mode, Role, Settings, Shading, Technique,
};
use stratavox::transfer::{
    Classified, ColorPoint, Interpolation, OpacityPoint, TransferFunction, Window,
};
use stratavox::volume::{Grid, Volume, labels::dim};

const GRID: fn() -> Grid = || Grid {
    dims: [17, 21, 13],
    world_from_voxel: sheared_affine(),
};
const CUBE: Grid = Grid {
    dims: [12, 12, 12],
    world_from_voxel: DAffine3::IDENTITY,
};

/// One colour, and the opacity per world length 1 of an extinction.
fn fog(srgb: [f64; 3], extinction: f64) -> TransferFunction {
    TransferFunction {
        color: vec![ColorPoint { value: 0.0, srgb }],
        opacity: vec![OpacityPoint {
            value: 0.0,
            opacity: -(-extinction).exp_m1(),
        }],
        reference_length: Some(1.0),
        interpolation: Interpolation::Linear,
        gradient_transfer: None,
        medium: None,
    }
}

fn labels_beside<'a>(map: &'a Volume, transfer: &'a TransferFunction) -> Channel<'a> {
    Channel {
        volume: map,
        transfer: Some(transfer),
        role: Role::Labels,
    }
}

fn layer(picture: &Picture, kind: LayerKind) -> Vec<f32> {
    let layer = picture.layers.iter().find(|layer| layer.kind == kind);
    layer.expect("the layer").values.clone()
}

#[test]
fn a_fog_that_is_dimmed_is_one_of_less_extinction_and_a_greyer_colour() {
    let volume = volume_of(GRID().dims, sheared_affine(), |_| 1.0);
    let (srgb, extinction, share) = ([1.0, 0.25, 0.0], 0.08, 0.3);
    let (shown, nothing) = (fog(srgb, extinction), fog([0.0; 3], 0.0));
    // Half of the labels of each row are dimmed, or all of them.
    let mut all = volume_of(GRID().dims, sheared_affine(), |_| 3.0);
    dim(&mut all, |label| label == 3);
    let none = volume_of(GRID().dims, sheared_affine(), |_| 3.0);
    let grey = 0.2126 * srgb[0] + 0.7152 * srgb[1] + 0.0722 * srgb[2];
    let faint = srgb.map(|c| grey + share * (c - grey));
    let wanted = fog(faint, share * extinction);
    let mut plain = Renderer::new(device(), &volume).unwrap();
    let mut dimmed = Renderer::several(device(), vec![&volume, &all]).unwrap();
    let mut kept = Renderer::several(device(), vec![&volume, &none]).unwrap();
    for shot in oblique_shots(GRID(), Mode::Composite) {
        let shot = shot.with(|settings| {
            settings.color_space = ColorSpace::Display;
            settings.dim = share;
        });
        let shot = PictureCase {
            extent: [20, 18],
            ..shot
        };
        let channels = [labels_beside(&all, &nothing)];
        let scene = Scene {
            beside: Beside::Channels(&channels),
            ..shot.scene(&volume, Some(&shown))
        };
        let fog = shot.scene(&volume, Some(&wanted));
        let answer = plain.render(&fog, &[]).unwrap().picture;
        let found = [
            dimmed.render(&scene, &[]).unwrap().picture,
            reference::render::<f32>(&scene).unwrap(),
        ];
        for picture in found {
            let mut worst = Worst::new(format!("dimmed fog, {}", shot.what()));
            let pairs = answer.pixels.iter().zip(&picture.pixels);
            for (pixel, (wanted, found)) in shot.pixels().zip(pairs) {
                for c in 0..4 {
                    // A hundred segments, each rounded a few times in f32.
                    worst.take(pixel, f64::from(wanted[c]) - f64::from(found[c]), 1e-5);
                }
            }
            worst.assert_holds();
        }
        let channels = [labels_beside(&none, &nothing)];
        let scene = Scene {
            beside: Beside::Channels(&channels),
            ..shot.scene(&volume, Some(&shown))
        };
        let found = kept.render(&scene, &[]).unwrap().picture;
        let brightest = |p: &Picture| p.pixels.iter().fold(0.0, |most: f32, p| most.max(p[3]));
        assert!(
            brightest(&found) > 2.0 * brightest(&answer),
            "what no word dims is as opaque as before"
        );
    }
}

/// Labels 5 in the lower half of x and 9 in the other, no label (0) before z = 4 and behind z = 8.
fn two_halves() -> Volume {
    let label = |p: glam::DVec3| match (p.z > 4.0 && p.z < 8.0, p.x < 6.0) {
        (false, _) => 0.0,
        (true, true) => 5.0,
        (true, false) => 9.0,
    };
    volume_of(CUBE.dims, CUBE.world_from_voxel, label)
}

/// Opaque from a value of 1 on.
fn opaque_names() -> TransferFunction {
    TransferFunction {
        color: vec![ColorPoint {
            value: 0.0,
            srgb: [1.0; 3],
        }],
        opacity: [(-0.5, 0.0), (0.5, 1.0)]
            .map(|(value, opacity)| OpacityPoint { value, opacity })
            .into(),
        reference_length: None,
        interpolation: Interpolation::Step,
        gradient_transfer: None,
        medium: None,
    }
}

#[test]
fn the_layer_of_labels_names_what_is_hit_first() {
    let map = two_halves();
    let names = opaque_names();
    let volume = volume_of(CUBE.dims, CUBE.world_from_voxel, |p| p.z);
    // Seen from below: opaque in the upper half of z alone, where the labels are.
    let shown = TransferFunction {
        opacity: [(0.0, 0.0), (6.25, 1.0)]
            .map(|(value, opacity)| OpacityPoint { value, opacity })
            .into(),
        ..opaque_names()
    };
    let nothing = fog([0.0; 3], 0.0);
    let channels = [labels_beside(&map, &nothing)];
    let mut alone = Renderer::new(device(), &map).unwrap();
    let mut over = Renderer::several(device(), vec![&volume, &map]).unwrap();
    for shot in straight_shots(CUBE, Mode::Composite) {
        let shot = shot.with(|settings| {
            settings.filter = Filter::Nearest;
            // A row of pixels that sees nothing.
            settings.crop = Some([dvec3(0.0, 1.0, 0.0), dvec3(12.0, 12.0, 12.0)]);
        });
        let scenes = [
            (shot.scene(&map, Some(&names)), &mut alone),
            (
                Scene {
                    beside: Beside::Channels(&channels),
                    ..shot.scene(&volume, Some(&shown))
                },
                &mut over,
            ),
        ];
        for (scene, renderer) in scenes {
            let found = renderer.render(&scene, &[LayerKind::Label]);
            if shot.settings.technique != Technique::Raycast {
                let problem = found.unwrap_err().to_string();
                assert!(problem.contains("label"), "{problem}");
                continue;
            }
            let device = layer(&found.unwrap().picture, LayerKind::Label);
            let reference = layer(&reference::render::<f32>(&scene).unwrap(), LayerKind::Label);
            let positions = renderer
                .render(&scene, &[LayerKind::Position])
                .unwrap()
                .picture;
            let positions = layer(&positions, LayerKind::Position);
            for (i, pixel) in shot.pixels().enumerate() {
                let wanted = match positions[3 * i] {
                    x if x.is_nan() => f32::NAN,
                    x if x < 6.0 => 5.0,
                    _ => 9.0,
                };
                for found in [device[i], reference[i]] {
                    let is_same = found == wanted || (found.is_nan() && wanted.is_nan());
                    assert!(is_same, "{pixel:?}: {found}, wanted {wanted}");
                }
            }
            let count = |label: f32| device.iter().filter(|&&found| found == label).count();
            assert_eq!([count(5.0), count(9.0)], [66, 66], "{}", shot.what());
            assert_eq!(device.iter().filter(|found| found.is_nan()).count(), 12);
        }
    }
}

#[test]
fn a_picture_without_labels_has_no_layer_of_them() {
    let map = two_halves();
    let names = opaque_names();
    let shots = straight_shots(CUBE, Mode::Composite);
    let shot = shots.into_iter().find(|shot| {
        shot.settings.technique == Technique::Raycast && shot.settings.lattice == Lattice::Ray
    });
    let shot = shot
        .unwrap()
        .with(|settings| settings.filter = Filter::Linear);
    let scene = shot.scene(&map, Some(&names));
    let mut renderer = Renderer::new(device(), &map).unwrap();
    let mixed = renderer.render(&scene, &[LayerKind::Label]).unwrap_err();
    assert!(matches!(mixed, offscreen::Error::NoLabels), "{mixed}");
    let nearest = shot.with(|settings| {
        settings.filter = Filter::Nearest;
        settings.mode = Mode::Average;
    });
    let scene = nearest.scene(&map, Some(&names));
    let projected = renderer.render(&scene, &[LayerKind::Label]).unwrap_err();
    assert!(projected.to_string().contains("average"), "{projected}");
}

/// Rays along both lattices, and jittered ones.
fn ray_shots(grid: Grid) -> Vec<PictureCase> {
    let all = oblique_shots(grid, Mode::Composite).into_iter();
    let on_rays = all.filter(|shot| shot.settings.technique == Technique::Raycast);
    on_rays
        .flat_map(|shot| {
            let jittered = shot.with(|settings| settings.lattice = Lattice::Jitter);
            match shot.settings.lattice {
                Lattice::Ray => vec![shot, jittered],
                _ => vec![shot],
            }
        })
        .map(|shot| PictureCase {
            extent: [28, 24],
            ..shot
        })
        .collect()
}

/// A crop box with three faces inside of the grid, and a plane that is oblique to everything.
fn cut(settings: &mut Settings) {
    settings.crop = Some([dvec3(0.0, 5.0, 0.0), dvec3(14.5, 21.0, 10.0)]);
    settings.clip_planes = vec![ClipPlane {
        normal: dvec3(-1.0, -0.4, 0.3),
        offset: -GRID().center().dot(dvec3(1.0, 0.4, -0.3)) - 1.0,
    }];
    settings.cut_faces = Some(CutFaces::Own);
}

#[test]
fn a_cut_face_has_the_colour_of_what_lies_there_and_its_depth() {
    // The field is x: what a pixel shows says where its ray has met the face.
    let volume = volume_of(CUBE.dims, CUBE.world_from_voxel, |p| p.x);
    let transfer = TransferFunction {
        color: [(0.0, [0.0, 1.0, 0.25]), (12.0, [1.0, 0.0, 0.25])]
            .map(|(value, srgb)| ColorPoint { value, srgb })
            .into(),
        // Hardly anything, and nothing under 3.
        opacity: [(3.0, 0.0), (3.0, 0.001)]
            .map(|(value, opacity)| OpacityPoint { value, opacity })
            .into(),
        reference_length: None,
        interpolation: Interpolation::Linear,
        gradient_transfer: None,
        medium: None,
    };
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    for preintegrated in [false, true] {
        for shot in ray_shots(CUBE).into_iter().take(3) {
            let shot = shot.with(|settings| {
                settings.preintegrated = preintegrated;
                settings.color_space = ColorSpace::Display;
                // All but the face that looks at the eye is grid.
                settings.crop = Some([DVec3::ZERO, dvec3(12.0, 12.0, 8.0)]);
                settings.cut_faces = Some(CutFaces::Own);
                settings.shading =
                    (!preintegrated && settings.lattice != Lattice::Jitter).then(Shading::default);
            });
            let scene = shot.scene(&volume, Some(&transfer));
            let found = renderer.render(&scene, &[LayerKind::Depth]).unwrap();
            let depths = layer(&found.picture, LayerKind::Depth);
            let rays = shot.camera.rays(shot.extent);
            let mut worst = Worst::new(format!("face, {preintegrated}, {}", shot.what()));
            let mut seen = 0;
            for (i, [x, y]) in shot.pixels().enumerate() {
                let (origin, direction) = rays.at(f64::from(x) + 0.5, f64::from(y) + 0.5);
                let t = (8.0 - origin.z) / direction.z;
                let place = origin + t * direction;
                let pixel = found.picture.pixels[i];
                let margin = 1e-3;
                let inside = |x: f64| (0.5 + margin..11.5 - margin).contains(&x);
                if direction.z > 0.0 || !inside(place.x) || !inside(place.y) {
                    continue;
                }
                if place.x < 3.0 - margin {
                    // Transparent there: what lies behind is seen, or nothing.
                    assert!(pixel[3] < 0.1, "{pixel:?}");
                    continue;
                }
                if place.x < 3.0 + 2.0 * margin {
                    continue;
                }
                seen += 1;
                let share = place.x / 12.0;
                let wanted = [share, 1.0 - share, 0.25, 1.0];
                for c in 0..4 {
                    // A table is within 1/4096 of the specification, and where a ray lies f32 says to 1e-5 here.
                    let allowed = if c < 2 { 1.0 / 4096.0 + 1e-5 } else { 1e-6 };
                    worst.take([x, y], f64::from(pixel[c]) - wanted[c], allowed);
                }
                worst.take([x, y], f64::from(depths[i]) - t, 5e-5);
            }
            worst.assert_holds();
            assert!(seen > 30, "{seen} pixels of the face, {}", shot.what());
        }
    }
}

#[test]
fn a_face_in_greys_is_the_section_through_the_same_plane() {
    let volume = volume_of(GRID().dims, sheared_affine(), waves);
    let window = [0.1, 0.9];
    let grey = Window::new(window[0], window[1]).unwrap();
    let section = grey.grey(Classified::Projection);
    let normal = dvec3(0.3, -0.5, 0.8).normalize();
    let center = GRID().center();
    let camera = Camera {
        eye: center + 60.0 * normal,
        target: center,
        up: DVec3::Y,
        projection: Projection::Orthographic { view_height: 30.0 },
        zoom: 1.0,
    };
    let plane = |normal: DVec3, thickness: f64| ClipPlane {
        normal,
        offset: normal.dot(center) - 0.5 * thickness,
    };
    let thinnest = 0.01 * GRID().smallest_spacing();
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    for filter in [Filter::Linear, Filter::Cubic] {
        let shot = |mode, clip_planes, cut_faces| PictureCase {
            grid: GRID(),
            camera,
            extent: [48, 40],
            settings: Settings {
                mode,
                filter,
                clip_planes,
                cut_faces,
                conformance: true,
                ..Settings::default()
            },
        };
        let thin = vec![plane(normal, thinnest), plane(-normal, thinnest)];
        let cut = shot(Mode::Average, thin, None);
        let wanted = cut.scene(&volume, Some(&section));
        let wanted = renderer.render(&wanted, &[]).unwrap().picture;
        // Nothing but the face: no opacity anywhere, as the other colours do not count.
        let half = vec![plane(-normal, 0.0)];
        let faced = shot(Mode::Composite, half, Some(CutFaces::Grey(window)));
        let nothing = fog([1.0, 0.0, 0.0], 0.0);
        let scene = faced.scene(&volume, Some(&nothing));
        let found = [
            renderer.render(&scene, &[]).unwrap().picture,
            reference::render::<f32>(&scene).unwrap(),
        ];
        for found in found {
            let mut worst = Worst::new(format!("face and section, {filter:?}"));
            let mut seen = 0;
            for (i, pixel) in faced.pixels().enumerate() {
                let (wanted, found) = (wanted.pixels[i], found.pixels[i]);
                let is_open = wanted[0] < 1e-4;
                let is_edge = wanted[3] != 1.0;
                if is_open || is_edge {
                    continue;
                }
                seen += 1;
                assert_eq!(found[3], 1.0, "{pixel:?}");
                for c in 0..3 {
                    // Both places are known to some 1e-5 (f32, 60 away from the eye); the waves rise by at most 1 a
                    // world length, the window by 1.25 a value, light by 2.3 a grey.
                    let allowed = 2.0 * 1e-5 * 1.25 * 2.3 + 2e-6;
                    worst.take(pixel, f64::from(wanted[c]) - f64::from(found[c]), allowed);
                }
            }
            worst.assert_holds();
            assert!(seen > 200, "{seen} pixels");
        }
    }
}

#[test]
fn cut_faces_are_drawn_as_their_reference_computes_them() {
    let volume = volume_of(GRID().dims, sheared_affine(), waves);
    let (second, names) = (volume_of(GRID().dims, sheared_affine(), |p| p.x), ramps());
    let mut holes = volume_of(GRID().dims, sheared_affine(), waves);
    let mask = (0..holes.voxels.len()).map(|i| u8::from(!i.is_multiple_of(17)));
    holes.validity = Some(mask.collect());
    let channels = [Channel {
        volume: &second,
        transfer: Some(&names),
        role: Role::Numbers,
    }];
    let colors = [&volume, &volume, &second];
    let transfer = ramps();
    let ways = [Some(CutFaces::Own), Some(CutFaces::Grey([0.3, 0.8]))];
    for (shown, beside) in [
        (&volume, Beside::Nothing),
        (&holes, Beside::Nothing),
        (&holes, Beside::Channels(&channels)),
        (&volume, Beside::Colors(&colors)),
    ] {
        let others = beside.volumes();
        let volumes = [shown].into_iter().chain(others).collect();
        let mut renderer = Renderer::several(device(), volumes).unwrap();
        let is_alone = matches!(beside, Beside::Nothing);
        for (nth, shot) in ray_shots(GRID()).into_iter().enumerate() {
            let is_jittered = shot.settings.lattice == Lattice::Jitter;
            if is_jittered && !is_alone {
                continue;
            }
            let shot = shot.with(|settings| {
                cut(settings);
                settings.cut_faces = ways[nth % 2];
                settings.preintegrated = is_alone && nth >= 4;
                settings.shading = (is_alone && !is_jittered && nth < 4).then(Shading::default);
            });
            let scene = Scene {
                beside,
                ..shot.scene(shown, Some(&transfer))
            };
            let all = [
                reference::render::<f64>(&scene).unwrap(),
                reference::render::<f32>(&scene).unwrap(),
                renderer.render(&scene, &[]).unwrap().picture,
            ];
            let opaque = all[2].pixels.iter().filter(|p| p[3] == 1.0).count();
            let what = format!("faces, {nth}, {}", shot.what());
            assert!(opaque > 20, "{what}: {opaque} pixels of faces");
            let lists = all.each_ref().map(|p| p.pixels.as_flattened());
            compare(&what, 4 * all[0].width, lists, 1.0);
        }
    }
}

#[test]
fn where_a_face_shows_nothing_the_picture_stays_as_it_is() {
    // Nothing lies outside of a ball that no cut reaches.
    let far = GRID().far_corner() / 2.0;
    let volume = volume_of(GRID().dims, sheared_affine(), |p| {
        if p.distance(far) < 4.0 {
            waves(p).max(0.5)
        } else {
            0.0
        }
    });
    let mut transfer = ramps();
    transfer.opacity.insert(
        0,
        OpacityPoint {
            value: 0.0,
            opacity: 0.0,
        },
    );
    transfer.opacity[1] = OpacityPoint {
        value: 0.1,
        opacity: 0.0,
    };
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    let inside = Camera {
        eye: GRID().center(),
        target: GRID().center() + DVec3::X,
        up: DVec3::Z,
        projection: Projection::Perspective { fov_degrees: 90.0 },
        zoom: 1.0,
    };
    for shot in ray_shots(GRID()) {
        for camera in [shot.camera, inside] {
            let shot = PictureCase {
                camera,
                ..shot.with(|settings| {
                    settings.crop = Some([DVec3::splat(1.25), GRID().far_corner() - 1.25]);
                })
            };
            let faced = shot.with(|settings| settings.cut_faces = Some(CutFaces::Own));
            let [without, with] = [&shot, &faced].map(|shot| {
                let scene = shot.scene(&volume, Some(&transfer));
                renderer.render(&scene, &[]).unwrap().picture
            });
            assert!(without.pixels.iter().any(|pixel| pixel[3] > 0.1));
            assert!(without.pixels == with.pixels, "{}", shot.what());
        }
    }
}

#[test]
fn faces_are_refused_by_name_where_there_are_none() {
    let volume = volume_of(CUBE.dims, CUBE.world_from_voxel, |p| p.x);
    let transfer = ramps();
    for (technique, mode) in [
        (Technique::Slices2d, Mode::Composite),
        (Technique::Raycast, Mode::Mip),
        (Technique::Raycast, Mode::Mida),
    ] {
        let settings = Settings {
            technique,
            mode,
            cut_faces: Some(CutFaces::Own),
            ..Settings::default()
        };
        let shot = oblique_shots(CUBE, mode).swap_remove(0);
        let shot = PictureCase { settings, ..shot };
        let scene = shot.scene(&volume, Some(&transfer));
        let problem = reference::render::<f32>(&scene).unwrap_err().to_string();
        assert!(problem.contains("opaque cut face"), "{problem}");
    }
    let shot = oblique_shots(CUBE, Mode::Composite).swap_remove(0);
    let shot = shot.with(|settings| settings.cut_faces = Some(CutFaces::Grey([2.0, 2.0])));
    let scene = shot.scene(&volume, Some(&transfer));
    let problem = reference::render::<f32>(&scene).unwrap_err().to_string();
    assert!(problem.contains("window of cut faces"), "{problem}");
}

#[test]
fn the_length_of_a_planes_normal_does_not_count() {
    let volume = volume_of(GRID().dims, sheared_affine(), waves);
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    let transfer = ramps();
    let normal = dvec3(0.75, -0.5, 0.25);
    let offset = normal.dot(GRID().center()) - 1.0;
    let mut picture = |scale: Option<f64>| {
        let shot = oblique_shots(GRID(), Mode::Composite)[0].with(|settings| {
            let plane = |scale: f64| ClipPlane {
                normal: scale * normal,
                offset: scale * offset,
            };
            settings.clip_planes = scale.map(plane).into_iter().collect();
        });
        let scene = shot.scene(&volume, Some(&transfer));
        renderer.render(&scene, &[]).unwrap().picture.pixels
    };
    let [whole, cut] = [None, Some(1.0)].map(&mut picture);
    assert!(whole != cut, "the plane cuts");
    for power in [-600, -66, 66, 126] {
        assert!(picture(Some(2f64.powi(power))) == cut, "2^{power}");
    }
}
