//! The nearest of many places, and all within a radius: a k-d tree.
//!
//! Bentley, "Multidimensional binary search trees used for associative searching", CACM 18(9), 1975; each cell is halved at the
//! median along the longest side of the box of its places, and cells are left out by their distance from the query as
//! Arya and Mount, "Algorithms for fast vector quantization", DCC 1993, sum it up on the way down.
//!
//! Of places at the same distance the one with the smaller index is nearer: what is found does not depend on the tree.

use super::distances::bounds;
use glam::DVec3;

/// Places of a cell that is not halved.
const LEAF: usize = 8;

/// Places, sorted into cells.
#[derive(Clone, Debug)]
pub(super) struct Neighbours {
    places: Vec<DVec3>,
    /// Of each of these, as the caller counts them.
    indices: Vec<u32>,
    /// Each halved cell is followed by those of its lower half.
    cells: Vec<Cell>,
}

#[derive(Clone, Copy, Debug)]
struct Cell {
    axis: usize,
    /// Places of the lower half are not above this, those of the upper one not below.
    at: f64,
    /// Where the upper half stands.
    upper: u32,
}

/// The nearest places so far.
#[derive(Clone, Debug)]
pub(super) struct Nearest {
    /// Squared distances and indices, the nearest first.
    found: Vec<(f64, u32)>,
    wanted: usize,
    /// Squared; farther places are not looked at.
    bound: f64,
}

impl Nearest {
    /// Room for so many; none yet.
    pub fn new(wanted: usize) -> Self {
        Self {
            found: Vec::with_capacity(wanted + 1),
            wanted,
            bound: f64::INFINITY,
        }
    }

    /// Squared distances and indices, the nearest first.
    pub fn found(&self) -> &[(f64, u32)] {
        &self.found
    }

    /// How far the last of them is; infinite where there are fewer than wanted.
    pub fn radius(&self) -> f64 {
        match self.found.last() {
            Some((squared, _)) if self.found.len() == self.wanted => squared.sqrt(),
            _ => f64::INFINITY,
        }
    }

    fn take(&mut self, squared: f64, index: u32) {
        if squared > self.bound {
            return;
        }
        let is_nearer = |other: &(f64, u32)| (other.0, other.1) < (squared, index);
        let place = self.found.len()
            - self
                .found
                .iter()
                .rev()
                .take_while(|o| !is_nearer(o))
                .count();
        if place == self.wanted {
            return;
        }
        self.found.truncate(self.wanted - 1);
        self.found.insert(place, (squared, index));
        if self.found.len() == self.wanted {
            self.bound = self.found[self.wanted - 1].0;
        }
    }
}

impl Neighbours {
    /// At most 2^32 places, all finite, at least one.
    pub fn new(places: &[DVec3]) -> Self {
        let mut all: Vec<(DVec3, u32)> = places.iter().copied().zip(0..).collect();
        let mut cells = Vec::new();
        halve(&mut all, &mut cells);
        let (places, indices) = all.into_iter().unzip();
        Self {
            places,
            indices,
            cells,
        }
    }

    /// The places nearest to `query` that are at most `farthest` away, as many as `nearest` has room for.
    pub fn nearest(&self, query: DVec3, farthest: f64, nearest: &mut Nearest) {
        nearest.found.clear();
        nearest.bound = farthest * farthest;
        let all = 0..self.places.len();
        self.visit(query, 0, all, DVec3::ZERO, nearest);
    }

    /// Looks at a cell, the nearer half of it first. `apart` is how far its box is from the query along each axis, at least.
    fn visit(
        &self,
        query: DVec3,
        cell: usize,
        range: std::ops::Range<usize>,
        apart: DVec3,
        nearest: &mut Nearest,
    ) {
        if range.len() <= LEAF {
            for (place, &index) in self.places[range.clone()].iter().zip(&self.indices[range]) {
                nearest.take(place.distance_squared(query), index);
            }
            return;
        }
        let Cell { axis, at, upper } = self.cells[cell];
        let middle = range.start + range.len() / 2;
        let lower = (cell + 1, range.start..middle);
        let upper = (upper as usize, middle..range.end);
        let beyond = query[axis] - at;
        let (near, far) = if beyond < 0.0 {
            (lower, upper)
        } else {
            (upper, lower)
        };
        self.visit(query, near.0, near.1, apart, nearest);
        let mut farther = apart;
        farther[axis] = beyond;
        // A hair less, for what rounding does to either.
        if farther.length_squared() * (1.0 - 1e-14) <= nearest.bound {
            self.visit(query, far.0, far.1, farther, nearest);
        }
    }

