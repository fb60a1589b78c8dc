//! The largest extinctions of ranges of values, as `shaders/lib/majorants.wgsl` looks them up.
//!
//! ```text
//! row 0      M(i) = most extinction in bin i
//! row r      M(i) = max of row r - 1 at i and at i + 2^(r - 1)        the largest of 2^r bins from i on
//! ```
//!
//! Where opacity depends on the gradient, the most is that over all gradients.

use crate::shaders::{MAJORANT_BINS, MAJORANT_ROWS, MAJORANT_VECTORS};
use crate::transfer::{Absorption, GradientTransfer, Interpolation, MediumPoint, TransferFunction};

/// Values in bins, and the table of their maxima.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Majorants {
    /// Where the first bin begins.
    pub first: f32,
    /// Bins per value.
    pub scale: f32,
    /// Row after row.
    pub rows: [[f32; 4]; MAJORANT_VECTORS as usize],
}

const BINS: usize = MAJORANT_BINS as usize;

impl Majorants {
    /// Of bins over a span of values, by the most between two values, both included. Beyond the span all is constant.
    pub fn new([first, last]: [f64; 2], most_between: impl Fn([f64; 2]) -> f64) -> Self {
        let width = (last - first) / BINS as f64;
        let mut rows = vec![0.0_f32; 4 * MAJORANT_VECTORS as usize];
        for (i, bin) in rows.iter_mut().enumerate().take(BINS) {
            let ends = [i, i + 1].map(|k| first + k as f64 * width);
            *bin = most_between(ends) as f32;
        }
        for row in 1..MAJORANT_ROWS as usize {
            let half = 1 << (row - 1);
            for i in 0..=BINS - 2 * half {
                let before = (row - 1) * BINS + i;
                rows[row * BINS + i] = rows[before].max(rows[before + half]);
            }
        }
        let scale = if width > 0.0 { width.recip() } else { 0.0 };
        Self {
            first: first as f32,
            scale: scale as f32,
            rows: std::array::from_fn(|v| std::array::from_fn(|k| rows[4 * v + k])),
        }
    }

    /// That of all bins: the one entry of the last row.
    pub fn of_all(&self) -> f32 {
        self.rows[(MAJORANT_BINS * (MAJORANT_ROWS - 1) / 4) as usize][0]
    }
}

/// An amount over values that grows with what stands at points, and is what it makes of that.
pub(super) struct AmountPoints<'a> {
    points: Vec<[f64; 2]>,
    interpolation: Interpolation,
    amount: Box<dyn Fn(f64) -> f64 + 'a>,
    /// What widgets add, opacities that `amount` makes something of.
    gradients: Option<&'a GradientTransfer>,
}

impl<'a> AmountPoints<'a> {
    /// Extinction, of three colours the largest, and emission.
    pub fn of(function: &'a TransferFunction, absorption: Absorption) -> [Self; 2] {
        let most = |[a, b, c]: [f64; 3]| a.max(b).max(c);
        let medium = function.medium.as_ref();
        let extinction = medium.map_or(&[][..], |medium| &medium.extinction);
        let emission = medium.map_or(&[][..], |medium| &medium.emission);
        let points =
            |list: &[MediumPoint]| list.iter().map(|p| [p.value, most(p.linear)]).collect();
        let opacity = || function.opacity.iter().map(|p| [p.value, p.opacity]);
        let interpolation = function.interpolation;
        [
            Self {
                points: match extinction {
                    [] => opacity().collect(),
                    _ => points(extinction),
                },
                interpolation,
                amount: match extinction {
                    [] => Box::new(move |opacity| absorption.of(opacity)),
                    _ => Box::new(|extinction| extinction),
                },
                gradients: function.gradient_transfer.as_ref(),
            },
            Self {
                points: points(emission),
                interpolation,
                amount: Box::new(|emission| emission),
                gradients: None,
            },
        ]
    }

