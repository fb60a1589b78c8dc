//! Interpolation of scattered points by inverse distances: its weights, and distances on the Earth in kilometres.
//!
//! ```text
//! f = sum w_s f_s / sum w_s,   w_s = ((R - d_s) / (R d_s))^2   over the 16 nearest, R the distance of the next one
//! ```

use super::{Found, sees, within};
use crate::files::Folder;
use glam::{DVec3, dvec3};
use std::fmt::Write;
use stratavox::format::{PointColumns, open_points};
use stratavox::points::Points;
use stratavox::points::interpolate::{Interpolation, Method, Options};
use stratavox::volume::{Limits, Source};

/// Places in the unit cube, the same from the same number.
fn places(count: usize, mut state: u32) -> Vec<DVec3> {
    let mut unit = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(state >> 8) / f64::from(1 << 24)
    };
    (0..count).map(|_| dvec3(unit(), unit(), unit())).collect()
}

fn smooth(p: DVec3) -> f64 {
    (4.0 * p.x).sin() * (3.0 * p.y).cos() + p.z.powi(3)
}

fn idw(points: &Points) -> Interpolation {
    let options = Options {
        method: Method::Idw,
        ..Options::default()
    };
    Interpolation::new(points, &options).expect("a field")
}

#[derive(Clone, Copy, Debug)]
enum OfWeights {
    /// The weight is the root of what it should be.
    NotSquared,
    /// R is the distance of the last point that has weight.
    RadiusTooShort,
    /// Weights fall as 1 / d^2, without a radius.
    NoRadius,
}

fn are_those_of_the_formula(fault: Option<OfWeights>) -> Found {
    let places_of_points = places(40, 7);
    let values: Vec<f32> = places_of_points.iter().map(|&p| smooth(p) as f32).collect();
    let points = Points::new(places_of_points, values, None, None).expect("points");
    let field = idw(&points);
    let mut worst: f64 = 0.0;
    for query in places(50, 99).into_iter().map(|p| 0.2 + 0.6 * p) {
        let all = points.places().iter().zip(points.values());
        let mut near: Vec<(f64, f64)> = all
            .map(|(p, &value)| (p.distance(query), f64::from(value)))
            .collect();
        near.sort_by(|a, b| a.0.total_cmp(&b.0));
        let radius = match fault {
            Some(OfWeights::RadiusTooShort) => near[15].0,
            _ => near[16].0,
        };
        let weight = |d: f64| match fault {
            Some(OfWeights::NotSquared) => (radius - d) / (radius * d),
            Some(OfWeights::NoRadius) => d.powi(-2),
            _ => ((radius - d) / (radius * d)).powi(2),
        };
        let sum: f64 = near[..16].iter().map(|(d, value)| weight(*d) * value).sum();
        let weights: f64 = near[..16].iter().map(|(d, _)| weight(*d)).sum();
        let found = field.at(query).expect("near");
        worst = worst.max((found - sum / weights).abs());
    }
    within("a value", worst, 1e-12)
}

#[test]
fn weights_of_inverse_distances_are_those_of_the_formula() {
    use OfWeights::*;
    sees(
        &[NotSquared, RadiusTooShort, NoRadius],
        are_those_of_the_formula,
    );
}

#[derive(Clone, Copy, Debug)]
struct DegreesAsKilometres;

/// 600 points of a cube of about 100 km: the root of the mean square error is that of the unit cube.
fn are_kilometres(fault: Option<DegreesAsKilometres>) -> Found {
    let of_table = |p: DVec3| [10.0 + 1.27 * p.x, 45.0 + 0.9 * p.y, 100.0 * p.z];
    let mut table = match fault {
        None => String::from("lon,lat,depth_km,v\n"),
        Some(DegreesAsKilometres) => String::from("x,y,depth_km,v\n"),
    };
    for place in places(600, 7) {
        let [x, y, depth] = of_table(place);
        let _ = writeln!(table, "{x},{y},{depth},{}", smooth(place));
    }
    let folder = Folder::new();
    let path = folder.write("points.csv", table);
    let file = open_points(&path, &PointColumns::default(), &Limits::default()).expect("points");
    let lengths = file
        .header()
        .degree_lengths
        .map(|length| length.unwrap_or(1.0));
    let field = idw(file.points());
    let (mut sum, mut count) = (0.0, 0);
    for query in places(1000, 99).into_iter().map(|p| 0.2 + 0.6 * p) {
        let [x, y, depth] = of_table(query);
        let place = dvec3(x * lengths[0], y * lengths[1], -depth);
        // What has no point near is as wrong as can be.
        let found = field.at(place).unwrap_or(f64::INFINITY);
        sum += (found - smooth(query)).powi(2);
        count += 1;
    }
    // The table of methods, and a fifth more as other points have it.
    within("the mean", (sum / f64::from(count)).sqrt(), 1.2 * 6.5e-2)
}

#[test]
fn distances_on_the_earth_are_kilometres() {
    sees(&[DegreesAsKilometres], are_kilometres);
}
