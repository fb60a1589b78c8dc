//! A function of value and gradient that shows the boundaries of a volume of which nothing else is known.
//!
//! Between two substances the values run from one to the other, steepest half way: over the values, the mean gradient
//!
//! ```text
//! g(v) = sum of gradients of voxels of value v / their number
//! ```
//!
//! is an arch that stands on the two substances and has its top on the boundary (Kindlmann & Durkin, Volume
//! Visualization 1998). Each top that stands out gets a contour ([`super::Shape::Contour`]), the faintest the lowest
//! value, so that what is inside is seen.

use super::{
    ColorPoint, GradientTransfer, Interpolation, OpacityPoint, Shape, TransferFunction, Widget,
};

/// How often pairs of value and gradient magnitude occur.
#[derive(Clone, Copy, Debug)]
pub struct JointCounts<'a> {
    /// Values where the first column begins and the last one ends.
    pub value_range: [f64; 2],
    /// The gradient, in values per world length, where the last row ends; the first begins at 0.
    pub steepest: f64,
    /// World length of the shortest side of a voxel.
    pub smallest_spacing: f64,
    /// By ascending value.
    pub columns: usize,
    /// Row by row, the smallest gradients first: from 0 up to the steepest.
    pub counts: &'a [u64],
}

/// Contours on the boundaries, opaque per `reference_length`. `None` where no arch is found.
pub fn boundaries(joint: &JointCounts, reference_length: Option<f64>) -> Option<TransferFunction> {
    let [low, high] = joint.value_range;
    let columns = joint.columns as f64;
    let value = |place: f64| low + place / columns * (high - low);
    let (means, shares) = mean_gradients(joint);
    let tops = tops(&means, |top| shares[top] >= FEWEST);
    if tops.is_empty() {
        return None;
    }
    let values: Vec<f64> = tops.iter().map(|&top| value(top as f64 + 0.5)).collect();
    let mut color = Vec::new();
    let mut widgets = Vec::new();
    for (i, &at) in values.iter().enumerate() {
        let before = i.checked_sub(1).map_or(low, |i| 0.5 * (values[i] + at));
        let after = values.get(i + 1).map_or(high, |next| 0.5 * (next + at));
        let rank = rank(i, values.len());
        let [dark, light] = shades(rank);
        // How far the contour reaches over the values. Its outer half is dark: what is seen from the side stands out.
        let gradient = means[tops[i]] * joint.steepest;
        let reach = HALF_WIDTH * joint.smallest_spacing * gradient;
        color.push(color_point((at - 0.8 * reach).max(before), dark));
        color.push(color_point((at + 0.3 * reach).min(after), light));
        widgets.push(Widget {
            srgb: None,
            opacity: FAINTEST * (DENSEST / FAINTEST).powf(rank),
            shape: Shape::Contour {
                value: at,
                half_width: HALF_WIDTH,
            },
            second: None,
        });
    }
    Some(TransferFunction {
        opacity: vec![OpacityPoint {
            value: color[0].value,
            opacity: 0.0,
        }],
        color,
        reference_length,
        interpolation: Interpolation::Linear,
        medium: None,
        gradient_transfer: Some(GradientTransfer {
            steepest: None,
            share: Vec::new(),
            widgets,
        }),
    })
}

/// Opacities of the lowest and of the highest boundary.
const FAINTEST: f64 = 0.05;
const DENSEST: f64 = 0.9;
/// Of contours, in smallest spacings: a surface between two voxels is met by some sample.
const HALF_WIDTH: f64 = 1.5;
/// Columns on either side over which the mean gradient is smoothed, of a hundred.
const SMOOTHED: f64 = 3.0;
/// By how much of the highest arch a top stands above what is beside it.
const PROMINENCE: f64 = 0.1;
/// Of all voxels, those that have the values of a top: a few outliers are no substance.
const FEWEST: f64 = 1e-3;
const MOST: usize = 4;

/// 0 for the first, 1 for the last, 1 for the only one.
fn rank(i: usize, count: usize) -> f64 {
    if count == 1 {
        1.0
    } else {
        i as f64 / (count - 1) as f64
    }
}

