//! Lines whose places have times: ways of particles up to a moment, and comets.
//!
//! ```text
//! drawn     what was passed from  now - T  to  now;  of ways without a tail from their begin
//! radius    width / 2 * (t - (now - T)) / T         of comets; T the length of the tail, now at the head
//! ```
//!
//! A particle that is gone leaves its tail behind, which ends a time T later.

use super::film::FilmTime;
use crate::annotate::ColorLegend;
use glam::DVec3;

/// Thinner than this part of their heads comets end in a point.
const POINT: f64 = 0.05;

/// A place that a particle passes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Passed {
    /// In the drawn world.
    pub place: DVec3,
    /// Linear.
    pub color: [f32; 3],
    /// Seconds, in the order of which places follow each other.
    pub seconds: f64,
}

/// A way, or a part of one.
#[derive(Clone, Debug, PartialEq)]
pub struct Way {
    pub passed: Vec<Passed>,
    /// Seconds at which the whole way begins and ends.
    pub ends: [f64; 2],
    /// That of its seed, counted from 1.
    pub number: u32,
}

/// The ways of particles through all times of a film.
#[derive(Clone, Debug)]
pub struct Ways {
    pub ways: Vec<Way>,
    /// Of the times of the file.
    pub seconds: Vec<f64>,
    /// What their colours mean.
    pub legend: Option<ColorLegend>,
    /// Values at the ends of these colours.
    pub range: [f64; 2],
}

/// How much of a way is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Tail {
    /// All that was passed.
    All,
    /// What was passed in so many seconds, the thinner the longer ago.
    Comet(f64),
    /// The same of the whole way.
    WholeComet,
}

/// Places of a line with their colours, and how wide it is there, from 0 to 1.
pub(super) type Drawn = (Vec<(DVec3, [f32; 3])>, Vec<f64>);

impl Ways {
    /// Seconds at a time of a film, counted from 0.
    pub(super) fn now(&self, film: &FilmTime) -> f64 {
        let last = self.seconds.len().saturating_sub(1);
        let at = |time: f64| self.seconds[(time as usize).min(last)];
        let [before, after] = [film.time.floor(), film.time.ceil()].map(at);
        before + film.time.fract() * (after - before)
    }

    /// Seconds from the first time to the last.
    pub(super) fn span(&self) -> f64 {
        let ends = [self.seconds.first(), self.seconds.last()];
        let [first, last] = ends.map(|end| end.copied().unwrap_or_default());
        last - first
    }
}

impl Way {
    /// What is drawn of it at a moment, by default when it ends; `None` where that is nothing.
    pub(super) fn drawn(&self, now: Option<f64>, tail: Tail) -> Option<Drawn> {
        let is_whole = now.is_none() && tail == Tail::All;
        let now = now.unwrap_or(self.ends[1]);
        let length = match tail {
            Tail::All => f64::INFINITY,
            Tail::Comet(seconds) => seconds,
            Tail::WholeComet => self.ends[1] - self.ends[0],
        };
        let since = now - length;
        let share = |seconds: f64| match tail {
            Tail::All => 1.0,
            _ => ((seconds - since) / length).clamp(POINT, 1.0),
        };
        let mut drawn = Drawn::default();
        let mut add = |passed: Passed| {
            drawn.0.push((passed.place, passed.color));
            drawn.1.push(share(passed.seconds));
        };
        for (i, pair) in self.passed.windows(2).enumerate() {
            let [a, b] = [pair[0], pair[1]];
            // Smoke is in the order of its places.
            if !is_whole && (b.seconds <= since || a.seconds >= now) {
                continue;
            }
            if i == 0 || a.seconds <= since {
                add(a.towards(b, since));
            }
            add(if is_whole { b } else { b.towards(a, now) });
        }
        (drawn.0.len() > 1).then_some(drawn)
    }
}

impl Passed {
    /// Where it is passed at a moment between two; else itself.
    fn towards(self, other: Self, seconds: f64) -> Self {
        let part = (seconds - self.seconds) / (other.seconds - self.seconds);
        if !(part > 0.0 && part <= 1.0) {
            return self;
        }
        let color = |k: usize| {
            let [a, b] = [self.color[k], other.color[k]].map(f64::from);
            (a + part * (b - a)) as f32
        };
        Self {
            place: self.place.lerp(other.place, part),
            color: [0, 1, 2].map(color),
            seconds,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A second and a unit of x a vertex, from 2 to 6 seconds.
    fn way() -> Way {
        let passed = (2..=6).map(f64::from).map(|seconds| Passed {
            place: DVec3::new(seconds, 0.0, 1.0),
            color: [seconds as f32 / 8.0, 0.5, 0.0],
            seconds,
        });
        Way {
            passed: passed.collect(),
            ends: [2.0, 6.0],
            number: 1,
        }
    }

    /// x and share of each place, whose colour must be that of its x.
    fn drawn(now: Option<f64>, tail: Tail) -> Vec<[f64; 2]> {
        let (places, shares) = way().drawn(now, tail).unwrap_or_default();
        for (place, color) in &places {
            assert_eq!(*color, [place.x as f32 / 8.0, 0.5, 0.0]);
            assert_eq!([place.y, place.z], [0.0, 1.0]);
        }
        places
            .iter()
            .zip(shares)
            .map(|((place, _), share)| [place.x, share])
            .collect()
    }

    #[test]
    fn ways_end_at_the_moment_and_comets_are_as_long_as_their_tails() {
        let all = |to: &[f64]| to.iter().map(|&x| [x, 1.0]).collect::<Vec<_>>();
        assert_eq!(drawn(None, Tail::All), all(&[2.0, 3.0, 4.0, 5.0, 6.0]));
        assert_eq!(drawn(Some(9.0), Tail::All), all(&[2.0, 3.0, 4.0, 5.0, 6.0]));
        assert_eq!(drawn(Some(3.75), Tail::All), all(&[2.0, 3.0, 3.75]));
        assert!(drawn(Some(2.0), Tail::All).is_empty());
        // A tail of two seconds, whose end is a point.
        let comet = drawn(Some(4.5), Tail::Comet(2.0));
        assert_eq!(comet, [[2.5, POINT], [3.0, 0.25], [4.0, 0.75], [4.5, 1.0]]);
        assert_eq!(
            drawn(Some(4.0), Tail::Comet(1.0)),
            [[3.0, POINT], [4.0, 1.0]]
        );
        assert_eq!(
            drawn(Some(2.5), Tail::Comet(2.0)),
            [[2.0, 0.75], [2.5, 1.0]]
        );
        // Gone a second ago, and two.
        assert_eq!(
            drawn(Some(7.0), Tail::Comet(2.0)),
            [[5.0, POINT], [6.0, 0.5]]
        );
        assert!(drawn(Some(8.0), Tail::Comet(2.0)).is_empty());
        let whole = drawn(None, Tail::WholeComet);
        assert_eq!(whole[..2], [[2.0, POINT], [3.0, 0.25]]);
        assert_eq!(whole[4], [6.0, 1.0]);
    }

    #[test]
    fn moments_of_a_film_lie_between_the_times_of_the_file() {
        let ways = Ways {
            ways: Vec::new(),
            seconds: vec![0.0, 10.0, 40.0],
            legend: None,
            range: [0.0, 1.0],
        };
        let now = |time: f64| {
            ways.now(&FilmTime {
                time,
                seeds: &[],
                ways: None,
            })
        };
        assert_eq!(
            [0.0, 0.5, 1.0, 1.25, 2.0].map(now),
            [0.0, 5.0, 10.0, 17.5, 40.0]
        );
        assert_eq!(ways.span(), 40.0);
    }
}
