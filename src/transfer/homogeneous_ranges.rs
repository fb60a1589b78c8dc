//! Between which values a transfer function hardly changes: where one sample may stand for those beside it.
//!
//! ```text
//! end(i) = the largest j with   max c - min c <= E/2                          of each colour, over cells i .. j - 1
//!                               max s - min s <= E/4 (min s + 1/L)            of extinction
//! ```
//!
//! Samples that take colour and extinction from elsewhere in such a range leave every channel of the picture within E,
//! with L the world length of the longest ray (`docs/sampling-notes.md` derives it). Cells are those of the function's
//! [`super::Table`]; a part of a range that is alike is alike, so that one number a cell tells all ranges.

use super::table::Cut;
use super::{Absorption, TransferFunction};
use crate::color::{ColorSpace, decode_srgb};
use std::collections::VecDeque;

/// Ranges of values that look alike.
#[derive(Clone, Debug, PartialEq)]
pub struct HomogeneousRanges {
    /// Value where cell 0 begins; values before it are in cell 0.
    pub first: f32,
    /// Cells per unit of value; values behind the last cell are in the last one.
    pub scale: f32,
    /// Of each cell, the first one behind it that is not alike; its own number where it is not so itself.
    pub end: Vec<u32>,
}

/// How far a picture may be from that of all samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    /// Of each channel, premultiplied, in the numbers that are blended.
    pub error: f64,
    /// World length of the longest ray.
    pub longest_ray: f64,
}

/// Colour as it is blended, and extinction.
type Material = [f64; 4];

impl HomogeneousRanges {
    /// Of a function of the value alone.
    pub fn new(
        function: &TransferFunction,
        reference_length: f64,
        space: ColorSpace,
        tolerance: Tolerance,
    ) -> Self {
        let Cut {
            first,
            width,
            count,
            ..
        } = Cut::new(function);
        let border = |i: usize| first + i as f64 * width;
        let ends = |i: usize| {
            // Beyond the cells the function is what it is at their ends.
            let from = if i == 0 { f64::MIN } else { border(i) };
            let to = if i + 1 == count {
                f64::MAX
            } else {
                border(i + 1)
            };
            extremes(function, reference_length, space, [from, to])
        };
        let cells: Vec<[Material; 2]> = (0..count).map(ends).collect();
        Self {
            first: first as f32,
            scale: (1.0 / width) as f32,
            end: ends_of_ranges(&cells, |range| is_alike(range, tolerance)),
        }
    }

    /// Whether all values of the range are.
    pub fn holds(&self, [low, high]: [f32; 2]) -> bool {
        let last = self.end.len() as f32 - 1.0;
        let cell = |value: f32, more: f32| ((value - self.first) * self.scale).floor() + more;
        let from = cell(low, -1.0).clamp(0.0, last);
        let to = cell(high, 1.0).clamp(0.0, last);
        self.end[from as usize] > to as u32
    }
}

fn is_alike([low, high]: [Material; 2], tolerance: Tolerance) -> bool {
    let Tolerance { error, longest_ray } = tolerance;
    let apart = |c: usize| high[c] - low[c];
    let limit = 0.25 * error * (low[3] + 1.0 / longest_ray);
    (0..3).all(|c| apart(c) <= 0.5 * error) && apart(3) <= limit
}

/// The smallest and the largest of everything between two values. The specification has its extremes at its points and at the
/// ends.
fn extremes(
    function: &TransferFunction,
    reference_length: f64,
    space: ColorSpace,
    [from, to]: [f64; 2],
) -> [Material; 2] {
    let absorption = Absorption::Extinction { reference_length };
    let mut low = [f64::INFINITY; 4];
    let mut high = [f64::NEG_INFINITY; 4];
    let mut take = |c: usize, x: f64| {
        low[c] = low[c].min(x);
        high[c] = high[c].max(x);
    };
    let is_inside = |value: f64| from <= value && value <= to;
    let colors = function.color.iter().filter(|point| is_inside(point.value));
    let blended = |srgb: [f64; 3]| match space {
        ColorSpace::Linear => srgb.map(decode_srgb),
        ColorSpace::Display => srgb,
    };
    let colors = colors.map(|point| blended(point.srgb));
    let at_ends = [from, to].map(|value| function.color(value, space));
    for color in colors.chain(at_ends) {
        (0..3).for_each(|c| take(c, color[c]));
    }
    let opacities = function.opacity.iter();
    let opacities = opacities.filter(|point| is_inside(point.value));
    let at_ends = [from, to].map(|value| function.opacity(value));
    for opacity in opacities.map(|point| point.opacity).chain(at_ends) {
        take(3, absorption.of(opacity));
    }
    [low, high]
}

/// Of each cell the first behind it up to which not all fit together.
fn ends_of_ranges(cells: &[[Material; 2]], fits: impl Fn([Material; 2]) -> bool) -> Vec<u32> {
    let mut ends = Vec::with_capacity(cells.len());
    let mut window = Window::default();
    let mut end = 0;
    for begin in 0..cells.len() {
        if end < begin {
            end = begin;
        }
        window.forget(begin);
        while end < cells.len() && fits(window.with(cells, end)) {
            window.take(cells, end);
            end += 1;
        }
        ends.push(end as u32);
    }
    ends
}

/// Which cells of a run hold its extremes: those that no later one outdoes.
#[derive(Default)]
struct Window {
    lows: [VecDeque<usize>; 4],
    highs: [VecDeque<usize>; 4],
}

