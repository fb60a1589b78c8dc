//! The value of the nearest point: constant in each cell of Voronoi's diagram.
//!
//! ```text
//! f(x) = f_s,  s the point with the smallest |x - x_s|, of several the first
//! ```
//!
//! Thiessen, "Precipitation averages for large areas", Monthly Weather Review 39(7), 1911.

use super::Found;

pub(super) fn value(found: &[Found], values: &[f64]) -> f64 {
    values[found[0].1 as usize]
}
