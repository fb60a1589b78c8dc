//! Points of VTK PolyData in XML, `.vtp`: places, and one of the arrays of point data as the value.
//!
//! The markup and the numbers are those of `.vti`. A file with polygons or strips is a surface, refused by name; lines and
//! vertices are not looked at.

use super::PointColumns;
use super::gathered::{Columns, Gathered};
use super::numbers;
use super::quantity::without_unit;
use super::roles::{Column, Roles, Table};
use super::source::{Names, PointFile};
use crate::format::file_source::FileSource;
use crate::format::problem::{at, escape, invalid, missing, unsupported};
use crate::format::select::{Axis, Role};
use crate::format::vti;
use crate::format::vti::payload::{self, Binary};
use crate::format::vti::xml::{self, Document, Element};
use crate::volume::{Format, Header, Limits, Problem, ReadError};
use glam::DAffine3;
use std::path::Path;

/// The word of errors.
const VTP: &str = "vtp";

/// What the coordinates of places are called here.
const COORDINATES: [&str; 3] = ["x", "y", "z"];

/// True where a file begins as PolyData in XML.
pub(in crate::format) fn recognizes(first: &[u8]) -> bool {
    let is_of_points = |word: &[u8]| word == b"type=\"PolyData\"" || word == b"type='PolyData'";
    vti::recognizes(first) && first.windows(15).any(is_of_points)
}

/// Opens the points of all pieces.
pub(super) fn open(
    path: &Path,
    wanted: &PointColumns,
    limits: &Limits,
) -> Result<PointFile, ReadError> {
    let document = xml::read(path, limits.max_header_bytes).map_err(at(path))?;
    let binary = Binary::of(&document.root).map_err(at(path))?;
    let pieces = pieces(&document).map_err(at(path))?;
    let first = pieces
        .first()
        .ok_or_else(|| at(path)(missing(VTP, "Piece")))?;
    let names = names(first.element);
    let roles = Roles::of(
        &Table {
            format: VTP,
            names: &names,
            are_numbers: &vec![true; names.len()],
        },
        wanted,
    );
    let roles = roles.map_err(at(path))?;
    if roles.places != [0, 1, 2] {
        let found = names.get(3..).unwrap_or_default().join(", ");
        let wanted = "places that are those of the points";
        return Err(at(path)(invalid(VTP, "x, y, z", wanted, &found)));
    }
    let file = PolyData {
        path,
        document: &document,
        binary,
        limits,
    };
    let std = roles.std.as_ref();
    let std_unit = std.and_then(|column| without_unit(&column.name).1);
    let mut gathered = Gathered::new(VTP, roles.axes.clone(), std_unit, limits);
    for piece in &pieces {
        file.gather(piece, &roles, &mut gathered)?;
    }
    let names = Names {
        value: roles.value.name,
        others: roles.others,
        notes: Vec::new(),
    };
    PointFile::new(path, Format::Vtp, gathered, names, limits)
}

struct Piece<'a> {
    element: &'a Element,
    points: u32,
}

/// The pieces that hold points.
fn pieces(document: &Document) -> Result<Vec<Piece<'_>>, Problem> {
    let root = &document.root;
    match root.get("type") {
        Some("PolyData") if root.name == "VTKFile" => {}
        found => {
            let wanted = "a VTKFile of PolyData";
            return Err(invalid(VTP, "type", wanted, found.unwrap_or("nothing")));
        }
    }
    let data = root.all("PolyData").next();
    let data = data.ok_or_else(|| missing(VTP, "PolyData"))?;
    let mut pieces = Vec::new();
    for element in data.all("Piece") {
        for surfaces in ["NumberOfPolys", "NumberOfStrips"] {
            if count(element, surfaces)?.unwrap_or(0) > 0 {
                return Err(unsupported(
                    VTP,
                    "a mesh (PolyData with polygons or strips)",
                ));
            }
        }
        let points = count(element, "NumberOfPoints")?;
        let points = points.ok_or_else(|| missing(VTP, "NumberOfPoints"))?;
        if points > 0 {
            pieces.push(Piece { element, points });
        }
    }
    Ok(pieces)
}

