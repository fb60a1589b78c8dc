//! A transfer function as an array that a shader searches: no table, no error but that of f32.
//!
//! Colour points come first, then opacity points; a shader that finds the last point at or below a value
//! and mixes with the next one computes the function of `sampling.md` 4.

use super::{Absorption, Interpolation, TransferFunction};
use crate::color::{ColorSpace, decode_srgb};
use crate::real::Real;

/// Control points for a shader.
#[derive(Clone, Debug, PartialEq)]
pub struct Points {
    /// `color_count` times (value, sRGB red, green, blue), then `opacity_count` times (value, opacity per
    /// reference length, 0, 0).
    pub entries: Vec<[f32; 4]>,
    /// Colour points; they are first.
    pub color_count: u32,
    /// Opacity points; they follow.
    pub opacity_count: u32,
    /// Between two points the left one's value holds.
    pub step: bool,
    /// Colours are decoded to linear light; else they stay sRGB numbers.
    pub decode: bool,
    /// What the fourth number of a classified value is.
    pub absorption: Absorption,
}

impl Points {
    /// The points of `function`.
    pub fn new(function: &TransferFunction, absorption: Absorption, space: ColorSpace) -> Self {
        let color = function.color.iter().map(|p| {
            let [r, g, b] = p.srgb.map(|c| c as f32);
            [p.value as f32, r, g, b]
        });
        let opacity = function
            .opacity
            .iter()
            .map(|p| [p.value as f32, p.opacity as f32, 0.0, 0.0]);
        Self {
            entries: color.chain(opacity).collect(),
            color_count: function.color.len() as u32,
            opacity_count: function.opacity.len() as u32,
            step: function.interpolation == Interpolation::Step,
            decode: space == ColorSpace::Linear,
            absorption,
        }
    }
}

/// (red, green, blue, absorption) at `value`; colour as it is blended.
pub fn classify_by_points<N: Real>(points: &Points, value: N) -> [N; 4] {
    let (color_count, opacity_count) = (points.color_count as usize, points.opacity_count as usize);
    let [r, g, b] = at(points, 0, color_count, value);
    let [opacity, _, _] = at(points, color_count, opacity_count, value);
    let shown = |c: N| if points.decode { decode_srgb(c) } else { c };
    [shown(r), shown(g), shown(b), points.absorption.of(opacity)]
}

/// What the `count` points from `first` on say of `value`.
fn at<N: Real>(points: &Points, first: usize, count: usize, value: N) -> [N; 3] {
    let n = N::from_f32;
    let entry = |i: usize| points.entries[first + i].map(n);
    if count == 0 {
        return [n(0.0); 3];
    }
    // What the function is after so many points.
    let after = |passed: usize| {
        let left = entry(passed.max(1) - 1);
        let mut found = [left[1], left[2], left[3]];
        if passed > 0 && passed < count && !points.step {
            let right = entry(passed);
            let t = (value - left[0]) / (right[0] - left[0]);
            for (c, found) in found.iter_mut().enumerate() {
                *found = found.lerp(right[c + 1], t);
            }
        }
        found
    };
    let passed = |is_passed: &dyn Fn(N) -> bool| {
        let is_passed = |i: &usize| is_passed(entry(*i)[0]);
        (0..count).take_while(is_passed).count()
    };
    let [low, high] = value.range();
    if points.step || low == high {
        return after(passed(&|point| point <= value));
    }
    // Lines meet where they end: whichever of them a device is on, it is near.
    let own = passed(&|point| point.to_f64() <= value.to_f64());
    let first = passed(&|point| point.range()[1] <= low);
    let last = passed(&|point| point.range()[0] <= high);
    let others = (first..=last).filter(|&passed| passed != own);
    others.fold(after(own), |found, passed| {
        let other = after(passed);
        std::array::from_fn(|c| found[c].or(other[c]))
    })
}
