//! Modified quadratic Shepard: what is averaged is a quadratic through each point.
//!
//! ```text
//! f(x)   = sum of w_s q_s(x) / sum of w_s,   w_s as in inverse distances
//! q_s(x) = f_s + g . u + u^T H u,   u = x - x_s
//! g, H   = arg min over the 17 nearest points t of s of  sum of v_t^2 (q_s(x_t) - f_t)^2,   v_t = (R - d_t) / d_t
//! ```
//!
//! with R the distance of the eighteenth. Franke and Nielson, "Smooth interpolation of large sets of scattered data",
//! Int. J. Numerical Methods in Engineering 15, 1980; Renka, "Multivariate interpolation of large sets of scattered data"
//! and "Algorithm 661: QSHEP3D", ACM TOMS 14(2), 1988. As there, a point whose neighbours do not tell the unknowns apart is
//! given more of them; where that is not enough, the unknowns that they do not tell are 0, second derivatives first.
//!
//! Quadratics are reproduced, and values at points. Outside of what it is fitted to a quadratic of noisy values goes far astray:
//! it is kept in the range of these values, widened by twice its width on both sides, which a smooth field between its points does
//! not leave.

use super::least_squares::{MOST, System};
use super::{Found, idw};
use crate::points::neighbours::{Nearest, Neighbours};
use glam::DVec3;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Neighbours that a quadratic is fitted to, and how many where these are not enough.
const FITTED: [usize; 3] = [17, 26, 40];
/// A column of the fit whose rest is below this part of it is not told apart from the others (Renka's DTOL).
const TOLERANCE: f64 = 1e-2;
/// Where there is no next neighbour, R is so many times the distance of the farthest.
const BEYOND: f64 = 1.1;
/// Widths of its range that a quadratic may leave it by.
const WIDER: f64 = 2.0;
/// Points that a thread fits at once.
const BLOCK: usize = 32;

/// Those of all points.
#[derive(Clone, Debug)]
pub(super) struct Quadratics(Vec<Quadratic>);

#[derive(Clone, Copy, Debug)]
struct Quadratic {
    /// g and H: of x, y, z, xx, yy, zz, xy, xz, yz.
    terms: [f64; MOST],
    /// What it may be.
    range: [f64; 2],
}

impl Quadratics {
    /// Of places in a plane, without the coordinate `normal`.
    pub fn fitted(
        places: &[DVec3],
        values: &[f64],
        neighbours: &Neighbours,
        normal: Option<usize>,
        threads: usize,
    ) -> Self {
        let terms = Terms::new(normal);
        let fit = Fit {
            places,
            values,
            neighbours,
            terms,
        };
        let next = AtomicUsize::new(0);
        let work = || {
            let (mut system, mut made) = (System::default(), Vec::new());
            loop {
                let first = next.fetch_add(BLOCK, Ordering::Relaxed);
                if first >= places.len() {
                    return made;
                }
                let block = first..places.len().min(first + BLOCK);
                let block = block.map(|i| fit.quadratic(i, &mut system)).collect();
                made.push((first, block));
            }
        };
        let mut blocks: Vec<(usize, Vec<Quadratic>)> = std::thread::scope(|scope| {
            let workers: Vec<_> = (0..threads.max(1)).map(|_| scope.spawn(work)).collect();
            let made = workers.into_iter().flat_map(|worker| match worker.join() {
                Ok(made) => made,
                Err(fault) => std::panic::resume_unwind(fault),
            });
            made.collect()
        });
        blocks.sort_unstable_by_key(|(first, _)| *first);
        Self(blocks.into_iter().flat_map(|(_, block)| block).collect())
    }

    pub fn value(&self, at: DVec3, found: &[Found], places: &[DVec3], values: &[f64]) -> f64 {
        idw::mean(found, |index| {
            let u = at - places[index];
            let Quadratic {
                terms: [x, y, z, xx, yy, zz, xy, xz, yz],
                range: [low, high],
            } = self.0[index];
            let slope = u.x * (x + xx * u.x + xy * u.y + xz * u.z);
            let value =
                values[index] + slope + u.y * (y + yy * u.y + yz * u.z) + u.z * (z + zz * u.z);
            value.clamp(low, high)
        })
    }
}

