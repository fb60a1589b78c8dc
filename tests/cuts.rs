//! What a picture leaves out, makes faint and names: labels that are dimmed, and the layer of labels.

mod shared;

use glam::{DAffine3, dvec3};
use shared::{Shot, Worst, device, oblique_shots, sheared_affine, straight_shots, volume_of};
use stratavox::offscreen::{self, Renderer, reference};
use stratavox::picture::{ColorSpace, LayerKind, Picture};
use stratavox::scene::{Beside, Channel, Scene};
use stratavox::technique::{Filter, Lattice, Mode, Role, Technique};
use stratavox::transfer::{ColorPoint, Interpolation, OpacityPoint, TransferFunction};
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
        graded: None,
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
        let shot = Shot {
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
        graded: None,
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
                assert!(problem.contains("Label"), "{problem}");
                continue;
            }
            let device = layer(&found.unwrap().picture, LayerKind::Label);
            let twin = layer(&reference::render::<f32>(&scene).unwrap(), LayerKind::Label);
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
                for found in [device[i], twin[i]] {
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
    assert!(projected.to_string().contains("Average"), "{projected}");
}
