//! What sheets make of fields, by sums over all voxels in f64: the mean of a quadratic field, and colours of thinner sheets.

use super::noise;
use glam::{DMat3, DVec3, dvec3};
use stratavox::technique::splat::kernel::Kernel;
use stratavox::technique::splat::oracle::{Line, sheets};

const SIDE: u32 = 21;
const STD: f64 = 0.6;

fn kernel(reach: f64) -> Kernel {
    Kernel {
        precision: DMat3::from_diagonal(DVec3::splat(1.0 / (STD * STD))),
        reach,
    }
}

fn centers(side: u32) -> impl Iterator<Item = DVec3> {
    let at = |n: u32| f64::from(n) + 0.5;
    (0..side * side * side)
        .map(move |i| dvec3(at(i % side), at(i / side % side), at(i / (side * side))))
}

/// Directions, and where near the middle of a grid a ray goes through.
fn rays(side: u32, count: u32) -> impl Iterator<Item = (DVec3, DVec3)> {
    let number = move |n: u32, k: u32| noise(dvec3(f64::from(n), f64::from(k), 0.7)) - 0.5;
    let middle = 0.5 * f64::from(side);
    (0..count).map(move |n| {
        let vector =
            |first: u32| dvec3(number(n, first), number(n, first + 1), number(n, first + 2));
        (vector(0).normalize(), DVec3::splat(middle) + vector(3))
    })
}

/// v - f = (h^2 tr B + w^2 r.Br / 12) / 2 for f = x.Bx / 2 and a sheet w thick: blur of variance h^2, and of w^2 / 12 along
/// the ray.
#[test]
fn a_sheet_blurs_a_quadratic_field_by_its_own_variance() {
    let b = DMat3::from_cols(
        dvec3(0.7, 0.2, -0.3),
        dvec3(0.2, -0.4, 0.5),
        dvec3(-0.3, 0.5, 0.9),
    );
    for (direction, middle) in rays(SIDE, 40) {
        let line = Line {
            origin: middle - 30.0 * direction,
            direction,
        };
        let numbers = centers(SIDE).map(|p| (p, [0.5 * (p - middle).dot(b * (p - middle)), 1.0]));
        let [[sum, weight]] = sheets(&kernel(5.2655), &line, numbers, &[29.5, 30.5])[..] else {
            panic!("one sheet")
        };
        let trace = b.col(0)[0] + b.col(1)[1] + b.col(2)[2];
        let law = 0.5 * (STD * STD * trace + direction.dot(b * direction) / 12.0);
        let off = sum / weight - law;
        // Of the sum of all entries of B, 5.2, 4e-3 (the ripple of a Gaussian of 0.6 voxels).
        assert!(off.abs() < 4e-3 * 5.2, "{direction}: off by {off:e}");
    }
}

/// Colours of classified voxels come to those of thin sheets with the square of the thickness.
#[test]
fn colours_of_thinner_sheets_converge_in_the_second_order() {
    const FEW: u32 = 10;
    let matter = |p: DVec3| {
        let depth = if noise(p) < 0.4 {
            0.8 * noise(p + 0.3)
        } else {
            0.0
        };
        [depth, depth * noise(p - 0.2)]
    };
    let color = |line: &Line, thickness: f64| {
        let edges: Vec<f64> = (0..=(40.0 / thickness) as u32)
            .map(|k| 20.0 + f64::from(k) * thickness)
            .collect();
        let numbers = centers(FEW).map(|p| (p, matter(p)));
        let (mut through, mut color) = (1.0, 0.0);
        for [depth, light] in sheets(&kernel(5.2655), line, numbers, &edges) {
            if depth > 0.0 {
                let opacity = -(-depth).exp_m1();
                color += through * opacity * light / depth;
                through *= 1.0 - opacity;
            }
        }
        color
    };
    let lines: Vec<Line> = rays(FEW, 24)
        .map(|(direction, middle)| Line {
            origin: middle - 40.0 * direction,
            direction,
        })
        .collect();
    let finest: Vec<f64> = lines.iter().map(|line| color(line, 1.0 / 64.0)).collect();
    let error = |thickness: f64| {
        let off = lines
            .iter()
            .zip(&finest)
            .map(|(line, fine)| (color(line, thickness) - fine).powi(2));
        (off.sum::<f64>() / lines.len() as f64).sqrt()
    };
    let errors = [1.0, 0.5, 0.25, 0.125].map(error);
    for pair in errors.windows(2).skip(1) {
        let order = (pair[0] / pair[1]).log2();
        assert!((order - 2.0).abs() < 0.1, "order {order}: {errors:?}");
    }
}
