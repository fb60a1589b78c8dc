//! Files of scattered points to [`PointFile`]s.
//!
//! ```text
//! names, rows -> which column is which -> numbers of rows -> places in the world -> Points -> a volume of their means, or by
//! interpolation
//! ```
//!
//! | file | points |
//! |---|---|
//! | `.csv`, `.tsv` | rows under a row of names |
//! | `.npy` | rows of an array `[N, 4]` to `[N, 6]` ([`open_npy`]) |
//! | `.ply` | vertices, with the first other property as their value |
//! | `.vtp` | points of PolyData, with an array of point data |
//! | `.nc` | samples of CF's discrete sampling geometries: points, series, profiles, trajectories |
//!
//! A row without a finite number where one is wanted is dropped and counted. Points at one place are kept and counted.

mod columns;
mod gathered;
mod gridded;
mod npy;
mod numbers;
mod place;
mod ply;
mod quantity;
mod roles;
mod rows;
#[cfg(feature = "netcdf")]
pub(super) mod sampled;
mod source;
mod table;
mod vtp;

pub use columns::{NoColumns, PointColumns};
pub use source::PointFile;

use super::problem::{at, invalid};
use crate::volume::{Limits, ReadError, Source, VolumeSelection};
use std::path::Path;

pub(super) use vtp::recognizes as recognizes_vtp;

/// What names of files of points end with.
const ENDINGS: [&str; 4] = ["csv", "tsv", "ply", "vtp"];

/// True where a file holds scattered points, by its name.
pub fn holds_points(path: &Path) -> bool {
    ENDINGS.iter().any(|ending| ends_with(path, ending))
}

/// True where a NetCDF file, which ends with `.nc`, `.nc4` or `.cdf`, says that it holds samples and no grid. It is opened
/// for that.
pub fn holds_samples(path: &Path, limits: &Limits) -> bool {
    let is_named = ["nc", "nc4", "cdf"]
        .iter()
        .any(|ending| ends_with(path, ending));
    #[cfg(feature = "netcdf")]
    let is_sampled = || super::netcdf::holds_samples(path, limits);
    #[cfg(not(feature = "netcdf"))]
    let is_sampled = || {
        let _ = limits;
        false
    };
    is_named && is_sampled()
}

fn ends_with(path: &Path, ending: &str) -> bool {
    path.extension()
        .is_some_and(|found| found.eq_ignore_ascii_case(ending))
}

/// Opens scattered points: PLY, VTP and NumPy arrays by content, else a table, of tabs where the name ends with `.tsv`,
/// of semicolons where the row of names has these and no comma.
///
/// # Errors
/// The file cannot be read, names no columns that make a place and a value, has rows of several lengths, or promises more
/// than there is. The error names the file, the field or line, what was wanted and what was found.
pub fn open_points(
    path: &Path,
    columns: &PointColumns,
    limits: &Limits,
) -> Result<PointFile, ReadError> {
    let first = super::first_bytes(path).map_err(at(path))?;
    if super::npy::recognizes(&first) {
        return match columns.first_named() {
            None => npy::open(path, limits),
            Some(key) => {
                let wanted = "no names: columns of an array have none";
                Err(at(path)(invalid("npy", key, wanted, "one")))
            }
        };
    }
    #[cfg(feature = "netcdf")]
    if super::netcdf::recognizes(&first) || super::hdf5::recognizes(&first) {
        return super::netcdf::open_samples(path, columns, limits);
    }
    if super::ply::recognizes(&first) || ends_with(path, "ply") {
        ply::open(path, columns, limits)
    } else if vtp::recognizes(&first) || ends_with(path, "vtp") {
        vtp::open(path, columns, limits)
    } else {
        table::open(path, delimiter(path, &first), columns, limits)
    }
}

/// What parts the columns of a table: tabs where its name says so, semicolons where its row of names has no comma.
fn delimiter(path: &Path, first: &[u8]) -> u8 {
    if ends_with(path, "tsv") {
        return b'\t';
    }
    let mut lines = first.split(|&byte| byte == b'\n');
    let names = lines.find(|line| !line.is_empty() && !line.starts_with(b"#"));
    match names {
        Some(line) if line.contains(&b';') && !line.contains(&b',') => b';',
        _ => b',',
    }
}

/// Opens an array of rows x, y, z, value and, where there are more, standard deviation and weight.
///
/// # Errors
/// The file cannot be read, is no array of floats of this shape, or is shorter than it promises.
pub fn open_npy(path: &Path, limits: &Limits) -> Result<PointFile, ReadError> {
    npy::open(path, limits)
}

/// The volume of points, of which a selection names the value.
pub(super) fn open(
    path: &Path,
    wanted: &VolumeSelection,
    limits: &Limits,
) -> Result<Box<dyn Source>, ReadError> {
    let columns = PointColumns {
        value: wanted.variable.clone(),
        ..PointColumns::default()
    };
    Ok(Box::new(open_points(path, &columns, limits)?))
}
