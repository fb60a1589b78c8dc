//! VTK ImageData in XML, `.vti`: points or cells of a regular lattice with named arrays.
//!
//! By "VTK XML Formats", docs.vtk.org/en/latest/vtk_file_formats/vtkxml_file_format.html, and where it is silent by
//! what VTK's reader does. Numbers stand in words, in base64 or as bytes behind the markup, whole or in blocks of
//! zlib or LZ4; LZMA is refused. Unlike there, a file that lost its end is an error.

mod arrays;
mod lattice;
pub(super) mod payload;
pub(super) mod xml;

use super::data::Data;
use super::file_source::FileSource;
use super::pieces::Pieces;
use super::problem::{at, escape, invalid, missing, unsupported};
use super::select::{Axis, Role};
use super::vtk::AS_THEY_STAND;
use crate::volume::{
    Format, Header, Limits, Problem, ReadError, Source, VolumeSelection, VoxelBox,
};
use lattice::Extent;
use payload::Binary;
use std::path::Path;
use xml::{Document, Element};

/// The word of errors.
const VTI: &str = "vti";

/// True where a file begins with the markup of a VTK file, of any data set.
pub(super) fn recognizes(first: &[u8]) -> bool {
    let first = first.strip_prefix(b"\xef\xbb\xbf").unwrap_or(first);
    let text = first.trim_ascii_start();
    text.starts_with(b"<") && text.windows(8).any(|word| word == b"<VTKFile")
}

/// Opens an image of one or several pieces.
pub(super) fn open(
    path: &Path,
    wanted: &VolumeSelection,
    limits: &Limits,
) -> Result<Box<dyn Source>, ReadError> {
    let document = xml::read(path, limits.max_header_bytes).map_err(at(path))?;
    let image = image(&document).map_err(at(path))?;
    let binary = Binary::of(&document.root).map_err(at(path))?;
    let lie = || invalid(VTI, "WholeExtent", "at least one point", "none");
    let whole = Extent::of(image, "WholeExtent")
        .and_then(|extent| extent.ok_or_else(lie))
        .map_err(at(path))?;
    let pieces = pieces(image).map_err(at(path))?;
    let first = pieces.first().map(|(_, element)| *element);
    let first = first.ok_or_else(|| at(path)(missing(VTI, "Piece")))?;
    let found = arrays::find(first, wanted).map_err(at(path))?;
    let stored = payload::stored_type(found.element).map_err(at(path))?;

    let of_cells = found.array.of_cells;
    let mut notes = vec![AS_THEY_STAND.to_owned()];
    notes.extend(found.notes.iter().cloned());
    let affine = lattice::affine(image, whole, of_cells, &mut notes).map_err(at(path))?;
    if of_cells {
        notes.push("the numbers belong to cells: voxels are the cells between points".to_owned());
    }
    let header = Header {
        components: found.array.components,
        meaning: found.array.meaning(stored),
        variables: found.names.clone(),
        time_names: time_name(path, &document, image, binary),
        notes,
        ..Header::new(Format::Vti, whole.dims(of_cells), stored, affine)
    };
    let mut parts = Vec::new();
    for (extent, element) in &pieces {
        let place = whole.place(*extent, of_cells).ok_or_else(|| {
            let wanted = "an extent inside WholeExtent, with cells if cells are wanted";
            let text = element.get("Extent").unwrap_or("");
            at(path)(invalid(VTI, "Piece Extent", wanted, text))
        })?;
        let array = found.same_in(element).map_err(at(path))?;
        let axes = axes(header.components, place.dims());
        let data = payload::find(path, &document, binary, array, axes).map_err(at(path))?;
        parts.push((place, data));
    }
    sources(path, header, parts, limits)
}

/// One source, or one over several.
fn sources(
    path: &Path,
    header: Header,
    mut parts: Vec<(VoxelBox, Data)>,
    limits: &Limits,
) -> Result<Box<dyn Source>, ReadError> {
    if let [(place, _)] = parts.as_slice()
        && *place == header.whole()
        && let Some((_, data)) = parts.pop()
    {
        return Ok(Box::new(FileSource::new(path, header, data, limits)));
    }
    let pieces = parts.into_iter().map(|(place, data)| {
        let part = Header {
            components: header.components,
            ..Header::new(
                Format::Vti,
                place.dims(),
                header.stored,
                header.world_from_voxel,
            )
        };
        let source: Box<dyn Source> = Box::new(FileSource::new(path, part, data, limits));
        (place, source)
    });
    let pieces = pieces.collect();
    Ok(Box::new(
        Pieces::new(path, header, pieces, limits).map_err(at(path))?,
    ))
}

/// The element of the data set, if it is one that we read.
fn image(document: &Document) -> Result<&Element, Problem> {
    let root = &document.root;
    if root.name != "VTKFile" {
        return Err(invalid(VTI, "markup", "VTKFile as the root", &root.name));
    }
    match root.required("type")? {
        "ImageData" => {}
        "PImageData" => {
            let what = "PImageData (a .pvti file, whose pieces are files of their own)";
            return Err(unsupported(VTI, what));
        }
        "RectilinearGrid" => {
            return Err(unsupported(VTI, "RectilinearGrid (unequal distances)"));
        }
        "UnstructuredGrid" | "PUnstructuredGrid" => return Err(Problem::Unstructured),
        text => {
            let what = format!("the data set `{}`, not ImageData,", escape(text));
            return Err(unsupported(VTI, what));
        }
    }
    let image = root.all("ImageData").next();
    let image = image.ok_or_else(|| missing(VTI, "ImageData"))?;
    if image.get("TimeValues").is_some() {
        return Err(unsupported(VTI, "several times in one file (TimeValues)"));
    }
    Ok(image)
}

/// The pieces that hold something.
fn pieces(image: &Element) -> Result<Vec<(Extent, &Element)>, Problem> {
    let all = image.all("Piece");
    let each = all.map(|piece| Ok(Extent::of(piece, "Extent")?.map(|extent| (extent, piece))));
    each.filter_map(Result::transpose).collect()
}

/// The stored array of a piece: the numbers of a voxel stand together.
fn axes(components: u32, dims: [u32; 3]) -> Vec<Axis> {
    let component = Axis {
        role: Role::Component,
        size: components.into(),
    };
    let space = dims.into_iter().enumerate().map(|(k, size)| Axis {
        role: Role::Space(k),
        size: size.into(),
    });
    std::iter::once(component).chain(space).collect()
}

/// `TimeValue` of the field data, if it is there.
fn time_name(path: &Path, document: &Document, image: &Element, binary: Binary) -> Vec<String> {
    let fields = image.all("FieldData").chain(document.root.all("FieldData"));
    let arrays = fields.flat_map(|field| field.all("DataArray"));
    let times = arrays.filter(|array| array.get("Name") == Some("TimeValue"));
    times
        .filter_map(|array| payload::one_number(path, document, binary, array))
        .map(|time| time.to_string())
        .take(1)
        .collect()
}
