//! Stream lines that are evenly spaced.
//!
//! ```text
//! a line begins   at distance d from a finished one, across it,  nearer to none
//! it ends         where it is nearer than d / 2 to a finished one
//! ```
//!
//! Jobard & Lefer, "Creating Evenly-Spaced Streamlines of Arbitrary Density", Visualization in Scientific Computing '97, in
//! three dimensions: each sample of a line offers four places across it. They are tried one after the other in the order of the
//! lines that offer them; then, for what no line has reached, the places of an even grid.

use super::crowd::Crowd;
use super::places::grid_seeds;
use crate::flow::field::VectorField;
use crate::flow::line::{Direction, End, Limits, Line};
use crate::flow::trace::stream_line_among;
use crate::volume::Grid;
use glam::DVec3;
use std::collections::VecDeque;

/// How lines are spaced.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EvenLines {
    /// Between lines, in the world as it is seen.
    pub distance: f64,
    /// How many times higher than it is the world is seen.
    pub stretch: f64,
    /// No more lines than these.
    pub most: usize,
    /// No line more where they have so many vertices together.
    pub most_vertices: usize,
}

impl EvenLines {
    /// A 24th of the box's diagonal apart, at most 2000 lines, of a thousand vertices in the mean.
    pub fn of(grid: &Grid, stretch: f64) -> Self {
        let mut seen = *grid;
        seen.world_from_voxel =
            glam::DAffine3::from_scale(DVec3::new(1.0, 1.0, stretch)) * grid.world_from_voxel;
        Self {
            distance: seen.diagonal() / 24.0,
            stretch,
            most: 2000,
            most_vertices: 2_000_000,
        }
    }
}

/// A place that is offered is this much farther than it has to be: rounding brings it no nearer.
const BEYOND: f64 = 1.0001;

/// Evenly spaced stream lines of the field as it is at `time`, in the box of a grid. Lines that are shorter than the distance
/// are left out, but for closed ones. `told` hears of each line, and how many there are with it.
pub fn even_stream_lines(
    field: &impl VectorField,
    time: f64,
    grid: &Grid,
    spacing: EvenLines,
    direction: Direction,
    limits: &Limits,
    told: &mut dyn FnMut(&Line, usize),
) -> Vec<Line> {
    let mut crowd = Crowd::new(spacing.distance, spacing.stretch);
    let mut offered = VecDeque::from([grid.center()]);
    let mut on_grid = grid_seeds(grid, counts(grid, &spacing)).into_iter();
    let mut lines: Vec<Line> = Vec::new();
    let mut vertices = 0;
    while lines.len() < spacing.most && vertices < spacing.most_vertices {
        let Some(seed) = offered.pop_front().or_else(|| on_grid.next()) else {
            break;
        };
        if crowd.is_taken(seed) || field.velocity(time, seed).is_err() {
            continue;
        }
        let mut line = stream_line_among(field, time, seed, direction, limits, &crowd);
        let is_closed = line.ends.contains(&Some(End::Closed));
        if !is_closed && seen_length(&line, &crowd) < spacing.distance {
            continue;
        }
        line.seed = lines.len();
        for vertex in &line.vertices {
            crowd.add(vertex.place);
        }
        offer(&line, &crowd, spacing.distance, &mut offered);
        vertices += line.vertices.len();
        told(&line, lines.len() + 1);
        lines.push(line);
    }
    lines
}

/// Places of the even grid along each axis: about the distance apart, so few that they cost little.
fn counts(grid: &Grid, spacing: &EvenLines) -> [u32; 3] {
    let m = grid.world_from_voxel.matrix3;
    let far = grid.far_corner();
    let stretch = DVec3::new(1.0, 1.0, spacing.stretch);
    let edges = [m.x_axis * far.x, m.y_axis * far.y, m.z_axis * far.z];
    edges.map(|edge| ((edge * stretch).length() / spacing.distance).clamp(1.0, 64.0) as u32)
}

fn seen_length(line: &Line, crowd: &Crowd) -> f64 {
    let chords = line.pieces().flat_map(|piece| piece.windows(2));
    chords
        .map(|pair| crowd.seen(pair[1].place - pair[0].place).length())
        .sum()
}

/// Four places across the line at each half of the distance along it.
fn offer(line: &Line, crowd: &Crowd, distance: f64, offered: &mut VecDeque<DVec3>) {
    let mut since = f64::INFINITY;
    for pair in line.pieces().flat_map(|piece| piece.windows(2)) {
        let [here, next] = [pair[0], pair[1]].map(|vertex| crowd.seen(vertex.place));
        let way = next - here;
        if since >= 0.5 * distance
            && let Some(along) = way.try_normalize()
        {
            let side = along.any_orthonormal_vector();
            let other = along.cross(side);
            for across in [side, other, -side, -other] {
                offered.push_back(crowd.place(here + BEYOND * distance * across));
            }
            since = 0.0;
        }
        since += way.length();
    }
}

#[cfg(test)]
mod tests;
