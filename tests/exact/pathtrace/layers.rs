//! What paths leave beside their picture, against closed forms, against other pictures of the same paths, and what it adds up to.

use super::isosurfaces::with_levels;
use super::medium::{medium, points};
use super::{
    LAYERS, around_blobs, at, blobs, drawn_with, eye, layer, light, lit, matter, numbers, scene,
    settings,
};
use crate::shared::{device, volume_of};
use glam::{DAffine3, DQuat, DVec3, dvec3};
use std::sync::{Arc, Mutex};
use stratavox::camera::Camera;
use stratavox::color::{decode_srgb, encode_srgb};
use stratavox::offscreen::{self, Error, PathSums, Renderer};
use stratavox::picture::LayerKind;
use stratavox::scene::Scene;
use stratavox::technique::Settings;
use stratavox::technique::pathtrace::PathTracing;

/// Seen along its normal, and aslant, where a pixel's rays meet it farther and nearer than its middle.
#[test]
fn a_plane_has_its_albedo_its_normal_and_its_depth() {
    let vacuum = matter([1.0; 3], &[(0.0, 0.0)]);
    let oblique = DAffine3::from_rotation_translation(
        DQuat::from_axis_angle(dvec3(1.0, 2.0, -0.5).normalize(), 0.7),
        dvec3(-7.0, -4.0, -3.0),
    ) * DAffine3::from_scale(dvec3(1.0, 0.7, 1.4));
    let slope = dvec3(0.3, -0.2, 0.5);
    let tilted = volume_of([14, 15, 10], oblique, |p| p.dot(slope));
    let middle = dvec3(7.0, 7.5, 5.0);
    let normal = (oblique.matrix3.inverse().transpose() * slope).normalize();
    let at_middle = oblique.transform_point3(middle);
    let albedo = [0.8, 0.5, 0.2];
    for (name, aslant, density) in [
        ("across", DVec3::ZERO, 1.0),
        ("aslant", dvec3(0.2, 0.3, 0.1), 1.0),
        ("of half the albedo", DVec3::ZERO, 0.5),
    ] {
        let towards = (normal + aslant).normalize();
        let camera = Camera {
            eye: at_middle + 3.0 * towards,
            target: at_middle,
            ..eye(DVec3::Z)
        };
        let path = PathTracing {
            samples: 4,
            // At the edges of the box, where values are held, the plane bends and is met again.
            bounces: Some(1),
            albedo: density,
            lights: vec![light(normal)],
            ..PathTracing::default()
        };
        let settings = with_levels(path, &[(middle.dot(slope), albedo, 1.0)]);
        let extent = [16; 2];
        let scene = scene(&tilted, &vacuum, &camera, &settings, extent);
        let reference = offscreen::reference::render::<f64>(&scene).expect("a picture");
        for picture in [reference, drawn_with(&scene, &LAYERS)] {
            let of = |kind| numbers(&picture, kind);
            for found in of(LayerKind::Albedo).chunks(3) {
                for (found, albedo) in found.iter().zip(albedo) {
                    let wanted = density * decode_srgb(encode_srgb(albedo));
                    assert!((f64::from(*found) - wanted).abs() < 1e-6, "{name}: {found}");
                }
            }
            for found in of(LayerKind::Normal).chunks(3) {
                let found = DVec3::from_slice(&[found[0], found[1], found[2]].map(f64::from));
                assert!((found - normal).length() < 1e-4, "{name}: {found}");
            }
            let rays = camera.rays(extent);
            // Half a pixel across and down, where the plane rises by the tangent.
            let cosine = towards.dot(normal);
            let side = 1.0 / f64::from(extent[0]);
            let rise = 0.5_f64.sqrt() * side * (1.0 - cosine * cosine).max(0.0).sqrt() / cosine;
            for (i, &found) in of(LayerKind::Depth).iter().enumerate() {
                let [x, y] = [i % 16, i / 16].map(|n| n as f64 + 0.5);
                let (origin, way) = rays.at(x, y);
                let wanted = (at_middle - origin).dot(normal) / way.dot(normal);
                let off = (f64::from(found) - wanted).abs();
                assert!(off <= rise + 2e-5, "{name}: {found} {wanted}");
            }
            for (direct, color) in of(LayerKind::Direct).iter().zip(colors(&picture)) {
                assert!(*direct == color && color > 0.0, "{name}: {direct} {color}");
            }
            for kind in [LayerKind::Indirect, LayerKind::Emission, LayerKind::Samples] {
                assert!(of(kind).iter().all(|&x| x == 0.0), "{name}: {kind:?}");
            }
            assert!(of(LayerKind::Bounces).iter().all(|&x| x == 1.0), "{name}");
        }
    }
}