    /// From the first value to the last, of another span too.
    pub fn span(&self, other: Option<[f64; 2]>) -> Option<[f64; 2]> {
        let (first, last) = (self.points.first(), self.points.last());
        let own = first.zip(last).map(|(first, last)| [first[0], last[0]]);
        let of_widgets = self.gradients.and_then(GradientTransfer::span);
        let both = |a: Option<[f64; 2]>, b: Option<[f64; 2]>| match (a, b) {
            (Some([a, b]), Some([c, d])) => Some([a.min(c), b.max(d)]),
            (a, b) => a.or(b),
        };
        both(both(own, of_widgets), other)
    }

    /// The most between two values, both included.
    pub fn most_between(&self, [low, high]: [f64; 2]) -> f64 {
        let inside = self.points.iter().filter(|p| (low..=high).contains(&p[0]));
        let ends = self.points.first().into_iter().chain(self.points.last());
        let beyond = ends.zip([|a, b| a > b, |a, b| a < b] as [fn(f64, f64) -> bool; 2]);
        let beyond = beyond.filter(|(end, is_out)| is_out(end[0], low) || is_out(end[0], high));
        let at_ends = self.points.windows(2).flat_map(|pair| {
            let [[from, a], [to, b]] = [pair[0], pair[1]];
            [low, high].map(|value| match value {
                _ if value < from || value > to => 0.0,
                _ if self.interpolation == Interpolation::Step => a,
                _ if to > from => a + (value - from) / (to - from) * (b - a),
                _ => a.max(b),
            })
        });
        let inside = inside.map(|p| p[1]);
        let most = inside.chain(beyond.map(|(end, _)| end[1])).chain(at_ends);
        let own = (self.amount)(most.fold(0.0, f64::max));
        match self.gradients {
            None => own,
            // No share of an opacity has more of its extinction than that share.
            Some(gradients) => {
                let widgets = gradients.most_opacities([low, high]);
                gradients.most_share() * own + widgets.map(|o| (self.amount)(o)).sum::<f64>()
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::transfer::OpacityPoint;

    /// As the shader looks it up.
    fn most(of: &Majorants, [low, high]: [usize; 2]) -> f32 {
        let row = (high - low + 1).ilog2() as usize;
        let entry = |bin: usize| {
            let entry = row * BINS + bin;
            of.rows[entry / 4][entry % 4]
        };
        entry(low).max(entry(high + 1 - (1 << row)))
    }

    #[test]
    fn no_value_of_a_range_has_more() {
        let heights = [0.0, 0.4, 0.1, 0.9, 0.9, 0.0, 0.3];
        let points = heights.iter().enumerate();
        let opacity = points.map(|(i, &opacity)| OpacityPoint {
            value: (i * i) as f64,
            opacity,
        });
        for interpolation in [Interpolation::Linear, Interpolation::Step] {
            let function = TransferFunction {
                opacity: opacity.clone().collect(),
                interpolation,
                color: Vec::new(),
                reference_length: None,
                gradient_transfer: None,
                medium: None,
            };
            let [amount, emission] = AmountPoints::of(&function, Absorption::Opacity);
            assert_eq!(emission.span(None), None);
            let span = amount.span(None).expect("points");
            let table = Majorants::new(span, |ends| amount.most_between(ends));
            for low in 0..BINS {
                for high in low..BINS {
                    let found = f64::from(most(&table, [low, high]));
                    let value = |i: usize| {
                        36.0 * (low as f64 + (high - low + 1) as f64 * i as f64 / 64.0) / 64.0
                    };
                    let seen = (0..=64).map(|i| amount.most_between([value(i); 2]));
                    let wanted = seen.fold(0.0, f64::max);
                    assert!(found >= wanted - 1e-6, "{low} {high}: {found} {wanted}");
                }
            }
            assert_eq!(most(&table, [0, 63]), 0.9);
            assert!(most(&table, [0, 0]) < 0.3);
        }
    }
}
