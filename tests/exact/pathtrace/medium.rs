//! Matter of which the transfer function says what it does to light: extinction of each colour, albedo, light of its own.

use super::{
    around_blobs, assert_near, assert_same_paths, at, blobs, drawn, eye, layer, light, lit, mean,
    scene, settings,
};
use stratavox::offscreen::reference;
use stratavox::picture::Picture;
use stratavox::technique::Settings;
use stratavox::technique::pathtrace::{PathTracing, SkyPicture};
use stratavox::transfer::{
    ColorPoint, Interpolation, MediumPoint, MediumTransfer, TransferFunction,
};

pub fn points<const N: usize>(of: [(f64, [f64; 3]); N]) -> Vec<MediumPoint> {
    let point = |(value, linear)| MediumPoint { value, linear };
    of.map(point).into()
}

/// Grey, whatever the medium says.
pub fn medium(
    extinction: Vec<MediumPoint>,
    albedo: Vec<MediumPoint>,
    emission: Vec<MediumPoint>,
) -> TransferFunction {
    let grey = TransferFunction {
        color: vec![ColorPoint {
            value: 0.0,
            srgb: [0.5; 3],
        }],
        opacity: Vec::new(),
        reference_length: None,
        interpolation: Interpolation::Linear,
        gradient_transfer: None,
        medium: Some(Box::new(MediumTransfer {
            albedo,
            emission,
            ..MediumTransfer::default()
        })),
    };
    grey.with_extinction(extinction)
}

/// What comes through a layer from an even half of the sky, that which nothing meets within, for each colour: by adding and
/// doubling, depths 4.8, 1.2 and .36.
#[test]
fn each_colour_comes_through_by_its_own_extinction() {
    let sigma = [4.0, 1.0, 0.3];
    let function = medium(
        points([(0.0, [0.0; 3]), (0.5, sigma), (1.0, sigma)]),
        points([(0.0, [0.9, 0.8, 0.5])]),
        Vec::new(),
    );
    // Between the rows at the horizon it is bilinear, and little light leaves along it.
    let (columns, rows) = (256, 128);
    let is_below = |i: u32| i >= columns * rows / 2;
    let below = (0..columns * rows).map(|i| [f32::from(u8::from(is_below(i))); 3]);
    let below: Vec<_> = below.collect();
    let settings = settings(PathTracing {
        samples: 48,
        density: 1.2,
        sky: [1.0; 3],
        sky_picture: Some(SkyPicture::new([columns, rows], &below).expect("a sky")),
        shows_sky: true,
        ..PathTracing::default()
    });
    let (volume, camera) = (layer(|_| 1.0), eye(at(1.0, 0.0)));
    let picture = drawn(&scene(&volume, &function, &camera, &settings, [48; 2]));
    for (channel, wanted) in [0.08502, 0.47750, 0.75479].into_iter().enumerate() {
        assert_near("through", mean(&picture, channel), wanted);
    }
}

/// A layer of emission E and extinction sigma has E / sigma (1 - e^(-sigma / mu)), E / mu where nothing is in the way; the eye
/// sees what light is not scattered to it.
#[test]
fn matter_shines_as_much_as_it_sends_out_and_lets_through() {
    let (mu, emission) = (0.6, [0.9, 0.3, 0.1]);
    let (volume, camera) = (layer(|_| 1.0), eye(at(mu, 0.0)));
    for (sigma, bounces, albedo) in [(1.5, Some(0), 1.0), (1.5, None, 0.0), (0.0, None, 1.0)] {
        let function = medium(
            points([(0.0, [0.0; 3]), (0.5, [sigma; 3]), (1.0, [sigma; 3])]),
            points([(0.0, [0.8; 3])]),
            points([(0.0, [0.0; 3]), (0.5, emission)]),
        );
        for skip in [true, false] {
            let settings = Settings {
                skip,
                ..settings(PathTracing {
                    samples: 64,
                    bounces,
                    albedo,
                    ..PathTracing::default()
                })
            };
            let picture = drawn(&scene(&volume, &function, &camera, &settings, [32; 2]));
            for (channel, e) in emission.into_iter().enumerate() {
                let wanted = match sigma == 0.0 {
                    true => e / mu,
                    false => e / sigma * (1.0 - (-sigma / mu).exp()),
                };
                assert_near(&format!("{sigma} {skip}"), mean(&picture, channel), wanted);
            }
        }
    }
}

