//! Steps that adapt: no channel is farther from the picture of all samples than was asked for, and where values look
//! alike there are fewer samples.

use crate::shared::{device, device_with, sheared_affine, volume_of};
use crate::skipping_shared::{Numbers, cameras};
use glam::{DAffine3, DVec3, dvec3};
use stratavox::camera::{Camera, Projection};
use stratavox::gpu::Caps;
use stratavox::offscreen::{Renderer, reference};
use stratavox::picture::{ColorSpace, LayerKind, Picture};
use stratavox::scene::{Beside, Channel, Scene};
use stratavox::technique::{
    CutFaces, Filter, Jitter, Lattice, Mode, Role, Settings, Shading, Technique,
};
use stratavox::transfer::{ColorPoint, Interpolation, OpacityPoint, TransferFunction};
use stratavox::volume::{Rescale, Volume, Voxels};

const DIMS: [u32; 3] = [37, 33, 26];

/// What f32 loses over 200 samples: 8 roundings each.
const ROUNDING: f64 = 200.0 * 8.0 * 6e-8;

/// A few substances in blocks, each with noise of its own.
fn blocks(numbers: &mut Numbers) -> Volume {
    let substances: Vec<[f64; 2]> = (0..5)
        .map(|_| [100.0 * numbers.next(), [0.0, 0.3, 8.0][numbers.below(3)]])
        .collect();
    let side = 9.0 + 9.0 * numbers.next();
    let noise: Vec<f64> = (0..1021).map(|_| numbers.next() - 0.5).collect();
    volume_of(DIMS, sheared_affine(), |p| {
        let block = (p / side).floor().dot(dvec3(1.0, 2.0, 3.0)) as usize;
        let [value, spread] = substances[block % substances.len()];
        let place = p.dot(dvec3(1.0, 37.0, 1221.0)) as usize % noise.len();
        value + spread * noise[place]
    })
}

/// Plateaus and ramps.
fn terraces(numbers: &mut Numbers) -> TransferFunction {
    let mut value = -5.0;
    let (mut height, mut srgb) = (0.1, [0.5; 3]);
    let mut function = TransferFunction {
        color: Vec::new(),
        opacity: Vec::new(),
        reference_length: None,
        interpolation: [Interpolation::Linear, Interpolation::Step][numbers.below(2)],
        gradient_transfer: None,
        medium: None,
    };
    while value < 110.0 {
        if numbers.next() < 0.6 {
            height = [0.0, 0.02, 0.3, 0.9][numbers.below(4)] * numbers.next();
            srgb = numbers.point().to_array();
        }
        function.opacity.push(OpacityPoint {
            value,
            opacity: height,
        });
        function.color.push(ColorPoint { value, srgb });
        value += 25.0 * numbers.next();
    }
    function
}

fn settings(numbers: &mut Numbers) -> Settings {
    Settings {
        filter: [Filter::Linear, Filter::Nearest][numbers.below(2)],
        lattice: [Lattice::Ray, Lattice::Jitter][numbers.below(2)],
        jitter: Jitter { seed: 3, frame: 1 },
        samples_per_voxel: [0.7, 1.0, 2.3][numbers.below(3)],
        color_space: [ColorSpace::Linear, ColorSpace::Display][numbers.below(2)],
        crop: (numbers.below(3) == 0).then(|| [dvec3(3.3, 4.0, 2.0), dvec3(30.0, 31.5, 25.0)]),
        cut_faces: (numbers.below(3) == 0).then_some(CutFaces::Own),
        ..Settings::default()
    }
}

/// How far two pictures are apart, and how many samples each has.
fn apart(a: &Picture, b: &Picture) -> (f64, [f64; 2]) {
    let channels = |picture: &Picture| picture.pixels.as_flattened().to_vec();
    let both = channels(a).into_iter().zip(channels(b));
    let worst = both.map(|(a, b)| f64::from((a - b).abs()));
    let samples = [a, b].map(|picture| {
        let layers = picture.layers.iter();
        let mut counts = layers.filter(|layer| layer.kind == LayerKind::Samples);
        let counts = &counts.next().expect("a layer").values;
        counts.iter().copied().map(f64::from).sum()
    });
    (worst.fold(0.0, f64::max), samples)
}