fn colors(picture: &stratavox::picture::Picture) -> Vec<f32> {
    let rgb = picture.pixels.iter().flat_map(|&[r, g, b, _]| [r, g, b]);
    rgb.collect()
}

/// Of a layer of optical depth x seen across, first collisions lie 1/x - e^-x / (1 - e^-x) deep in it on average.
#[test]
fn light_that_is_scattered_once_is_direct_and_its_depth_is_that_of_a_layer() {
    let (depth, albedo) = (1.92_f64, 0.8);
    let function = matter([0.9, 0.5, 0.2], &[(0.0, 0.0), (0.5, depth), (1.0, depth)]);
    let settings = Settings {
        conformance: true,
        ..settings(PathTracing {
            samples: 16,
            bounces: Some(1),
            albedo,
            sky: [0.3, 0.2, 0.1],
            lights: vec![light(at(0.7, 2.0))],
            ..PathTracing::default()
        })
    };
    let (volume, camera) = (layer(|_| 1.0), eye(at(1.0, 0.0)));
    let scene = scene(&volume, &function, &camera, &settings, [48; 2]);
    let picture = drawn_with(&scene, &LAYERS);
    let of = |kind| numbers(&picture, kind);
    for (direct, color) in of(LayerKind::Direct).iter().zip(colors(&picture)) {
        // Of 16 paths, two lights each.
        assert!((direct - color).abs() <= 32.0 * 2.0_f32.powi(-24) * color);
    }
    for kind in [LayerKind::Indirect, LayerKind::Emission, LayerKind::Normal] {
        assert!(of(kind).iter().all(|&x| x == 0.0), "{kind:?}");
    }
    let met = || picture.pixels.iter().map(|pixel| pixel[3]);
    // Each path that meets something is scattered once.
    assert!(met().zip(of(LayerKind::Bounces)).all(|(a, b)| a == *b));
    for (met, found) in met().zip(of(LayerKind::Albedo).chunks(3)) {
        for (found, own) in found.iter().zip([0.9, 0.5, 0.2]) {
            let wanted = albedo * decode_srgb(encode_srgb(own)) * f64::from(met);
            assert!((f64::from(*found) - wanted).abs() < 1e-6);
        }
    }
    let weighted = met().zip(of(LayerKind::Depth));
    let weighted = weighted.filter(|(met, _)| *met > 0.0);
    let [sum, weight] = weighted.fold([0.0; 2], |[sum, weight], (met, depth)| {
        let met = f64::from(met);
        [sum + met * f64::from(*depth), weight + met]
    });
    let gone = (-depth).exp() / (1.0 - (-depth).exp());
    let wanted = 3.0 + 1.0 / depth - gone;
    // Of one: 1/x^2 - e^-x / (1 - e^-x)^2.
    let variance = depth.powi(-2) - gone * (1.0 + gone);
    let error = (variance / (16.0 * weight)).sqrt();
    let off = (sum / weight - wanted) / error;
    println!("{} +- {error}, wanted {wanted}", sum / weight);
    assert!(off.abs() < 4.0, "{off} standard errors");
}

