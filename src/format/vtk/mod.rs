//! Legacy VTK files, `.vtk`: a header of text lines, then arrays in words or big-endian bytes.
//!
//! By "VTK Legacy Formats", docs.vtk.org/en/latest/vtk_file_formats/vtk_legacy_file_format.html, and where it is
//! silent by what VTK's reader does: a field's name is percent-encoded, `METADATA` goes on to an empty line,
//! `vtkIdType` has four bytes and `long` eight. Only `STRUCTURED_POINTS` lie on a regular lattice; other data
//! sets are refused by name.

pub(super) mod array;
mod header;
mod scan;
mod sections;

use super::convert::Endian;
use super::data::{Data, FoundPart};
use super::decode::Encoding;
use super::file_source::FileSource;
use super::geometry::world_from_voxel;
use super::problem::{at, invalid};
use super::select::{Axis, Role};
use crate::volume::{Format, Header, Limits, Problem, ReadError, Source, VolumeSelection};
use array::Attribute;
use glam::{DMat3, DVec3};
use header::Lattice;
use scan::Scan;
use sections::{Section, Sections};
use std::path::Path;

/// The word of errors.
const VTK: &str = "vtk";

/// What is said of every VTK file.
pub(super) const AS_THEY_STAND: &str =
    "VTK files name no patient directions: the axes are taken as RAS+ as they stand";

/// True where a file begins with the first line of a legacy file.
pub(super) fn recognizes(first: &[u8]) -> bool {
    first.trim_ascii_start().starts_with(b"# vtk DataFile")
}

/// Opens structured points.
pub(super) fn open(
    path: &Path,
    wanted: &VolumeSelection,
    limits: &Limits,
) -> Result<Box<dyn Source>, ReadError> {
    let mut scan = Scan::open(path, limits.max_header_bytes).map_err(at(path))?;
    let lattice = Lattice::read(&mut scan).map_err(at(path))?;
    let sections = sections::read(&mut scan, &lattice).map_err(at(path))?;
    let (header, data) =
        taken(path, &lattice, sections, wanted, scan.is_binary).map_err(at(path))?;
    Ok(Box::new(FileSource::new(path, header, data, limits)))
}

/// The wanted array, and what is said about it.
fn taken(
    path: &Path,
    lattice: &Lattice,
    sections: Sections,
    wanted: &VolumeSelection,
    is_binary: bool,
) -> Result<(Header, Data), Problem> {
    let described: Vec<array::Array> = sections.all.iter().map(|s| s.array.clone()).collect();
    let names = array::names(&described);
    let chosen = array::choose(&described, &names, wanted, VTK)?;
    let section = sections.all.into_iter().nth(chosen);
    let Section {
        array,
        stored,
        start,
        end,
    } = section.ok_or_else(|| super::problem::missing(VTK, "POINT_DATA"))?;
    let mut notes = vec![AS_THEY_STAND.to_owned()];
    notes.extend(sections.notes);
    let dims = lattice.dims(array.of_cells);
    let affine = affine(lattice, array.of_cells)?;
    if array.of_cells {
        notes.push("the numbers belong to cells: voxels are the cells between points".to_owned());
    }
    let header = Header {
        components: array.components,
        meaning: array.meaning(stored),
        variables: array::chosen_first(names, chosen),
        time_names: sections
            .time
            .map(|time| time.to_string())
            .into_iter()
            .collect(),
        notes,
        ..Header::new(Format::Vtk, dims, stored, affine)
    };
    let component = Axis {
        role: Role::Component,
        size: array.components.into(),
    };
    let space = dims.into_iter().enumerate().map(|(k, size)| Axis {
        role: Role::Space(k),
        size: size.into(),
    });
    let axes: Vec<Axis> = std::iter::once(component).chain(space).collect();
    let data = Data {
        format: VTK,
        stored,
        endian: if is_binary {
            Endian::Big
        } else {
            Endian::Little
        },
        encoding: match (is_binary, array.attribute) {
            (true, _) => Encoding::Raw,
            // VTK writes colors in words as fractions, and all scalars of bytes as colors.
            (false, Attribute::Colors) => Encoding::Fractions,
            (false, _) => Encoding::Ascii,
        },
        part_bytes: sections::bytes(&axes, stored)?,
        axes,
        parts: vec![FoundPart {
            path: path.to_owned(),
            offset: start,
            encoded_bytes: end.saturating_sub(start),
            skip_bytes: 0,
        }],
        notes: Vec::new(),
    };
    Ok((header, data))
}

/// As in [`super::vti`]: points at `origin + spacing * index`, cells half a spacing on.
#[allow(
    clippy::arithmetic_side_effects,
    reason = "vectors of f64: nothing wraps or panics"
)]
fn affine(lattice: &Lattice, of_cells: bool) -> Result<glam::DAffine3, Problem> {
    let spacing = DVec3::from_array(lattice.spacing);
    let mut first = DVec3::from_array(lattice.origin);
    let is_deep = lattice.points.map(|n| if n > 1 { 1.0 } else { 0.0 });
    if of_cells {
        first += spacing * DVec3::from_array(is_deep) * 0.5;
    }
    let steps = DMat3::from_diagonal(spacing);
    let columns = [steps.x_axis, steps.y_axis, steps.z_axis];
    world_from_voxel(columns, first).ok_or_else(|| {
        let [x, y, z] = lattice.spacing;
        let found = format!("{x} {y} {z}");
        invalid(VTK, "SPACING", "lengths that span a volume", &found)
    })
}
