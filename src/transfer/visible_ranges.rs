//! Which values a transfer function shows at all: for skipping what is not seen.
//!
//! ```text
//! next(i) = the smallest j >= i with some opacity anywhere in cell j        values from cell a to b are not seen
//!                                                                           where next(a) > b
//! ```
//!
//! Cells are those of the function's [`super::Table`]; one counts as seen where the specification has any opacity in it, ends
//! included, so that neither the table nor the specification itself shows what is called unseen.
//!
//! A contour around v of half-width r (in smallest spacings h, [`super::GradientTransfer`]) reaches r h |gradient| far. Where all
//! values around a sample are in a range, its gradient is at most s (high - low) / h, s of the grid and of how
//! gradients are made; so the contour is not seen there where
//!
//! ```text
//! distance of v from [low, high] > r s (high - low)
//! ```

use super::table::Cut;
use super::{Cells, GradientTransfer, Shape, TransferFunction, Widget};
use crate::shaders::NEAR_ROUNDING;

/// How many standard deviations away a bell of opacity 1 is no opacity in f32: 1 - exp(-6^2 / 2) is 1.
const DEVIATIONS: f64 = 6.0;
/// Cells over the values of a function of gradients, whose widgets lie where its table need not be fine.
const GRADED_CELLS: usize = 4096;

/// Where a transfer function has opacity, whatever the gradient.
#[derive(Clone, Debug, PartialEq)]
pub struct VisibleRanges {
    /// Value where cell 0 begins; values before it are in cell 0.
    pub first: f32,
    /// Cells per unit of value; values behind the last cell are in the last one.
    pub scale: f32,
    /// Of each cell, the next that is seen; the number of cells where there is none.
    pub next: Vec<u32>,
    /// What is seen beside that, of ranges that come near.
    pub contours: Vec<ContourReach>,
}

/// A value that a range shows from so far away.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContourReach {
    /// The value.
    pub value: f32,
    /// How far away, as a multiple of how wide the range is.
    pub reach: f32,
}

impl ContourReach {
    fn is_shown_by(self, [low, high]: [f32; 2]) -> bool {
        let away = (low - self.value).max(self.value - high).max(0.0);
        away <= self.reach * (high - low) + NEAR_ROUNDING * self.value.abs()
    }
}

impl VisibleRanges {
    /// Of the function's own opacities.
    pub fn new(function: &TransferFunction) -> Self {
        Self::by(Cut::new(function), function, None)
    }

    /// The same where a gradient, times the smallest spacing, is at most `slope` times the width of the range of all
    /// values that it is made of: contours are seen in ranges that come near their values.
    pub fn of_slope(function: &TransferFunction, slope: f64) -> Self {
        Self::by(Cut::new(function), function, Some(slope))
    }

    /// Of the means between two values: a range shows nothing where no value in it has opacity, whichever two ends
    /// there are.
    pub fn between(function: &TransferFunction) -> Self {
        Self::by(Cut::for_slabs(function), function, None)
    }

    fn by(cut: Cut, function: &TransferFunction, slope: Option<f64>) -> Self {
        let Cut {
            first,
            width,
            count,
            ..
        } = cut;
        let cell = |value: f64| {
            ((value - first) / width)
                .floor()
                .clamp(0.0, count as f64 - 1.0)
        };
        let mut is_seen = vec![false; count];
        let mut show =
            |from: f64, to: f64| is_seen[cell(from) as usize..=cell(to) as usize].fill(true);
        let points = &function.opacity;
        let ends = points.first().into_iter().chain(points.last());
        for (end, beyond) in ends.zip([f64::NEG_INFINITY, f64::INFINITY]) {
            if end.opacity > 0.0 {
                show(end.value.min(beyond), end.value.max(beyond));
            }
        }
        for pair in points.windows(2) {
            if pair.iter().any(|point| point.opacity > 0.0) {
                show(pair[0].value, pair[1].value);
            }
        }
        let Some(gradient_transfer) = &function.gradient_transfer else {
            return Self::of_cells(first as f32, (1.0 / width) as f32, &is_seen);
        };
        // What the table shows is seen as far as its cells reach.
        let end = |i: usize| match i {
            0 => f64::NEG_INFINITY,
            i if i == count => f64::INFINITY,
            i => first + i as f64 * width,
        };
        let seen_cells = (0..count).filter(|&i| is_seen[i]);
        let of_values = seen_cells.map(|i| [end(i), end(i + 1)]);
        let spans = of_values
            .chain(spans_of(gradient_transfer, slope.is_some()))
            .collect();
        let contours = slope.map(|slope| contours_of(gradient_transfer, slope));
        Self {
            contours: contours.unwrap_or_default(),
            ..Self::of_spans(spans)
        }
    }

