//! When a picture ends, and what is taken out of it.

use super::{around_blobs, blobs, drawn, lit, matter, scene, settings};
use crate::shared::device;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use stratavox::offscreen::Renderer;
use stratavox::picture::{LayerKind, Picture};
use stratavox::technique::pathtrace::PathTracing;

/// Taking it out is worth more than twice the paths.
#[test]
fn noise_that_is_taken_out_is_no_detail() {
    let (volume, camera) = (blobs(), around_blobs());
    let function = matter([0.9, 0.7, 0.4], &[(0.1, 0.0), (0.4, 1.5), (1.0, 0.2)]);
    let mut renderer = Renderer::new(device(), &volume).expect("a renderer");
    let mut of = |samples, seed, denoise| {
        let settings = settings(PathTracing {
            samples,
            seed,
            denoise,
            ..lit()
        });
        let scene = scene(&volume, &function, &camera, &settings, [60, 50]);
        renderer.render(&scene, &[]).expect("a picture").picture
    };
    let truth = of(256, 7, false);
    let error = |picture: &Picture| {
        let pairs = picture.pixels.iter().zip(&truth.pixels);
        let off = pairs.flat_map(|(a, b)| [0, 1, 2, 3].map(|c| f64::from(a[c] - b[c]).powi(2)));
        (off.sum::<f64>() / (4 * truth.pixels.len()) as f64).sqrt()
    };
    let [before, after] = [false, true].map(|denoise| error(&of(16, 0, denoise)));
    println!("{before} {after}");
    assert!(after < before / 2.0_f64.sqrt(), "{before} {after}");
}

/// Of each pixel: the sum of squares over pixels is that of the picture, and errors against many more paths are as large. What
/// comes through is what no path has met.
#[test]
fn layers_say_the_error_of_each_pixel_and_what_comes_through() {
    let (volume, camera) = (blobs(), around_blobs());
    let function = matter([0.9, 0.7, 0.4], &[(0.1, 0.0), (0.4, 1.5), (1.0, 0.2)]);
    let mut renderer = Renderer::new(device(), &volume).expect("a renderer");
    let mut of = |samples, seed| {
        let settings = settings(PathTracing {
            samples,
            seed,
            ..lit()
        });
        let scene = scene(&volume, &function, &camera, &settings, [30, 25]);
        let kinds = [LayerKind::Noise, LayerKind::Transmittance];
        let picture = renderer.render(&scene, &kinds).expect("a picture").picture;
        (picture, renderer.traced())
    };
    let (picture, traced) = of(64, 0);
    let [noise, through] = &picture.layers[..] else {
        panic!("two layers: {:?}", picture.layers.len());
    };
    let kinds = [noise.kind, through.kind];
    assert_eq!(kinds, [LayerKind::Noise, LayerKind::Transmittance]);
    for (pixel, through) in picture.pixels.iter().zip(&through.values) {
        assert_eq!(1.0 - pixel[3], *through);
    }
    let y = |p: &[f32; 4]| {
        0.2126 * f64::from(p[0]) + 0.7152 * f64::from(p[1]) + 0.0722 * f64::from(p[2])
    };
    let light: f64 = picture.pixels.iter().map(|p| y(p).powi(2)).sum();
    let variance: f64 = noise.values.iter().map(|&x| f64::from(x).powi(2)).sum();
    let wanted = traced.noise.expect("several blocks");
    assert!(((variance / light).sqrt() / wanted - 1.0).abs() < 1e-5);
    let (truth, _) = of(256, 9);
    let of_pixels = picture.pixels.iter().zip(&truth.pixels).zip(&noise.values);
    let lit = of_pixels.filter(|(_, noise)| **noise > 0.0);
    let (mut squares, mut count) = (0.0, 0.0);
    for ((a, b), &noise) in lit {
        squares += ((y(a) - y(b)) / f64::from(noise)).powi(2) / (1.0 + 1.0 / 4.0);
        count += 1.0;
    }
    // By B = 11 blocks or more, of Gauss's curve: (B - 1) / (B - 3) <= 1.25; of light that is rare the blocks know less.
    let mean: f64 = squares / count;
    println!("{mean} over {count} pixels");
    assert!(count > 200.0 && (0.9..1.6).contains(&mean), "{mean}");
}

