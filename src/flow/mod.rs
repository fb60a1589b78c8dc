//! Stream, path and streak lines of a velocity field.
//!
//! ```text
//! dx/dt = v(t, x)
//! stream line    the solution with t held in v: tangent to the velocity of one instant
//! path line      the solution: the way of one particle
//! streak line    where all particles are that left one place so far
//! ```
//!
//! Places are those of the drawn world before heights are exaggerated. Knows nothing of files that it reads, and nothing
//! of Vulkan.
//!
//! ```
//! use glam::DVec3;
//! use stratavox::flow::{Direction, GridField, Limits, Metric, Snapshot, stream_lines};
//! use stratavox::volume::Grid;
//!
//! let grid = Grid { dims: [8; 3], world_from_voxel: glam::DAffine3::IDENTITY };
//! let wind = Snapshot::from_fn(&grid, |_| Some([2.0, 0.0, 0.0]));
//! let field = GridField::new(grid, vec![(0.0, wind)], Metric::plain(1.0))?;
//! let lines = stream_lines(&field, 0.0, &[DVec3::splat(4.0)], Direction::Both, &Limits::default());
//! assert_eq!(lines[0].vertices[0].place.y, 4.0);
//! # Ok::<(), stratavox::flow::FieldError>(())
//! ```

mod atmosphere;
mod dormand_prince;
mod error;
mod field;
mod grid_field;
mod line;
mod metric;
mod seeds;
mod snapshot;
mod trace;
pub mod wind;
pub mod write;

pub use atmosphere::height_of_pressure;
pub use error::FieldError;
pub use field::{Absence, Frozen, VectorField};
pub use grid_field::GridField;
pub use line::{Direction, End, Limits, Line, Vertex};
pub use metric::{Horizontal, Metric, Vertical};
pub use seeds::{
    Axis, Comparison, EvenLines, Seed, SeedPlace, SeedTable, Seeds, SeedsError, TableError,
    even_stream_lines, grid_seeds, plane_seeds, rake_seeds, random_seeds, seeds_where,
};
pub use snapshot::{Component, Snapshot};
pub use trace::{path_lines, path_lines_from, streak_lines, stream_lines};
