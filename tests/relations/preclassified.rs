//! Voxels that a scene has classified before they are interpolated: the pictures of the four volumes that they are made to be.
//!
//! ```text
//! Preclassified of a volume and a function = Classified of preclassified(volume, function)       to the byte
//! ```
//!
//! Shear-warp reads runs that the device makes of codes, where those of the four volumes are made by the host.

use crate::runs_on_device::{SPACES, function, volumes};
use crate::shared::{device, device_with, oblique_camera, projections};
use crate::skipping_shared::Numbers;
use stratavox::camera::Camera;
use stratavox::gpu::{Caps, Headless};
use stratavox::offscreen::{Error, Renderer, reference};
use stratavox::picture::Picture;
use stratavox::resident::MadeBy;
use stratavox::scene::{Beside, Scene};
use stratavox::technique::preclassified::preclassified;
use stratavox::technique::{self, AmbientOcclusion, Filter, Mode, Settings, Shading, Technique};
use stratavox::transfer::{GradientTransfer, Interpolation, TransferFunction};
use stratavox::volume::{Volume, Voxels};

/// Noise, and an empty half.
fn values(numbers: &mut Numbers, dims: [u32; 3]) -> Vec<f64> {
    let count = dims.iter().product::<u32>() as usize;
    let value = |n: usize, noise: f64| noise * f64::from(u8::from(n < count / 2));
    (0..count).map(|n| value(n, numbers.next())).collect()
}

/// The same values as floats, which have no codes.
fn without_codes(volume: &Volume) -> Volume {
    let stored = (0..volume.voxels.len()).map(|n| volume.voxels.stored(n));
    Volume {
        voxels: Voxels::F32(stored.collect()),
        ..volume.clone()
    }
}

fn camera(volume: &Volume, number: usize) -> Camera {
    let grid = volume.grid();
    oblique_camera(&grid, projections(&grid)[number])
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
        beside: Beside::Preclassified,
        camera,
        extent_pixels: [60, 52],
        settings,
    }
}

fn bits(picture: &Picture) -> Vec<u32> {
    let numbers = picture.pixels.as_flattened().iter();
    numbers.map(|n| n.to_bits()).collect()
}

/// The bits of the same picture by four volumes, and who has made their runs.
fn of_volumes(device: Headless, scene: &Scene) -> (Vec<u32>, Option<MadeBy>, Headless) {
    let function = scene.transfer.expect("a function");
    let length = scene.reference_length();
    let made = preclassified(scene.volume, function, length, scene.settings.color_space);
    let made = made.expect("volumes");
    let [red, beside @ ..] = made.each_ref();
    let mut renderer = Renderer::several(device, made.iter().collect()).expect("a renderer");
    let scene = Scene {
        volume: red,
        beside: Beside::Classified(&beside),
        ..*scene
    };
    let picture = renderer.render(&scene, &[]).expect("a picture").picture;
    let made_by = renderer.runs_made_by();
    (bits(&picture), made_by, renderer.into_device())
}

/// Ways to draw, and whether pictures of them read runs.
fn ways() -> Vec<(Settings, bool)> {
    let of = |technique, filter| Settings {
        technique,
        filter,
        ..Settings::default()
    };
    let shear_warp = of(Technique::ShearWarp, Filter::Linear);
    let occlusion = AmbientOcclusion {
        strength: 0.5,
        radius_world: None,
    };
    vec![
        (shear_warp.clone(), true),
        (of(Technique::ShearWarp, Filter::Nearest), true),
        (
            Settings {
                conformance: true,
                shading: Some(Shading::default()),
                ..shear_warp.clone()
            },
            true,
        ),
        (
            Settings {
                color_space: SPACES[1],
                skip: false,
                ..shear_warp.clone()
            },
            true,
        ),
        (
            Settings {
                ambient_occlusion: Some(occlusion),
                ..shear_warp.clone()
            },
            false,
        ),
        (
            Settings {
                samples_per_voxel: 2.0,
                ..shear_warp
            },
            false,
        ),
        (of(Technique::Raycast, Filter::Linear), false),
        (of(Technique::Slices2d, Filter::Nearest), false),
        (of(Technique::Slices3d, Filter::Linear), false),
        (of(Technique::Splat, Filter::Linear), false),
    ]
}