/// Of extinction s under a majorant m a ray through a layer tries m / s (1 - e^-s) collisions until one is real or it leaves.
#[test]
fn samples_are_the_collisions_that_are_tried() {
    let (sigma, majorant) = (0.7_f64, 2.5);
    let function = matter([1.0; 3], &[(0.0, 0.0), (0.5, majorant), (1.0, sigma)]);
    let settings = Settings {
        skip: false,
        ..settings(PathTracing {
            samples: 16,
            bounces: Some(0),
            ..PathTracing::default()
        })
    };
    let (volume, camera) = (layer(|_| 1.0), eye(at(1.0, 0.0)));
    let scene = scene(&volume, &function, &camera, &settings, [48; 2]);
    let picture = drawn_with(&scene, &LAYERS);
    let tried = numbers(&picture, LayerKind::Samples);
    let n = tried.len() as f64;
    let mean = tried.iter().copied().map(f64::from).sum::<f64>() / n;
    let squares = tried.iter().map(|&x| (f64::from(x) - mean).powi(2));
    let error = (squares.sum::<f64>() / (n - 1.0) / n).sqrt();
    let wanted = majorant / sigma * (1.0 - (-sigma).exp());
    println!("{mean} +- {error}, wanted {wanted}");
    assert!((mean - wanted).abs() < 4.0 * error && error < 0.02 * wanted);
    // Without bounces matter shines in its colours, and a collision is no less a first one.
    assert!(numbers(&picture, LayerKind::Emission) == colors(&picture));
    for kind in [LayerKind::Direct, LayerKind::Indirect, LayerKind::Bounces] {
        assert!(numbers(&picture, kind).iter().all(|&x| x == 0.0));
    }
}

/// Matter that shines, scatters and lies under a sky.
fn all_lights(path: PathTracing) -> (stratavox::transfer::TransferFunction, Settings) {
    let function = medium(
        points([(0.0, [0.0; 3]), (0.4, [0.4; 3]), (1.0, [0.15; 3])]),
        points([(0.0, [0.9, 0.7, 0.4]), (0.5, [0.3, 0.9, 0.8])]),
        points([(0.2, [0.0; 3]), (0.6, [0.05, 0.02, 0.1])]),
    );
    (function, settings(path))
}

/// Light that was scattered once is the picture of one bounce, and what nothing scatters that of none: the same paths to the bit,
/// of which one is in each pixel, so that no sum has another order.
#[test]
fn direct_light_and_emission_are_pictures_of_fewer_bounces() {
    let (volume, camera) = (blobs(), around_blobs());
    let of = |bounces, is_lit: bool| {
        let path = PathTracing {
            samples: 1,
            bounces,
            sky: [0.0; 3],
            lights: if is_lit { lit().lights } else { Vec::new() },
            ..lit()
        };
        let (shining, settings) = all_lights(path);
        let dark = matter([0.9, 0.7, 0.4], &[(0.0, 0.0), (0.4, 0.4), (1.0, 0.2)]);
        let function = if is_lit { dark } else { shining };
        drawn_with(
            &scene(&volume, &function, &camera, &settings, [60, 50]),
            &LAYERS,
        )
    };
    let (all, once) = (of(None, true), of(Some(1), true));
    let direct = numbers(&all, LayerKind::Direct);
    assert!(direct == colors(&once));
    assert!(direct != colors(&all));
    assert!(direct.iter().filter(|&&x| x > 0.0).count() > 1000);
    let (all, none) = (of(None, false), of(Some(0), false));
    let emission = numbers(&all, LayerKind::Emission);
    assert!(emission == colors(&none));
    assert!(emission != colors(&all));
    assert!(emission.iter().filter(|&&x| x > 0.0).count() > 1000);
}

