//! Where lines begin.
//!
//! ```text
//! grid      the middles of NX x NY x NZ equal parts of the box
//! random    p = A (u n),  u = pcg4d(i, seed, 0, 0) / 2^32,  n voxels
//! plane     the middles of N x N equal parts of a plane of the box
//! rake      N places of a line, its ends the first and the last
//! where     N of the voxels whose value is over, or under, a threshold
//! even      lines that keep a distance from each other (Jobard & Lefer 1997)
//! ```
//!
//! Places are those of the drawn world before heights are exaggerated.

mod choice;
mod crowd;
mod even;
mod pcg;
mod places;
mod table;
mod words;

pub(super) use crowd::Crowd;

pub use choice::{Comparison, seeds_where};
pub use even::{EvenLines, even_stream_lines};
pub use places::{grid_seeds, plane_seeds, rake_seeds, random_seeds};
pub use table::{Seed, SeedPlace, SeedTable, TableError};
pub use words::{Axis, Seeds, SeedsError};