/// Flesh on the outside, ivory inside.
fn shades(rank: f64) -> [[f64; 3]; 2] {
    let between =
        |a: [f64; 3], b: [f64; 3]| std::array::from_fn(|c| (a[c] + rank * (b[c] - a[c])) / 255.0);
    [
        between([90.0, 44.0, 30.0], [70.0, 30.0, 16.0]),
        between([236.0, 180.0, 152.0], [255.0, 250.0, 236.0]),
    ]
}

fn color_point(value: f64, srgb: [f64; 3]) -> ColorPoint {
    ColorPoint { value, srgb }
}

/// The mean gradient over each column, as a share of the steepest, smoothed by neighbours; and the share of all
/// voxels that lie in it and in the neighbours.
fn mean_gradients(joint: &JointCounts) -> (Vec<f64>, Vec<f64>) {
    let columns = joint.columns.max(1);
    let rows = joint.counts.len() / columns;
    let (mut numbers, mut sums) = (vec![0.0; columns], vec![0.0; columns]);
    for (i, &count) in joint.counts.iter().enumerate() {
        let gradient = ((i / columns) as f64 + 0.5) / rows as f64;
        numbers[i % columns] += count as f64;
        sums[i % columns] += count as f64 * gradient;
    }
    let all: f64 = numbers.iter().sum();
    // A value that occurs once says nothing.
    let few = (all * 1e-4 / columns as f64).max(f64::MIN_POSITIVE);
    let radius = (SMOOTHED / 100.0 * columns as f64).ceil() as usize;
    let smooth = |of: &[f64], i: usize| -> f64 {
        let near = i.saturating_sub(radius)..(i + radius + 1).min(columns);
        // A tent, so that a top is where the values say it.
        near.map(|j| of[j] * (1.0 - i.abs_diff(j) as f64 / (radius + 1) as f64))
            .sum()
    };
    // Each column counts as one, whatever its number, but for those of next to none.
    let weights: Vec<f64> = numbers.iter().map(|n| n / (n + few)).collect();
    let means = sums.iter().zip(&numbers).map(|(sum, n)| sum / (n + few));
    let means: Vec<f64> = means.collect();
    let smoothed = |i| smooth(&means, i) / smooth(&weights, i).max(f64::MIN_POSITIVE);
    let share = |i| smooth(&numbers, i) / all.max(1.0);
    (0..columns).map(|i| (smoothed(i), share(i))).unzip()
}

/// Where the arches have their tops, by ascending place: those that stand out most.
fn tops(means: &[f64], counts: impl Fn(usize) -> bool) -> Vec<usize> {
    let counted = (0..means.len()).filter(|&i| counts(i));
    let highest = counted.map(|i| means[i]).fold(0.0, f64::max);
    let mut found: Vec<(usize, f64)> = (0..means.len())
        .filter(|&i| counts(i))
        .filter_map(|i| Some((i, prominence(means, i, &counts)?)))
        .filter(|&(_, prominence)| prominence > PROMINENCE * highest)
        .collect();
    found.sort_by(|a, b| b.1.total_cmp(&a.1));
    found.truncate(MOST);
    let mut tops: Vec<usize> = found.into_iter().map(|(i, _)| i).collect();
    tops.sort_unstable();
    tops
}

/// How far one has to climb down from a top before something higher comes, on the shallower side; `None` where
/// there is no top. What does not count is as low as can be.
fn prominence(means: &[f64], top: usize, counts: impl Fn(usize) -> bool) -> Option<f64> {
    let height = means[top];
    let is_top = (top == 0 || means[top - 1] < height)
        && means.get(top + 1).is_none_or(|&next| next <= height);
    if !is_top || height <= 0.0 {
        return None;
    }
    let lowest = |way: &mut dyn Iterator<Item = usize>| {
        let mut lowest = height;
        for i in way {
            let mean = if counts(i) { means[i] } else { 0.0 };
            if mean > height {
                return lowest;
            }
            lowest = lowest.min(mean);
        }
        // Beyond the ends there is nothing.
        0.0
    };
    let left = lowest(&mut (0..top).rev());
    let right = lowest(&mut (top + 1..means.len()));
    Some(height - left.max(right))
}
