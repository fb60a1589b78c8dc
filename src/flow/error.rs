//! Why there is no field.

/// What is wrong with the wind that was given.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FieldError {
    /// Components lie on different grids.
    #[error("wind: {name} is on a grid of {found:?} voxels, wanted the {wanted:?} of east")]
    Grids {
        /// north or up.
        name: &'static str,
        /// Voxels of the first component.
        wanted: [u32; 3],
        /// Voxels of this one.
        found: [u32; 3],
    },
    /// A snapshot is of another grid than the field.
    #[error("wind: snapshot {index} has {found:?} voxels, wanted {wanted:?}")]
    Snapshot {
        /// From 0.
        index: usize,
        /// Voxels of the grid.
        wanted: [u32; 3],
        /// Voxels of the snapshot.
        found: [usize; 3],
    },
    /// There is no snapshot, or times do not grow.
    #[error("wind: wanted at least one snapshot at times that grow, found {found:?} s")]
    Times {
        /// As they were given.
        found: Vec<f64>,
    },
    /// A number of each column is wanted.
    #[error("wind: {what}: wanted {wanted} finite numbers, one a column, found {found}")]
    Columns {
        /// The map factor, or the height of the ground.
        what: &'static str,
        /// Columns of the grid.
        wanted: usize,
        /// Numbers that were given.
        found: usize,
    },
    /// A length is not over 0.
    #[error("wind: {what}: wanted a number over 0, found {found}")]
    NotPositive {
        /// What has to be over 0.
        what: &'static str,
        /// What it is.
        found: f64,
    },
    /// Degrees, maps, pressures and the ground want axes east, north and up.
    #[error("wind: {what} wants a grid whose axes are those of the world, found a turned one")]
    Turned {
        /// What wants it.
        what: &'static str,
    },
}
