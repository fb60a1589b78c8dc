//! Matter that depends on the gradient, and several volumes and labels in one place: paths go through what a composite shows.

use super::{
    around_blobs, assert_same_paths, blobs, drawn, lit, matter, mean_of, of_codes, scene, settings,
};
use stratavox::scene::{Beside, Channel, Scene};
use stratavox::technique::pathtrace::PathTracing;
use stratavox::technique::{Role, Settings};
use stratavox::transfer::{
    GradientTransfer, OpacityPoint, SecondDerivative, Shape, TransferFunction, Widget,
};
use stratavox::volume::{Rescale, Volume, Voxels};

/// A share of the opacity where it is steep, a contour, and a bell that the second derivative weighs.
fn steep() -> TransferFunction {
    let point = |value, opacity| OpacityPoint { value, opacity };
    let widget = |srgb, opacity, shape, second| Widget {
        srgb: Some(srgb),
        opacity,
        shape,
        second,
    };
    let contour = Shape::Contour {
        value: 0.2,
        half_width: 1.5,
    };
    let bell = Shape::Gaussian {
        value: -0.2,
        gradient: 0.5,
        sigma_value: 0.15,
        sigma_gradient: 0.3,
    };
    let second = SecondDerivative::Bell {
        middle: 0.0,
        sigma: 0.2,
    };
    TransferFunction {
        gradient_transfer: Some(GradientTransfer {
            steepest: Some(0.25),
            share: vec![point(0.1, 0.2), point(0.7, 1.0)],
            widgets: vec![
                widget([0.9, 0.3, 0.2], 0.8, contour, None),
                widget([0.2, 0.5, 0.9], 0.5, bell, Some(second)),
            ],
        }),
        ..matter([0.9, 0.7, 0.4], &[(0.1, 0.0), (0.4, 1.5), (1.0, 0.2)])
    }
}

/// Waves across the blobs, and labels of the octants, one of them without data and one shadowed.
fn beside(of: &Volume) -> [Volume; 2] {
    let [nx, ny, nz] = of.dims;
    let places = || (0..nx * ny * nz).map(|i| [i % nx, i / nx % ny, i / nx / ny]);
    let volume = |voxels| {
        Volume::from_voxels(
            of.dims,
            of.world_from_voxel,
            voxels,
            Rescale::default(),
            None,
        )
        .expect("a volume")
    };
    let waves = places().map(|[x, y, z]| {
        let [x, y, z] = [x, y, z].map(|n| n as f32);
        (0.3 * x + 0.1 * y).sin() * (0.2 * z).cos()
    });
    let labels = places().map(|[x, y, _]| (1 + x / 14 + 3 * (y / 19)) as u8);
    let mut labels = volume(Voxels::U8(labels.collect()));
    // 2: there, and shadowed.
    let marks = places().map(|[x, y, _]| match (x / 14, y / 19) {
        (0, 0) => 0,
        (1, 1) => 2,
        _ => 1,
    });
    labels.validity = Some(marks.collect());
    [volume(Voxels::F32(waves.collect())), labels]
}

#[test]
fn the_shader_traces_the_paths_of_its_reference_by_gradients_and_channels() {
    let (floats, camera) = (blobs(), around_blobs());
    let function = steep();
    let settings = |conformance| Settings {
        // Cells change which numbers are drawn.
        skip: false,
        conformance,
        ..settings(lit())
    };
    for (name, volume, conformance) in [
        ("f32", floats.clone(), true),
        ("u8", of_codes(&floats, u8::MAX.into()), false),
        ("u16", of_codes(&floats, u16::MAX), false),
    ] {
        let settings = settings(conformance);
        let scene = scene(&volume, &function, &camera, &settings, [60, 50]);
        assert_same_paths(name, &scene, 900);
    }
    let [waves, labels] = beside(&floats);
    let one = matter([0.9, 0.7, 0.4], &[(0.1, 0.0), (0.4, 1.5), (1.0, 0.2)]);
    let other = matter([0.2, 0.5, 0.9], &[(0.0, 0.0), (0.8, 0.6)]);
    let faint = matter([0.9, 0.2, 0.9], &[(2.5, 0.0), (3.0, 0.1), (9.0, 0.1)]);
    let channels = |volume, transfer, role| Channel {
        volume,
        transfer: Some(transfer),
        role,
    };
    let others = [
        channels(&waves, &other, Role::Numbers),
        channels(&labels, &faint, Role::Labels),
    ];
    let opaque = [channels(&waves, &other, Role::Opacity)];
    for (name, beside) in [("channels", &others[..]), ("opacity", &opaque)] {
        let settings = settings(true);
        let scene = Scene {
            beside: Beside::Channels(beside),
            ..scene(&floats, &one, &camera, &settings, [60, 50])
        };
        assert_same_paths(name, &scene, 900);
    }
}

