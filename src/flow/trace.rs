//! Lines from seeds: those of an instant, those of particles, and those of smoke.
//!
//! ```text
//! stream line    dx/ds = v(t, x),  t held                 tangent to the velocity of one instant
//! path line      dx/dt = v(t, x)                          the way of one particle
//! streak line    x(T) of the particles that left the seed at t <= T
//! ```

mod seam;
mod streak;
mod walk;

pub use streak::streak_lines;

use super::field::{Frozen, VectorField};
use super::line::{Direction, End, Limits, Line};
use super::seeds::Crowd;
use glam::DVec3;
use std::sync::atomic::{AtomicUsize, Ordering};
use walk::Walk;

/// Seeds that a thread takes at once.
const BLOCK: usize = 64;

/// Stream lines of the field as it is at `time`, a line a seed in their order. The number of threads changes no bit.
pub fn stream_lines(
    field: &impl VectorField,
    time: f64,
    seeds: &[DVec3],
    direction: Direction,
    limits: &Limits,
) -> Vec<Line> {
    let frozen = Frozen::new(field, time);
    in_order(seeds.len(), threads(), |seed| {
        line(&frozen, (0.0, seeds[seed]), seed, direction, limits, None)
    })
}

/// Path lines of particles that are at the seeds at `time`.
pub fn path_lines(
    field: &impl VectorField,
    time: f64,
    seeds: &[DVec3],
    direction: Direction,
    limits: &Limits,
) -> Vec<Line> {
    let seeds: Vec<_> = seeds.iter().map(|&seed| (time, seed)).collect();
    path_lines_from(field, &seeds, direction, limits)
}

/// Path lines of particles that are at the seeds each at a time of its own, in seconds.
pub fn path_lines_from(
    field: &impl VectorField,
    seeds: &[(f64, DVec3)],
    direction: Direction,
    limits: &Limits,
) -> Vec<Line> {
    in_order(seeds.len(), threads(), |seed| {
        line(field, seeds[seed], seed, direction, limits, None)
    })
}

/// One stream line that keeps away from others.
pub(super) fn stream_line_among(
    field: &impl VectorField,
    time: f64,
    start: DVec3,
    direction: Direction,
    limits: &Limits,
    crowd: &Crowd,
) -> Line {
    let frozen = Frozen::new(field, time);
    line(&frozen, (0.0, start), 0, direction, limits, Some(crowd))
}

fn threads() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// So many lines, each made by whichever thread is free, in the order of their numbers.
fn in_order(count: usize, threads: usize, make: impl Fn(usize) -> Line + Sync) -> Vec<Line> {
    let blocks = count.div_ceil(BLOCK);
    let next = AtomicUsize::new(0);
    let work = || {
        let mut made = Vec::new();
        loop {
            let block = next.fetch_add(1, Ordering::Relaxed);
            if block >= blocks {
                return made;
            }
            made.extend((block * BLOCK..count.min((block + 1) * BLOCK)).map(&make));
        }
    };
    let mut all: Vec<Line> = std::thread::scope(|scope| {
        let workers: Vec<_> = (0..threads.clamp(1, blocks.max(1)))
            .map(|_| scope.spawn(work))
            .collect();
        let made = workers.into_iter().flat_map(|worker| match worker.join() {
            Ok(made) => made,
            Err(fault) => std::panic::resume_unwind(fault),
        });
        made.collect()
    });
    all.sort_by_key(|line| line.seed);
    all
}

fn line(
    field: &impl VectorField,
    (time, start): (f64, DVec3),
    seed: usize,
    direction: Direction,
    limits: &Limits,
    crowd: Option<&Crowd>,
) -> Line {
    let follow = |sign: f64| {
        let walk = Walk::new(field, limits, sign);
        let walk = match crowd {
            Some(crowd) => walk.among(crowd),
            None => walk,
        };
        walk.follow(time, start)
    };
    let (mut way, mut ends) = (Vec::new(), [None, None]);
    if direction != Direction::Forward {
        let (back, end) = follow(-1.0);
        way.extend(back.into_iter().rev());
        ends[0] = Some(end);
    }
    // A closed line is whole by one way round.
    if direction != Direction::Backward && ends[0] != Some(End::Closed) {
        let (ahead, end) = follow(1.0);
        // The seed is there already.
        let known = usize::from(!way.is_empty());
        way.extend(ahead.into_iter().skip(known));
        ends[1] = Some(end);
    }
    let (vertices, breaks) = seam::split(way, field.seam());
    Line {
        seed,
        vertices,
        breaks,
        ends,
    }
}

#[cfg(test)]
mod tests;
