//! Streak lines: where the smoke of a chimney is at one moment.
//!
//! ```text
//! s(t) = x(T; t),   x(t; t) = seed,   dx/dT = v(T, x),    first <= t <= T
//! ```
//!
//! Particles leave at even times; where two neighbours came apart by more than a cell, one more leaves between them.

use super::walk::Walk;
use super::{in_order, seam, threads};
use crate::flow::field::VectorField;
use crate::flow::line::{End, Limits, Line, Vertex};
use glam::DVec3;

/// Particles that leave at first.
const FIRST: usize = 17;
/// Neighbours that leave nearer in time than this part of the whole are not parted again.
const SHORTEST: f64 = 1.0 / 4096.0;

/// Streak lines at the time `span[1]` of particles that left the seeds since `span[0]`, seconds: a line a seed, oldest
/// particle first. The time of a vertex is when its particle left. Where particles have gone, the line is in pieces, and its
/// first end says why the oldest one has.
pub fn streak_lines(
    field: &impl VectorField,
    span: [f64; 2],
    seeds: &[DVec3],
    limits: &Limits,
) -> Vec<Line> {
    in_order(seeds.len(), threads(), |seed| {
        streak_line(field, span, seeds[seed], seed, limits)
    })
}

/// A particle: when it left, where it is, why it is nowhere.
type Particle = (f64, Result<Vertex, End>);

fn streak_line(
    field: &impl VectorField,
    span: [f64; 2],
    start: DVec3,
    seed: usize,
    limits: &Limits,
) -> Line {
    let particle = |time: f64| -> Particle { (time, end_of(field, time, span[1], start, limits)) };
    let cells_from_world = field.cells_from_world();
    let are_apart = |a: &Particle, b: &Particle| match (&a.1, &b.1) {
        (Ok(a), Ok(b)) => (cells_from_world * (b.place - a.place)).abs().max_element() > 1.0,
        (a, b) => a.is_ok() != b.is_ok(),
    };
    let whole = span[1] - span[0];
    let step = whole / (FIRST - 1) as f64;
    let mut waiting: Vec<Particle> = (0..FIRST)
        .map(|i| particle(span[1] - i as f64 * step))
        .collect();
    let first_end = waiting[FIRST - 1].1.err();
    let mut made: Vec<Particle> = Vec::new();
    // The oldest stands last, and is looked at first.
    while let Some(next) = waiting.pop() {
        if let Some(last) = made.last()
            && are_apart(last, &next)
            && next.0 - last.0 > SHORTEST * whole
            && made.len() + waiting.len() < limits.vertices
        {
            let between = particle(0.5 * (last.0 + next.0));
            waiting.extend([next, between]);
            continue;
        }
        made.push(next);
    }
    let (mut vertices, mut breaks) = (Vec::new(), Vec::new());
    for piece in made.split(|(_, found)| found.is_err()) {
        let way = piece.iter().filter_map(|(_, found)| found.ok()).collect();
        let (on_map, broken) = seam::split(way, field.seam());
        if !vertices.is_empty() && !on_map.is_empty() {
            breaks.push(vertices.len());
        }
        breaks.extend(broken.into_iter().map(|at| at + vertices.len()));
        vertices.extend(on_map);
    }
    Line {
        seed,
        vertices,
        breaks,
        ends: [Some(first_end.unwrap_or(End::Time)), Some(End::Time)],
    }
}

/// Where a particle that left at `time` is at `last`.
fn end_of(
    field: &impl VectorField,
    time: f64,
    last: f64,
    start: DVec3,
    limits: &Limits,
) -> Result<Vertex, End> {
    let limits = Limits {
        duration: last - time,
        vertices: usize::MAX,
        ..*limits
    };
    let (way, end) = Walk::new(field, &limits, 1.0).follow(time, start);
    let vertex = way.last().copied().ok_or(end)?;
    // What stands still is where it is.
    match end {
        End::Time | End::Stagnation => Ok(Vertex { time, ..vertex }),
        _ => Err(end),
    }
}

#[cfg(test)]
mod tests;