#[test]
fn pictures_are_those_of_four_volumes_whoever_makes_runs() {
    let mut numbers = Numbers(41);
    let mut there = device();
    let dims = [37, 14, 12];
    let values = values(&mut numbers, dims);
    let validity: Vec<u8> = (0..values.len())
        .map(|_| u8::from(numbers.next() > 0.02))
        .collect();
    let interpolations = [Interpolation::Linear, Interpolation::Step];
    for (n, (settings, reads_runs)) in ways().into_iter().enumerate() {
        let validity = (n % 2 == 0).then_some(&validity[..]);
        let mut all = volumes(dims, &values, validity);
        all.push(without_codes(&all[2]));
        let some = [n % 5, (n + 2) % 5, 5];
        for number in some {
            let volume = &all[number];
            let what = format!("{:?} of {:?}", settings, volume.voxels.voxel_type());
            let function = function(0.3, interpolations[n / 2 % 2]);
            let camera = camera(volume, n % 2);
            let scene = scene(volume, &function, &camera, &settings);
            let (wanted, by_host, device) = of_volumes(there, &scene);
            let mut renderer = Renderer::new(device, volume).expect("a renderer");
            let picture = renderer.render(&scene, &[]).expect("a picture").picture;
            let by = match number {
                5 => MadeBy::Host,
                _ => MadeBy::Device,
            };
            assert_eq!(by_host, reads_runs.then_some(MadeBy::Host), "{what}");
            assert_eq!(renderer.runs_made_by(), reads_runs.then_some(by), "{what}");
            assert!(bits(&picture) == wanted, "{what}");
            let drawn = picture.pixels.iter().filter(|p| p[3] > 0.05).count();
            assert!(drawn > 100, "{drawn} pixels, {what}");
            there = renderer.into_device();
        }
    }
}

/// One renderer: functions, techniques and values in turn, each as if it were the first.
#[test]
fn a_renderer_forgets_what_another_function_made() {
    let mut numbers = Numbers(13);
    let dims = [33, 12, 14];
    let values = values(&mut numbers, dims);
    let all = volumes(dims, &values, None);
    let volume = &all[3];
    let camera = camera(volume, 0);
    let light = Settings {
        ambient_occlusion: Some(AmbientOcclusion {
            strength: 0.8,
            radius_world: None,
        }),
        ..Settings::default()
    };
    let shear_warp = Settings {
        technique: Technique::ShearWarp,
        ..Settings::default()
    };
    let (low, high) = (
        function(0.1, Interpolation::Linear),
        function(0.7, Interpolation::Linear),
    );
    let longer = TransferFunction {
        reference_length: Some(4.0),
        ..low.clone()
    };
    let pictures = [
        (&low, &shear_warp, Beside::Preclassified),
        (&high, &shear_warp, Beside::Preclassified),
        (&longer, &shear_warp, Beside::Preclassified),
        (&low, &shear_warp, Beside::Nothing),
        (&low, &light, Beside::Preclassified),
        (&high, &light, Beside::Preclassified),
        (&high, &light, Beside::Nothing),
        (&high, &shear_warp, Beside::Preclassified),
        (&low, &shear_warp, Beside::Preclassified),
    ];
    let drawn = |renderer: &mut Renderer, (function, settings, beside)| {
        let scene = Scene {
            beside,
            ..scene(volume, function, &camera, settings)
        };
        let picture = renderer.render(&scene, &[]).expect("a picture").picture;
        bits(&picture)
    };
    let mut kept = Renderer::new(device(), volume).expect("a renderer");
    let mut seen = Vec::new();
    for (n, what) in pictures.into_iter().enumerate() {
        let found = drawn(&mut kept, what);
        let mut fresh = Renderer::new(device(), volume).expect("a renderer");
        assert!(found == drawn(&mut fresh, what), "picture {n}");
        seen.push(found);
    }
    for (n, a) in seen.iter().enumerate() {
        let same = seen.iter().filter(|b| *b == a).count();
        // The first and the last are one picture, and so are the second and the last but one.
        let wanted = if [0, 1, 7, 8].contains(&n) { 2 } else { 1 };
        assert_eq!(same, wanted, "picture {n}");
    }
}

