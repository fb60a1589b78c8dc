//! Random paths whose answers are known: of each path, to the bit or by a formula, or of the mean of all.
//!
//! ```text
//! furnace   white matter in a white sky: each path brings 1
//! deep      the same of matter so dense that paths are scattered a hundred times and more
//! plane     of a value in vacuum, a light far away, one bounce: each path brings albedo n . l
//! cells     of N paths without bounces a binomial number meets matter of depth D: N (1 - e^-D), within 6 standard deviations
//! ```

use super::super::ground::PATHS;
use super::{EXTENT, light, shot};
use crate::camera::{Camera, Projection};
use crate::color::{decode_srgb, encode_srgb};
use crate::conformance::case::{Case, Stop};
use crate::conformance::measurement::{Bound, Measurement, Pictures};
use crate::conformance::oracle::{Numbers, PictureCase};
use crate::conformance::test_bed::TestBed;
use crate::picture::Picture;
use crate::technique::pathtrace::PathTracing;
use crate::technique::{Filter, Level};
use crate::transfer::{ColorPoint, Interpolation, OpacityPoint, Phase, TransferFunction};
use crate::volume::Grid;
use glam::{DAffine3, DVec3, dvec3};

/// The distance of 1 from the next f32: an operation may round either way.
const EPS: f64 = 1.0 / (1u32 << 23) as f64;

const OF_FURNACE: &str = "White matter takes nothing of a weight, and an even sky of radiance 1 is found where a path leaves alone: every path \
that meets matter brings 1 and no rounding comes in. Sums of up to 4 ones, divided by 4, are numbers of f32: red, green and blue are alpha, to the bit.";

const OF_PLANE: &str = "e = 2^-23, an operation may round either way. Voxels are whole numbers of 2^-7: slopes of a cell are exact but for the \
mixes of equal numbers, 2 e each, thrice. The gradient is three products with entries of a matrix that are off by e / 2, and two sums: \
8 e of the sum of their sizes, by cancellation 8 e k of its length, k that sum over the length. Its length, the quotient and the product \
with the light (a direction off by e / 2 and three products) are (5 + 5/2 + 2 x 4) e, the albedo 2 e, the mean over paths 4 e: allowed = \
albedo (8 k sqrt 3 + 22) e.";

const OF_CELLS: &str = "Each path meets matter by the chance p = 1 - e^-D, D the optical depth of its ray, which is the same for all rays of the \
picture, and independent of the others: of N paths it is a binomial number, N p on average, of the standard deviation sqrt(N p (1 - p)). \
Six of these: a right device is outside less than once in 10^8 choices of the seed, and the seed is one. Colours are those of the function where a \
path meets matter: alpha times these, within 4 e, e = 2^-23, which sums, a quotient and the decoding of colours (24 e) may be off by.";

/// All four.
pub fn cases() -> Vec<Case> {
    let name = |look: &str| format!("pathtrace.composite.{look}.linear_fetch.f32.perspective");
    vec![
        Case::new(name("furnace"), furnace),
        Case::new(name("deep"), deep),
        Case::new(name("plane"), plane),
        Case::new(
            "pathtrace.composite.cells.linear_fetch.f32.orthographic",
            cells,
        ),
    ]
}

/// One albedo, opacities over a length of 1.
fn matter(albedo: [f64; 3], extinctions: &[(f64, f64)]) -> TransferFunction {
    let opacity = |&(value, extinction): &(f64, f64)| OpacityPoint {
        value,
        opacity: -(-extinction).exp_m1(),
    };
    TransferFunction {
        color: vec![ColorPoint {
            value: 0.0,
            srgb: albedo.map(encode_srgb),
        }],
        opacity: extinctions.iter().map(opacity).collect(),
        reference_length: Some(1.0),
        interpolation: Interpolation::Linear,
        gradient_transfer: None,
        medium: None,
    }
}

fn furnace(bed: &mut TestBed) -> Result<Measurement, Stop> {
    in_white_sky(
        bed,
        PathTracing {
            phase: Phase::HenyeyGreenstein(0.5),
            surface: 3.0,
            ..PathTracing::default()
        },
    )
}

/// Optical depths of some ten: one path in a hundred is scattered more than 64 times, none so often that it ends by chance.
fn deep(bed: &mut TestBed) -> Result<Measurement, Stop> {
    let density = 3.0;
    in_white_sky(
        bed,
        PathTracing {
            density,
            ..PathTracing::default()
        },
    )
}

