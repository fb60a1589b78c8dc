//! A transfer function as an array that a shader searches: no table, no error but that of f32.
//!
//! Colour points come first, then opacity points; a shader that finds the last point at or below a value
//! and mixes with the next one computes the function of `sampling.md` 4.

use super::{Absorption, Interpolation, MediumPoint, TransferFunction};
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
    /// Emission points of a medium; they follow.
    pub emission_count: u32,
    /// Opacity points are (value, extinctions per world length of red, green and blue).
    pub are_extinctions: bool,
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
        let medium = match absorption {
            Absorption::Medium { .. } => function.medium.as_deref(),
            Absorption::Extinction { .. } | Absorption::Opacity => None,
        };
        let [extinction, albedo, emission] = match medium {
            Some(medium) => {
                [&medium.extinction, &medium.albedo, &medium.emission].map(|list| entries(list))
            }
            None => [const { Vec::new() }; 3],
        };
        let color = function.color.iter().map(|p| {
            let [r, g, b] = p.srgb.map(|c| c as f32);
            [p.value as f32, r, g, b]
        });
        let opacity = function
            .opacity
            .iter()
            .map(|p| [p.value as f32, p.opacity as f32, 0.0, 0.0]);
        let (are_extinctions, has_albedo) = (!extinction.is_empty(), !albedo.is_empty());
        let color = if has_albedo { albedo } else { color.collect() };
        let opacity = match are_extinctions {
            true => extinction,
            false => opacity.collect(),
        };
        Self {
            color_count: color.len() as u32,
            opacity_count: opacity.len() as u32,
            emission_count: emission.len() as u32,
            entries: [color, opacity, emission].concat(),
            are_extinctions,
            step: function.interpolation == Interpolation::Step,
            decode: space == ColorSpace::Linear && !has_albedo,
            absorption,
        }
    }
}

impl Points {
    /// What shaders divide by: extinctions, or what is made of opacities for one unit of length.
    pub fn reference_length(&self) -> f64 {
        match self.absorption {
            Absorption::Medium { density, .. } if self.are_extinctions => 1.0 / density,
            absorption => absorption.reference_length(),
        }
    }
}

/// Points of a medium.
fn entries(points: &[MediumPoint]) -> Vec<[f32; 4]> {
    let entry = |p: &MediumPoint| [p.value, p.linear[0], p.linear[1], p.linear[2]];
    points.iter().map(|p| entry(p).map(|x| x as f32)).collect()
}

/// Extinctions per world length, of red, green and blue.
pub fn extinctions_by_points<N: Real>(points: &Points, value: N) -> [N; 3] {
    let first = points.color_count as usize;
    let found = at(points, first, points.opacity_count as usize, value);
    match (points.are_extinctions, points.absorption) {
        (true, Absorption::Medium { density, .. }) => found.map(|x| x * N::from_f64(density)),
        _ => [points.absorption.of(found[0]); 3],
    }
}

/// Radiance per world length.
pub fn emission_by_points<N: Real>(points: &Points, value: N) -> [N; 3] {
    let first = points.color_count + points.opacity_count;
    at(
        points,
        first as usize,
        points.emission_count as usize,
        value,
    )
}

/// (red, green, blue, absorption) at `value`; colour as it is blended.
pub fn classify_by_points<N: Real>(points: &Points, value: N) -> [N; 4] {
    let [r, g, b] = at(points, 0, points.color_count as usize, value);
    let [red, green, blue] = extinctions_by_points(points, value);
    // A mean, of three that are alike without rounding.
    let third = N::from_f64(1.0 / 3.0);
    let absorption = red + (green - red) * third + (blue - red) * third;
    let shown = |c: N| if points.decode { decode_srgb(c) } else { c };
    [shown(r), shown(g), shown(b), absorption]
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