    /// All numbers over 0, but for those so small that arithmetic may take them for it: of what is an amount already.
    pub fn positive() -> Self {
        Self::of_spans(vec![[4.0 * f64::from(f32::MIN_POSITIVE), f64::INFINITY]])
    }

    /// Of ranges of values, ends included.
    fn of_spans(spans: Vec<[f64; 2]>) -> Self {
        let ends = || spans.iter().flatten().copied().filter(|v| v.is_finite());
        let low = ends().reduce(f64::min).unwrap_or(0.0);
        let high = ends().reduce(f64::max).unwrap_or(0.0);
        // Something lies beyond the first span and the last one.
        let width = ((high - low) / (GRADED_CELLS - 4) as f64).max(f64::from(f32::MIN_POSITIVE));
        let first = low - 2.0 * width;
        let last = GRADED_CELLS as f64 - 1.0;
        let cell = |value: f64| ((value - first) / width).floor().clamp(0.0, last) as usize;
        let mut is_seen = vec![false; GRADED_CELLS];
        for [from, to] in spans {
            is_seen[cell(from)..=cell(to)].fill(true);
        }
        let scale = (1.0 / width).min(f32::MAX.into());
        Self::of_cells(first as f32, scale as f32, &is_seen)
    }

    /// Single values, those of surfaces: a range shows one where it holds it, within 1/4096 of `value_range`.
    pub fn of_values(values: &[f32], [low, high]: [f64; 2]) -> Self {
        const CELLS: usize = 4096;
        let width = ((high - low) / CELLS as f64).max(f64::from(f32::MIN_POSITIVE));
        let scale = (1.0 / width).min(f32::MAX.into());
        let mut is_seen = vec![false; CELLS];
        for &value in values {
            let cell = ((f64::from(value) - low) * scale).floor();
            is_seen[cell.clamp(0.0, CELLS as f64 - 1.0) as usize] = true;
        }
        Self::of_cells(low as f32, scale as f32, &is_seen)
    }

    /// The same and single values, those of surfaces: a range shows one where it holds it.
    pub(crate) fn with_values(mut self, values: impl Iterator<Item = f32>) -> Self {
        let reach = 0.0;
        let held = values.map(|value| ContourReach { value, reach });
        self.contours.extend(held);
        self
    }

    fn of_cells(first: f32, scale: f32, is_seen: &[bool]) -> Self {
        let mut next = vec![is_seen.len() as u32; is_seen.len()];
        let mut nearest = is_seen.len() as u32;
        for (i, &is_seen) in is_seen.iter().enumerate().rev() {
            if is_seen {
                nearest = i as u32;
            }
            next[i] = nearest;
        }
        Self {
            first,
            scale,
            next,
            contours: Vec::new(),
        }
    }

    /// Whether every value is seen, so that nothing can be left out.
    pub fn is_all(&self) -> bool {
        (0..).zip(&self.next).all(|(i, &next)| i == next)
    }

    /// Whether any value of the range may be seen.
    pub fn shows(&self, [low, high]: [f32; 2]) -> bool {
        let last = self.next.len() as f32 - 1.0;
        let cell = |value: f32, more: f32| ((value - self.first) * self.scale).floor() + more;
        let from = cell(low, -1.0).clamp(0.0, last);
        let to = cell(high, 1.0).clamp(0.0, last);
        let is_near = |contour: &ContourReach| contour.is_shown_by([low, high]);
        self.next[from as usize] <= to as u32 || self.contours.iter().any(is_near)
    }
}