#[test]
fn the_picture_is_within_its_error_of_that_of_all_samples() {
    let mut numbers = Numbers(5);
    let mut renderer = None;
    let (mut all, mut taken) = (0.0, 0.0);
    for nth in 0..8 {
        let (volume, function) = (blocks(&mut numbers), terraces(&mut numbers));
        let plain = settings(&mut numbers);
        let error = [0.004, 0.03, 0.2][nth % 3];
        let adaptive = Settings {
            adaptive_steps: Some(error),
            ..plain.clone()
        };
        let grid = volume.grid();
        let camera = cameras(&grid)[numbers.below(3)];
        let scene = |settings| Scene {
            volume: &volume,
            transfer: Some(&function),
            beside: Beside::Nothing,
            camera: &camera,
            extent_pixels: [15, 11],
            settings,
        };
        let [wanted, found] = [&plain, &adaptive]
            .map(|settings| reference::render::<f64>(&scene(settings)).expect("a picture"));
        let (off, [every, fewer]) = apart(&wanted, &found);
        assert!(off <= error + 1e-7, "{off} over {error}: {adaptive:?}");
        (all, taken) = (all + every, taken + fewer);

        // The device, on its own samples; half of the volumes in bricks.
        if nth % 4 == 0 {
            let caps = Caps {
                max_image_dimension_3d: if nth == 0 { 24 } else { u32::MAX },
                ..Caps::UNLIMITED
            };
            renderer = Some(device_with(caps));
        }
        let on = renderer.take().unwrap_or_else(device);
        let mut drawn = Renderer::new(on, &volume).expect("a renderer");
        let layers = [LayerKind::Samples];
        let [wanted, found] = [&plain, &adaptive].map(|settings| {
            let rendered = drawn.render(&scene(settings), &layers);
            rendered.expect("a picture").picture
        });
        let (off, [every, fewer]) = apart(&wanted, &found);
        assert!(
            off <= error + ROUNDING,
            "{off} over {error} on a device: {adaptive:?}"
        );
        assert!(fewer <= every * 1.02, "{fewer} for {every}: {adaptive:?}");
        renderer = Some(drawn.into_device());
    }
    assert!(taken < all, "{taken} of {all}");
}

/// A cube of 32 voxels a side, looked at along z, through it one ray in the middle.
fn looked_down_on<R>(
    volume: &Volume,
    function: &TransferFunction,
    settings: &Settings,
    look: impl FnOnce(&Scene) -> R,
) -> R {
    let grid = volume.grid();
    let camera = Camera {
        eye: grid.center() + 99.0 * DVec3::Z,
        target: grid.center(),
        up: DVec3::Y,
        projection: Projection::Orthographic { view_height: 30.0 },
        zoom: 1.0,
    };
    look(&Scene {
        volume,
        transfer: Some(function),
        beside: Beside::Nothing,
        camera: &camera,
        extent_pixels: [9, 9],
        settings,
    })
}

fn cube(voxels: Voxels) -> Volume {
    let affine = DAffine3::IDENTITY;
    let volume = Volume::from_voxels([32; 3], affine, voxels, Rescale::default(), None);
    volume.expect("a right volume")
}

fn between(ends: [(f64, f64, [f64; 3]); 2], reference_length: f64) -> TransferFunction {
    TransferFunction {
        color: ends
            .map(|(value, _, srgb)| ColorPoint { value, srgb })
            .into(),
        opacity: ends
            .map(|(value, opacity, _)| OpacityPoint { value, opacity })
            .into(),
        reference_length: Some(reference_length),
        interpolation: Interpolation::Linear,
        gradient_transfer: None,
        medium: None,
    }
}

#[test]
fn a_homogenous_cube_takes_a_sample_a_cell_and_is_as_deep_as_it_was() {
    let volume = cube(Voxels::U8(vec![100; 32 * 32 * 32]));
    let red = |value| (value, 0.05, [1.0, 0.0, 0.0]);
    let function = between([red(0.0), red(200.0)], 1.0);
    let mut drawn = Renderer::new(device(), &volume).expect("a renderer");
    let mut draw = |adaptive_steps| {
        let settings = Settings {
            adaptive_steps,
            ..Settings::default()
        };
        looked_down_on(&volume, &function, &settings, |scene| {
            let reference = reference::render::<f64>(scene).expect("a picture");
            let picture = drawn.render(scene, &[LayerKind::Samples]);
            [reference, picture.expect("a picture").picture]
        })
    };
    let [_, all] = draw(None);
    let [reference, fewer] = draw(Some(0.001));
    // 1 - 0.95^32, by an exact correction of the opacity, whatever the length of a run.
    let wanted = 1.0 - 0.95_f64.powi(32);
    for pixel in reference.pixels.iter().chain(&fewer.pixels) {
        for (c, wanted) in [(0, wanted), (1, 0.0), (3, wanted)] {
            assert!((f64::from(pixel[c]) - wanted).abs() < 3e-6, "{pixel:?}");
        }
    }
    let (_, [every, few]) = apart(&all, &fewer);
    assert_eq!(every, 81.0 * 32.0);
    // Four cells of eight samples, and the first and the last that stand by themselves.
    assert!(few <= 81.0 * 6.0, "{few}");
    let (_, [of_reference, _]) = apart(&reference, &fewer);
    assert!(of_reference <= 81.0 * 5.0, "{of_reference}");
}

