//! HDF5: data sets by their paths, `group/name`.
//!
//! By the HDF5 File Format Specification 3.0, support.hdfgroup.org. The bytes are decoded by the crate
//! `hdf5-reader`, which is young: every call is fenced, and given limits. What a data set's axes are is a
//! convention of programs, not of the format; ours:
//!
//! ```text
//! [y, x]   [z, y, x]   [z, y, x, c] where c <= 4   [t, z, y, x]   [t, z, y, x, c] where c <= 4
//! ```
//!
//! Leading axes of one point are left out. Without a word for one, the data sets of three axes and more are the
//! variables, and where there are none those of two. Three floats a voxel are a vector.
//! Links to other files and raw data in other files are not followed. A NetCDF-4 file is HDF5 too, and is
//! handed on to that reader.

mod arrays;
mod chunks;
mod place;

use super::cf::{Arrays, Grid, Kind, Missing, Role, Variable};
use super::problem::{at, escape, invalid, unsupported};
use crate::volume::{
    ComponentKind, Format, Header, Limits, Problem, ReadError, Source, VolumeSelection, VoxelType,
};
pub(super) use arrays::{Hdf5, problem_of};
pub(super) use chunks::filters;
use std::path::Path;
use std::sync::Arc;

/// The word of errors.
pub(super) const HDF5: &str = "hdf5";

/// The eight bytes that a file begins with, at 0 or behind a user block of 512 bytes and more.
const SIGNATURE: &[u8] = b"\x89HDF\r\n\x1a\n";

/// True where a file begins with HDF5's signature.
pub(super) fn recognizes(first: &[u8]) -> bool {
    let places = [0_usize, 512, 1024, 2048];
    places.into_iter().any(|at| {
        first
            .get(at..)
            .is_some_and(|rest| rest.starts_with(SIGNATURE))
    })
}

/// Opens a data set; of a NetCDF-4 file a variable.
pub(super) fn open(
    path: &Path,
    wanted: &VolumeSelection,
    limits: &Limits,
) -> Result<Box<dyn Source>, ReadError> {
    let (file, file_bytes) = Hdf5::open(path, limits).map_err(at(path))?;
    if file.is_netcdf().map_err(at(path))? {
        return super::netcdf::open_hdf5(path, file, wanted, limits);
    }
    let file = file.listed(limits).map_err(at(path))?;
    let grid = grid(file, file_bytes, wanted, limits).map_err(at(path))?;
    Ok(Box::new(grid))
}

fn grid(
    file: Hdf5,
    file_bytes: u64,
    wanted: &VolumeSelection,
    limits: &Limits,
) -> Result<Grid, Problem> {
    let (variable, names) = choose(&file, wanted)?;
    let Kind::Numbers(stored) = variable.kind else {
        return Err(unsupported(HDF5, "a data set that holds no numbers"));
    };
    let roles = roles(&variable)?;
    let size = |role: Role| {
        let found = roles.iter().position(|&other| other == role);
        let size = found.and_then(|at| variable.dimensions.get(at));
        let size = size.map_or(1, |dimension| dimension.size);
        u32::try_from(size)
            .ok()
            .filter(|&size| size > 0)
            .ok_or_else(|| {
                let field = format!("dimensions of {}", escape(&variable.name));
                let wanted = "1 to 2^32 - 1 points along each axis";
                invalid(HDF5, &field, wanted, &size.to_string())
            })
    };
    let dims = [
        size(Role::Space(0))?,
        size(Role::Space(1))?,
        size(Role::Space(2))?,
    ];
    let components = size(Role::Component)?;
    let (world_from_voxel, mut notes) = place::place(&variable)?;
    if let Some(scale) = variable.attributes.number("realWorldMapping_scale") {
        notes.push(format!(
            "values are as stored: the attribute realWorldMapping_scale, {scale}, is not applied"
        ));
    }
    if !stored.is_kept_exactly() {
        notes.push(format!(
            "voxels are stored as {} and kept as f32",
            stored.name()
        ));
    }
    let unit = ["units", "unit"]
        .iter()
        .find_map(|name| variable.attributes.text(name));
    let header = Header {
        components,
        times: size(Role::Time)?,
        meaning: meaning(&variable, stored, components),
        unit: unit.map(str::to_owned),
        long_name: variable.attributes.text("long_name").map(str::to_owned),
        length_metres: variable.attributes.numbers("element_size_um").map(|_| 1e-3),
        variables: names,
        notes,
        ..Header::new(Format::Hdf5, dims, stored, world_from_voxel)
    };
    let grid = Grid {
        arrays: Arc::new(file),
        variable,
        roles,
        header,
        read_as: stored,
        missing: Missing::NONE,
        max_bytes: limits.max_bytes,
    };
    grid.new_checked(file_bytes)
}

