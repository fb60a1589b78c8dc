//! What a mode shows of the samples of a ray (`sampling.md` 5 and 6), written a second time in
//! f64.
//!
//! ```text
//! composite    C += T a c,  T *= 1 - a,  a = 1 - exp(-s d)
//! mida         b = 1 - max(u - m, 0) (1 + gamma),  C = b C + (1 - b A) a c,  A = b A + (1 - b A) a
//! lmip         the largest up to where the value first falls from over the threshold
//! attenuated   the largest of u exp(-k sum of u d before it),  k the attenuation over the diagonal
//! mip, minip   the largest, the smallest;  exact: of the trilinear field, a cubic in each cell, by its derivative
//! average      sum of v d over sum of d               xray         sum of v d
//! ```

use super::chord::{Chord, PictureCase};
use super::light::Open;
use super::matter::{Matter, Part};
use crate::technique::{Filter, Mode};
use glam::DVec3;

/// A pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    /// Premultiplied colour.
    pub pixel: [f64; 4],
    /// What is projected, NaN where nothing is.
    pub value: f64,
    /// Where it is; where opacity reaches one half.
    pub depth: f64,
    /// What the answer itself is not sure of, beside rounding.
    pub slack: f64,
}

impl Seen {
    /// A ray that meets nothing.
    pub const NOTHING: Self = Self {
        pixel: [0.0; 4],
        value: f64::NAN,
        depth: f64::NAN,
        slack: 0.0,
    };
}

/// One ray's.
pub fn seen(shot: &PictureCase, chord: &Chord, parts: &[Part]) -> Seen {
    seen_through(shot, chord, parts, None)
}

/// The same where matter takes light away.
pub fn seen_through(
    shot: &PictureCase,
    chord: &Chord,
    parts: &[Part],
    open: Option<&Open>,
) -> Seen {
    let mode = shot.settings.mode;
    if chord.samples.is_empty() {
        return Seen::NOTHING;
    }
    let matter = Matter::new(shot, parts, open);
    if !mode.is_projection() {
        return absorbed(shot, chord, &matter);
    }
    let (value, depth) = projected(shot, chord, &matter);
    let function = &parts[0].function;
    let opacity = function.opacity(value);
    let [r, g, b] = function.srgb(value).map(|c| opacity * c);
    Seen {
        pixel: [r, g, b, opacity],
        value,
        depth,
        slack: 0.0,
    }
}

fn unit(shot: &PictureCase, value: f64) -> f64 {
    let [low, high] = shot.settings.per_mode.unit_values;
    ((value - low) / (high - low)).clamp(0.0, 1.0)
}

fn absorbed(shot: &PictureCase, chord: &Chord, matter: &Matter) -> Seen {
    let along = shot.grid.world_from_voxel.matrix3 * chord.direction;
    let is_mida = shot.settings.mode == Mode::Mida;
    let gamma = shot.settings.per_mode.mida_gamma;
    let (mut color, mut opacity, mut largest) = (DVec3::ZERO, 0.0, 0.0f64);
    let mut depth = f64::NAN;
    for &(t, d) in &chord.samples {
        let place = chord.at(t);
        let (own, extinction) = matter.at(place, along);
        let alpha = -(-extinction * d).exp_m1();
        let kept = match is_mida {
            true => {
                let u = unit(shot, matter.value(0, place));
                let kept = 1.0 - (u - largest).max(0.0) * (1.0 + gamma);
                largest = largest.max(u);
                kept
            }
            false => 1.0,
        };
        let seen = 1.0 - kept * opacity;
        color = kept * color + seen * alpha * DVec3::from_array(own);
        let before = kept * opacity;
        opacity = before + seen * alpha;
        match (before < 0.5, opacity < 0.5) {
            (_, true) => depth = f64::NAN,
            (true, false) => depth = t,
            _ => {}
        }
    }
    let [r, g, b] = color.to_array();
    Seen {
        pixel: [r, g, b, opacity],
        value: f64::NAN,
        depth,
        slack: 0.0,
    }
}

