//! The largest extinctions of ranges of values, as `shaders/lib/majorants.wgsl` looks them up.
//!
//! ```text
//! row 0      M(i) = most extinction in bin i
//! row r      M(i) = max of row r - 1 at i and at i + 2^(r - 1)        the largest of 2^r bins from i on
//! ```

use crate::shaders::{MAJORANT_BINS, MAJORANT_ROWS, MAJORANT_VECTORS};
use crate::transfer::{Interpolation, TransferFunction};

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
    /// Of a function, with extinctions by `extinction_of` its opacities.
    pub fn new(function: &TransferFunction, extinction_of: impl Fn(f64) -> f64) -> Self {
        let points = &function.opacity;
        let [first, last] = match (points.first(), points.last()) {
            (Some(first), Some(last)) => [first.value, last.value],
            _ => [0.0; 2],
        };
        let width = (last - first) / BINS as f64;
        let mut rows = vec![0.0_f32; 4 * MAJORANT_VECTORS as usize];
        for (i, bin) in rows.iter_mut().enumerate().take(BINS) {
            let ends = [i, i + 1].map(|k| first + k as f64 * width);
            *bin = extinction_of(most_between(function, ends)) as f32;
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
}

/// The largest opacity between two values, both included.
fn most_between(function: &TransferFunction, [low, high]: [f64; 2]) -> f64 {
    let points = &function.opacity;
    let inside = points.iter().filter(|p| (low..=high).contains(&p.value));
    let at_ends = points.windows(2).flat_map(|pair| {
        let [a, b] = [&pair[0], &pair[1]];
        [low, high].map(|value| match value {
            _ if value < a.value || value > b.value => 0.0,
            _ if function.interpolation == Interpolation::Step => a.opacity,
            _ if b.value > a.value => {
                let part = (value - a.value) / (b.value - a.value);
                a.opacity + part * (b.opacity - a.opacity)
            }
            _ => a.opacity.max(b.opacity),
        })
    });
    inside.map(|p| p.opacity).chain(at_ends).fold(0.0, f64::max)
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
            };
            let table = Majorants::new(&function, |opacity| opacity);
            for low in 0..BINS {
                for high in low..BINS {
                    let found = f64::from(most(&table, [low, high]));
                    let value = |i: usize| {
                        36.0 * (low as f64 + (high - low + 1) as f64 * i as f64 / 64.0) / 64.0
                    };
                    let seen = (0..=64).map(|i| most_between(&function, [value(i); 2]));
                    let wanted = seen.fold(0.0, f64::max);
                    assert!(found >= wanted - 1e-6, "{low} {high}: {found} {wanted}");
                }
            }
            assert_eq!(most(&table, [0, 63]), 0.9);
            assert!(most(&table, [0, 0]) < 0.3);
        }
    }
}