/// The data set to read, and the names of all, that one first.
fn choose(file: &Hdf5, wanted: &VolumeSelection) -> Result<(Variable, Vec<String>), Problem> {
    let of_rank = |least: usize| -> Vec<&Variable> {
        let all = file.variables().iter();
        all.filter(|variable| {
            matches!(variable.kind, Kind::Numbers(_)) && long_axes(variable) >= least
        })
        .collect()
    };
    let mut drawable = of_rank(3);
    if drawable.is_empty() {
        drawable = of_rank(2);
    }
    let there: Vec<&str> = drawable
        .iter()
        .map(|variable| variable.name.as_str())
        .collect();
    let (variable, asked) = match &wanted.variable {
        Some(asked) => {
            let plain = asked.trim_start_matches('/');
            let found = file
                .variables()
                .iter()
                .find(|variable| variable.name == plain);
            let found = found.ok_or_else(|| {
                let wanted = format!("one of {}", escape(&there.join(", ")));
                invalid(HDF5, "data set", wanted, asked)
            })?;
            (found, asked.clone())
        }
        None => {
            let first = drawable.first().copied().ok_or_else(|| {
                let wanted = "a data set of numbers with at least two axes";
                invalid(HDF5, "data sets", wanted, "none")
            })?;
            (first, first.name.clone())
        }
    };
    let others = drawable.iter().filter(|other| other.name != variable.name);
    let names = std::iter::once(asked)
        .chain(others.map(|other| other.name.clone()))
        .collect();
    Ok((variable.clone(), names))
}

/// Axes of more than one point.
fn long_axes(variable: &Variable) -> usize {
    let sizes = variable.dimensions.iter().map(|dimension| dimension.size);
    if sizes.clone().any(|size| size == 0) {
        return 0;
    }
    sizes.filter(|&size| size > 1).count()
}

/// The largest last axis that is components.
const MOST_COMPONENTS: u64 = 4;

/// What each axis is, slowest first.
fn roles(variable: &Variable) -> Result<Vec<Role>, Problem> {
    let sizes: Vec<u64> = variable
        .dimensions
        .iter()
        .map(|dimension| dimension.size)
        .collect();
    let is_components = sizes.last().is_some_and(|&size| size <= MOST_COMPONENTS);
    let [x, y, z] = [Role::Space(0), Role::Space(1), Role::Space(2)];
    let inner = |rank: usize| -> Option<Vec<Role>> {
        Some(match rank {
            2 => vec![y, x],
            3 => vec![z, y, x],
            4 if is_components => vec![z, y, x, Role::Component],
            4 => vec![Role::Time, z, y, x],
            5 if is_components => vec![Role::Time, z, y, x, Role::Component],
            _ => return None,
        })
    };
    let mut dropped = 0_usize;
    let mut rest = sizes.as_slice();
    loop {
        let rank = rest.len();
        let fits = inner(rank);
        match rest.split_first() {
            // Leading axes of one point say nothing where those behind them are enough.
            Some((1, behind)) if rank > 3 => {
                dropped = dropped.saturating_add(1);
                rest = behind;
            }
            _ => {
                let fixed = std::iter::repeat_n(Role::Fixed(0), dropped);
                return fits.map(|roles| fixed.chain(roles).collect()).ok_or_else(|| {
                    let what = format!(
                        "a data set of sizes {sizes:?}: axes are [t, z, y, x, c], c at most {MOST_COMPONENTS}, and it"
                    );
                    unsupported(HDF5, what)
                });
            }
        }
    }
}

/// What the components are, where the file (or their number) says so. HDF5 Image and Palette Specification 1.2:
/// attributes `CLASS` and `IMAGE_SUBCLASS`.
fn meaning(variable: &Variable, stored: VoxelType, components: u32) -> ComponentKind {
    let is_true_color = variable.attributes.text("IMAGE_SUBCLASS") == Some("IMAGE_TRUECOLOR");
    match components {
        3 if is_true_color => ComponentKind::Rgb,
        4 if is_true_color => ComponentKind::Rgba,
        3 if stored.is_float() => ComponentKind::Vector,
        _ => ComponentKind::Numbers,
    }
}
