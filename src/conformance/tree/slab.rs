//! A13 and A6: pre-integrated slabs of a linear field, whatever the step and the lattice.
//!
//! ```text
//! tau = L (T(f1) - T(f0)) / (f1 - f0)      C = c (1 - exp(-tau)),  f0 and f1 the values where the ray enters and leaves
//! T   = integral of -ln(1 - a) / d0        ((1 - a) ln(1 - a) + a) / (d0 a') where a runs straight with the slope a'
//! ```

use super::drawn::measure;
use super::ground::{self, PLACEMENTS, PROJECTIONS, Placement};
use crate::conformance::case::{Case, Profile, Stop};
use crate::conformance::measurement::Measurement;
use crate::conformance::oracle::{Chord, Classes, Kind, Seen};
use crate::conformance::test_bed::TestBed;
use crate::technique::{Filter, Lattice, Mode, Order, Settings};
use crate::transfer::{
    Absorption, ColorPoint, Interpolation, OpacityPoint, SlabTable, TransferFunction,
};
use crate::volume::VoxelType;

const COLOR: [f64; 3] = [0.9, 0.2, 0.6];

/// Ramps, and a spike that is far thinner than what a step passes.
const FUNCTIONS: [(&str, &[(f64, f64)]); 2] = [
    ("ramps", &[(0.2, 0.02), (0.6, 0.15), (0.9, 0.4)]),
    (
        "spike",
        &[(0.2, 0.02), (0.5, 0.02), (0.505, 0.9), (0.51, 0.02)],
    ),
];

/// Where slabs end, and how long they are.
const STEPS: [(&str, f64); 2] = [("slabs", 0.5), ("long_slabs", 0.23)];

/// All of them.
pub fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    let jitter = Placement {
        word: "raycast.jitter",
        lattice: Lattice::Jitter,
        ..PLACEMENTS[0]
    };
    let placements = PLACEMENTS.into_iter().filter(Placement::has_slabs);
    for placement in placements.chain([jitter]) {
        for (projection, is_perspective) in PROJECTIONS {
            for (word, function) in FUNCTIONS {
                for (steps, samples) in STEPS {
                    let of = placement.word;
                    let name =
                        format!("{of}.composite.{steps}_{word}.linear_fetch.f32.{projection}");
                    let mut case = Case::new(name, move |bed| {
                        draw(bed, placement, function, samples, is_perspective)
                    });
                    case.needs = ground::needs(placement, Mode::Composite, VoxelType::F32, false);
                    let is_first = placement.order == Order::BackToFront;
                    let is_in = is_first && (steps == "slabs") == is_perspective;
                    case.profile = if is_in {
                        Profile::Baseline
                    } else {
                        Profile::Full
                    };
                    cases.push(case);
                }
            }
        }
    }
    cases
}

fn draw(
    bed: &mut TestBed,
    placement: Placement,
    opacity: &[(f64, f64)],
    samples_per_voxel: f64,
    is_perspective: bool,
) -> Result<Measurement, Stop> {
    let linear = (Filter::Linear, false);
    let shot = ground::shot(placement, Mode::Composite, linear, is_perspective);
    let shot = shot.with(|settings: &mut Settings| {
        settings.preintegrated = true;
        settings.samples_per_voxel = samples_per_voxel;
        // Stacks with slices of their own keep one a slice.
        settings.smooth = settings.technique.draws_stacks() && samples_per_voxel < 0.4;
    });
    let field = Kind::Ramp.field();
    let volume = field.volume(&shot, VoxelType::F32);
    let point = |&(value, opacity): &(f64, f64)| OpacityPoint { value, opacity };
    let function = TransferFunction {
        color: vec![ColorPoint {
            value: 0.0,
            srgb: COLOR,
        }],
        opacity: opacity.iter().map(point).collect(),
        reference_length: Some(1.0),
        interpolation: Interpolation::Linear,
        gradient_transfer: None,
        medium: None,
    };
    let absorption = Absorption::Extinction {
        reference_length: 1.0,
    };
    let table = SlabTable::new(&function, absorption, Classes::SPACE);
    let cell = 1.0 / f64::from(table.scale);
    let scene = shot.scene(&volume, Some(&function));
    let of = |chord: &Chord| {
        let [t0, t1] = chord.ends;
        let [f0, f1] = [t0, t1].map(|t| field.value(chord.at(t)));
        let rise = (f1 - f0) / (t1 - t0);
        let depth = (integral(&function, f1) - integral(&function, f0)) / rise;
        let alpha = -(-depth).exp_m1();
        let [r, g, b] = COLOR.map(|c| alpha * c);
        // A cell of the table is a line, and only those that a ray begins and ends in are cut: half a cell each of
        // what extinction there is.
        let near = |f: f64| [f - cell, f, f + cell].map(|f| -(-function.opacity(f)).ln_1p());
        let at_end = |f: f64| near(f).into_iter().fold(0.0, f64::max);
        let slack = 0.5 * cell / rise.abs() * (at_end(f0) + at_end(f1)) * (-depth).exp();
        Seen {
            pixel: [r, g, b, alpha],
            slack,
            ..Seen::NOTHING
        }
    };
    measure(bed, &shot, &scene, &[], of)
}

/// T at a value, of a reference length of 1.
fn integral(function: &TransferFunction, value: f64) -> f64 {
    let points = &function.opacity;
    let constant = |a: f64, width: f64| -(-a).ln_1p() * width;
    let mut sum = constant(
        points[0].opacity,
        value.min(points[0].value) - points[0].value,
    );
    for pair in points.windows(2) {
        let (start, end) = (pair[0].value, pair[1].value.min(value));
        if end <= start {
            continue;
        }
        let slope = (pair[1].opacity - pair[0].opacity) / (pair[1].value - start);
        let a = [pair[0].opacity, pair[0].opacity + slope * (end - start)];
        let primitive = |a: f64| (1.0 - a) * (-a).ln_1p() + a;
        sum += match slope == 0.0 {
            true => constant(a[0], end - start),
            false => (primitive(a[1]) - primitive(a[0])) / slope,
        };
    }
    let last = points[points.len() - 1];
    sum + constant(last.opacity, (value - last.value).max(0.0))
}
