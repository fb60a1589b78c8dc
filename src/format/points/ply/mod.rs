//! Vertices of PLY files, by Turk's description of 1994: `.ply` in words or in bytes of either order.
//!
//! A file with faces is a surface, and one with the properties of Gaussian splats (3DGS) draws by another law: both are refused by
//! name. Elements behind the vertices are not looked at.

mod vertices;

use super::PointColumns;
use super::gathered::Gathered;
use super::quantity::without_unit;
use super::roles::{Roles, Table};
use super::source::{Names, PointFile};
use crate::format::place::open_regular;
use crate::format::ply::{Element, Head, PLY};
use crate::format::problem::{at, missing, unsupported};
use crate::volume::{Format, Limits, Problem, ReadError};
use std::io::BufReader;
use std::path::Path;

/// Properties that say how a Gaussian splat looks.
const OF_SPLATS: [&str; 3] = ["f_dc_0", "scale_0", "rot_0"];

/// Opens vertices.
pub(super) fn open(
    path: &Path,
    wanted: &PointColumns,
    limits: &Limits,
) -> Result<PointFile, ReadError> {
    let (gathered, names) = gathered(path, wanted, limits).map_err(at(path))?;
    PointFile::new(path, Format::Ply, gathered, names, limits)
}

fn gathered(
    path: &Path,
    wanted: &PointColumns,
    limits: &Limits,
) -> Result<(Gathered, Names), Problem> {
    let (file, _) = open_regular(path)?;
    let head = Head::read(BufReader::new(file), limits.max_header_bytes)?;
    let vertices = vertices_of(&head)?;
    let names: Vec<String> = vertices.properties.iter().map(|p| p.name.clone()).collect();
    let roles = Roles::of(
        &Table {
            format: PLY,
            names: &names,
            are_numbers: &vec![true; names.len()],
        },
        wanted,
    )?;
    let std = roles.std.as_ref();
    let std_unit = std.and_then(|column| without_unit(&column.name).1);
    let mut gathered = Gathered::new(PLY, roles.axes.clone(), std_unit, limits);
    vertices::read(path, &head, vertices, &roles, limits, &mut gathered)?;
    let names = Names {
        value: roles.value.name,
        others: roles.others,
        notes: Vec::new(),
    };
    Ok((gathered, names))
}

/// The element of vertices, of a file that is a set of points.
fn vertices_of(head: &Head) -> Result<&Element, Problem> {
    if head.has_faces() {
        return Err(unsupported(PLY, "a mesh (a file with faces)"));
    }
    let mut all = head.elements.iter();
    let vertices = all.find(|element| element.name == "vertex");
    let vertices = vertices.ok_or_else(|| missing(PLY, "element vertex"))?;
    let has = |name: &&str| vertices.properties.iter().any(|p| p.name == *name);
    if OF_SPLATS.iter().all(has) {
        let what = "a scene of Gaussian splats (3DGS, with f_dc_0, scale_0 and rot_0)";
        return Err(unsupported(PLY, what));
    }
    if vertices.bytes().is_none() {
        return Err(unsupported(PLY, "a list as a property of vertices"));
    }
    Ok(vertices)
}