/// Which of the nine terms there are.
#[derive(Clone, Copy, Debug)]
struct Terms {
    numbers: [usize; MOST],
    count: usize,
    linear: usize,
}

impl Terms {
    /// Axes that each term is a product of; the linear ones have one.
    const AXES: [[Option<usize>; 2]; MOST] = [
        [Some(0), None],
        [Some(1), None],
        [Some(2), None],
        [Some(0), Some(0)],
        [Some(1), Some(1)],
        [Some(2), Some(2)],
        [Some(0), Some(1)],
        [Some(0), Some(2)],
        [Some(1), Some(2)],
    ];

    fn new(normal: Option<usize>) -> Self {
        let there = |term: &usize| normal.is_none() || !Self::AXES[*term].contains(&normal);
        let mut terms = Self {
            numbers: [0; MOST],
            count: 0,
            linear: if normal.is_some() { 2 } else { 3 },
        };
        for term in (0..MOST).filter(there) {
            terms.numbers[terms.count] = term;
            terms.count += 1;
        }
        terms
    }
}

struct Fit<'a> {
    places: &'a [DVec3],
    values: &'a [f64],
    neighbours: &'a Neighbours,
    terms: Terms,
}

impl Fit<'_> {
    fn quadratic(&self, point: usize, system: &mut System) -> Quadratic {
        let mut terms = [0.0; MOST];
        let mut range = [self.values[point]; 2];
        for fitted in FITTED {
            // The point itself, those that are fitted, and the next one.
            let mut nearest = Nearest::new(fitted + 2);
            self.neighbours
                .nearest(self.places[point], f64::INFINITY, &mut nearest);
            // A distance whose square is no number above 0 is none.
            let others = nearest.found();
            let others = &others[others.partition_point(|(squared, _)| *squared == 0.0)..];
            let (others, radius) = match others {
                [all @ .., next] if all.len() == fitted => (all, next.0.sqrt()),
                all => (all, BEYOND * all.last().map_or(0.0, |far| far.0.sqrt())),
            };
            let rest;
            (rest, terms) = self.fitted(point, others, radius, system);
            for &(_, other) in others {
                let value = self.values[other as usize];
                range = [range[0].min(value), range[1].max(value)];
            }
            if rest > TOLERANCE || others.len() < fitted {
                break;
            }
        }
        let [low, high] = range;
        let width = high - low;
        Quadratic {
            terms,
            range: [low - WIDER * width, high + WIDER * width],
        }
    }

    /// The smallest rest of a column, and the coefficients.
    fn fitted(
        &self,
        point: usize,
        others: &[Found],
        radius: f64,
        system: &mut System,
    ) -> (f64, [f64; MOST]) {
        let Terms {
            numbers,
            count,
            linear,
        } = self.terms;
        let here = self.places[point];
        let nearest = others.first().map_or(1.0, |near| near.0.sqrt());
        system.clear();
        for &(squared, other) in others {
            let distance = squared.sqrt();
            // Times the smallest distance for all: none is too large for a number.
            let weight = (radius - distance) * nearest / (radius * distance);
            let u = (self.places[other as usize] - here) / radius;
            let all = [
                u.x,
                u.y,
                u.z,
                u.x * u.x,
                u.y * u.y,
                u.z * u.z,
                u.x * u.y,
                u.x * u.z,
                u.y * u.z,
            ];
            let unknowns: [f64; MOST] = std::array::from_fn(|k| weight * all[numbers[k]]);
            let right = weight * (self.values[other as usize] - self.values[point]);
            system.push(&unknowns[..count], right);
        }
        let solution = system.solve(count, linear, TOLERANCE);
        let mut quadratic = [0.0; MOST];
        for (k, &term) in numbers[..count].iter().enumerate() {
            let scale = if k < linear { radius } else { radius * radius };
            quadratic[term] = solution.coefficients[k] / scale;
        }
        (solution.smallest_rest, quadratic)
    }
}