/// Nothing is counted twice and nothing is lost: sums of n numbers of 0 or more in f32 are off by (n - 1) 2^-24 of them at most.
#[test]
fn light_by_its_scatterings_adds_up_to_the_picture() {
    let (volume, camera) = (blobs(), around_blobs());
    let (paths, sky) = (8.0, [0.2, 0.3, 0.5]);
    for f0 in [0.0, 0.3] {
        let pictures = [false, true].map(|shows_sky| {
            let path = PathTracing {
                samples: 8,
                f0,
                sky,
                shows_sky,
                ..lit()
            };
            let (function, settings) = all_lights(path);
            let scene = scene(&volume, &function, &camera, &settings, [60, 50]);
            let reference = offscreen::reference::render::<f32>(&scene).expect("a picture");
            [drawn_with(&scene, &LAYERS), reference]
        });
        let [[hidden, of_hidden], [seen, of_seen]] = pictures;
        let mut indirect_only = 0;
        for (picture, behind) in [
            (&hidden, None),
            (&of_hidden, None),
            (&seen, Some(&hidden)),
            (&of_seen, Some(&of_hidden)),
        ] {
            let of = |kind| numbers(picture, kind);
            let kinds = [LayerKind::Direct, LayerKind::Indirect, LayerKind::Emission];
            let parts = kinds.map(of);
            let (tried, bounces) = (of(LayerKind::Samples), of(LayerKind::Bounces));
            for (i, color) in colors(picture).into_iter().enumerate() {
                let (pixel, color) = (i / 3, f64::from(color));
                let part: [f64; 3] = parts.each_ref().map(|part| part[i].into());
                let through = behind.map_or(0.0, |hidden| 1.0 - hidden.pixels[pixel][3]);
                let sum = part.iter().sum::<f64>() + sky[i % 3] * f64::from(through);
                let n = paths * f64::from(tried[pixel] + bounces[pixel] + 2.0);
                let bound = 2.0 * (n + 2.0) * 2.0_f64.powi(-24) * color;
                assert!((sum - color).abs() <= bound, "{pixel}: {part:?} {color}");
                indirect_only += usize::from(part.iter().all(|&x| x > 0.0));
            }
        }
        assert!(indirect_only > 4000, "{indirect_only} have all three");
    }
}

/// However matter scatters, what comes to the eye unscattered is E / sigma (1 - e^(-sigma / mu)).
#[test]
fn emission_is_what_comes_straight_to_the_eye() {
    let (mu, sigma, emission) = (0.6, 1.5, [0.9, 0.3, 0.1]);
    let function = medium(
        points([(0.0, [0.0; 3]), (0.5, [sigma; 3]), (1.0, [sigma; 3])]),
        points([(0.0, [0.8; 3])]),
        points([(0.0, [0.0; 3]), (0.5, emission)]),
    );
    let settings = settings(PathTracing {
        samples: 64,
        ..PathTracing::default()
    });
    let (volume, camera) = (layer(|_| 1.0), eye(at(mu, 0.0)));
    let scene = scene(&volume, &function, &camera, &settings, [32; 2]);
    let picture = drawn_with(&scene, &LAYERS);
    let found = numbers(&picture, LayerKind::Emission);
    for (c, e) in emission.into_iter().enumerate() {
        let own = || found.iter().skip(c).step_by(3).copied().map(f64::from);
        let n = own().count() as f64;
        let mean = own().sum::<f64>() / n;
        let error = (own().map(|x| (x - mean).powi(2)).sum::<f64>() / (n - 1.0) / n).sqrt();
        let wanted = e / sigma * (1.0 - (-sigma / mu).exp());
        assert!((mean - wanted).abs() < 4.0 * error, "{mean} {wanted}");
        assert!(error < 0.02 * wanted);
        let [all, _] = super::mean(&picture, c);
        assert!(all > 1.2 * wanted, "{all} {wanted}");
    }
}

