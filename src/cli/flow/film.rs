//! Stream lines of a film: from the seeds of its first frame, as long as they are there, so that lines change and do not
//! jump.
//!
//! ```text
//! wind at time t    linear between those of floor(t) and ceil(t)
//! ```

use super::moving::Ways;
use super::wind::Wind;
use crate::flow::{Direction, Limits, Line, stream_lines};
use glam::DVec3;

/// A line of the first frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilmSeed {
    place: DVec3,
    /// World length before the seed and behind it.
    lengths: [f64; 2],
}

/// A frame of a film.
#[derive(Clone, Copy, Debug)]
pub struct FilmTime<'a> {
    /// Counted from 0, between two times where it is no whole number.
    pub time: f64,
    /// The lines of the first frame; none where lines are not those of its seeds.
    pub seeds: &'a [FilmSeed],
    /// The ways of particles, where lines are these.
    pub ways: Option<&'a Ways>,
}

/// The seeds of lines.
pub(super) fn seeds_of(lines: &[Line]) -> Vec<FilmSeed> {
    let of = |line: &Line| {
        let at = line.vertices.iter().position(|vertex| vertex.time == 0.0)?;
        let length = |range: std::ops::RangeInclusive<usize>| {
            let chords = line.vertices[range].windows(2);
            chords
                .map(|pair| (pair[1].place - pair[0].place).length())
                .sum()
        };
        Some(FilmSeed {
            place: line.vertices[at].place,
            lengths: [length(0..=at), length(at..=line.vertices.len() - 1)],
        })
    };
    lines.iter().filter_map(of).collect()
}

/// Lines from these seeds in the wind of a moment.
pub(super) fn lines_from(seeds: &[FilmSeed], wind: &Wind, time: f64) -> Vec<Line> {
    let way = |seed: &FilmSeed, direction, length: f64| {
        let limits = Limits {
            length,
            ..Limits::default()
        };
        let line = stream_lines(&wind.field, time, &[seed.place], direction, &limits);
        line.into_iter().next().filter(|_| length > 0.0)
    };
    let of = |(number, seed): (usize, &FilmSeed)| {
        let before = way(seed, Direction::Backward, seed.lengths[0]);
        let behind = way(seed, Direction::Forward, seed.lengths[1]);
        let mut line = match (before, behind) {
            (Some(mut before), Some(behind))
                if before.breaks.is_empty() && behind.breaks.is_empty() =>
            {
                before
                    .vertices
                    .extend_from_slice(behind.vertices.get(1..).unwrap_or_default());
                before.ends[1] = behind.ends[1];
                before
            }
            (before, behind) => behind.or(before)?,
        };
        line.seed = number;
        Some(line)
    };
    seeds.iter().enumerate().filter_map(of).collect()
}
