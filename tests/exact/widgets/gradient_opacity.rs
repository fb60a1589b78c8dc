//! A function that weighs by gradients has a program of its own; one widget of no opacity makes it the general one.

use super::*;
use crate::shared::new_device;
use stratavox::gpu::Gpu;
use stratavox::volume::Voxels;

/// Codes of 8 bits, of 16, and floats, which devices filter in different ways; the first has a hole.
fn volumes() -> [Volume; 3] {
    let floats = volume_of([15, 13, 11], sheared_affine(), |p| 20.0 + 8.0 * waves(p));
    let of = |voxels, fill| {
        Volume::from_voxels(
            floats.dims,
            floats.world_from_voxel,
            voxels,
            floats.rescale,
            fill,
        )
    };
    let Voxels::F32(values) = &floats.voxels else {
        panic!("floats");
    };
    let mut bytes: Vec<u8> = values.iter().map(|&v| (4.0 * v) as u8).collect();
    bytes[1200] = 255;
    let words = values.iter().map(|&v| (40.0 * v) as u16).collect();
    let made = [
        of(Voxels::U8(bytes), Some(255.0)),
        of(Voxels::U16(words), None),
    ];
    let [bytes, words] = made.map(|volume| volume.expect("a volume"));
    [bytes, words, floats]
}

/// What steep values are, by a third of the range over a voxel.
fn weighing(volume: &Volume) -> TransferFunction {
    let [low, high] = volume.value_range;
    let steepest = (high - low) / 3.0 / volume.grid().smallest_spacing();
    TransferFunction {
        opacity: points(&[(low, 0.0), (low + 0.2 * (high - low), 0.1), (high, 0.6)]),
        color: vec![
            ColorPoint {
                value: low,
                srgb: [1.0, 0.4, 0.1],
            },
            ColorPoint {
                value: high,
                srgb: [0.2, 0.5, 1.0],
            },
        ],
        ..only(GradientTransfer {
            steepest: Some(steepest),
            share: points(&[(0.05, 0.0), (0.2, 0.3), (0.6, 1.0)]),
            widgets: Vec::new(),
        })
    }
}

#[test]
fn pictures_of_the_program_for_weights_are_those_of_the_general_one() {
    for volume in volumes() {
        let weighing = weighing(&volume);
        let mut general = weighing.clone();
        let nothing = widget(
            0.0,
            Shape::Rectangle {
                values: [0.0, 1e6],
                gradients: [0.0, 1e6],
            },
        );
        general
            .gradient_transfer
            .as_mut()
            .expect("gradient_transfer")
            .widgets = vec![nothing];
        let mut even = weighing.clone();
        even.gradient_transfer = None;
        for filter in [Filter::Linear, Filter::Nearest] {
            for shading in [None, Some(Shading::default())] {
                let camera = oblique_shots(volume.grid(), Mode::Composite)[0].camera;
                let settings = Settings {
                    filter,
                    shading: shading.clone(),
                    ..Settings::default()
                };
                let mut renderer = Renderer::new(new_device(), &volume).unwrap();
                let mut drawn = |function: &TransferFunction| {
                    let scene = Scene {
                        beside: Default::default(),
                        volume: &volume,
                        transfer: Some(function),
                        camera: &camera,
                        extent_pixels: [41, 33],
                        settings: &settings,
                    };
                    let made = |gpu: &Gpu| gpu.pipelines_made();
                    let before = made(renderer.device().gpu());
                    let picture = renderer.render(&scene, &[]).unwrap().picture;
                    (picture.pixels, made(renderer.device().gpu()) - before)
                };
                let (found, _) = drawn(&weighing);
                let (wanted, programs) = drawn(&general);
                assert!(programs > 0, "both are one program");
                let (even, _) = drawn(&even);
                let far = |other: &[[f32; 4]]| {
                    let apart = found.iter().flatten().zip(other.iter().flatten());
                    apart.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
                };
                let what = format!(
                    "{:?} {filter:?}, light {}",
                    volume.voxels.voxel_type(),
                    shading.is_some()
                );
                // The general one makes a mean of one colour: a few roundings of f32 a sample.
                assert!(far(&wanted) < 1e-5, "{what}: {} apart", far(&wanted));
                assert!(far(&even) > 0.1, "{what}: weights make no difference");
            }
        }
    }
}
