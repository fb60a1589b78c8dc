//! Points as a file has them, on their way to a function: checked, put in order, filled up.
//!
//! Between points of VTK's functions lies a curve with a midpoint m and a sharpness h, both of the left point
//! (`vtkPiecewiseFunction`, documented at `GetTable`): at the fraction s of the way,
//!
//! ```text
//! s' = s / (2 m)                    s < m        h > 0.99: colours step at s' = 1/2
//!      1/2 + (s - m) / (2 (1 - m))  else         h < 0.01: a straight line in s'
//!                                                else: the Hermite curve of s'' with end slopes (1 - h)
//! s'' = (2 s')^(1 + 10 h) / 2       s' < 1/2, and turned about the middle above it
//! ```

use super::super::{
    ColorPoint, FileProblem, Interpolation, MAX_POINTS, OpacityPoint, TransferFunction,
};
use super::{Imported, Scale};

/// What a file has said so far.
#[derive(Clone, Debug)]
pub(super) struct Draft {
    pub origin: &'static str,
    pub name: Option<String>,
    pub scale: Scale,
    /// Value and sRGB.
    pub color: Vec<(f64, [f64; 3])>,
    /// Value and opacity.
    pub opacity: Vec<(f64, f64)>,
    pub reference_length: Option<f64>,
    pub left_out: Vec<String>,
}

/// The curve between two points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Curve {
    pub midpoint: f64,
    pub sharpness: f64,
}

impl Curve {
    pub const LINE: Self = Self {
        midpoint: 0.5,
        sharpness: 0.0,
    };

    /// Fractions of the way where points of straight lines are needed, and the share of the right end there.
    pub fn shares(self, sharp_is_step: bool) -> Vec<(f64, f64)> {
        let middle = self.midpoint.clamp(1e-5, 1.0 - 1e-5);
        if sharp_is_step && self.sharpness > 0.99 {
            return vec![(middle, 0.0), (middle, 1.0)];
        }
        if self.sharpness < 0.01 {
            return match middle == 0.5 {
                true => Vec::new(),
                false => vec![(middle, 0.5)],
            };
        }
        const PARTS: u32 = 128;
        let fractions = (1..PARTS).map(|i| f64::from(i) / f64::from(PARTS));
        fractions.map(|s| (s, self.share(s, middle))).collect()
    }

    fn share(self, s: f64, middle: f64) -> f64 {
        let s = if s < middle {
            0.5 * s / middle
        } else {
            0.5 + 0.5 * (s - middle) / (1.0 - middle)
        };
        let power = 1.0 + 10.0 * self.sharpness;
        let s = if s < 0.5 {
            0.5 * (2.0 * s).powf(power)
        } else {
            1.0 - 0.5 * (2.0 * (1.0 - s)).powf(power)
        };
        let (square, cube) = (s * s, s * s * s);
        let slope = 1.0 - self.sharpness;
        let ends = 3.0 * square - 2.0 * cube;
        let slopes = slope * ((cube - 2.0 * square + s) + (cube - square));
        (ends + slopes).clamp(0.0, 1.0)
    }
}

impl Draft {
    pub fn new(origin: &'static str) -> Self {
        Self {
            origin,
            name: None,
            scale: Scale::Values,
            color: Vec::new(),
            opacity: Vec::new(),
            reference_length: None,
            left_out: Vec::new(),
        }
    }

    /// A refusal.
    pub fn refuse(&self, problem: impl Into<String>) -> FileProblem {
        FileProblem::Foreign {
            origin: self.origin,
            problem: problem.into(),
        }
    }

    /// Adds opacities with the curve that begins at each of them.
    pub fn add_opacities(&mut self, points: &[([f64; 2], Curve)]) {
        for (i, &([value, opacity], curve)) in points.iter().enumerate() {
            self.opacity.push((value, opacity));
            if let Some(&([next, right], _)) = points.get(i + 1) {
                for (t, share) in curve.shares(false) {
                    let at = value + t * (next - value);
                    self.opacity.push((at, opacity + share * (right - opacity)));
                }
            }
        }
    }

    /// Adds colours with the curve that begins at each of them.
    pub fn add_colors(&mut self, points: &[(f64, [f64; 3], Curve)]) {
        for (i, &(value, left, curve)) in points.iter().enumerate() {
            self.color.push((value, left));
            if let Some(&(next, right, _)) = points.get(i + 1) {
                for (t, share) in curve.shares(true) {
                    let mixed = std::array::from_fn(|c| left[c] + share * (right[c] - left[c]));
                    self.color.push((value + t * (next - value), mixed));
                }
            }
        }
    }

