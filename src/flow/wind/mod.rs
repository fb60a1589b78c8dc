//! The wind of a file: which of its variables, in which units, over which map.
//!
//! ```text
//! names, CF standard names  ->  east, north, up        units  ->  m/s or Pa/s        place of the grid  ->  metric
//! ```
//!
//! Knows headers, and nothing of the files that they are of.

mod choice;
mod columns;
mod moments;
mod place;
mod unit;

pub use choice::WindNames;
pub use columns::filled_down;
pub use moments::seconds_since_first;
pub use place::{MapFactors, metric_of};
pub use unit::{UnitError, WindUnit};
