//! Stream lines of a film: from the seeds of its first frame, as long as they are there, so that lines change and do not
//! jump.
//!
//! ```text
//! wind at time t    linear between those of floor(t) and ceil(t)
//! colours           over the least and the greatest end of their ranges at each time of the file
//! ```

use super::colors::LineColors;
use super::drawn::input_of_wind;
use super::flags::{FlowColor, FlowWord};
use super::moving::Ways;
use super::wind::Wind;
use crate::cli::{
    Error,
    flags::{Numbers, SceneFlags},
    progress::Progress,
};
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
    /// Seconds between spheres along the lines of the first frame, where there are such.
    pub sphere_step: Option<f64>,
}

/// The scene of a film from its time `first` on, whose stream lines have colours over the values of all times of the file where
/// nobody says their range.
pub fn with_range_of_film(
    scene: &SceneFlags,
    first: f64,
    times: u32,
    progress: &Progress,
) -> Result<SceneFlags, Error> {
    let mut whole = scene.clone();
    let (flags, style) = (&scene.flow, &scene.flow_style);
    let has_one = matches!(flags.color()?, Some(FlowColor::One(_)));
    if flags.flow != Some(FlowWord::Stream) || style.flow_range.is_some() || has_one {
        return Ok(whole);
    }
    let (quiet, input) = (Progress::of_part(), input_of_wind(scene));
    let traced = |time: f64, seeds: Option<&[FilmSeed]>| {
        let mut input = input.clone();
        input.time = Some(time.floor().to_string());
        let of_film = seeds.map(|seeds| FilmTime {
            time,
            seeds,
            ways: None,
            sphere_step: None,
        });
        flags.traced(FlowWord::Stream, &input, of_film, Some(&[]), &quiet)
    };
    let of_first = traced(first, None)?;
    let seeds = seeds_of(&of_first.lines);
    let mut range = [f64::INFINITY, f64::NEG_INFINITY];
    for time in 0..times {
        progress.stage("look at all times", time as usize, times as usize);
        let of_other = match f64::from(time) == first {
            true => None,
            false => Some(traced(time.into(), Some(&seeds))?),
        };
        let values = &of_other.as_ref().unwrap_or(&of_first).values;
        let [low, high] = LineColors::new(values, None, None, None).range;
        range = [range[0].min(low), range[1].max(high)];
    }
    if range[0] < range[1] {
        whole.flow_style.flow_range = Some(Numbers(range));
    }
    Ok(whole)
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