#[test]
fn an_adversary_comes_within_a_quarter_of_the_error_and_not_beyond_it() {
    // The samples in the middle of runs, and they alone, show other values than all others.
    let middles = [28, 27, 20, 12, 4];
    let layer = |z: usize| vec![if middles.contains(&z) { 1.0 } else { 0.0 }; 32 * 32];
    let volume = cube(Voxels::F32((0..32).flat_map(layer).collect()));
    const ERROR: f64 = 0.1;
    // Of colours 0.048 of 0.05 that are allowed; of an extinction of -ln(0.37) / 32, 0.0011 of 0.0012.
    let function = between([(0.0, 0.63, [0.9; 3]), (1.0, 0.643, [0.948; 3])], 32.0);
    let mut drawn = Renderer::new(device(), &volume).expect("a renderer");
    let mut draw = |adaptive_steps| {
        let settings = Settings {
            adaptive_steps,
            filter: Filter::Nearest,
            color_space: ColorSpace::Display,
            ..Settings::default()
        };
        looked_down_on(&volume, &function, &settings, |scene| {
            let reference = reference::render::<f64>(scene).expect("a picture");
            let picture = drawn.render(scene, &[LayerKind::Samples]);
            [reference, picture.expect("a picture").picture]
        })
    };
    let (all, few) = (draw(None), draw(Some(ERROR)));
    for (all, few) in all.iter().zip(&few) {
        let (off, [every, fewer]) = apart(all, few);
        assert!(fewer < 0.2 * every, "{fewer} of {every}");
        assert!(off > 0.25 * ERROR && off <= ERROR, "{off}");
    }
}

#[test]
fn what_has_no_such_steps_refuses_them_by_name() {
    let mut numbers = Numbers(9);
    let (volume, function) = (blocks(&mut numbers), terraces(&mut numbers));
    let mut holes = volume.clone();
    let Voxels::F32(values) = &mut holes.voxels else {
        unreachable!("made so")
    };
    values[77] = f32::NAN;
    let holes = Volume::from_voxels(
        DIMS,
        sheared_affine(),
        holes.voxels.clone(),
        Rescale::default(),
        None,
    );
    let holes = holes.expect("a right volume");
    let camera = cameras(&volume.grid())[0];
    let own = || Settings {
        adaptive_steps: Some(0.01),
        ..Settings::default()
    };
    let beside = [Channel {
        volume: &volume,
        transfer: Some(&function),
        role: Role::Numbers,
    }];
    let said = |volume, beside, settings: Settings| {
        let scene = Scene {
            volume,
            transfer: Some(&function),
            beside,
            camera: &camera,
            extent_pixels: [4, 4],
            settings: &settings,
        };
        reference::render::<f32>(&scene)
            .expect_err("refused")
            .to_string()
    };
    let refused: [(&str, Settings); 8] = [
        (
            "ray casting",
            Settings {
                technique: Technique::Slices3d,
                ..own()
            },
        ),
        (
            "ray casting",
            Settings {
                technique: Technique::Slices2d,
                ..own()
            },
        ),
        (
            "mode",
            Settings {
                mode: Mode::Mida,
                ..own()
            },
        ),
        (
            "planes",
            Settings {
                lattice: Lattice::Planes,
                ..own()
            },
        ),
        (
            "conformance",
            Settings {
                conformance: true,
                ..own()
            },
        ),
        (
            "pre-integrated",
            Settings {
                preintegrated: true,
                ..own()
            },
        ),
        (
            "filter",
            Settings {
                filter: Filter::Cubic,
                ..own()
            },
        ),
        (
            "shaded",
            Settings {
                shading: Some(Shading::default()),
                ..own()
            },
        ),
    ];
    for (word, settings) in refused {
        let said = said(&volume, Beside::Nothing, settings);
        assert!(
            said.contains("adaptive steps") && said.contains(word),
            "{word}: {said}"
        );
    }
    let mixed = said(&volume, Beside::Channels(&beside), own());
    assert!(
        mixed.contains("adaptive steps") && mixed.contains("several"),
        "{mixed}"
    );
    let holed = said(&holes, Beside::Nothing, own());
    assert!(
        holed.contains("adaptive steps") && holed.contains("without"),
        "{holed}"
    );
    for error in [0.0, -1.0, 1.5, f64::NAN] {
        let settings = Settings {
            adaptive_steps: Some(error),
            ..Settings::default()
        };
        let said = said(&volume, Beside::Nothing, settings);
        assert!(said.contains("error of adaptive steps"), "{said}");
    }
}