fn count(element: &Element, name: &str) -> Result<Option<u32>, Problem> {
    let Some(text) = element.get(name) else {
        return Ok(None);
    };
    let count = text.trim().parse().ok();
    let count = count.ok_or_else(|| invalid(VTP, name, "a number below 2^32", text))?;
    Ok(Some(count))
}

/// Coordinates, and the arrays of one number a point; the one that the file calls its scalars comes first.
fn names(piece: &Element) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for data in piece.all("PointData") {
        for array in data.all("DataArray").filter(|array| is_scalar(array)) {
            let name = array.get("Name").unwrap_or("");
            let (stem, _) = without_unit(name);
            let is_coordinate = COORDINATES.iter().any(|c| c.eq_ignore_ascii_case(stem));
            if name.is_empty() || is_coordinate {
                continue;
            }
            match data.get("Scalars") == Some(name) {
                true => names.insert(0, name.to_owned()),
                false => names.push(name.to_owned()),
            }
        }
    }
    let coordinates = COORDINATES.map(str::to_owned).into_iter();
    coordinates.chain(names).collect()
}

fn is_scalar(array: &Element) -> bool {
    array.get("NumberOfComponents").unwrap_or("1").trim() == "1"
        && !matches!(array.get("type"), Some("String" | "Bit"))
}

/// What is the same for all pieces.
struct PolyData<'a> {
    path: &'a Path,
    document: &'a Document,
    binary: Binary,
    limits: &'a Limits,
}

impl PolyData<'_> {
    fn gather(
        &self,
        piece: &Piece,
        roles: &Roles,
        gathered: &mut Gathered,
    ) -> Result<(), ReadError> {
        let places = piece.element.all("Points").next();
        let places = places.and_then(|points| points.all("DataArray").next());
        let places = places.ok_or_else(|| at(self.path)(missing(VTP, "DataArray of Points")))?;
        let components = places.get("NumberOfComponents").unwrap_or("1");
        if components.trim() != "3" {
            let field = "NumberOfComponents";
            return Err(at(self.path)(invalid(
                VTP,
                field,
                "3 for Points",
                components,
            )));
        }
        let places = self.source(places, 3, piece.points)?;
        let coordinate = |index: u32| numbers::component(&places, index);
        let optional = |column: &Option<Column>| match column {
            Some(column) => self.array(piece, column).map(Some),
            None => Ok(None),
        };
        let columns = Columns {
            place: [coordinate(0)?, coordinate(1)?, coordinate(2)?],
            value: self.array(piece, &roles.value)?,
            std: optional(&roles.std)?,
            weight: optional(&roles.weight)?,
        };
        gathered.push_columns(&columns).map_err(at(self.path))
    }

    /// The numbers of a named array of a piece.
    fn array(&self, piece: &Piece, column: &Column) -> Result<Vec<f64>, ReadError> {
        let mut all = piece
            .element
            .all("PointData")
            .flat_map(|data| data.all("DataArray"));
        let named = |array: &&Element| array.get("Name") == Some(&column.name) && is_scalar(array);
        let found = all.find(named).ok_or_else(|| {
            let wanted = format!("the array {} in each piece", escape(&column.name));
            at(self.path)(invalid(VTP, "PointData", wanted, "none"))
        })?;
        numbers::component(&self.source(found, 1, piece.points)?, 0)
    }

    /// An array as a line of voxels.
    fn source(
        &self,
        array: &Element,
        components: u32,
        points: u32,
    ) -> Result<FileSource, ReadError> {
        let stored = payload::stored_type(array).map_err(at(self.path))?;
        let header = Header {
            components,
            ..Header::new(Format::Vtp, [points, 1, 1], stored, DAffine3::IDENTITY)
        };
        let axes = vec![
            Axis {
                role: Role::Component,
                size: components.into(),
            },
            Axis {
                role: Role::Space(0),
                size: points.into(),
            },
        ];
        let data = payload::find(self.path, self.document, self.binary, array, axes);
        let data = data.map_err(at(self.path))?;
        Ok(FileSource::new(self.path, header, data, self.limits))
    }
}