/// Layers are those of the picture's paths however the work is cut, they change no pixel, and a picture that goes on from sums
/// without them has none.
#[test]
fn layers_change_no_pixel_and_do_not_depend_on_how_the_work_is_cut() {
    let (volume, camera) = (blobs(), around_blobs());
    let function = matter([0.9, 0.7, 0.4], &[(0.1, 0.0), (0.4, 1.5), (1.0, 0.2)]);
    let mut renderer = Renderer::new(device(), &volume).expect("a renderer");
    let path = PathTracing {
        samples: 11,
        ..lit()
    };
    let settings = settings(path);
    let scene = scene(&volume, &function, &camera, &settings, [60, 50]);
    let plain = renderer.render(&scene, &[]).expect("a picture").picture;
    let mut of = |ms, kinds: &[LayerKind]| {
        renderer.set_submission_ms(ms);
        renderer.render(&scene, kinds).expect("a picture").picture
    };
    let whole = of(f64::INFINITY, &LAYERS);
    assert!(whole.pixels == plain.pixels);
    let bits = |numbers: &[f32]| numbers.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    for ms in [100.0, 0.0] {
        let pieces = of(ms, &LAYERS);
        for kind in LAYERS {
            let [a, b] = [&whole, &pieces].map(|picture| bits(numbers(picture, kind)));
            assert!(a == b, "{kind:?}");
        }
    }
    for kind in LAYERS {
        let alone = of(100.0, &[kind]);
        assert!(alone.pixels == plain.pixels);
        assert!(
            bits(numbers(&alone, kind)) == bits(numbers(&whole, kind)),
            "{kind:?}"
        );
    }
    assert_no_layers_of_sums(renderer, &scene);
}

/// What no ray meets has the layers of nothing, whatever the images held before.
#[test]
fn where_nothing_is_met_layers_are_empty_behind_other_pictures() {
    let (volume, near) = (blobs(), around_blobs());
    let far = Camera {
        eye: 3.0 * near.eye - 2.0 * near.target,
        ..near
    };
    let near = Camera { zoom: 6.0, ..near };
    let function = matter([0.9, 0.7, 0.4], &[(0.1, 0.0), (0.4, 1.5), (1.0, 0.2)]);
    let settings = settings(PathTracing {
        samples: 2,
        ..lit()
    });
    let mut renderer = Renderer::new(device(), &volume).expect("a renderer");
    let mut of = |camera| {
        let scene = scene(&volume, &function, camera, &settings, [60, 50]);
        renderer.render(&scene, &LAYERS).expect("a picture").picture
    };
    let filled = of(&near);
    let met = filled.pixels.iter().filter(|pixel| pixel[3] > 0.0);
    assert!(met.count() > 2500);
    let picture = of(&far);
    let mut empty = 0;
    for (i, pixel) in picture.pixels.iter().enumerate() {
        if pixel[3] > 0.0 {
            continue;
        }
        empty += 1;
        for kind in LAYERS {
            let n = kind.numbers();
            let own = &numbers(&picture, kind)[n * i..][..n];
            match kind {
                LayerKind::Depth => assert!(own[0].is_nan()),
                // In matter without extinction beside it collisions are tried.
                LayerKind::Samples => assert!(own[0] >= 0.0 && own[0] < 100.0),
                _ => assert!(own.iter().all(|&x| x == 0.0), "{kind:?}: {own:?}"),
            }
        }
    }
    assert!(empty > 1500, "{empty}");
}

fn assert_no_layers_of_sums(mut renderer: Renderer, scene: &Scene) {
    let kept = Arc::new(Mutex::new(PathSums::default()));
    let keeps = Arc::clone(&kept);
    renderer.keep_paths(PathSums::default(), move |sums| {
        *keeps.lock().expect("one thread") = sums.clone();
    });
    renderer.render(scene, &[]).expect("a picture");
    let begun = kept.lock().expect("one thread").clone();
    assert!(begun.paths() > 0);
    // What guides the filter that takes noise out is there; what else somebody wants has to be wanted from the beginning.
    assert!(begun.have(LayerKind::Noise) && begun.have(LayerKind::Albedo));
    assert!(!begun.have(LayerKind::Direct));
    renderer.keep_paths(begun, |_| {});
    let refused = renderer.render(scene, &[LayerKind::Noise, LayerKind::Direct]);
    assert!(matches!(refused, Err(Error::NoLayersOfBegun)));
}
