//! Where the widgets of a transfer function lie in the plane of value and gradient, as lines over the joint histogram.
//!
//! ```text
//! contour     f = v - r h g and f = v + r h g, its reach at the gradient g
//! region      from its first value to its last one
//! triangle    f = v - w s / top and f = v + w s / top between threshold and top
//! gaussian    the ellipses of one and two deviations
//! rectangle, image    their sides
//! ```

use super::{Plot, color};
use crate::{
    figure::{Figure, INK, Mark, Point},
    transfer::{GradientTransfer, Shape, TransferFunction, Widget},
};
use serde_json::{Value, json};
use std::f64::consts::TAU;

/// Corners of an ellipse.
const CORNERS: usize = 64;

/// What lines are made of beside the function.
#[derive(Clone, Copy, Debug)]
pub struct Axes {
    /// The largest gradient magnitude that is shown.
    pub top: f64,
    /// Of the grid, in world length.
    pub smallest_spacing: f64,
}

/// The lines of one widget, each a list of value and gradient magnitude.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    /// The word of its shape.
    shape: &'static str,
    /// sRGB.
    srgb: [f64; 3],
    lines: Vec<Vec<[f64; 2]>>,
}

/// One outline a widget.
pub fn of(function: &TransferFunction, axes: Axes) -> Vec<Outline> {
    let Some(gradient_transfer) = &function.gradient_transfer else {
        return Vec::new();
    };
    let outline = |widget| outline(function, gradient_transfer, widget, axes);
    gradient_transfer.widgets.iter().map(outline).collect()
}

fn outline(
    function: &TransferFunction,
    gradient_transfer: &GradientTransfer,
    widget: &Widget,
    axes: Axes,
) -> Outline {
    let steepest = gradient_transfer.steepest.unwrap_or(axes.top);
    let middle = |[a, b]: [f64; 2]| 0.5 * (a + b);
    let (shape, value, lines) = match &widget.shape {
        Shape::Contour { value, half_width } => {
            let reach = half_width * axes.smallest_spacing * axes.top;
            let top = axes.top;
            let lines = vec![vec![
                [value - reach, top],
                [*value, 0.0],
                [value + reach, top],
            ]];
            ("contour", *value, lines)
        }
        Shape::Region { points } => {
            let first = points.first().map_or(0.0, |point| point.value);
            let last = points.last().map_or(0.0, |point| point.value);
            let sides = rectangle([first, last], [0.0, axes.top]);
            ("region", middle([first, last]), vec![sides])
        }
        Shape::Triangle {
            value,
            half_width,
            threshold,
            top,
        } => {
            let reach = |s: f64| half_width * s / top;
            let corner = |sign: f64, s: f64| [value + sign * reach(s), s * steepest];
            let mut line = vec![
                corner(-1.0, *threshold),
                corner(-1.0, *top),
                corner(1.0, *top),
                corner(1.0, *threshold),
            ];
            line.push(line[0]);
            ("triangle", *value, vec![line])
        }
        Shape::Rectangle { values, gradients } => {
            let sides = rectangle(*values, gradients.map(|s| s * steepest));
            ("rectangle", middle(*values), vec![sides])
        }
        Shape::Gaussian {
            value,
            gradient,
            sigma_value,
            sigma_gradient,
        } => {
            let ellipse = |deviations: f64| {
                let corner = |i: usize| {
                    let (sin, cos) = (TAU * i as f64 / CORNERS as f64).sin_cos();
                    let s = gradient + deviations * sigma_gradient * sin;
                    [value + deviations * sigma_value * cos, s * steepest]
                };
                (0..=CORNERS).map(corner).collect()
            };
            ("gaussian", *value, vec![ellipse(1.0), ellipse(2.0)])
        }
        Shape::Image {
            values, gradients, ..
        } => {
            let sides = rectangle(*values, gradients.map(|s| s * steepest));
            ("image", middle(*values), vec![sides])
        }
    };
    Outline {
        shape,
        srgb: widget.srgb.unwrap_or_else(|| function.srgb(value)),
        lines,
    }
}

fn rectangle([v0, v1]: [f64; 2], [g0, g1]: [f64; 2]) -> Vec<[f64; 2]> {
    vec![[v0, g0], [v1, g0], [v1, g1], [v0, g1], [v0, g0]]
}

/// The numbers of a file.
pub fn json(outlines: &[Outline]) -> Value {
    let one = |outline: &Outline| json!({"shape": outline.shape, "color": outline.srgb, "lines": outline.lines});
    outlines.iter().map(one).collect()
}

/// Draws what lies inside of the axes, each line on ink so that it is seen on any count.
pub fn draw(figure: &mut Figure, plot: &Plot, axes: Axes, outlines: &[Outline]) {
    let place = |[value, gradient]: [f64; 2]| [plot.x(value), plot.y(gradient / axes.top)];
    let low = [plot.left, plot.top];
    let high = [plot.right, plot.bottom];
    for outline in outlines {
        for line in &outline.lines {
            let pairs = line.windows(2);
            let inside =
                pairs.filter_map(|pair| clipped(place(pair[0]), place(pair[1]), low, high));
            let inside: Vec<_> = inside.collect();
            for (color, width) in [(INK, 4.0), (color(outline.srgb), 2.0)] {
                for &[from, to] in &inside {
                    figure.marks.push(Mark::Line {
                        points: vec![from, to],
                        color,
                        width,
                    });
                }
            }
        }
    }
}

/// The part of a straight line inside a rectangle (Liang & Barsky 1984).
fn clipped(from: Point, to: Point, low: Point, high: Point) -> Option<[Point; 2]> {
    let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
    for k in 0..2 {
        let way = to[k] - from[k];
        let [a, b] = [low[k] - from[k], high[k] - from[k]];
        if way == 0.0 {
            if a > 0.0 || b < 0.0 {
                return None;
            }
            continue;
        }
        let (first, last) = if way > 0.0 { (a, b) } else { (b, a) };
        enter = enter.max(first / way);
        leave = leave.min(last / way);
    }
    let at = |t: f64| [0, 1].map(|k| from[k] + t * (to[k] - from[k]));
    (enter <= leave).then(|| [at(enter), at(leave)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_cut_where_it_leaves_the_axes() {
        let (low, high) = ([0.0, 0.0], [10.0, 4.0]);
        let cut = |from, to| clipped(from, to, low, high);
        assert_eq!(
            cut([-5.0, 2.0], [15.0, 2.0]),
            Some([[0.0, 2.0], [10.0, 2.0]])
        );
        assert_eq!(cut([4.0, 6.0], [4.0, 2.0]), Some([[4.0, 4.0], [4.0, 2.0]]));
        assert_eq!(cut([1.0, 1.0], [2.0, 3.0]), Some([[1.0, 1.0], [2.0, 3.0]]));
        assert_eq!(cut([-1.0, 1.0], [-1.0, 3.0]), None);
        assert_eq!(cut([-4.0, 3.0], [1.0, 8.0]), None);
    }
}