    /// Makes all transparent outside `low` to `high`.
    pub fn mask(&mut self, [low, high]: [f64; 2]) {
        let (Some(&first), Some(&last)) = (self.opacity.first(), self.opacity.last()) else {
            return;
        };
        let at = |value: f64| opacity_at(&self.opacity, value);
        let mut kept = Vec::new();
        if low > first.0 || (low == first.0 && first.1 > 0.0) {
            kept.extend([(low, 0.0), (low, at(low))]);
        }
        let inside = self.opacity.iter();
        kept.extend(inside.filter(|p| p.0 >= low && p.0 <= high));
        if high < last.0 {
            kept.extend([(high, at(high)), (high, 0.0)]);
        }
        self.opacity = kept;
    }

    /// The function, or what is wrong with the points.
    pub fn finish(mut self) -> Result<Imported, FileProblem> {
        self.color.sort_by(|a, b| a.0.total_cmp(&b.0));
        self.opacity.sort_by(|a, b| a.0.total_cmp(&b.0));
        if self.color.is_empty() && self.opacity.is_empty() {
            return Err(self.refuse("it has no points"));
        }
        if self.color.len().max(self.opacity.len()) > MAX_POINTS {
            return Err(self.refuse(format!("it needs more than {MAX_POINTS} points")));
        }
        self.check_numbers()?;
        self.fill_up();
        let color = self.color.iter().map(|&(value, srgb)| ColorPoint {
            value,
            srgb: srgb.map(|c| c.clamp(0.0, 1.0)),
        });
        let opacity = self.opacity.iter().map(|&(value, opacity)| OpacityPoint {
            value,
            opacity: opacity.clamp(0.0, 1.0),
        });
        Ok(Imported {
            function: TransferFunction {
                color: color.collect(),
                opacity: opacity.collect(),
                reference_length: self.reference_length,
                interpolation: Interpolation::Linear,
                gradient_transfer: None,
                medium: None,
            },
            origin: self.origin,
            name: self.name,
            scale: self.scale,
            left_out: self.left_out,
            preintegrated: false,
        })
    }

    fn check_numbers(&mut self) -> Result<(), FileProblem> {
        let values = self.color.iter().map(|p| p.0);
        for value in values.chain(self.opacity.iter().map(|p| p.0)) {
            if value.is_nan() || value.abs() > f64::from(f32::MAX) {
                return Err(self.refuse(format!("a point stands at {value}, wanted a number")));
            }
        }
        let shares = self.color.iter().flat_map(|p| p.1);
        let shares: Vec<f64> = shares.chain(self.opacity.iter().map(|p| p.1)).collect();
        if let Some(wrong) = shares.iter().find(|share| !share.is_finite()) {
            return Err(self.refuse(format!("a colour or opacity is {wrong}, wanted a number")));
        }
        // Rounding is no reason for a word.
        let outside = |share: &&f64| !(-1e-6..=1.0 + 1e-6).contains(*share);
        let count = shares.iter().filter(outside).count();
        if count > 0 {
            let said =
                format!("{count} numbers of colours and opacities beyond 0 to 1, cut off there");
            self.left_out.push(said);
        }
        Ok(())
    }

    /// A function has both: the ramp of preset `grey` stands in for what a file is silent about.
    fn fill_up(&mut self) {
        let range = |values: Vec<f64>| [values[0], values[values.len() - 1]];
        if self.opacity.is_empty() {
            let [low, high] = range(self.color.iter().map(|p| p.0).collect());
            self.opacity = vec![(low, 0.0), (high, 1.0 / 20.0)];
            let said =
                "nothing about opacity is in the file: it rises from 0 to 1/20 over the colours";
            self.left_out.push(said.to_owned());
        }
        if self.color.is_empty() {
            let [low, high] = range(self.opacity.iter().map(|p| p.0).collect());
            self.color = vec![(low, [0.0; 3]), (high, [1.0; 3])];
            let said = "nothing about colour is in the file: it is grey, black to white over the opacities";
            self.left_out.push(said.to_owned());
        }
    }
}

/// Straight lines between the points, constant beyond.
fn opacity_at(points: &[(f64, f64)], value: f64) -> f64 {
    let after = points.partition_point(|p| p.0 <= value);
    match (points.get(after.wrapping_sub(1)), points.get(after)) {
        (Some(&(x0, y0)), Some(&(x1, y1))) => y0 + (value - x0) / (x1 - x0) * (y1 - y0),
        (Some(&(_, y)), None) | (None, Some(&(_, y))) => y,
        (None, None) => 0.0,
    }
}
