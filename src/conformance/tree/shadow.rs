//! A20: light that a uniform medium scatters once towards the eye, by half-angle slices, which take it slice by slice.
//! With q = exp(-s h) and N slices of which a sample of the eye meets one each:
//!
//! ```text
//! light from the eye     sum of (1 - q) q^k q^k          = (1 - q^2N) / (1 + q)
//! light from behind      sum of (1 - q) q^k q^(N-1-k)    = N (1 - q) q^(N-1)
//! seen                   ambient (1 - q^N) + (1 - ambient) light
//! ```

use super::ground;
use crate::camera::{Camera, Projection};
use crate::conformance::case::{Case, Stop};
use crate::conformance::measurement::{Bound, Measurement};
use crate::conformance::oracle::{Classes, Numbers, PictureCase};
use crate::conformance::test_bed::TestBed;
use crate::technique::{Light, Settings, Shading, Shadows, Technique};
use crate::transfer::{ColorPoint, Interpolation, OpacityPoint, TransferFunction};
use crate::volume::Grid;
use glam::{DAffine3, DVec3, dvec3};

const SIDE: u32 = 12;
const EXTINCTION: f64 = 0.11;
/// The distance of 1 from the next f32, and what log may be off by near 1.
const EPS: f64 = 1.0 / (1u32 << 23) as f64;
const LOG: f64 = 1.0 / (1u32 << 21) as f64;

const DERIVATION: &str = "e = 2^-23, an operation may round either way. The opacity of a slice is off by 2^-21 for log over the reference \
length times h, by (3 + 2 s h) e for exp and by 6 e. Each of N slices lets its error into what the eye sees, into what the eye sees of those \
behind and into what the light leaves for those after, seen by at most all of the light; blends round thrice on both ways: \
allowed = 3 N (that + 4 e).";

/// Both ways of the light, coarse and fine.
pub fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for (word, towards) in [("from_the_eye", DVec3::NEG_Z), ("from_behind", DVec3::Z)] {
        for per_voxel in [1, 2, 4] {
            let name = format!("slices_3d.half_angle.{word}.{}_slices", SIDE * per_voxel);
            let case = Case::new(name, move |bed| draw(bed, towards, per_voxel));
            cases.push(case.needing(ground::blended_floats()));
        }
    }
    cases
}

fn draw(bed: &mut TestBed, towards: DVec3, per_voxel: u32) -> Result<Measurement, Stop> {
    let grid = Grid {
        dims: [SIDE; 3],
        world_from_voxel: DAffine3::IDENTITY,
    };
    let light = Light::of_world(towards, [1.0; 3]);
    let shading = Shading {
        lights: vec![light],
        shadows: Shadows::HalfAngle,
        ..Shading::plain()
    };
    let ambient = shading.ambient;
    let shot = PictureCase {
        grid,
        camera: Camera {
            eye: grid.center() - dvec3(0.0, 0.0, 30.0),
            target: grid.center(),
            up: DVec3::Y,
            projection: Projection::Orthographic {
                view_height: SIDE.into(),
            },
            zoom: 1.0,
        },
        extent: [SIDE; 2],
        settings: Settings {
            technique: Technique::Slices3d,
            samples_per_voxel: per_voxel.into(),
            shading: Some(shading),
            color_space: Classes::SPACE,
            conformance: true,
            ..Settings::default()
        },
    };
    let function = TransferFunction {
        color: vec![ColorPoint {
            value: 0.0,
            srgb: [1.0; 3],
        }],
        opacity: vec![OpacityPoint {
            value: 0.0,
            opacity: -(-EXTINCTION).exp_m1(),
        }],
        reference_length: Some(1.0),
        interpolation: Interpolation::Step,
        gradient_transfer: None,
        medium: None,
    };
    let numbers = Numbers::of(&shot, |_| 1.0);
    let found = bed.render(&shot.scene(&numbers.volume, Some(&function)), &[])?;
    let (h, slices) = (1.0 / f64::from(per_voxel), SIDE * per_voxel);
    let (q, n) = ((-EXTINCTION * h).exp(), f64::from(slices));
    let direct = match towards == DVec3::Z {
        true => n * (1.0 - q) * q.powf(n - 1.0),
        false => (1.0 - q.powf(2.0 * n)) / (1.0 + q),
    };
    let alpha = 1.0 - q.powf(n);
    let color = ambient * alpha + (1.0 - ambient) * direct;
    let of_slice = LOG * h + (3.0 + 2.0 * EXTINCTION * h) * EPS + 6.0 * EPS;
    let allowed = 3.0 * n * (of_slice + 4.0 * EPS);
    let bound = Bound::new("half-angle-sum", DERIVATION)
        .with("N", n)
        .with("h", h);
    let mut measurement = Measurement::new(bound, 400);
    for ([x, y], pixel) in shot.pixels().zip(&found.pixels) {
        // Texels of the light at the rim of the box see past it.
        if !(1..SIDE - 1).contains(&x) || !(1..SIDE - 1).contains(&y) {
            continue;
        }
        for (c, &found) in pixel.iter().enumerate() {
            let wanted = if c == 3 { alpha } else { color };
            let at = || format!("channel {c} of pixel {:?}", [x, y]);
            measurement.take(at, wanted, found.into(), allowed);
        }
    }
    Ok(measurement)
}
