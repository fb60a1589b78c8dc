//! One way from a seed, step by step.
//!
//! ```text
//! h = half a cell at first,  <= one cell of the velocity there,  <= rest of the time,  <= next snapshot
//! error e in cells over the tolerance:  e <= 1 accept, else a shorter step;  a stage without velocity: half of it,
//! until it is under a thousandth of a cell: the line ends there
//! ```
//!
//! A trilinear field has kinks at the faces of cells, which the estimate of the error misses in longer steps. Between its ends a
//! step leaves vertices so that a chord is within a twentieth of a cell of the way.

use crate::flow::dormand_prince::{Controller, Step, step};
use crate::flow::field::{Absence, VectorField};
use crate::flow::line::{End, Limits, Vertex};
use crate::flow::seeds::Crowd;
use glam::{DMat3, DVec3};

/// A step that is shorter, in cells, is none.
const SHORTEST: f64 = 1e-3;
/// What a chord may be off by, in cells.
const CHORD: f64 = 0.05;
/// A step has no more chords.
const MOST_CHORDS: f64 = 16.0;
/// A line is closed this near to its seed, in cells, and after so many of them.
const CLOSED: f64 = 0.1;
const CLOSED_AFTER: f64 = 4.0;
/// This part of a fast speed is none, over so many steps.
const STAGNANT: f64 = 1e-6;
const STAGNANT_STEPS: u32 = 8;
/// So many tolerances from where a line is, it has not moved: near a sink steps only find its place anew.
const UNMOVED: f64 = 10.0;

/// One way from a seed.
pub(super) struct Walk<'a, F> {
    field: &'a F,
    limits: &'a Limits,
    sign: f64,
    cells_from_world: DMat3,
    /// World length once around, where the field has no end along x.
    period: Option<f64>,
    crowd: Option<&'a Crowd>,
}

impl<'a, F: VectorField> Walk<'a, F> {
    pub fn new(field: &'a F, limits: &'a Limits, sign: f64) -> Self {
        Self {
            field,
            limits,
            sign,
            cells_from_world: field.cells_from_world(),
            period: field.seam().map(|[low, high]| high - low),
            crowd: None,
        }
    }

    /// How long a way is in cells, along the axis where it is longest.
    fn cells(&self, way: DVec3) -> f64 {
        (self.cells_from_world * way).abs().max_element()
    }

    /// The same that ends where it comes too near to other lines.
    pub fn among(mut self, crowd: &'a Crowd) -> Self {
        self.crowd = Some(crowd);
        self
    }

    /// The way of a seed, and why it ends. Where the field has no end along x, places go on beyond it.
    pub fn follow(&self, start: f64, seed: DVec3) -> (Vec<Vertex>, End) {
        let first = match self.field.velocity(start, seed) {
            Ok(velocity) => velocity,
            Err(absence) => return (Vec::new(), End::Absence(absence)),
        };
        let mut vertices = Vec::new();
        let mut way = Way {
            time: start,
            place: seed,
            velocity: first,
            length: 0.0,
            cells: 0.0,
        };
        vertices.extend(self.vertex(start, seed));
        let last = self.last_time(start);
        let stagnant = STAGNANT * self.field.fast_speed();
        let mut controller = Controller::default();
        let mut wanted = 0.5 / self.cells(first);
        let (mut slow_steps, mut still_steps, mut anchor) = (0, 0, seed);
        loop {
            let speed = way.velocity.length();
            slow_steps = if speed <= stagnant { slow_steps + 1 } else { 0 };
            let is_still = self.cells(way.place - anchor) < UNMOVED * self.limits.tolerance;
            still_steps = if is_still { still_steps + 1 } else { 0 };
            if !is_still {
                anchor = way.place;
            }
            if slow_steps.max(still_steps) >= STAGNANT_STEPS || speed == 0.0 {
                return (vertices, End::Stagnation);
            }
            let rest = (last - way.time).abs();
            if rest == 0.0 {
                return (vertices, End::Time);
            }
            let to_snapshot = self.field.next_snapshot(way.time, self.sign > 0.0);
            let to_snapshot = to_snapshot.map_or(f64::INFINITY, |t| (t - way.time).abs());
            let most = rest.min(to_snapshot).min(1.0 / self.cells(way.velocity));
            let made = match self.make(&way, wanted.min(most)) {
                Ok(made) => made,
                Err(absence) => return (vertices, End::Absence(absence)),
            };
            let error = self.cells(made.error()) / self.limits.tolerance;
            wanted = made.duration.abs() * controller.growth(error);
            if let Some(end) = self.leave(&mut vertices, &mut way, &made, seed, first) {
                return (vertices, end);
            }
        }
    }

