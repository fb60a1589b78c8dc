//! What a mode makes of the samples of a ray, in f64, and how far a device that computes in f32 may be from it.
//!
//! ```text
//! composite   C = sum T_i a_i c_i,  A = 1 - prod (1 - a_i),  a_i = 1 - exp(-s_i d_i),  s = -ln(1 - o) / d0
//! mip, minip  the largest, the smallest value             average, xray   sum v d / sum d, sum v d
//! ```
//!
//! The derivation of the bounds is [`DERIVATION`], which goes into each record.

use super::chord::{Chord, PictureCase};
use super::field::Field;
use crate::picture::ColorSpace;
use crate::technique::{Filter, Mode};
use crate::transfer::{ColorPoint, Interpolation, OpacityPoint, TransferFunction};

/// Half a unit in the last place of an f32 at 1.
const U: f64 = 1.0 / (1u32 << 24) as f64;
/// Codes, over 256.
const LARGEST_CODE: f64 = 1.25;
/// The same of a 16-bit float.
const HALF: f64 = 1.0 / 2048.0;
/// What log may be off by near 1 (Vulkan specification, "Precision and Operation of SPIR-V Instructions").
const LOG: f64 = 1.0 / (1u32 << 21) as f64;
/// What a table of a transfer function may be off by (`sampling.md` 4).
const TABLE: f64 = 1.0 / 4096.0;

/// How the bounds of exact pictures are made.
pub const DERIVATION: &str = "u = 2^-24. A place is a sum of four products of f32 (8 u of the sum of their sizes, each way), \
its value is off by the steps of the field times that, by taps x 3 u of the largest code, and, with the device's sampler, by the \
steps times 2^-b (b sub-texel bits: a weight may be rounded either way), and of 16-bit floats by 3 x 2^-11 of the largest (a \
sampler may keep the texels' own precision, and round once an axis). Opacity and colour follow with their slopes (and 1/4096 \
where a table stands for the points), extinction with 2^-21 for log and 1 / (1 - o), a segment's depth with its length, its \
opacity with (3 + 2x) 2^-23 for exp (Vulkan specification, precision of SPIR-V instructions). Of a composited ray each \
segment's slip is seen by at most all of the light: the sum over segments, and 6 u for each blend. Sums: 3 u of their size a \
sample. On the ray lattice the ends of the domain move by the blur of the place, which adds or takes that much depth.";

/// Values to opacity and colour, both linear over the values that fields have. Colours are blended as they are.
#[derive(Clone, Copy, Debug)]
pub struct Classes {
    range: [f64; 2],
    opacity: [f64; 2],
    color: [[f64; 3]; 2],
}

impl Classes {
    /// Over all values that fields have.
    pub const RAMP: Self = Self {
        range: [0.0, 1.25],
        opacity: [0.02, 0.3],
        color: [[0.1, 0.8, 0.3], [0.9, 0.2, 0.6]],
    };

    fn at(&self, value: f64) -> ([f64; 3], f64) {
        let part = (value - self.range[0]) / (self.range[1] - self.range[0]);
        let mix = |a: f64, b: f64| a + part * (b - a);
        let color = [0, 1, 2].map(|c: usize| mix(self.color[0][c], self.color[1][c]));
        (color, mix(self.opacity[0], self.opacity[1]))
    }

    /// The steepest rise of opacity, and of a colour.
    fn slopes(&self) -> [f64; 2] {
        let over = self.range[1] - self.range[0];
        let color = (0..3).map(|c| (self.color[1][c] - self.color[0][c]).abs());
        [
            (self.opacity[1] - self.opacity[0]).abs() / over,
            color.fold(0.0, f64::max) / over,
        ]
    }

    /// As the library has it.
    pub fn function(&self) -> TransferFunction {
        let color = |k: usize| ColorPoint {
            value: self.range[k],
            srgb: self.color[k],
        };
        let opacity = |k: usize| OpacityPoint {
            value: self.range[k],
            opacity: self.opacity[k],
        };
        TransferFunction {
            color: vec![color(0), color(1)],
            opacity: vec![opacity(0), opacity(1)],
            reference_length: Some(1.0),
            interpolation: Interpolation::Linear,
            gradient_transfer: None,
            medium: None,
        }
    }

    /// The numbers of a function are blended as they are.
    pub const SPACE: ColorSpace = ColorSpace::Display;
}

/// What a pixel should be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Answer {
    /// What a projecting mode projects, NaN without a sample.
    pub value: f64,
    /// How far that may be off.
    pub value_allowed: f64,
    /// Premultiplied colour.
    pub pixel: [f64; 4],
    /// How far each channel may be off.
    pub pixel_allowed: f64,
}

impl Answer {
    /// Where there is nothing.
    pub const NOTHING: Self = Self {
        value: f64::NAN,
        value_allowed: 0.0,
        pixel: [0.0; 4],
        pixel_allowed: 0.0,
    };
}

/// How exactly a device's sampler may interpolate.
#[derive(Clone, Copy, Debug)]
pub struct SamplerPrecision {
    /// Of its weights.
    pub bits: u32,
    /// Whether texels are 16-bit floats, whose precision it may keep.
    pub keeps_halves: bool,
}

