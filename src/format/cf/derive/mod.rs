//! Variables that a file does not have, computed from those that it has: temperature, pressure, wind speed, relative
//! humidity.
//!
//! ```text
//! name -> parts of the file, in SI units -> one grid for all -> a formula, voxel by voxel
//! ```
//!
//! A variable of the file with the name that is asked for is taken instead. Only the parts of what is asked for are read,
//! on the grid as stored (winds of WRF brought to the middles of cells): uneven levels become even ones afterwards.

mod formula;
mod open;
mod parts;
mod recipe;
mod si;
mod source;

pub(super) use recipe::{Recipe, available, recipe};
