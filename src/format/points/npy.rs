//! NumPy arrays of points, `[N, 4]` to `[N, 6]`: x, y, z, value, standard deviation, weight.

use super::gathered::{Columns, Gathered};
use super::numbers;
use super::place::Axes;
use super::source::{Names, PointFile};
use crate::format::file_source::FileSource;
use crate::format::npy::{NPY, Plain};
use crate::format::problem::{at, invalid};
use crate::format::select::{Axis, Role};
use crate::volume::{Format, Header, Limits, Problem, ReadError, VoxelType};
use glam::DAffine3;
use std::path::Path;

/// Opens an array of f32 or f64.
pub(super) fn open(path: &Path, limits: &Limits) -> Result<PointFile, ReadError> {
    let plain = Plain::open(path, limits).map_err(at(path))?;
    let [count, columns] = shape(&plain).map_err(at(path))?;
    let of_points = Axis {
        role: Role::Space(0),
        size: count.into(),
    };
    let of_columns = Axis {
        role: Role::Component,
        size: columns.into(),
    };
    // As they lie in memory, the fastest first.
    let axes = match plain.fortran_order {
        true => vec![of_points, of_columns],
        false => vec![of_columns, of_points],
    };
    let header = Header {
        components: columns,
        ..Header::new(Format::Npy, [count, 1, 1], plain.stored, DAffine3::IDENTITY)
    };
    let data = plain.data(path, axes)?;
    let source = FileSource::new(path, header, data, limits);
    let mut gathered = Gathered::new(NPY, Axes::plain(), None, limits);
    let column = |index: u32| numbers::component(&source, index);
    let optional = |index: u32| match index < columns {
        true => column(index).map(Some),
        false => Ok(None),
    };
    let columns_of_file = Columns {
        place: [column(0)?, column(1)?, column(2)?],
        value: column(3)?,
        std: optional(4)?,
        weight: optional(5)?,
    };
    gathered.push_columns(&columns_of_file).map_err(at(path))?;
    let names = Names {
        value: String::new(),
        others: Vec::new(),
        notes: vec![format!(
            "the columns of the array are taken as {}",
            ["x", "y", "z", "value", "standard deviation", "weight"]
                .into_iter()
                .zip(0..columns)
                .map(|(name, _)| name)
                .collect::<Vec<_>>()
                .join(", ")
        )],
    };
    PointFile::new(path, Format::Npy, gathered, names, limits)
}

/// Points and columns.
fn shape(plain: &Plain) -> Result<[u32; 2], Problem> {
    let sizes = match plain.shape.as_slice() {
        [count, columns] => u32::try_from(*count).ok().zip(u32::try_from(*columns).ok()),
        _ => None,
    };
    let [count, columns] = sizes
        .filter(|(count, columns)| *count > 0 && (4..=6).contains(columns))
        .map(|(count, columns)| [count, columns])
        .ok_or_else(|| {
            let wanted = "a table of points, (N, 4) to (N, 6)";
            invalid(NPY, "shape", wanted, &plain.shape_text())
        })?;
    if !matches!(plain.stored, VoxelType::F32 | VoxelType::F64) {
        let wanted = "points of f32 or f64";
        return Err(invalid(NPY, "descr", wanted, plain.stored.name()));
    }
    Ok([count, columns])
}
