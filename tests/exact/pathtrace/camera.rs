//! Rays through a lens.

use super::{drawn, matter, mean, scene, settings};
use crate::shared::volume_of;
use glam::{DAffine3, DVec3, dvec3};
use stratavox::camera::{Camera, Projection};
use stratavox::picture::Picture;
use stratavox::technique::pathtrace::{Lens, PathTracing};

/// A small opaque plate at distance z, seen through a lens that is sharp at D: on the plane of focus its shadow is spread
/// over a circle 2 radius |z - D| / z wide, and as much light is covered as through a pinhole.
#[test]
fn a_point_out_of_focus_is_a_circle_as_wide_as_a_thin_lens_says() {
    const SIDE: f64 = 0.04;
    let (z, focus, radius) = (2.0, 3.0, 0.3);
    let place = DAffine3::from_translation(dvec3(-0.5 * SIDE, -0.5 * SIDE, 0.0))
        * DAffine3::from_scale(dvec3(0.25 * SIDE, 0.25 * SIDE, 1e-4));
    let volume = volume_of([4; 3], place, |_| 1.0);
    let function = matter([1.0; 3], &[(0.0, 8.0)]);
    let camera = Camera {
        eye: dvec3(0.0, 0.0, z),
        target: DVec3::ZERO,
        up: DVec3::Y,
        projection: Projection::Perspective { fov_degrees: 30.0 },
        zoom: 1.0,
    };
    let extent = 96;
    let seen_by = |camera: &Camera, lens| {
        let settings = settings(PathTracing {
            samples: 256,
            bounces: Some(0),
            density: 1e4,
            lens,
            ..PathTracing::default()
        });
        drawn(&scene(&volume, &function, camera, &settings, [extent; 2]))
    };
    let picture = |lens| seen_by(&camera, lens);
    let sharp = picture(None);
    let blurred = picture(Some(Lens {
        radius,
        focus: Some(focus),
    }));
    // Of pixels on the plane of focus.
    let pixel = 2.0 * focus * 15.0_f64.to_radians().tan() / f64::from(extent);
    let middle = 0.5 * f64::from(extent);
    let mut moments = [0.0; 2];
    for (i, p) in blurred.pixels.iter().enumerate() {
        let [x, y] = [i as u32 % extent, i as u32 / extent].map(|n| f64::from(n) + 0.5 - middle);
        moments[0] += f64::from(p[3]);
        moments[1] += f64::from(p[3]) * (x * x + y * y) * pixel * pixel;
    }
    // The mean square of a disc is r^2 / 2, and the plate's own of a square w^2 / 6.
    let (r, own) = (radius * (z - focus).abs() / z, SIDE * focus / z);
    let wanted = (r * r + own * own / 3.0).sqrt();
    let found = (2.0 * moments[1] / moments[0]).sqrt();
    println!("{found} of {wanted}");
    // Some 3500 rays meet it, and their squares spread by 1 / sqrt(3) of the mean: four standard errors of its root.
    assert!((found / wanted - 1.0).abs() < 0.02, "{found} {wanted}");
    let [covered, through_pinhole] = [&blurred, &sharp].map(|picture| mean(picture, 3)[0]);
    // As many of the pinhole's rays do: two standard errors of the ratio.
    assert!(
        (covered / through_pinhole - 1.0).abs() < 0.05,
        "{covered} {through_pinhole}"
    );
    let apart = |a: &Picture, b: &Picture| {
        let pairs = a.pixels.iter().zip(&b.pixels);
        let off = pairs.map(|(a, b)| f64::from((a[3] - b[3]).abs()));
        off.fold(0.0, f64::max)
    };
    assert!(apart(&blurred, &sharp) > 0.7);
    // What lies on the plane of focus is as sharp as through a pinhole, 22 degrees beside its middle too: there a sphere of
    // focus would spread it over 3 pixels. Of 256 rays a pixel the difference has a standard error of .045 at most.
    for beside in [0.0, 0.8] {
        let camera = Camera {
            eye: dvec3(beside, 0.0, z),
            target: dvec3(beside, 0.0, 0.0),
            projection: Projection::Perspective { fov_degrees: 60.0 },
            ..camera
        };
        let [through_pinhole, through_lens] = [
            None,
            Some(Lens {
                radius: 1.0,
                focus: None,
            }),
        ]
        .map(|lens| seen_by(&camera, lens));
        // The plate is 1.66 pixels wide: it covers .69 of the pixels about a corner, and more of others.
        assert!(through_pinhole.pixels.iter().any(|p| p[3] > 0.5));
        let off = apart(&through_pinhole, &through_lens);
        assert!(off < 0.25, "{off}");
    }
}
