//! Pre-integrated classification: what lies between two values of a transfer function, in one table.
//!
//! Along a segment of length d whose value runs linearly from sf to sb, with T and K the integrals of extinction
//! and of extinction times colour over the value,
//!
//! ```text
//! tau = d (T(sb) - T(sf)) / (sb - sf)         alpha = 1 - exp(-tau)
//! C   = alpha (K(sb) - K(sf)) / (T(sb) - T(sf))
//! ```
//!
//! (Max, Hanrahan and Crawfis 1990; Engel, Kraus and Ertl 2001). That is a segment of the mean extinction and the
//! mean colour between both values. Engel's colour without the attenuation inside the segment exceeds 1 where it
//! is opaque; this one never does.
//!
//! A cell of the table keeps its own mean and slope, and the sum of the means before it in two f32, together 48
//! bits. A mean over several cells is made of three sums without a minus sign: the part of the first cell, the
//! whole cells between, the part of the last one. So values that are close lose no digits, and two values in one
//! cell divide by nothing.
//!
//! The cells are those of [`super::Table`], and one more behind the last. Inside a cell the specification is a line. Where it
//! jumps there, a segment that ends in that cell misses a quarter of the jump over one cell at most; so the cells of a
//! function that jumps where no cell begins are as small as 2^16 of them allow.

use super::table::Cut;
use super::{Absorption, Interpolation, TransferFunction};
use crate::color::{ColorSpace, decode_srgb};
use crate::real::Real;

/// One cell, in parts of (emission red, green, blue, extinction). Emission is extinction times colour.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct SlabCell {
    /// The mean over the cell.
    pub mean: [f32; 4],
    /// What is added from one end of the cell to the other; keeps the mean, and no end below 0.
    pub slope: [f32; 4],
    /// The means of all cells before, added up.
    pub sum: [f32; 4],
    /// What rounding took from `sum`.
    pub sum_rest: [f32; 4],
}

/// A transfer function, integrated.
#[derive(Clone, Debug, PartialEq)]
pub struct SlabTable {
    /// The first and the last are constant.
    pub cells: Vec<SlabCell>,
    /// Value where cell 0 begins.
    pub first: f32,
    /// Cells per unit of value.
    pub scale: f32,
}

/// Positions in the table end here: far beyond it, where f32 still can subtract.
const FARTHEST_CELL: f32 = 1e15;

impl SlabTable {
    /// The integrals of `function`.
    pub fn new(function: &TransferFunction, absorption: Absorption, space: ColorSpace) -> Self {
        let law = Law::new(function, absorption, space);
        let cut = Cut::for_slabs(function);
        let (first, width, count) = (cut.first, cut.width, cut.count);
        let mut sums = [0.0; 4];
        let mut cells = Vec::with_capacity(count + 1);
        // One more than the table of single values has: the last is constant.
        for i in 0..=count {
            let start = first + i as f64 * width;
            let [mean, slope] = law.line_over(start, start + width);
            let sum = sums.map(|x| x as f32);
            cells.push(SlabCell {
                mean: mean.map(|x| x as f32),
                slope: slope.map(|x| x as f32),
                sum,
                sum_rest: std::array::from_fn(|c| (sums[c] - f64::from(sum[c])) as f32),
            });
            // What a lookup adds up are the rounded means.
            sums = std::array::from_fn(|c| sums[c] + f64::from(mean[c] as f32));
        }
        Self {
            cells,
            first: first as f32,
            scale: (1.0 / width) as f32,
        }
    }
}

/// (red, green, blue, extinction) of a segment whose value runs from `front` to `back`.
pub fn classify_slab<N: Real>(table: &SlabTable, front: N, back: N) -> [N; 4] {
    let zero = N::from_f64(0.0);
    let [r, g, b, extinction] = mean_between(table, front, back);
    if extinction <= N::from_f32(f32::MIN_POSITIVE) {
        return [zero; 4];
    }
    let share = |c: N| (c / extinction).max(zero).min(N::from_f64(1.0));
    [share(r), share(g), share(b), extinction]
}

