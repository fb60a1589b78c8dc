//! The joint histogram: gradient magnitude above value, counts as colours on a logarithmic scale.

use super::outlines::{self, Axes, Outline};
use super::{Counted, NAME_SIZE, Plot, TICK_SIZE, color, function_json};
use crate::{
    figure::{Anchor, FAINT, Figure, INK, Mark, Ticks, log_ticks},
    transfer::TransferFunction,
    volume::JointHistogram,
};
use serde_json::{Value, json};

const ROWS: usize = 192;
/// Steps of the bar that explains the colours.
const STEPS: usize = 128;

/// Five colours of viridis (Smith & van der Walt 2015, public domain), lightest first: many voxels are dark.
const COLORS: [[f64; 3]; 5] = [
    [253.0, 231.0, 37.0],
    [94.0, 201.0, 98.0],
    [33.0, 145.0, 140.0],
    [59.0, 82.0, 139.0],
    [68.0, 1.0, 84.0],
];

/// The figure, and its numbers.
pub fn of(counted: &Counted, function: &TransferFunction, max_bins: usize) -> (Figure, Value) {
    let joint = JointHistogram::of(&counted.volume, max_bins, ROWS);
    let mut json = counted.json("stratavox_joint_histogram");
    let rows: Vec<&[u64]> = match joint.columns {
        0 => Vec::new(),
        columns => joint.counts.chunks(columns).collect(),
    };
    json["value_edges"] = json!(joint.value_edges());
    json["gradient_edges"] = json!(joint.gradient_edges());
    json["gradient_unit"] = json!(gradient_unit(counted));
    json["counts"] = json!(rows);
    let axes = Axes {
        // Without data there is no gradient, and any axis will do.
        top: match joint.gradient_range[1] {
            top if top > 0.0 => top,
            _ => 1.0,
        },
        smallest_spacing: counted.volume.grid().smallest_spacing(),
    };
    let outlines = outlines::of(function, axes);
    json["transfer_function"] = function_json(function);
    json["outlines"] = outlines::json(&outlines);
    (figure(counted, &joint, axes, &outlines), json)
}

fn gradient_unit(counted: &Counted) -> String {
    let value = counted.unit.as_deref().unwrap_or("value");
    let length = counted.length_unit.unwrap_or("world length");
    format!("{value} per {length}")
}

fn figure(counted: &Counted, joint: &JointHistogram, axes: Axes, outlines: &[Outline]) -> Figure {
    let sentences = [counted.sentence()];
    let mut figure = Plot::figure(counted, "Values and gradients", &sentences);
    let [low, high] = joint.value_range;
    let plot = Plot {
        left: 84.0,
        right: 846.0,
        top: 76.0,
        bottom: 520.0,
        range: if low < high { [low, high] } else { [0.0, 1.0] },
    };
    let most = joint.counts.iter().copied().max().unwrap_or(0).max(1) as f64;
    plot.value_grid(&mut figure);
    if joint.columns > 0 {
        // The top row of a picture comes first, the flattest gradients lie at its foot.
        let rows = joint.counts.chunks(joint.columns).rev().flatten();
        figure.marks.push(Mark::Cells {
            at: [plot.left, plot.top],
            size: [plot.right - plot.left, plot.bottom - plot.top],
            columns: joint.columns,
            colors: rows.map(|&count| shade(count as f64, most)).collect(),
        });
    }
    outlines::draw(&mut figure, &plot, axes, outlines);
    plot.frame(&mut figure);
    plot.value_axis(&mut figure, counted, plot.bottom);

    let top = axes.top;
    let ticks = Ticks::linear([0.0, top], 6);
    for (gradient, text) in &ticks.at {
        let y = plot.y(gradient / top);
        figure.line([plot.left - 5.0, y], [plot.left, y], INK, 1.0);
        figure.text([plot.left - 9.0, y + 4.5], text, TICK_SIZE, Anchor::End);
    }
    let unit = gradient_unit(counted);
    let name = format!("gradient magnitude ({unit}){}", ticks.suffix());
    let middle = 0.5 * (plot.top + plot.bottom);
    figure.upward([22.0, middle], name, NAME_SIZE, INK);
    legend(&mut figure, &plot, most);
    figure
}

/// White where there is nothing, and from light to dark as decades go by.
fn shade(count: f64, most: f64) -> [u8; 3] {
    if count == 0.0 {
        return [255; 3];
    }
    let t = if most > 1.0 {
        count.ln() / most.ln()
    } else {
        1.0
    };
    let place = t * (COLORS.len() - 1) as f64;
    let left = (place as usize).min(COLORS.len() - 2);
    let share = place - left as f64;
    let mixed = std::array::from_fn(|k| {
        let (a, b) = (COLORS[left][k], COLORS[left + 1][k]);
        (a + share * (b - a)) / 255.0
    });
    let [r, g, b, _] = color(mixed);
    [r, g, b]
}

fn legend(figure: &mut Figure, plot: &Plot, most: f64) {
    let (left, right) = (plot.right + 22.0, plot.right + 38.0);
    let (top, bottom) = (plot.top + 20.0, plot.bottom);
    figure.text([left, plot.top + 8.0], "voxels", TICK_SIZE, Anchor::Start);
    let step = |step: usize| {
        let t = 1.0 - (step as f64 + 0.5) / STEPS as f64;
        shade(most.max(1.0 + 1e-9).powf(t), most)
    };
    figure.marks.push(Mark::Cells {
        at: [left, top],
        size: [right - left, bottom - top],
        columns: 1,
        colors: (0..STEPS).map(step).collect(),
    });
    figure.frame([left, top], [right, bottom], FAINT);
    for (count, text) in log_ticks(most) {
        let t = if most > 1.0 {
            count.ln() / most.ln()
        } else {
            0.0
        };
        let y = bottom + t * (top - bottom);
        figure.line([right, y], [right + 4.0, y], INK, 1.0);
        figure.text([right + 8.0, y + 4.5], text, TICK_SIZE, Anchor::Start);
    }
}