/// Between two points extinction is a straight line, so that its integral over a ramp of values is that of the ramp.
#[test]
fn extinction_is_linear_between_its_points() {
    let (mu, sigma) = (0.7, 3.0);
    let (volume, camera) = (layer(|z| z), eye(at(mu, 0.0)));
    let function = medium(
        points([(0.0, [0.0; 3]), (1.0, [sigma; 3])]),
        Vec::new(),
        Vec::new(),
    );
    for conformance in [true, false] {
        let settings = Settings {
            conformance,
            ..settings(PathTracing {
                samples: 64,
                bounces: Some(0),
                ..PathTracing::default()
            })
        };
        let picture = drawn(&scene(&volume, &function, &camera, &settings, [48; 2]));
        let wanted = 1.0 - (-0.5 * sigma / mu).exp();
        assert_near("met", mean(&picture, 3), wanted);
    }
}

/// White matter in a white sky: each path brings 1, to the bit.
#[test]
fn white_matter_of_an_extinction_is_as_bright_as_the_sky() {
    let (volume, camera) = (blobs(), around_blobs());
    let function = medium(
        points([(0.0, [0.0; 3]), (0.4, [0.3; 3]), (1.0, [0.04; 3])]),
        points([(0.0, [1.0; 3])]),
        Vec::new(),
    );
    for conformance in [true, false] {
        let settings = Settings {
            conformance,
            ..settings(PathTracing {
                samples: 4,
                surface: 3.0,
                sky: [1.0; 3],
                ..PathTracing::default()
            })
        };
        let scene = scene(&volume, &function, &camera, &settings, [60, 50]);
        let reference = reference::render::<f64>(&scene).expect("a picture");
        for picture in [drawn(&scene), reference] {
            let met = picture.pixels.iter().filter(|pixel| pixel[3] > 0.0);
            assert!(met.clone().count() > 500);
            for &[r, g, b, alpha] in met {
                assert_eq!([r, g, b], [alpha; 3]);
            }
        }
    }
}

/// Path by path, with three extinctions and light of its own.
#[test]
fn the_shader_traces_the_paths_of_its_reference_through_a_medium() {
    let (volume, camera) = (blobs(), around_blobs());
    let function = medium(
        points([
            (0.0, [0.0; 3]),
            (0.4, [1.5, 0.9, 0.3]),
            (1.0, [0.2, 0.3, 0.8]),
        ]),
        points([(0.0, [0.9, 0.7, 0.4]), (0.5, [0.3, 0.9, 0.8])]),
        points([(0.2, [0.0; 3]), (0.6, [0.05, 0.02, 0.1])]),
    );
    let settings = Settings {
        // Cells change which numbers are drawn.
        skip: false,
        conformance: true,
        ..settings(lit())
    };
    let scene = scene(&volume, &function, &camera, &settings, [60, 50]);
    assert_same_paths("three extinctions", &scene, 1000);
}

fn assert_even(picture: &Picture) {
    assert!(picture.pixels.iter().all(|p| p[0] == p[1] && p[1] == p[2]));
}

/// Three extinctions that are alike are one.
#[test]
fn one_extinction_leaves_grey_light_grey() {
    let (volume, camera) = (layer(|_| 1.0), eye(at(0.5, 0.0)));
    let function = medium(
        points([(0.0, [1.7; 3])]),
        points([(0.0, [0.9; 3])]),
        Vec::new(),
    );
    let settings = settings(PathTracing {
        samples: 4,
        lights: vec![light(at(0.8, 1.0))],
        ..PathTracing::default()
    });
    assert_even(&drawn(&scene(
        &volume, &function, &camera, &settings, [8; 2],
    )));
}