/// The values that widgets of any opacity reach, whatever the gradient; without those of contours, if these are told
/// apart.
fn spans_of(gradient_transfer: &GradientTransfer, has_contours: bool) -> Vec<[f64; 2]> {
    let is_left = |widget: &&Widget| {
        let is_contour = matches!(widget.shape, Shape::Contour { .. });
        widget.opacity > 0.0 && !(has_contours && is_contour)
    };
    let seen = gradient_transfer.widgets.iter().filter(is_left);
    seen.flat_map(spans_of_widget).collect()
}

fn contours_of(gradient_transfer: &GradientTransfer, slope: f64) -> Vec<ContourReach> {
    let near = |widget: &Widget| match widget.shape {
        Shape::Contour { value, half_width } if widget.opacity > 0.0 => Some(ContourReach {
            value: value as f32,
            // A thousandth more than what is exact.
            reach: (1.001 * slope * half_width.abs()) as f32,
        }),
        _ => None,
    };
    gradient_transfer.widgets.iter().filter_map(near).collect()
}

fn spans_of_widget(widget: &Widget) -> Vec<[f64; 2]> {
    let around = |value: f64, reach: f64| vec![[value - reach, value + reach]];
    match &widget.shape {
        // As far as the gradient takes it.
        Shape::Contour { value, .. } => around(*value, f64::INFINITY),
        Shape::Region { points } => {
            let pairs = points.windows(2);
            let seen = pairs.filter(|pair| pair.iter().any(|point| point.opacity > 0.0));
            seen.map(|pair| [pair[0].value, pair[1].value]).collect()
        }
        Shape::Triangle {
            value, half_width, ..
        } => around(*value, half_width.abs()),
        Shape::Rectangle { values, .. } => vec![*values],
        Shape::Gaussian {
            value, sigma_value, ..
        } => around(*value, DEVIATIONS * sigma_value.abs()),
        Shape::Image {
            values: [from, to],
            columns,
            cells,
            ..
        } => {
            let width = (to - from) / *columns as f64;
            // Between the middles of cells: each reaches the middle of the next, and another for rounding.
            let reach = |i: usize| {
                let column = i as f64;
                [from + (column - 1.0) * width, from + (column + 2.0) * width]
            };
            let seen = (0..*columns).filter(|&i| shows_column(cells, *columns, i));
            seen.map(reach).collect()
        }
    }
}