fn in_white_sky(bed: &mut TestBed, path: PathTracing) -> Result<Measurement, Stop> {
    let shot = shot(PATHS, Filter::Linear).with(|settings| {
        settings.path = PathTracing {
            samples: 4,
            sky: [1.0; 3],
            ..path
        };
    });
    let numbers = Numbers::of(&shot, super::ground::waves);
    let function = matter([1.0; 3], &[(0.2, 0.0), (0.6, 0.3), (0.9, 0.1)]);
    let found = bed.render(&shot.scene(&numbers.volume, Some(&function)), &[])?;
    let mut measurement = Measurement::new(Bound::new("white-sky", OF_FURNACE), 1000);
    for (pixel, numbers) in shot.pixels().zip(&found.pixels) {
        for c in 0..3 {
            let at = || format!("channel {c} of pixel {pixel:?}");
            measurement.take(at, numbers[3].into(), numbers[c].into(), 0.0);
        }
    }
    Ok(drawn(measurement, found, |[_, _, _, a]| [a; 4]))
}

fn plane(bed: &mut TestBed) -> Result<Measurement, Stop> {
    const ALBEDO: [f64; 3] = [0.8, 0.5, 0.25];
    let slope = dvec3(3.0, -2.0, 5.0) / 128.0;
    let way = dvec3(0.4, -0.9, 0.5);
    let shot = shot(PATHS, Filter::Linear);
    let level = slope.dot(0.5 * shot.grid.far_corner());
    let shot = shot.with(|settings| {
        settings.per_mode.levels = vec![Level {
            value: level,
            srgb: ALBEDO.map(encode_srgb),
            opacity: 1.0,
        }];
        settings.path = PathTracing {
            samples: 4,
            // Before the outermost voxels, where the plane is bent, a path may meet it once more.
            bounces: Some(1),
            lights: vec![light(way)],
            ..PathTracing::default()
        };
    });
    let numbers = Numbers::of(&shot, |p| slope.dot(p));
    let vacuum = matter([1.0; 3], &[(0.0, 0.0)]);
    let found = bed.render(&shot.scene(&numbers.volume, Some(&vacuum)), &[])?;
    let rows = shot.grid.world_from_voxel.matrix3.inverse().transpose();
    let across = rows * slope;
    let sizes = (0..3).map(|k| (rows.col(k) * slope[k]).abs());
    let cancels = sizes.sum::<DVec3>().length() / across.length();
    let to_eye = shot.camera.eye - shot.grid.center();
    let normal = across.normalize() * across.dot(to_eye).signum();
    let cosine = normal.dot(way.normalize());
    let bound = Bound::new("lambert", OF_PLANE).with("k", cancels);
    let mut measurement = Measurement::new(bound, 400);
    measurement.hold(|| "the light is before the plane".into(), cosine > 0.2);
    for (pixel, numbers) in shot.pixels().zip(&found.pixels) {
        if !is_filled(&shot, pixel, slope, level) {
            continue;
        }
        let at = || format!("alpha of pixel {pixel:?}");
        measurement.take(at, 1.0, numbers[3].into(), 0.0);
        for c in 0..3 {
            let albedo = decode_srgb(encode_srgb(ALBEDO[c]));
            let at = || format!("channel {c} of pixel {pixel:?}");
            let allowed = albedo * (8.0 * cancels * 3.0_f64.sqrt() + 22.0) * EPS;
            measurement.take(at, albedo * cosine, numbers[c].into(), allowed);
        }
    }
    let colour = ALBEDO.map(|c| (c * cosine) as f32);
    Ok(drawn(measurement, found, |[_, _, _, a]| {
        [a * colour[0], a * colour[1], a * colour[2], a]
    }))
}

