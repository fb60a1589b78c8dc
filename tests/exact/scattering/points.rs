//! Points that shine in fog, seen along a ray that passes near.

use super::{drawn, matter, scene, single};
use crate::shared::volume_of;
use glam::{DAffine3, DVec3, dvec3};
use std::f64::consts::PI;
use stratavox::camera::{Camera, Projection};
use stratavox::offscreen::reference;
use stratavox::picture::Picture;
use stratavox::technique::pathtrace::{Lamp, LampShape, PathTracing};
use stratavox::technique::{Lattice, Settings, SingleScattering};

/// A ray from -2 to 3 along x in fog that scatters light to all sides alike, and a point of intensity 1 beside the origin.
struct Beside {
    extinction: f64,
    distance: f64,
    scattering: SingleScattering,
    lattice: Lattice,
}

impl Beside {
    fn settings(&self, segments: u32) -> Settings {
        let lamp = Lamp {
            place: dvec3(0.0, self.distance, 0.0),
            // Points have no size here.
            shape: LampShape::Sphere { radius: Some(0.0) },
            srgb: [1.0; 3],
        };
        let path = PathTracing {
            lamps: vec![lamp],
            ..PathTracing::default()
        };
        Settings {
            samples_per_voxel: f64::from(segments) / 16.0,
            conformance: true,
            lattice: self.lattice,
            ..single(self.scattering, path)
        }
    }

    /// In f64, and by the device where it is asked.
    fn found(&self, segments: u32, on_device: bool) -> [f64; 2] {
        let side = 5.0 / 16.0;
        let corner = dvec3(-2.0, -2.0 * side, -2.0 * side);
        let place = DAffine3::from_translation(corner) * DAffine3::from_scale(DVec3::splat(side));
        let volume = volume_of([16, 4, 4], place, |_| 1.0);
        let function = matter([1.0; 3], &[(0.0, self.extinction)]);
        let camera = Camera {
            eye: dvec3(-9.0, 0.0, 0.0),
            target: DVec3::ZERO,
            up: DVec3::Z,
            projection: Projection::Orthographic { view_height: 1e-6 },
            zoom: 1.0,
        };
        let settings = self.settings(segments);
        let scene = scene(&volume, &function, &camera, &settings, [3; 2]);
        // Of colour 1 where the camera is turned to: intensity pi d^2.
        let intensity = PI * self.distance * self.distance;
        let middle = |picture: Picture| f64::from(picture.pixels[4][0]) / intensity;
        let double = middle(reference::render::<f64>(&scene).expect("a picture"));
        [
            double,
            if on_device {
                middle(drawn(&scene))
            } else {
                double
            },
        ]
    }

    /// By the middles of many steps, of light that nothing hinders or of what fog leaves of it.
    fn wanted(&self) -> f64 {
        let n = 400_000;
        let hindered = match self.scattering {
            SingleScattering::Open => 0.0,
            _ => self.extinction,
        };
        let of = |i: i32| {
            let t = 5.0 * (f64::from(i) + 0.5) / f64::from(n);
            let r = (t - 2.0).hypot(self.distance);
            (-self.extinction * t - hindered * r).exp() / (r * r)
        };
        let sum: f64 = (0..n).map(of).sum();
        self.extinction / (4.0 * PI) * sum * 5.0 / f64::from(n)
    }
}

/// Sigma / (4 pi) times the angle that the ray is seen under over d, of fog as thin as it was nothing.
#[test]
fn a_point_in_thin_fog_gives_the_angle_that_the_ray_is_seen_under() {
    let extinction = 0.01;
    for distance in [0.25, 0.05, 0.01] {
        for lattice in [Lattice::Ray, Lattice::Planes] {
            let beside = Beside {
                extinction,
                distance,
                scattering: SingleScattering::Open,
                lattice,
            };
            let angle = (3.0_f64 / distance).atan() + (2.0 / distance).atan();
            let of_vacuum = extinction * angle / distance / (4.0 * PI);
            let wanted = beside.wanted();
            // What of the light is lost on the way to the eye: of two units of fog, 2 % at most.
            assert!(
                (wanted / of_vacuum - 0.98).abs() < 0.02,
                "{wanted} {of_vacuum}"
            );
            let [double, found] = beside.found(64, true);
            println!("{distance} {lattice}: {double} {found}, wanted {wanted}");
            // The point is a tenth of a step off the middle of its segment: 1e-4 of the way to the eye.
            assert!(
                (double / wanted - 1.0).abs() < 1.2e-4,
                "{distance} {lattice}"
            );
            // Opacities of 8e-4 have seven bits less than 1.
            assert!((found / wanted - 1.0).abs() < 2e-4, "{distance} {lattice}");
        }
    }
}

/// Light as far as the ray is long from it: .0988656, by middles of many steps.
#[test]
fn a_point_in_fog_is_met_with_order_two() {
    let beside = Beside {
        extinction: 0.9,
        distance: 0.25,
        scattering: SingleScattering::March,
        lattice: Lattice::Ray,
    };
    let wanted = beside.wanted();
    assert!((wanted - 0.0988656).abs() < 1e-7, "{wanted}");
    let offs = [64, 128, 256].map(|segments| {
        let [double, found] = beside.found(segments, segments == 64);
        println!("{segments}: {double} {found}");
        let rounding = (found / double - 1.0).abs();
        assert!(rounding < 1e-5, "{segments}: {rounding}");
        double / wanted - 1.0
    });
    assert!(offs[0].abs() < 2.5e-4, "{offs:?}");
    for pair in offs.windows(2) {
        let order = (pair[0] / pair[1]).abs().log2();
        assert!((order - 2.0).abs() < 0.1, "{offs:?}: {order}");
    }
}
