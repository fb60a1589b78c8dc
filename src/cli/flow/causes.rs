//! What is said of lines: why they end, and how far particles go between snapshots.
//!
//! ```text
//! cells a snapshot = sum of the cells of all chords / sum of their seconds * mean seconds between snapshots
//! ```

use super::super::progress::Progress;
use super::wind::Wind;
use crate::flow::{End, Line, VectorField};

/// Farther between two snapshots the wind between them is a guess.
const FAR: f64 = 8.0;

/// How many lines there are, and how often each cause ended one.
pub fn say(lines: &[Line], progress: &Progress) {
    let vertices: usize = lines.iter().map(|line| line.vertices.len()).sum();
    let drawn = lines.iter().filter(|line| line.pieces().next().is_some());
    let drawn = drawn.count();
    let counts = End::ALL.into_iter().filter_map(|cause| {
        let ends = lines.iter().flat_map(|line| line.ends).flatten();
        let count = ends.filter(|&end| end == cause).count();
        (count > 0).then(|| format!("{} {count}", cause.name()))
    });
    let counts: Vec<String> = counts.collect();
    progress.note(&format!(
        "{} lines of {vertices} vertices; ends: {}",
        drawn,
        counts.join(", ")
    ));
    if drawn == 0 && !lines.is_empty() {
        progress.note(
            "no line goes anywhere: particles need times of the file after their start, or before it with --flow-direction backward",
        );
    }
}

/// How many cells particles go from one snapshot to the next, and a warning where that is far.
pub fn say_displacement(lines: &[Line], wind: &Wind, progress: &Progress) {
    let cells_from_world = wind.field.cells_from_world();
    let (mut cells, mut seconds) = (0.0, 0.0);
    for pair in lines
        .iter()
        .flat_map(Line::pieces)
        .flat_map(|piece| piece.windows(2))
    {
        let way = cells_from_world * (pair[1].place - pair[0].place);
        cells += way.abs().max_element();
        seconds += pair[1].time - pair[0].time;
    }
    let [Some(first), Some(last)] = [wind.times.first(), wind.times.last()] else {
        return;
    };
    let between = (last.1 - first.1) / (wind.times.len() as f64 - 1.0);
    let mean = cells / seconds * between;
    if !mean.is_finite() {
        return;
    }
    progress.note(&format!(
        "particles go {mean:.1} cells from one snapshot to the next"
    ));
    if mean > FAR {
        progress.note("snapshots are far apart: path lines are uncertain");
    }
}