/// Whether all rays of a pixel, and those of the pixels around, meet the plane inside of the outermost voxel centres, where the field is the
/// line that it should be: of a convex part of a plane.
fn is_filled(shot: &PictureCase, [x, y]: [u32; 2], slope: DVec3, level: f64) -> bool {
    let far = shot.grid.far_corner();
    let rays = shot.camera.rays(shot.extent);
    let to_voxel = shot.grid.world_from_voxel.inverse();
    let meets = |[dx, dy]: [f64; 2]| {
        let (origin, direction) = rays.at(f64::from(x) + dx, f64::from(y) + dy);
        let origin = to_voxel.transform_point3(origin);
        let direction = to_voxel.transform_vector3(direction);
        let t = (level - slope.dot(origin)) / slope.dot(direction);
        let at = origin + t * direction;
        t > 0.0 && at.cmpgt(DVec3::splat(0.5)).all() && at.cmplt(far - 0.5).all()
    };
    [[-1.0, -1.0], [2.0, -1.0], [-1.0, 2.0], [2.0, 2.0]]
        .into_iter()
        .all(meets)
}

fn cells(bed: &mut TestBed) -> Result<Measurement, Stop> {
    const EXTINCTION: f64 = 0.8;
    const ALBEDO: [f64; 3] = [0.9, 0.6, 0.3];
    const PATHS_OF_PIXEL: u32 = 16;
    let grid = Grid {
        dims: [40, 40, 24],
        world_from_voxel: DAffine3::IDENTITY,
    };
    let towards = dvec3(0.3, -0.2, 1.0).normalize();
    let mut shot = shot(PATHS, Filter::Linear).with(|settings| {
        settings.path = PathTracing {
            samples: PATHS_OF_PIXEL,
            bounces: Some(0),
            ..PathTracing::default()
        };
    });
    shot.grid = grid;
    shot.camera = Camera {
        eye: grid.center() + 100.0 * towards,
        target: grid.center(),
        up: DVec3::Y,
        projection: Projection::Orthographic { view_height: 12.0 },
        zoom: 1.0,
    };
    // One layer of voxels beside a face of macro cells, that at z = 8: half a voxel of what it makes lies in the cells below,
    // whose own voxels are empty.
    let numbers = Numbers::of(&shot, |p| f64::from(u8::from(p.z > 8.0 && p.z < 9.0)));
    let function = matter(ALBEDO, &[(0.0, 0.0), (1.0, EXTINCTION)]);
    let found = bed.render(&shot.scene(&numbers.volume, Some(&function)), &[])?;
    // Opacities are linear in values, extinctions are not: the mean over a rise from 0 to 1, on both sides.
    let steps = 10_000;
    let opacity = -(-EXTINCTION).exp_m1();
    let of = |i: i32| -(-opacity * (f64::from(i) + 0.5) / f64::from(steps)).ln_1p();
    let mean = (0..steps).map(of).sum::<f64>() / f64::from(steps);
    let depth = 2.0 * mean / towards.z;
    let chance = -(-depth).exp_m1();
    let count = f64::from(PATHS_OF_PIXEL * EXTENT[0] * EXTENT[1]);
    let deviation = (chance * (1.0 - chance) / count).sqrt();
    let bound = Bound::new("binomial", OF_CELLS)
        .with("N", count)
        .with("D", depth);
    let mut measurement = Measurement::new(bound, 1000);
    let met = found.pixels.iter().map(|p| f64::from(p[3]));
    let met = met.sum::<f64>() / f64::from(EXTENT[0] * EXTENT[1]);
    let at = || "the part of all paths that meets matter".into();
    measurement.take(at, chance, met, 6.0 * deviation);
    let colour = ALBEDO.map(|c| decode_srgb(encode_srgb(c)));
    for (pixel, numbers) in shot.pixels().zip(&found.pixels) {
        for c in 0..3 {
            let at = || format!("channel {c} of pixel {pixel:?}");
            let wanted = f64::from(numbers[3]) * colour[c];
            measurement.take(at, wanted, numbers[c].into(), 28.0 * EPS);
        }
    }
    let colour = colour.map(|c| c as f32);
    Ok(drawn(measurement, found, |[_, _, _, a]| {
        [a * colour[0], a * colour[1], a * colour[2], a]
    }))
}

/// The measurement with its pictures: what is expected of a pixel is what `of` makes of it.
fn drawn(
    mut measurement: Measurement,
    found: Picture,
    of: impl Fn([f32; 4]) -> [f32; 4],
) -> Measurement {
    let seen = found.pixels.iter().filter(|pixel| pixel[3] > 0.01).count();
    measurement.hold(|| "pixels that are drawn".into(), seen > 100);
    measurement.pictures = Some(Pictures {
        width: found.width,
        expected: found.pixels.iter().map(|&pixel| of(pixel)).collect(),
        found: found.pixels,
    });
    measurement
}