impl Window {
    fn forget(&mut self, before: usize) {
        for queue in self.lows.iter_mut().chain(&mut self.highs) {
            while queue.front().is_some_and(|&cell| cell < before) {
                queue.pop_front();
            }
        }
    }

    /// The extremes with one cell more.
    fn with(&self, cells: &[[Material; 2]], next: usize) -> [Material; 2] {
        let [low, high] = cells[next];
        let of = |queue: &VecDeque<usize>, end: usize, c: usize| {
            queue.front().map(|&cell| cells[cell][end][c])
        };
        [
            std::array::from_fn(|c| of(&self.lows[c], 0, c).map_or(low[c], |x| x.min(low[c]))),
            std::array::from_fn(|c| of(&self.highs[c], 1, c).map_or(high[c], |x| x.max(high[c]))),
        ]
    }

    fn take(&mut self, cells: &[[Material; 2]], next: usize) {
        let both = self.lows.iter_mut().zip(&mut self.highs);
        for (c, (lows, highs)) in both.enumerate() {
            let is_outdone = |&cell: &usize| cells[cell][0][c] >= cells[next][0][c];
            while lows.back().is_some_and(is_outdone) {
                lows.pop_back();
            }
            let is_outdone = |&cell: &usize| cells[cell][1][c] <= cells[next][1][c];
            while highs.back().is_some_and(is_outdone) {
                highs.pop_back();
            }
            lows.push_back(next);
            highs.push_back(next);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::transfer::{ColorPoint, Interpolation, OpacityPoint};

    fn random() -> impl FnMut() -> f64 {
        let mut state = 11u64;
        move || {
            state = state
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            (state >> 40) as f64 / (1u64 << 24) as f64
        }
    }

    #[test]
    fn a_run_is_as_long_as_all_its_cells_fit_and_no_longer() {
        let mut random = random();
        let cells: Vec<[Material; 2]> = (0..300)
            .map(|_| {
                let low: Material = std::array::from_fn(|_| (4.0 * random()).floor());
                [low, low.map(|x| x + (1.3 * random()).floor())]
            })
            .collect();
        let fits = |[low, high]: [Material; 2]| (0..4).all(|c| high[c] - low[c] <= 2.0);
        let ends = ends_of_ranges(&cells, fits);
        for (begin, &end) in ends.iter().enumerate() {
            let all = |end: usize| {
                cells[begin..end].iter().fold(
                    [[f64::INFINITY; 4], [f64::NEG_INFINITY; 4]],
                    |[low, high], cell| {
                        [
                            std::array::from_fn(|c| low[c].min(cell[0][c])),
                            std::array::from_fn(|c| high[c].max(cell[1][c])),
                        ]
                    },
                )
            };
            let longest = (begin..=cells.len()).rev().find(|&end| fits(all(end)));
            assert_eq!(Some(end as usize), longest, "{begin}");
        }
    }

    #[test]
    fn values_of_a_range_that_is_alike_are() {
        let mut random = random();
        let tolerance = Tolerance {
            error: 0.1,
            longest_ray: 40.0,
        };
        let mut found = [0; 2];
        for nth in 0..60 {
            let mut at = 0.0;
            let mut flat = 0.3;
            let points: Vec<(f64, f64)> = (0..2 + nth % 7)
                .map(|_| {
                    at += if random() < 0.2 { 0.0 } else { 30.0 * random() };
                    if random() < 0.6 {
                        flat = random();
                    }
                    (at, flat)
                })
                .collect();
            let function = TransferFunction {
                color: points
                    .iter()
                    .map(|&(value, x)| ColorPoint {
                        value: value + 2.0,
                        srgb: [x, 1.0 - x, 0.5],
                    })
                    .collect(),
                opacity: points
                    .iter()
                    .map(|&(value, opacity)| OpacityPoint { value, opacity })
                    .collect(),
                reference_length: None,
                interpolation: [Interpolation::Linear, Interpolation::Step][nth % 2],
                gradient_transfer: None,
                medium: None,
            };
            let space = ColorSpace::Linear;
            let alike = HomogeneousRanges::new(&function, 1.5, space, tolerance);
            for _ in 0..60 {
                let low = (120.0 * random() - 10.0) as f32;
                let high = low + (20.0 * random().powi(3)) as f32;
                let is_alike = alike.holds([low, high]);
                found[usize::from(is_alike)] += 1;
                if !is_alike {
                    continue;
                }
                let absorption = Absorption::Extinction {
                    reference_length: 1.5,
                };
                let materials: Vec<Material> = (0..=50)
                    .map(|i| {
                        let value = f64::from(low) + f64::from(high - low) * f64::from(i) / 50.0;
                        let [r, g, b] = function.color(value, space);
                        [r, g, b, absorption.of(function.opacity(value))]
                    })
                    .collect();
                for (a, b) in materials
                    .iter()
                    .flat_map(|a| materials.iter().map(move |b| (a, b)))
                {
                    let color = (0..3).all(|c| (a[c] - b[c]).abs() <= 0.05);
                    let extinction = a[3] - b[3] <= 0.025 * (b[3] + 1.0 / 40.0);
                    assert!(color && extinction, "{low} to {high}: {a:?} and {b:?}");
                }
            }
        }
        assert!(found[0] > 300 && found[1] > 300, "{found:?}");
    }
}