/// What the ray of a chord should show. `None` where it depends on rounding.
pub fn answer(
    shot: &PictureCase,
    chord: &Chord,
    field: &Field,
    classes: &Classes,
    sampler: SamplerPrecision,
) -> Option<Answer> {
    if chord.hangs {
        return None;
    }
    if chord.samples.is_empty() {
        return Some(Answer::NOTHING);
    }
    let values = values(shot, chord, field, sampler)?;
    Some(match shot.settings.mode {
        Mode::Composite => composite(shot, chord, &values, classes),
        mode => projected(chord, &values, classes, mode),
    })
}

/// Value and what it may be off by, of each sample.
fn values(
    shot: &PictureCase,
    chord: &Chord,
    field: &Field,
    sampler: SamplerPrecision,
) -> Option<Vec<(f64, f64)>> {
    let settings = &shot.settings;
    let by_sampler = !settings.conformance && settings.filter != Filter::Nearest;
    let taps = match settings.filter {
        Filter::Nearest => 1.0,
        Filter::Linear => 8.0,
        _ => 64.0,
    };
    let weights = match by_sampler {
        true => field.steps().element_sum() * 2f64.powi(-(sampler.bits as i32)),
        false => 0.0,
    };
    let digits = match by_sampler && sampler.keeps_halves {
        true => 3.0 * HALF * LARGEST_CODE,
        false => 0.0,
    };
    let of_filter = taps * 3.0 * U * LARGEST_CODE + weights + digits;
    let sample = |&(t, _): &(f64, f64)| {
        let (value, moved) = field.sampled(shot, chord, t)?;
        Some((value, moved + of_filter))
    };
    chord.samples.iter().map(sample).collect()
}

fn composite(
    shot: &PictureCase,
    chord: &Chord,
    values: &[(f64, f64)],
    classes: &Classes,
) -> Answer {
    let [opacity_slope, color_slope] = classes.slopes();
    let table = if shot.settings.conformance {
        0.0
    } else {
        TABLE
    };
    let (mut color, mut transmittance) = ([0.0; 3], 1.0);
    // Depth that may come or go, and colour that may be off.
    let (mut depth_off, mut color_off, mut thickest) = (0.0, 0.0f64, 0.0f64);
    for (&(_, d), &(value, off)) in chord.samples.iter().zip(values) {
        let (c, opacity) = classes.at(value);
        let sigma = -(-opacity).ln_1p();
        let x = sigma * d;
        let alpha = -(-x).exp_m1();
        for (sum, c) in color.iter_mut().zip(c) {
            *sum += transmittance * alpha * c;
        }
        transmittance *= 1.0 - alpha;
        let opacity_off = opacity_slope * off + table + 4.0 * U;
        let sigma_off = opacity_off / (1.0 - opacity) + LOG + 2.0 * U * sigma;
        let length_off = 8.0 * U * d;
        depth_off += sigma_off * d + sigma * length_off + (3.0 + 2.0 * x) * 2.0 * U + 6.0 * U;
        color_off = color_off.max(color_slope * off + table + 4.0 * U);
        thickest = thickest.max(sigma);
    }
    let ends = 2.0 * chord.blur * thickest;
    let [r, g, b] = color;
    Answer {
        value: f64::NAN,
        value_allowed: 0.0,
        pixel: [r, g, b, 1.0 - transmittance],
        pixel_allowed: depth_off + ends + color_off,
    }
}

fn projected(chord: &Chord, values: &[(f64, f64)], classes: &Classes, mode: Mode) -> Answer {
    let off = values.iter().map(|v| v.1).fold(0.0, f64::max);
    let count = values.len() as f64;
    let length = chord.length();
    let all = || values.iter().map(|v| v.0);
    let sum: f64 = chord
        .samples
        .iter()
        .zip(values)
        .map(|(s, v)| s.1 * v.0)
        .sum();
    let largest = all().map(f64::abs).fold(0.0, f64::max);
    // Sums grow by three roundings a sample, each of no more than all of it.
    let of_sum =
        (3.0 * count * U + 8.0 * U) * largest * length + off * length + 2.0 * chord.blur * largest;
    let (value, value_allowed) = match mode {
        Mode::Mip => (all().fold(f64::NEG_INFINITY, f64::max), off),
        Mode::Minip => (all().fold(f64::INFINITY, f64::min), off),
        // Where both ends move together, mean and length do.
        Mode::Average => (
            sum / length,
            off + (6.0 * count * U + 20.0 * U) * largest + 4.0 * chord.blur / length * largest,
        ),
        _ => (sum, of_sum),
    };
    let [opacity_slope, color_slope] = classes.slopes();
    let clamped = value.clamp(classes.range[0], classes.range[1]);
    let (color, opacity) = classes.at(clamped);
    let [r, g, b] = color.map(|c| c * opacity);
    Answer {
        value,
        value_allowed,
        pixel: [r, g, b, opacity],
        pixel_allowed: (opacity_slope + color_slope) * value_allowed + 12.0 * U,
    }
}
