//! Places of finished lines, found again by where they are.
//!
//! ```text
//! cell of p = floor(S p / d),  S = diag(1, 1, stretch)        a place nearer than d lies in one of 27 cells
//! ```
//!
//! Distances are those of the picture: heights are stretched before they are measured.

use glam::DVec3;
use std::collections::HashMap;

/// Chords of lines are no longer than this part of the distance between lines.
const CHORD: f64 = 0.125;

/// What lines keep away from.
#[derive(Clone, Debug)]
pub(in crate::flow) struct Crowd {
    cells: HashMap<[i64; 3], Vec<DVec3>>,
    stretch: f64,
    distance: f64,
}

impl Crowd {
    /// Of lines that begin at this distance from each other, in a world whose heights are stretched.
    pub fn new(distance: f64, stretch: f64) -> Self {
        Self {
            cells: HashMap::new(),
            stretch,
            distance,
        }
    }

    /// A place, or a way, as it is seen.
    pub fn seen(&self, place: DVec3) -> DVec3 {
        place * DVec3::new(1.0, 1.0, self.stretch)
    }

    /// The place that is seen there.
    pub fn place(&self, seen: DVec3) -> DVec3 {
        seen / DVec3::new(1.0, 1.0, self.stretch)
    }

    /// Chords that a step has, so that no line slips between the samples of another.
    pub fn samples(&self, way: DVec3) -> f64 {
        let chords = self.seen(way).length() / (CHORD * self.distance);
        chords.ceil().clamp(1.0, 1e4)
    }

    fn cell(&self, seen: DVec3) -> [i64; 3] {
        (seen / self.distance).to_array().map(|x| x.floor() as i64)
    }

    pub fn add(&mut self, place: DVec3) {
        let seen = self.seen(place);
        let cell = self.cell(seen);
        self.cells.entry(cell).or_default().push(seen);
    }

    /// Whether another line is nearer than half the distance: a line ends there.
    pub fn is_near(&self, place: DVec3) -> bool {
        self.is_within(place, 0.5 * self.distance)
    }

    /// Whether another line is nearer than the distance: no line begins there.
    pub fn is_taken(&self, place: DVec3) -> bool {
        self.is_within(place, self.distance)
    }

    fn is_within(&self, place: DVec3, distance: f64) -> bool {
        let seen = self.seen(place);
        let [x, y, z] = self.cell(seen);
        let around = [-1, 0, 1];
        let mut cells = around.into_iter().flat_map(|i| {
            around
                .into_iter()
                .flat_map(move |j| around.into_iter().map(move |k| [x + i, y + j, z + k]))
        });
        let squared = distance * distance;
        cells.any(|cell| {
            let there = self.cells.get(&cell);
            there.is_some_and(|there| there.iter().any(|p| p.distance_squared(seen) < squared))
        })
    }
}