    /// Indices of all places nearer to `query` than `radius`, in their order.
    pub fn within(&self, query: DVec3, radius: f64, found: &mut Vec<(u32, f64)>) {
        found.clear();
        let mut open = vec![(0, 0..self.places.len())];
        while let Some((cell, range)) = open.pop() {
            if range.len() <= LEAF {
                for (place, &index) in self.places[range.clone()].iter().zip(&self.indices[range]) {
                    let distance = place.distance(query);
                    if distance < radius {
                        found.push((index, distance));
                    }
                }
                continue;
            }
            let Cell { axis, at, upper } = self.cells[cell];
            let middle = range.start + range.len() / 2;
            if query[axis] - at < radius {
                open.push((cell + 1, range.start..middle));
            }
            if at - query[axis] < radius {
                open.push((upper as usize, middle..range.end));
            }
        }
        found.sort_unstable_by_key(|(index, _)| *index);
    }
}

/// Sorts places into the halves of their cell, and so on.
fn halve(places: &mut [(DVec3, u32)], cells: &mut Vec<Cell>) {
    if places.len() <= LEAF {
        return;
    }
    let [low, high] = bounds(places.iter().map(|(place, _)| *place));
    let axis = (high - low).max_position();
    let middle = places.len() / 2;
    let (_, (at, _), _) =
        places.select_nth_unstable_by(middle, |a, b| a.0[axis].total_cmp(&b.0[axis]));
    let at = at[axis];
    let this = cells.len();
    cells.push(Cell { axis, at, upper: 0 });
    let (lower, upper) = places.split_at_mut(middle);
    halve(lower, cells);
    cells[this].upper = cells.len() as u32;
    halve(upper, cells);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Random numbers from 0 to 1 in steps of 1/16: many places are alike, and many distances.
    fn places(count: usize, flat: DVec3) -> Vec<DVec3> {
        let mut state = 11_u32;
        let mut unit = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(state >> 28) / 16.0
        };
        (0..count)
            .map(|_| glam::dvec3(unit(), unit(), unit()) * flat)
            .collect()
    }

    #[test]
    fn the_nearest_are_those_of_a_search_through_all() {
        for (count, flat) in [
            (1, DVec3::ONE),
            (9, DVec3::ONE),
            (700, DVec3::ONE),
            (300, DVec3::X),
        ] {
            let places = places(count, flat);
            let tree = Neighbours::new(&places);
            for query in places.iter().take(40).map(|p| *p * 1.3 - 0.1) {
                let distances = places.iter().map(|p| p.distance_squared(query));
                let mut all: Vec<(f64, u32)> = distances.zip(0..).collect();
                all.sort_by(|a, b| a.partial_cmp(b).expect("numbers"));
                for wanted in [1, 17] {
                    let mut nearest = Nearest::new(wanted);
                    tree.nearest(query, f64::INFINITY, &mut nearest);
                    assert_eq!(
                        nearest.found(),
                        &all[..wanted.min(count)],
                        "{count} {query}"
                    );
                    tree.nearest(query, 0.2, &mut nearest);
                    let near = all.iter().filter(|(squared, _)| *squared <= 0.2 * 0.2);
                    let near: Vec<_> = near.take(wanted).copied().collect();
                    assert_eq!(nearest.found(), near);
                }
                let mut found = Vec::new();
                tree.within(query, 0.3, &mut found);
                let near = (0..count as u32).filter(|&i| places[i as usize].distance(query) < 0.3);
                let found: Vec<u32> = found.iter().map(|(index, _)| *index).collect();
                assert_eq!(found, near.collect::<Vec<_>>());
            }
        }
    }
}