#[test]
fn without_room_for_codes_the_host_makes_runs() {
    let mut numbers = Numbers(5);
    let dims = [64, 32, 32];
    let values = values(&mut numbers, dims);
    let volume = &volumes(dims, &values, None)[2];
    let function = function(0.3, Interpolation::Linear);
    let camera = camera(volume, 0);
    let settings = Settings {
        technique: Technique::ShearWarp,
        ..Settings::default()
    };
    let scene = scene(volume, &function, &camera, &settings);
    let drawn = |device| {
        let mut renderer = Renderer::new(device, volume).expect("a renderer");
        let picture = renderer.render(&scene, &[]).expect("a picture").picture;
        (bits(&picture), renderer.runs(), renderer.runs_made_by())
    };
    let small = Caps {
        max_storage_buffer_range: 100_000,
        ..Caps::UNLIMITED
    };
    let (whole, size, by) = drawn(device());
    let (lean, lean_size, lean_by) = drawn(device_with(small));
    assert_eq!([by, lean_by], [Some(MadeBy::Device), Some(MadeBy::Host)]);
    assert_eq!(size, lean_size);
    assert!(whole == lean);
}

#[test]
fn the_cpu_reference_classifies_voxels_as_well() {
    let mut numbers = Numbers(9);
    let dims = [17, 12, 9];
    let values = values(&mut numbers, dims);
    let volume = &volumes(dims, &values, None)[1];
    let function = function(0.3, Interpolation::Linear);
    let camera = camera(volume, 1);
    for technique in [Technique::ShearWarp, Technique::Raycast] {
        let settings = Settings {
            technique,
            ..Settings::default()
        };
        let coded = scene(volume, &function, &camera, &settings);
        let made = preclassified(volume, &function, 1.0, settings.color_space).expect("volumes");
        let [red, beside @ ..] = made.each_ref();
        let dense = Scene {
            volume: red,
            beside: Beside::Classified(&beside),
            ..coded
        };
        let values = Scene {
            beside: Beside::Nothing,
            ..coded
        };
        let [coded, dense, values] = [coded, dense, values].map(|scene| {
            let picture = reference::render::<f32>(&scene).expect("a picture");
            bits(&picture)
        });
        assert!(coded == dense && coded != values, "{technique:?}");
    }
}

#[test]
fn what_cannot_be_classified_before_and_too_few_volumes_are_refused_by_name() {
    let mut numbers = Numbers(2);
    let dims = [9, 8, 7];
    let values = values(&mut numbers, dims);
    let all = volumes(dims, &values, None);
    let volume = &all[0];
    let plain = function(0.3, Interpolation::Linear);
    let graded = TransferFunction {
        gradient_transfer: Some(GradientTransfer::default()),
        ..plain.clone()
    };
    let camera = camera(volume, 0);
    let composite = Settings::default();
    let mip = Settings {
        mode: Mode::Mip,
        ..Settings::default()
    };
    let usual = scene(volume, &plain, &camera, &composite);
    assert!(usual.check().is_ok());
    let none = Scene {
        transfer: None,
        ..usual
    };
    assert_eq!(none.check(), Err(technique::Error::NoTransferFunction));
    let projected = Scene {
        settings: &mip,
        ..usual
    };
    assert!(projected.check().is_err());
    let graded = Scene {
        transfer: Some(&graded),
        ..usual
    };
    assert_eq!(graded.check(), Err(technique::Error::GradientTransferAlone));
    // Three beside the first, of a renderer of the first alone.
    let beside = [&all[1], &all[2], &all[3]];
    let four = Scene {
        beside: Beside::Classified(&beside),
        ..usual
    };
    let mut renderer = Renderer::new(device(), volume).expect("a renderer");
    let refused = renderer.render(&four, &[]).map(|_| ());
    let text = refused.as_ref().err().map(ToString::to_string);
    assert!(
        matches!(
            refused,
            Err(Error::FewerVolumes {
                wanted: 4,
                found: 1
            })
        ),
        "{text:?}"
    );
    let text = text.expect("refused");
    assert!(text.contains('4') && text.contains('1'), "{text}");
    assert!(renderer.render(&usual, &[]).is_ok());
}