fn projected(shot: &PictureCase, chord: &Chord, matter: &Matter) -> (f64, f64) {
    let per_mode = &shot.settings.per_mode;
    let value_at = |t: f64| matter.value(0, chord.at(t));
    let all = || chord.samples.iter().map(|&(t, d)| (value_at(t), t, d));
    let extreme = |is_better: &dyn Fn(f64, f64) -> bool| {
        let mut best = (f64::NAN, f64::NAN);
        for (value, t, _) in all() {
            if best.0.is_nan() || is_better(value, best.0) {
                best = (value, t);
            }
        }
        best
    };
    match shot.settings.mode {
        Mode::Mip if per_mode.exact_maximum => exact(chord, &value_at, 1.0),
        Mode::Minip if per_mode.exact_maximum => exact(chord, &value_at, -1.0),
        Mode::Mip => extreme(&|a, b| a > b),
        Mode::Minip => extreme(&|a, b| a < b),
        Mode::Lmip => {
            let mut best = (f64::NEG_INFINITY, f64::NAN);
            for (value, t, _) in all() {
                if value > best.0 {
                    best = (value, t);
                } else if value < best.0 && best.0 > per_mode.lmip_threshold {
                    break;
                }
            }
            best
        }
        Mode::AttenuatedMip => {
            let (mut best, mut before) = ((f64::NEG_INFINITY, f64::NAN), 0.0);
            let per_length = per_mode.attenuation / shot.grid.diagonal();
            for (value, t, d) in all() {
                let u = unit(shot, value);
                let faded = u * (-per_length * before).exp();
                if faded > best.0 {
                    best = (faded, t);
                }
                before += u * d;
            }
            let [low, high] = per_mode.unit_values;
            (low + best.0 * (high - low), best.1)
        }
        mode => {
            let sum: f64 = all().map(|(value, _, d)| value * d).sum();
            match mode {
                Mode::Average => (sum / chord.length(), f64::NAN),
                _ => (sum, f64::NAN),
            }
        }
    }
}

/// The extreme of the field itself along the chord: a cubic between two walls of cells, known by four of its values.
fn exact(chord: &Chord, value_at: &dyn Fn(f64) -> f64, sign: f64) -> (f64, f64) {
    let [enter, leave] = chord.ends;
    let mut walls = vec![enter, leave];
    for k in 0..3 {
        let wall = |i: i32| (f64::from(i) + 0.5 - chord.origin[k]) / chord.direction[k];
        walls.extend((-1..40).map(wall).filter(|t| (enter..leave).contains(t)));
    }
    walls.sort_by(f64::total_cmp);
    let mut best = (f64::NEG_INFINITY, f64::NAN);
    for cell in walls.windows(2) {
        let (start, length) = (cell[0], cell[1] - cell[0]);
        let [f0, f1, f2, f3] =
            [0.0, 1.0, 2.0, 3.0].map(|i| sign * value_at(start + length * i / 3.0));
        let b = (-11.0 * f0 + 18.0 * f1 - 9.0 * f2 + 2.0 * f3) / 2.0;
        let c = (18.0 * f0 - 45.0 * f1 + 36.0 * f2 - 9.0 * f3) / 2.0;
        let d = (-9.0 * f0 + 27.0 * f1 - 27.0 * f2 + 9.0 * f3) / 2.0;
        let root = (c * c - 3.0 * b * d).max(0.0).sqrt();
        // Where the derivative is zero, without cancellation.
        let q = -c - c.signum() * root;
        for u in [0.0, 1.0, q / (3.0 * d), b / q] {
            let value = f0 + u * (b + u * (c + u * d));
            if (0.0..=1.0).contains(&u) && value > best.0 {
                best = (value, start + u * length);
            }
        }
    }
    (sign * best.0, best.1)
}

/// Filters whose kernels are written here.
pub const FILTERS: [(&str, Filter); 5] = [
    ("nearest", Filter::Nearest),
    ("linear_fetch", Filter::Linear),
    ("quadratic_smooth", Filter::QuadraticSmooth),
    ("cubic_smooth", Filter::CubicSmooth),
    ("catmull_rom", Filter::CatmullRom),
];