fn shows_column(cells: &Cells, columns: usize, column: usize) -> bool {
    let mut places = (column..cells.count()).step_by(columns);
    match cells {
        Cells::Shares(shares) => places.any(|i| shares[i] > 0.0),
        Cells::Rgba(colors) => places.any(|i| colors[i][3] > 0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::ColorSpace;
    use crate::transfer::{Absorption, Interpolation, OpacityPoint, Table};

    fn function(points: &[(f64, f64)], interpolation: Interpolation) -> TransferFunction {
        let point = |&(value, opacity): &(f64, f64)| OpacityPoint { value, opacity };
        TransferFunction {
            color: Vec::new(),
            opacity: points.iter().map(point).collect(),
            reference_length: None,
            interpolation,
            gradient_transfer: None,
            medium: None,
        }
    }

    #[test]
    fn what_lies_between_two_hills_is_not_seen_and_what_is_beyond_is_what_stands_at_the_end() {
        let hills = [
            (0., 0.),
            (10., 0.),
            (11., 0.4),
            (12., 0.),
            (20., 0.),
            (21., 0.3),
        ];
        let seen = VisibleRanges::new(&function(&hills, Interpolation::Linear));
        for (range, is_shown) in [
            ([0.0, 9.9], false),
            ([-1e30, 9.9], false),
            ([9.9, 10.5], true),
            ([12.5, 19.5], false),
            ([12.5, 20.5], true),
            ([25.0, 1e30], true),
        ] {
            assert_eq!(seen.shows(range), is_shown, "{range:?}");
        }
    }

    #[test]
    fn what_lies_before_a_function_that_begins_transparent_is_not_seen() {
        let ramp = [(120., 0.), (200., 0.05), (1800., 0.9)];
        for interpolation in [Interpolation::Linear, Interpolation::Step] {
            let seen = VisibleRanges::new(&function(&ramp, interpolation));
            assert!(!seen.shows([-1024.0, 100.0]));
            assert!(seen.shows([-1024.0, 210.0]));
        }
    }

    #[test]
    fn a_range_that_holds_a_level_shows_it() {
        let seen = VisibleRanges::of_values(&[0.5, 300.0, -2000.0], [-1000.0, 3000.0]);
        for (range, is_shown) in [
            ([0.4, 0.6], true),
            ([-900.0, -10.0], false),
            ([10.0, 290.0], false),
            ([290.0, 310.0], true),
            ([400.0, 9000.0], false),
        ] {
            assert_eq!(seen.shows(range), is_shown, "{range:?}");
        }
        // All values are the same.
        assert!(VisibleRanges::of_values(&[1.0], [1.0, 1.0]).shows([1.0, 1.0]));
    }

    #[test]
    fn a_contour_is_seen_from_as_far_as_a_range_is_wide() {
        let contour = |opacity| Widget {
            srgb: None,
            opacity,
            shape: Shape::Contour {
                value: 100.0,
                half_width: 2.0,
            },
            second: None,
        };
        let of = |opacity| TransferFunction {
            medium: None,
            gradient_transfer: Some(GradientTransfer {
                widgets: vec![contour(opacity)],
                ..GradientTransfer::default()
            }),
            ..function(&[], Interpolation::Linear)
        };
        let seen = VisibleRanges::of_slope(&of(0.5), 1.5);
        for (range, is_shown) in [
            ([0.0, 20.0], false),
            ([0.0, 24.9], false),
            ([0.0, 25.1], true),
            ([120.0, 120.5], false),
            ([90.0, 110.0], true),
            ([100.0, 100.0], true),
            ([130.0, 141.0], true),
        ] {
            assert_eq!(seen.shows(range), is_shown, "{range:?}");
        }
        // Nothing is known of the gradient, or the contour is not there.
        assert!(VisibleRanges::new(&of(0.5)).shows([0.0, 20.0]));
        assert!(!VisibleRanges::of_slope(&of(0.0), 1.5).shows([90.0, 110.0]));
    }

    #[test]
    fn a_function_without_opacity_shows_nothing_and_a_point_alone_everything() {
        for interpolation in [Interpolation::Linear, Interpolation::Step] {
            assert!(!VisibleRanges::new(&function(&[], interpolation)).shows([-1e9, 1e9]));
            assert!(!VisibleRanges::new(&function(&[(3., 0.)], interpolation)).shows([-1e9, 1e9]));
            assert!(VisibleRanges::new(&function(&[(3., 0.1)], interpolation)).shows([7.0, 7.0]));
        }
    }

    #[test]
    fn what_a_table_or_the_law_shows_is_seen() {
        let mut state = 7u64;
        let mut random = || {
            state = state
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            (state >> 40) as f64 / (1u64 << 24) as f64
        };
        for nth in 0..200 {
            let mut at = -50.0;
            let points: Vec<_> = (0..1 + nth % 9)
                .map(|_| {
                    at += if random() < 0.2 { 0.0 } else { 30.0 * random() };
                    (at, if random() < 0.5 { 0.0 } else { random() })
                })
                .collect();
            let kind = [Interpolation::Linear, Interpolation::Step][nth % 2];
            let function = function(&points, kind);
            let seen = VisibleRanges::new(&function);
            let absorption = Absorption::Extinction {
                reference_length: 1.0,
            };
            let table = Table::new(&function, absorption, ColorSpace::Linear);
            assert_eq!(seen.next.len(), table.entries.len());
            for _ in 0..200 {
                let value = (400.0 * random() - 100.0) as f32;
                let entry = ((value - table.first) * table.scale)
                    .clamp(0.0, table.entries.len() as f32 - 1.0);
                let shown =
                    table.entries[entry as usize][3] > 0.0 || function.opacity(value.into()) > 0.0;
                assert!(!shown || seen.shows([value; 2]), "{points:?} at {value}");
            }
        }
    }

    #[test]
    fn amounts_are_seen_where_there_is_any() {
        let seen = VisibleRanges::positive();
        assert!(!seen.shows([0.0, 0.0]) && !seen.shows([-3.0, 0.0]));
        for most in [1e-37, 1e-20, 1.0, 3.0, 1e30] {
            assert!(
                seen.shows([0.0, most]) && seen.shows([most, most]),
                "{most}"
            );
        }
    }
}