    fn last_time(&self, start: f64) -> f64 {
        let [first, last] = self.field.time_span();
        match self.sign > 0.0 {
            true => (start + self.limits.duration).min(last),
            false => (start - self.limits.duration).max(first),
        }
    }

    /// A step of this duration at most that is within the tolerance.
    fn make(&self, from: &Way, mut duration: f64) -> Result<Step, Absence> {
        let velocity = |time: f64, place: DVec3| self.field.velocity(time, place);
        loop {
            let is_shortest = duration * self.cells(from.velocity) < SHORTEST;
            match step(
                velocity,
                from.time,
                from.place,
                self.sign * duration,
                from.velocity,
            ) {
                Ok(made) => {
                    let error = self.cells(made.error()) / self.limits.tolerance;
                    // A way that turns may be longer than its first velocity says.
                    let cells = self.cells(made.end - made.start);
                    if is_shortest || (error <= 1.0 && cells <= 1.0) {
                        return Ok(made);
                    }
                    let by_error = if error > 1.0 {
                        Controller::reduction(error)
                    } else {
                        1.0
                    };
                    duration *= by_error.min(0.95 / cells.max(0.95));
                }
                Err(absence) if is_shortest => return Err(absence),
                Err(_) => duration *= 0.5,
            }
        }
    }

    /// Leaves the vertices of a step; why the line ends in it, where it does.
    fn leave(
        &self,
        vertices: &mut Vec<Vertex>,
        way: &mut Way,
        made: &Step,
        seed: DVec3,
        first: DVec3,
    ) -> Option<End> {
        let dense = made.dense();
        let off = self.cells(dense.at(0.5) - 0.5 * (made.start + made.end));
        let mut chords = (off / CHORD).sqrt().ceil().clamp(1.0, MOST_CHORDS);
        if let Some(crowd) = self.crowd {
            chords = chords.max(crowd.samples(made.end - made.start));
        }
        for chord in 1..=chords as u32 {
            let part = f64::from(chord) / chords;
            let is_last = f64::from(chord) == chords;
            let mut place = if is_last { made.end } else { dense.at(part) };
            let mut time = made.time + part * made.duration;
            let before = way.place;
            let mut end = None;
            let ahead = place - before;
            way.cells += self.cells(ahead);
            let seed = self.beside(seed, place);
            let to_seed = nearest(before, place, seed);
            if way.cells > CLOSED_AFTER
                && self.cells(to_seed - seed) < CLOSED
                && ahead.dot(self.sign * first) > 0.0
            {
                (place, end) = (seed, Some(End::Closed));
            }
            if end.is_none() && self.crowd.is_some_and(|crowd| crowd.is_near(place)) {
                return Some(End::Crowded);
            }
            let length = ahead.length();
            if end.is_none() && way.length + length >= self.limits.length {
                let share = (self.limits.length - way.length) / length;
                place = before + share * ahead;
                time = way.time + share * (time - way.time);
                end = Some(End::Length);
            }
            way.length += length;
            (way.time, way.place) = (time, place);
            vertices.extend(self.vertex(time, place));
            if end.is_none() && vertices.len() >= self.limits.vertices {
                end = Some(End::Vertices);
            }
            if end.is_some() {
                return end;
            }
        }
        way.time = made.time + made.duration;
        way.velocity = made.last_velocity();
        None
    }

    /// The seed, as many times around as a place is.
    fn beside(&self, seed: DVec3, place: DVec3) -> DVec3 {
        match self.period {
            None => seed,
            Some(period) => seed + period * ((place.x - seed.x) / period).round() * DVec3::X,
        }
    }

    fn vertex(&self, time: f64, place: DVec3) -> Option<Vertex> {
        // Between the stages of a step a way may graze what has none.
        let speed = self.field.speed(time, place).ok()?;
        Some(Vertex { place, time, speed })
    }
}

/// Where a walk is.
struct Way {
    time: f64,
    place: DVec3,
    velocity: DVec3,
    length: f64,
    cells: f64,
}

/// The place between `a` and `b` that is nearest to `to`.
fn nearest(a: DVec3, b: DVec3, to: DVec3) -> DVec3 {
    let along = b - a;
    let part = (to - a).dot(along) / along.length_squared();
    a + part.clamp(0.0, 1.0) * along
}