/// Majorants are those of all gradients, and of all channels: a cell whose bound were too low would let paths through.
#[test]
fn without_bounces_gradients_and_channels_are_the_composite() {
    let (volume, camera) = (blobs(), around_blobs());
    let [waves, labels] = beside(&volume);
    let graded = steep();
    let one = matter([0.9, 0.7, 0.4], &[(0.1, 0.0), (0.4, 1.5), (1.0, 0.2)]);
    let other = matter([0.2, 0.5, 0.9], &[(0.0, 0.0), (0.8, 0.6)]);
    let nothing = matter([0.0; 3], &[(0.0, 0.0)]);
    let channel = |volume, transfer, role| Channel {
        volume,
        transfer: Some(transfer),
        role,
    };
    let others = [
        channel(&waves, &other, Role::Numbers),
        channel(&labels, &nothing, Role::Labels),
    ];
    let paths = settings(PathTracing {
        samples: 32,
        bounces: Some(0),
        ..PathTracing::default()
    });
    let rays = Settings {
        samples_per_voxel: 16.0,
        rays_per_side: 2,
        ..Settings::default()
    };
    for (name, function, beside) in [
        ("gradients", &graded, Beside::Nothing),
        ("channels", &one, Beside::Channels(&others)),
    ] {
        let pictures = [&paths, &rays].map(|settings| {
            drawn(&Scene {
                beside,
                ..scene(&volume, function, &camera, settings, [60, 50])
            })
        });
        let [paths, rays] = pictures;
        for channel in 0..4 {
            let pairs = || paths.pixels.iter().zip(&rays.pixels);
            let n = pairs().count() as f64;
            let off = pairs().map(|(a, b)| f64::from(a[channel] - b[channel]));
            // Colours of what is met differ: E[c^2] is no more than the chance that something is.
            let variance = pairs().map(|(_, b)| f64::from(b[3]) / 32.0);
            let (off, error) = (off.sum::<f64>() / n, variance.sum::<f64>().sqrt() / n);
            println!("{name} {channel}: {off} +- {error}");
            assert!(
                off.abs() < 4.0 * error,
                "{name} {channel}: {off} +- {error}"
            );
            assert!(error < 3e-3);
        }
    }
}

/// Whatever scatters white light from all around to all sides is as bright as it.
#[test]
fn white_matter_of_gradients_and_of_channels_is_as_bright_as_the_sky() {
    let (volume, camera) = (blobs(), around_blobs());
    let [waves, _] = beside(&volume);
    let white = matter([1.0; 3], &[(0.1, 0.0), (0.4, 1.5), (1.0, 0.2)]);
    let mut graded = steep();
    graded.color = white.color.clone();
    if let Some(gradients) = &mut graded.gradient_transfer {
        gradients.widgets.truncate(1);
        gradients.widgets[0].srgb = None;
    }
    let others = [Channel {
        volume: &waves,
        transfer: Some(&white),
        role: Role::Numbers,
    }];
    // So thin that no path ends by chance, which paths of very many turns do.
    let settings = settings(PathTracing {
        samples: 4,
        density: 0.1,
        surface: 3.0,
        sky: [1.0; 3],
        ..PathTracing::default()
    });
    for (name, function, beside) in [
        ("gradients", &graded, Beside::Nothing),
        ("channels", &white, Beside::Channels(&others)),
    ] {
        let scene = Scene {
            beside,
            ..scene(&volume, function, &camera, &settings, [60, 50])
        };
        let picture = drawn(&scene);
        let [brightness, _] = mean_of(&picture, 0);
        let [met, _] = mean_of(&picture, 3);
        assert!(met > 0.2, "{name}: {met}");
        // Colours are means, sums of products over a sum: a few roundings a collision.
        assert!(
            (brightness / met - 1.0).abs() < 1e-5,
            "{name}: {brightness} {met}"
        );
    }
}
