//! Lines whose places have times: ways of particles up to a moment, comets, and spheres at equal times.
//!
//! ```text
//! drawn     what was passed from  now - T  to  now;  of ways without a tail from their begin
//! radius    width / 2 * (t - (now - T)) / T         of comets; T the length of the tail, now at the head
//! spheres   at t = 0, T, 2 T ...                    T the largest round time in a sixteenth of the median of all ways
//! ```
//!
//! A particle that is gone leaves its tail behind, which ends a time T later.

use super::film::FilmTime;
use crate::annotate::ColorLegend;
use crate::figure::short;
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
    /// Of ribbons: how far it is turned, radians.
    pub turn: f64,
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

/// What is drawn of a way.
#[derive(Clone, Debug, Default)]
pub(super) struct Drawn {
    /// Places with their colours.
    pub line: Vec<(DVec3, [f32; 3])>,
    /// How wide it is there, from 0 to 1.
    pub shares: Vec<f64>,
    /// How far it is turned there, radians.
    pub turns: Vec<f64>,
}

/// Spheres along a way of median length, and along all of them.
const SPHERES: f64 = 16.0;
const MOST_SPHERES: f64 = 200_000.0;
const DAY: f64 = 86_400.0;
/// Round times over which a file of the Earth counts, seconds.
const ROUND: [f64; 14] = [
    60.0, 120.0, 300.0, 600.0, 900.0, 1800.0, 3600.0, 7200.0, 10_800.0, 21_600.0, 43_200.0,
    86_400.0, 172_800.0, 432_000.0,
];

impl Ways {
    /// Seconds at a time of a film, counted from 0.
    pub(super) fn now(&self, film: &FilmTime) -> f64 {
        let last = self.seconds.len().saturating_sub(1);
        let at = |time: f64| self.seconds[(time as usize).min(last)];
        let [before, after] = [film.time.floor(), film.time.ceil()].map(at);
        before + film.time.fract() * (after - before)
    }

    /// Seconds between spheres along the ways.
    pub(super) fn time_apart(&self, is_earth: bool) -> f64 {
        let lengths = self.ways.iter().map(|way| way.ends[1] - way.ends[0]);
        let mut lengths: Vec<f64> = lengths.filter(|&length| length > 0.0).collect();
        lengths.sort_by(f64::total_cmp);
        let median = lengths.get(lengths.len() / 2).copied().unwrap_or(1.0);
        let all: f64 = lengths.iter().sum();
        let wanted = (median / SPHERES).max(all / MOST_SPHERES);
        let of_clock = ROUND.iter().rev().find(|&&round| round <= wanted);
        let unit = match of_clock.filter(|_| is_earth) {
            Some(&round) if wanted < 10.0 * DAY => return round,
            Some(_) => DAY,
            None => 1.0,
        };
        let ten = unit * 10.0_f64.powf((wanted / unit).log10().floor());
        let steps = [5.0, 2.0, 1.0].map(|n| n * ten);
        let mut steps = steps.into_iter();
        steps.find(|&step| step <= wanted).unwrap_or(ten)
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
            drawn.line.push((passed.place, passed.color));
            drawn.shares.push(share(passed.seconds));
            drawn.turns.push(passed.turn);
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
        (drawn.line.len() > 1).then_some(drawn)
    }

    /// Where it is, with its colour, at each multiple of a time in seconds, up to a moment where there is one.
    pub(super) fn marks(&self, now: Option<f64>, step: f64) -> Vec<(DVec3, [f32; 3])> {
        let now = now.unwrap_or(f64::INFINITY);
        let mut marks = Vec::new();
        for (i, pair) in self.passed.windows(2).enumerate() {
            let [a, b] = [pair[0], pair[1]];
            // The place between two pieces is of the first.
            let first = (a.seconds / step).ceil();
            let first = if i > 0 && first * step == a.seconds {
                first + 1.0
            } else {
                first
            };
            let count = ((b.seconds.min(now) / step).floor() - first + 1.0).max(0.0);
            for k in 0..count as u32 {
                let passed = a.towards(b, (first + f64::from(k)) * step);
                marks.push((passed.place, passed.color));
            }
        }
        marks
    }
}

/// A time as it is said.
pub(super) fn in_words(seconds: f64) -> String {
    let units = [(86_400.0, "d"), (3600.0, "h"), (60.0, "min")];
    let unit = units
        .into_iter()
        .find(|(length, _)| seconds % length == 0.0);
    let (length, unit) = unit.unwrap_or((1.0, "s"));
    format!("{} {unit}", short(seconds / length))
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
            turn: self.turn + part * (other.turn - self.turn),
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
            turn: 3.0 * seconds,
        });
        Way {
            passed: passed.collect(),
            ends: [2.0, 6.0],
            number: 1,
        }
    }

    /// x and share of each place, whose colour must be that of its x.
    fn drawn(now: Option<f64>, tail: Tail) -> Vec<[f64; 2]> {
        let Drawn {
            line: places,
            shares,
            turns,
        } = way().drawn(now, tail).unwrap_or_default();
        for ((place, color), turn) in places.iter().zip(turns) {
            assert!((turn - 3.0 * place.x).abs() < 1e-12);
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
    fn spheres_lie_at_multiples_of_a_time_up_to_the_moment() {
        let marks = |now, step| -> Vec<f64> {
            let marks = way().marks(now, step);
            marks.iter().map(|(place, _)| place.x).collect()
        };
        assert_eq!(marks(None, 1.0), [2.0, 3.0, 4.0, 5.0, 6.0]);
        assert_eq!(marks(None, 0.75), [2.25, 3.0, 3.75, 4.5, 5.25, 6.0]);
        assert_eq!(marks(Some(4.4), 0.75), [2.25, 3.0, 3.75]);
        assert!(marks(Some(1.0), 0.75).is_empty() && marks(None, 7.0).is_empty());
        let ways = |length: f64| Ways {
            ways: vec![
                Way {
                    ends: [0.0, length],
                    ..way()
                };
                3
            ],
            seconds: Vec::new(),
            legend: None,
            range: [0.0, 1.0],
        };
        for (length, is_earth, wanted) in [
            (16.0 * 3700.0, true, "1 h"),
            (16.0 * 3700.0, false, "2000 s"),
            (16.0 * 899.0, true, "10 min"),
            (16.0 * 0.06, true, "0.05 s"),
            (16.0 * 347.0 * DAY, true, "200 d"),
        ] {
            let found = ways(length).time_apart(is_earth);
            assert_eq!(in_words(found), wanted, "{length}");
        }
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
                sphere_step: None,
            })
        };
        assert_eq!(
            [0.0, 0.5, 1.0, 1.25, 2.0].map(now),
            [0.0, 5.0, 10.0, 17.5, 40.0]
        );
        assert_eq!(ways.span(), 40.0);
    }
}
