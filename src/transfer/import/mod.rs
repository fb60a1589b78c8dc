//! Transfer functions of other programs, told apart by what stands in the file, not by its name.
//!
//! | file | what it is |
//! |---|---|
//! | JSON with `volumeProperties` | 3D Slicer volume property, schema version 1 |
//! | text of nine lines and more, the first six one number each | 3D Slicer `.vp` |
//! | XML with `VolumeProperty` | 3D Slicer `presets.xml` or scene (MRML) |
//! | JSON with `RGBPoints`, XML `ColorMap` | ParaView colour map |
//! | XML `Points` of `pos` and `rgba` | Inviwo `.itf` |
//! | XML `VoreenData` | Voreen `.tfi` |
//! | XML `MapperFunctionParams` | VAPOR `.tf3` |
//! | rows `x r g b`, `x a` or `x r g b a` | points of VTK's piecewise functions, as scripts keep them |
//!
//! What a file says beyond colour and opacity of a value is named in [`Imported::left_out`].

mod color;
mod draft;
mod inviwo;
mod paraview;
mod rows;
mod slicer;
mod slicer_json;
mod vapor;
mod voreen;
mod xml;

use super::file::{MAX_FILE_BYTES, read_limited, transfer_function_in};
use super::{FileError, FileProblem, TransferFunction};
use serde_json::Value;
use std::path::Path;

/// A function from a file of this or another program.
#[derive(Clone, Debug, PartialEq)]
pub struct Imported {
    /// Colour and opacity.
    pub function: TransferFunction,
    /// What the file is, as in "a ParaView colour map".
    pub origin: &'static str,
    /// The name that the file gives the function.
    pub name: Option<String>,
    /// What the points of the function stand at.
    pub scale: Scale,
    /// What the file says that is not in the function, one piece each.
    pub left_out: Vec<String>,
    /// True where the file asks for pre-integrated classification.
    pub preintegrated: bool,
}

/// What the points of a function stand at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Values of the volume, after rescale.
    Values,
    /// Fractions of an interval of values: 0 its low end, 1 its high end.
    Fractions,
}

/// The function in the file at `path`, ours or another program's; `wanted` is its name, where a file holds several.
pub fn import_transfer_function(path: &Path, wanted: Option<&str>) -> Result<Imported, FileError> {
    let of_file = |problem| FileError {
        path: path.to_owned(),
        problem,
    };
    let bytes = read_limited(path).map_err(of_file)?;
    from_bytes(&bytes, wanted, path.parent()).map_err(of_file)
}

/// The function that these bytes of a file state.
pub fn transfer_function_from_bytes(
    bytes: &[u8],
    wanted: Option<&str>,
) -> Result<Imported, FileProblem> {
    from_bytes(bytes, wanted, None)
}

/// The same of a file in `folder`.
fn from_bytes(
    bytes: &[u8],
    wanted: Option<&str>,
    folder: Option<&Path>,
) -> Result<Imported, FileProblem> {
    if bytes.len() as u64 > MAX_FILE_BYTES {
        return Err(FileProblem::TooLong);
    }
    let text = String::from_utf8_lossy(bytes);
    let text = text.trim_start_matches('\u{feff}').trim_start();
    match text.chars().next() {
        Some('{' | '[') => from_json(text, wanted, folder),
        Some('<') => from_xml(text, wanted),
        _ if slicer::is_vp(text) => slicer::vp(text),
        _ => rows::read(text),
    }
}

fn from_json(
    text: &str,
    wanted: Option<&str>,
    folder: Option<&Path>,
) -> Result<Imported, FileProblem> {
    let value: Value =
        serde_json::from_str(text).map_err(|cause| FileProblem::Json(cause.to_string()))?;
    if value.get("volumeProperties").is_some() {
        return slicer_json::read(&value);
    }
    let first = value.get(0).unwrap_or(&value);
    if ["RGBPoints", "IndexedColors", "ColorSpace"]
        .iter()
        .any(|key| first.get(key).is_some())
    {
        return paraview::json(&value, wanted);
    }
    // Doubled keys are seen in the text alone; and what is neither is told what ours has.
    let function = transfer_function_in(text.as_bytes(), folder)?;
    Ok(Imported {
        function,
        origin: "a stratavox transfer function",
        name: None,
        scale: Scale::Values,
        left_out: Vec::new(),
        preintegrated: value.get("preintegrated") == Some(&Value::Bool(true)),
    })
}

fn from_xml(text: &str, wanted: Option<&str>) -> Result<Imported, FileProblem> {
    let root = xml::parse(text)?;
    match root.name.as_str() {
        "MapperFunctionParams" => vapor::read(&root),
        "VoreenData" => voreen::read(&root),
        "ColorMap" | "ColorMaps" => paraview::xml(&root, wanted),
        _ if root.find("VolumeProperty").is_some() => slicer::mrml(&root, wanted),
        _ if root.find("rgba").is_some() => inviwo::read(&root),
        name => Err(FileProblem::Unknown(format!(
            "XML that begins with `{name}`"
        ))),
    }
}

/// The one of several things that `wanted` names, or the only one.
fn choose<'a, T>(
    origin: &'static str,
    all: &'a [T],
    name: impl Fn(&T) -> Option<String>,
    wanted: Option<&str>,
) -> Result<&'a T, FileProblem> {
    let names = || all.iter().filter_map(&name).collect::<Vec<_>>().join(", ");
    let refused = |problem| Err(FileProblem::Foreign { origin, problem });
    match (all, wanted) {
        ([], _) => refused("it holds no transfer function".to_owned()),
        (_, Some(wanted)) => match all.iter().find(|one| name(one).as_deref() == Some(wanted)) {
            Some(found) => Ok(found),
            None => refused(format!("none is named {wanted:?}; there are {}", names())),
        },
        ([only], None) => Ok(only),
        (_, None) => refused(format!("it holds several, choose one by name: {}", names())),
    }
}
