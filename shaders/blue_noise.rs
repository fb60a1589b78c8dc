//! A dither array by void and cluster (R. Ulichney, Proc. SPIE 1913, 1993): numbers 0 to n^2 - 1 on a torus such that
//! those under any bound lie evenly. Part of `build.rs`.
//!
//! ```text
//! energy of a place = sum over points q of exp(-|p - q|^2 / (2 sigma^2)),  |p - q| the short way around
//! ```
//!
//! Some points are spread evenly, by moving the one of most energy to the free place of least until that is its own.
//! They are numbered downwards as they are taken away where energy is most, and the rest upwards as places are filled
//! where it is least. (The paper's third phase takes the tightest cluster of free places; the sum over all places is
//! one number on a torus, so that is the largest void again.)
//!
//! Energies are whole numbers: sums do not depend on their order, and every machine builds the same array.

/// Numbers along a side.
pub const SIDE: usize = 64;
const COUNT: usize = SIDE * SIDE;
/// Best in Ulichney's trials, between 1.5 and 2.
const SIGMA: f64 = 1.9;
/// Farther away a weight is under 2^-24 of the largest.
const REACH: usize = 11;
const ONE: f64 = 16_777_216.0;
/// Points at first: a tenth of all at most.
const FIRST: usize = COUNT / 10;

/// The array, row after row.
pub fn ranks() -> Vec<u32> {
    let mut field = Field::new();
    // Any scatter will do. Squares meet some places twice, which makes one point.
    for k in 0..FIRST {
        field.set(k * k * 7 % COUNT, true);
    }
    loop {
        let moved = field.extreme(true);
        field.set(moved, false);
        let free = field.extreme(false);
        field.set(free, true);
        if free == moved {
            break;
        }
    }
    let first = field.is_point.clone();
    let count = first.iter().filter(|&&is_point| is_point).count();
    let mut ranks = vec![0; COUNT];
    for rank in (0..count).rev() {
        let place = field.extreme(true);
        field.set(place, false);
        ranks[place] = rank as u32;
    }
    for (place, _) in first.iter().enumerate().filter(|(_, is_point)| **is_point) {
        field.set(place, true);
    }
    for rank in count..COUNT {
        let place = field.extreme(false);
        field.set(place, true);
        ranks[place] = rank as u32;
    }
    ranks
}

/// Points on a torus, and what they add up to everywhere.
struct Field {
    is_point: Vec<bool>,
    energy: Vec<i64>,
    /// By distance along x and along y.
    weights: Vec<i64>,
    /// In each row the point of most energy and the free place of least, where there is one.
    of_row: Vec<[Option<usize>; 2]>,
}

impl Field {
    fn new() -> Self {
        let width = REACH + 1;
        let weight = |i: usize| {
            let square = ((i % width).pow(2) + (i / width).pow(2)) as f64;
            (ONE * (-square / (2.0 * SIGMA * SIGMA)).exp()).round() as i64
        };
        let mut field = Self {
            is_point: vec![false; COUNT],
            energy: vec![0; COUNT],
            weights: (0..width * width).map(weight).collect(),
            of_row: vec![[None; 2]; SIDE],
        };
        for y in 0..SIDE {
            field.look_along(y);
        }
        field
    }

    fn set(&mut self, place: usize, is_point: bool) {
        if self.is_point[place] == is_point {
            return;
        }
        self.is_point[place] = is_point;
        let sign = if is_point { 1 } else { -1 };
        let (x, y) = (place % SIDE, place / SIDE);
        for dy in 0..2 * REACH + 1 {
            let row = (y + SIDE + dy - REACH) % SIDE;
            for dx in 0..2 * REACH + 1 {
                let column = (x + SIDE + dx - REACH) % SIDE;
                let weight = self.weights[dy.abs_diff(REACH) * (REACH + 1) + dx.abs_diff(REACH)];
                self.energy[row * SIDE + column] += sign * weight;
            }
            self.look_along(row);
        }
    }

    fn look_along(&mut self, row: usize) {
        let (mut most, mut least) = (None, None);
        let (mut high, mut low) = (i64::MIN, i64::MAX);
        for place in row * SIDE..(row + 1) * SIDE {
            let energy = self.energy[place];
            if self.is_point[place] {
                if energy > high {
                    (high, most) = (energy, Some(place));
                }
            } else if energy < low {
                (low, least) = (energy, Some(place));
            }
        }
        self.of_row[row] = [most, least];
    }

    /// The point of most energy, or the free place of least; the first of several.
    fn extreme(&self, of_points: bool) -> usize {
        let which = usize::from(!of_points);
        let places = self.of_row.iter().filter_map(|found| found[which]);
        let best = places.min_by_key(|&place| {
            let energy = self.energy[place];
            if of_points { -energy } else { energy }
        });
        best.expect("neither all places nor none are taken")
    }
}
