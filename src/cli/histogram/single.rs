//! The histogram of values: counts on a logarithmic scale, the opacity over them, the colours below.

use super::{Counted, NAME_SIZE, Plot, TICK_SIZE, color, function_json, shortened};
use crate::{
    color::ColorSpace,
    figure::short,
    figure::{Anchor, Color, FAINT, Figure, GRID, INK, Mark, Point, Ticks, log_ticks},
    transfer::{Absorption, Interpolation, Points, TransferFunction, classify_by_points},
    volume::Histogram,
};
use serde_json::{Value, json};

const BARS: Color = [148, 170, 204, 255];
const OPACITY: Color = [198, 70, 30, 255];
/// A bin of one voxel is drawn from half a voxel on: on a logarithmic scale it would have no height.
const FOOT: f64 = 0.5;
/// Patches of the colour bar.
const PATCHES: usize = 512;

/// The figure, and its numbers.
pub fn of(counted: &Counted, function: &TransferFunction, max_bins: usize) -> (Figure, Value) {
    let histogram = Histogram::of(&counted.volume, max_bins);
    let mut json = counted.json("stratavox_histogram");
    json["edges"] = json!(histogram.edges());
    json["counts"] = json!(histogram.counts);
    json["transfer_function"] = function_json(function);
    (figure(counted, function, &histogram), json)
}

fn figure(counted: &Counted, function: &TransferFunction, histogram: &Histogram) -> Figure {
    let sentences = [counted.sentence()];
    let mut figure = Plot::figure(counted, "Histogram", &sentences);
    let [low, high] = histogram.value_range;
    let plot = Plot {
        left: 84.0,
        right: 866.0,
        top: 76.0,
        bottom: 486.0,
        range: if low < high { [low, high] } else { [0.0, 1.0] },
    };
    plot.value_grid(&mut figure);
    counts(&mut figure, &plot, histogram);
    opacity(&mut figure, &plot, function);
    plot.frame(&mut figure);
    colors(&mut figure, &plot, function);
    plot.value_axis(&mut figure, counted, plot.bottom + 32.0);
    figure
}

/// The counts and their axis.
fn counts(figure: &mut Figure, plot: &Plot, histogram: &Histogram) {
    let most = histogram.counts.iter().copied().max().unwrap_or(0).max(1) as f64;
    // Room above the highest bar.
    let decades = (most / FOOT).log10() * 1.04;
    let height = |count: f64| plot.y((count / FOOT).log10().max(0.0) / decades);
    for (count, text) in log_ticks(most) {
        let y = height(count);
        figure.line([plot.left, y], [plot.right, y], GRID, 1.0);
        figure.line([plot.left - 5.0, y], [plot.left, y], INK, 1.0);
        figure.text([plot.left - 9.0, y + 4.5], text, TICK_SIZE, Anchor::End);
        for minor in 2..10 {
            let count = count * f64::from(minor);
            if count <= most {
                let y = height(count);
                figure.line([plot.left - 2.5, y], [plot.left, y], INK, 0.7);
            }
        }
    }
    figure.upward(
        [24.0, 0.5 * (plot.top + plot.bottom)],
        "voxels",
        NAME_SIZE,
        INK,
    );
    let edges = histogram.edges();
    let mut outline: Vec<Point> = Vec::new();
    for (bin, &count) in histogram.counts.iter().enumerate() {
        let y = height((count as f64).max(FOOT));
        outline.extend([[plot.x(edges[bin]), y], [plot.x(edges[bin + 1]), y]]);
    }
    if let ([first, ..], [.., last]) = (outline.as_slice(), outline.as_slice()) {
        let (first, last) = ([first[0], plot.bottom], [last[0], plot.bottom]);
        outline.insert(0, first);
        outline.push(last);
        figure.marks.push(Mark::Area {
            points: outline,
            fill: BARS,
        });
    }
}

/// The opacity as a line with an axis of its own on the right.
fn opacity(figure: &mut Figure, plot: &Plot, function: &TransferFunction) {
    let most = function
        .opacity
        .iter()
        .map(|p| p.opacity)
        .fold(0.0, f64::max);
    let top = if most > 0.0 { most * 1.06 } else { 1.0 };
    let place = |value: f64, opacity: f64| [plot.x(value), plot.y(opacity / top)];
    let ticks = Ticks::linear([0.0, top], 5);
    for (opacity, text) in &ticks.at {
        let y = plot.y(opacity / top);
        figure.line([plot.right, y], [plot.right + 5.0, y], OPACITY, 1.0);
        figure.text([plot.right + 9.0, y + 4.5], text, TICK_SIZE, Anchor::Start);
    }
    let per = match function.reference_length {
        Some(length) => format!("opacity per length of {}", short(length)),
        None => "opacity per smallest voxel spacing".to_owned(),
    };
    let name = shortened(&format!("{per}{}", ticks.suffix()), 50);
    let middle = 0.5 * (plot.top + plot.bottom);
    figure.upward([942.0, middle], name, NAME_SIZE, OPACITY);

    let line = curve(plot, function).into_iter();
    let points: Vec<Point> = line.map(|[value, opacity]| place(value, opacity)).collect();
    figure.marks.push(Mark::Line {
        points: points.clone(),
        color: OPACITY,
        width: 2.2,
    });
    // Control points, those inside the axes.
    for point in &function.opacity {
        if (plot.range[0]..=plot.range[1]).contains(&point.value) {
            figure.marks.push(Mark::Line {
                points: vec![place(point.value, point.opacity)],
                color: OPACITY,
                width: 6.5,
            });
        }
    }
}

/// Value and opacity along the line, from end to end of the axis.
fn curve(plot: &Plot, function: &TransferFunction) -> Vec<[f64; 2]> {
    let [low, high] = plot.range;
    let points = Points::new(function, Absorption::Opacity, ColorSpace::Display);
    let at = |value: f64| classify_by_points(&points, value)[3];
    let mut curve = vec![[low, at(low)]];
    for point in &function.opacity {
        if point.value > low && point.value < high {
            if function.interpolation == Interpolation::Step {
                let before = curve[curve.len() - 1][1];
                curve.push([point.value, before]);
            }
            curve.push([point.value, point.opacity]);
        }
    }
    let last = match function.interpolation {
        Interpolation::Step => curve[curve.len() - 1][1],
        Interpolation::Linear => at(high),
    };
    curve.push([high, last]);
    curve
}

/// A bar of the colours that values have.
fn colors(figure: &mut Figure, plot: &Plot, function: &TransferFunction) {
    let points = Points::new(function, Absorption::Opacity, ColorSpace::Display);
    let [low, high] = plot.range;
    let patch = |patch: usize| {
        let t = (patch as f64 + 0.5) / PATCHES as f64;
        let [r, g, b, _] = classify_by_points(&points, low + t * (high - low));
        let [r, g, b, _] = color([r, g, b]);
        [r, g, b]
    };
    let (top, bottom) = (plot.bottom + 8.0, plot.bottom + 28.0);
    figure.marks.push(Mark::Cells {
        at: [plot.left, top],
        size: [plot.right - plot.left, bottom - top],
        columns: PATCHES,
        colors: (0..PATCHES).map(patch).collect(),
    });
    figure.frame([plot.left, top], [plot.right, bottom], FAINT);
    figure.faint([plot.left - 9.0, bottom - 5.0], "colour", 13.0, Anchor::End);
}