/// The mean of (emission, extinction) between two values.
fn mean_between<N: Real>(table: &SlabTable, front: N, back: N) -> [N; 4] {
    let half = N::from_f64(0.5);
    let position = |value: N| {
        let far = N::from_f32(FARTHEST_CELL);
        let cell = (value - N::from_f32(table.first)) * N::from_f32(table.scale);
        cell.max(-far).min(far)
    };
    let last = table.cells.len() - 1;
    let cell_of = |at: N| (at.to_f64().floor().max(0.0) as usize).min(last);
    let number = |x: f32| N::from_f32(x);
    let (low, high) = (position(front.min(back)), position(front.max(back)));
    let (first, end) = (cell_of(low), cell_of(high));
    let in_first = low - N::from_f64(first as f64);
    let in_last = high - N::from_f64(end as f64);
    let (a, b) = (&table.cells[first], &table.cells[end]);
    if first == end {
        let middle = half * (in_first + in_last) - half;
        return std::array::from_fn(|c| number(a.mean[c]) + middle * number(a.slope[c]));
    }
    let after = &table.cells[first + 1];
    let (head, tail) = (N::from_f64(1.0) - in_first, in_last);
    let length = high - low;
    std::array::from_fn(|c| {
        let of_first = number(a.mean[c]) + half * in_first * number(a.slope[c]);
        let of_last = number(b.mean[c]) + (half * in_last - half) * number(b.slope[c]);
        let whole = (number(b.sum[c]) - number(after.sum[c]))
            + (number(b.sum_rest[c]) - number(after.sum_rest[c]));
        (head * of_first + whole + tail * of_last) / length
    })
}

/// A transfer function that is asked often.
struct Law<'a> {
    function: &'a TransferFunction,
    absorption: Absorption,
    space: ColorSpace,
    /// Where it bends or jumps, ascending.
    bends: Vec<f64>,
}

/// Three points and their weights on 0 to 1: exact for polynomials of degree 5 (Gauss, Legendre).
const GAUSS: [(f64, f64); 3] = [
    (0.112_701_665_379_258_3, 5.0 / 18.0),
    (0.5, 4.0 / 9.0),
    (0.887_298_334_620_741_7, 5.0 / 18.0),
];

impl<'a> Law<'a> {
    fn new(function: &'a TransferFunction, absorption: Absorption, space: ColorSpace) -> Self {
        let color = function.color.iter().map(|p| p.value);
        let mut bends: Vec<f64> = color
            .chain(function.opacity.iter().map(|p| p.value))
            .collect();
        bends.sort_by(f64::total_cmp);
        Self {
            function,
            absorption,
            space,
            bends,
        }
    }

    /// Mean and slope over a cell of the line that fits (emission, extinction) best.
    fn line_over(&self, start: f64, end: f64) -> [[f64; 4]; 2] {
        let width = end - start;
        let from = self.bends.partition_point(|&bend| bend <= start);
        let to = self.bends.partition_point(|&bend| bend < end).max(from);
        let inner = self.bends[from..to].iter().copied();
        let mut left = start;
        let (mut mean, mut tilt) = ([0.0; 4], [0.0; 4]);
        for right in inner.chain([end]) {
            for (at, weight) in GAUSS {
                let value = left + at * (right - left);
                let weight = weight * (right - left) / width;
                let found = self.emission_and_extinction(value);
                for c in 0..4 {
                    mean[c] += weight * found[c];
                    tilt[c] += weight * ((value - start) / width - 0.5) * found[c];
                }
            }
            left = right;
        }
        // The first Legendre coefficient; a line that kept the mean and went below 0 is no density.
        let slope = |c: usize| (12.0 * tilt[c]).clamp(-2.0 * mean[c], 2.0 * mean[c]);
        [mean, std::array::from_fn(slope)]
    }

    fn emission_and_extinction(&self, value: f64) -> [f64; 4] {
        let function = self.function;
        let opacity = function.opacity.as_slice();
        let [opacity] = self.between(opacity, |p| (p.value, [p.opacity]), value);
        if opacity == 0.0 {
            return [0.0; 4];
        }
        let extinction = self.absorption.of(opacity);
        let srgb = self.between(function.color.as_slice(), |p| (p.value, p.srgb), value);
        let [r, g, b] = match self.space {
            ColorSpace::Linear => srgb.map(decode_srgb),
            ColorSpace::Display => srgb,
        };
        [r * extinction, g * extinction, b * extinction, extinction]
    }

    /// The specification between control points, found by halving.
    fn between<P, const C: usize>(
        &self,
        points: &[P],
        of: impl Fn(&P) -> (f64, [f64; C]),
        value: f64,
    ) -> [f64; C] {
        let passed = points.partition_point(|point| of(point).0 <= value);
        let at = |i: usize| points.get(i).map(&of);
        match (passed.checked_sub(1).and_then(at), at(passed)) {
            (None, None) => [0.0; C],
            (None, Some((_, right))) => right,
            (Some((_, left)), None) => left,
            (Some((_, left)), _) if self.function.interpolation == Interpolation::Step => left,
            (Some((start, left)), Some((end, right))) => {
                let t = (value - start) / (end - start);
                std::array::from_fn(|c| left[c] + t * (right[c] - left[c]))
            }
        }
    }
}