/// The picture of `--noise` is that of as many paths, and its noise is the error against many more.
#[test]
fn a_picture_ends_where_its_noise_is_low() {
    let (volume, camera) = (blobs(), around_blobs());
    let function = matter([0.9, 0.7, 0.4], &[(0.1, 0.0), (0.4, 1.5), (1.0, 0.2)]);
    let mut renderer = Renderer::new(device(), &volume).expect("a renderer");
    let mut of = |path: PathTracing| {
        let settings = settings(path);
        let scene = scene(&volume, &function, &camera, &settings, [42, 35]);
        let picture = renderer.render(&scene, &[]).expect("a picture").picture;
        (picture, renderer.traced())
    };
    let paths = |samples, seed| PathTracing {
        samples,
        seed,
        ..lit()
    };
    let (ended, traced) = of(PathTracing {
        noise: Some(0.2),
        ..paths(4096, 0)
    });
    let noise = traced.noise.expect("several blocks");
    assert!(
        traced.paths.is_power_of_two() && traced.paths >= 16,
        "{traced:?}"
    );
    assert!(noise <= 0.2 && traced.paths < 4096, "{traced:?}");
    let (same, _) = of(paths(traced.paths, 0));
    assert!(ended == same);
    let (_, before) = of(paths(traced.paths / 2, 0));
    assert!(
        traced.paths == 16 || before.noise.is_some_and(|noise| noise > 0.2),
        "{before:?}"
    );
    let (truth, _) = of(paths(8 * traced.paths, 9));
    let y = |p: &[f32; 4]| {
        0.2126 * f64::from(p[0]) + 0.7152 * f64::from(p[1]) + 0.0722 * f64::from(p[2])
    };
    let pairs = || ended.pixels.iter().zip(&truth.pixels);
    let off: f64 = pairs().map(|(a, b)| (y(a) - y(b)).powi(2)).sum();
    let light: f64 = pairs().map(|(_, b)| y(b).powi(2)).sum();
    // Both have noise.
    let error = (off / light / (1.0 + 1.0 / 8.0)).sqrt();
    println!("{traced:?}, error {error}");
    assert!((error / noise - 1.0).abs() < 0.15, "{error} {noise}");
}

/// One block is traced whatever else is said, and the picture is the mean of what there is.
#[test]
fn a_picture_ends_when_it_is_asked_to_and_after_its_seconds() {
    let (volume, camera) = (blobs(), around_blobs());
    let function = matter([0.9, 0.7, 0.4], &[(0.1, 0.0), (0.4, 1.5), (1.0, 0.2)]);
    let drawn_by = |path: PathTracing, asked: bool| {
        let mut renderer = Renderer::new(device(), &volume).expect("a renderer");
        renderer.end_paths_when(Arc::new(AtomicBool::new(asked)));
        let settings = settings(path);
        let scene = scene(&volume, &function, &camera, &settings, [60, 50]);
        let picture = renderer.render(&scene, &[]).expect("a picture").picture;
        (picture, renderer.traced().paths)
    };
    let many = PathTracing {
        samples: 64,
        denoise: true,
        ..lit()
    };
    let short = PathTracing {
        seconds: Some(1e-6),
        ..many.clone()
    };
    for (picture, paths) in [drawn_by(many.clone(), true), drawn_by(short, false)] {
        assert!(paths > 0 && paths < 64, "{paths}");
        let settings = settings(PathTracing {
            samples: paths,
            denoise: false,
            ..many.clone()
        });
        let wanted = drawn(&scene(&volume, &function, &camera, &settings, [60, 50]));
        for (a, b) in picture.pixels.iter().zip(&wanted.pixels) {
            assert!((0..4).all(|c| (a[c] - b[c]).abs() < 1e-6), "{a:?} {b:?}");
        }
    }
    assert_eq!(drawn_by(many, false).1, 64);
}
