//! What gridded data of the Earth means, whatever container it lies in: the Climate and Forecast conventions.
//!
//! By the CF Metadata Conventions 1.11, cfconventions.org, and the NetCDF Users Guide, appendix B (attribute
//! conventions). A container gives its variables and attributes ([`Arrays`]); from there on
//!
//! ```text
//! variables -> one is chosen -> an axis for each of its dimensions -> coordinates -> world, in kilometres
//!           -> Grid (the voxels as stored) -> Regular or Columns (evenly spaced, where the grid is not)
//! ```
//!
//! World coordinates of a piece of the Earth are kilometres: x east, y north, z up. Degrees become lengths by
//! the equirectangular projection about the middle latitude, pressures heights by the US Standard Atmosphere
//! 1976. Levels that are only numbers are spread over a quarter of the width. What was done is a note.

mod axes;
mod centered;
mod choose;
mod columns;
mod coordinates;
mod curved;
mod derive;
mod grid;
mod knots;
mod missing;
mod model;
mod moved_pole;
mod open;
mod place;
mod regular;
#[cfg(feature = "netcdf")]
mod sampled;
mod time;
mod units;
mod values;
mod wrf;
mod wrf_map;
mod wrf_names;

pub(crate) use grid::{Grid, Role};
pub(crate) use missing::Missing;
pub(crate) use model::{Arrays, Attributes, Contents, Dimension, Kind, Value, Variable};
pub(crate) use open::open;
#[cfg(feature = "netcdf")]
pub(crate) use sampled::{Samples, Vertical, is_sampled, samples};
#[cfg(feature = "netcdf")]
pub(crate) use units::Measure;
