//! NRRD and NHDR, versions 1 to 6: a text header, with the voxels behind it or in other files.
//!
//! By the definition of the format, teem.sourceforge.net/nrrd/format.html. Not read: `block` samples, the
//! encoding `zrl`, lists of files with their own skips (`SKIPLIST`).

mod array;
mod fields;
mod files;
mod space;

use super::convert::Endian;
use super::data::{Data, Promise};
use super::decode::Encoding;
use super::file_source::FileSource;
use super::problem::{at, escape, invalid, missing, unsupported};
use crate::volume::{Format, Header, Limits, Problem, ReadError, VoxelType};
use array::Array;
use fields::Fields;
use std::path::Path;

/// The word of errors.
const NRRD: &str = "nrrd";

/// True where a file begins as every NRRD does.
pub(super) fn recognizes(first: &[u8]) -> bool {
    first.starts_with(b"NRRD0")
}

/// Opens a header, attached or detached.
pub(super) fn open(path: &Path, limits: &Limits) -> Result<FileSource, ReadError> {
    let fields = Fields::read(path, limits.max_header_bytes).map_err(at(path))?;
    let array = Array::of(&fields).map_err(at(path))?;
    let stored = stored_type(&fields).map_err(at(path))?;
    let encoding = encoding(&fields).map_err(at(path))?;
    let endian = endian(&fields, stored, encoding).map_err(at(path))?;
    let header = header(&fields, &array, stored).map_err(at(path))?;
    let promise = Promise {
        format: NRRD,
        stored,
        endian,
        encoding,
        parts: files::parts(path, &fields, &array, encoding, limits)?,
        axes: array.axes,
    };
    let data = Data::find(promise, path)?;
    Ok(FileSource::new(path, header, data, limits))
}

fn header(fields: &Fields, array: &Array, stored: VoxelType) -> Result<Header, Problem> {
    let mut notes = array.notes.clone();
    let world_from_voxel = space::affine(fields, array, &mut notes)?;
    if let Some((count, first)) = &fields.unknown {
        notes.push(format!(
            "{count} header lines have fields unknown to the format and are ignored, the first is `{first}`"
        ));
    }
    if let (Some(low), Some(high)) = (fields.get("old min"), fields.get("old max")) {
        let (low, high) = (escape(low), escape(high));
        notes.push(format!(
            "voxels were quantized from {low} to {high}; they are taken as they are stored"
        ));
    }
    let units = fields.get("sample units").unwrap_or("");
    let is_hounsfield =
        units.eq_ignore_ascii_case("hu") || units.to_ascii_lowercase().starts_with("hounsfield");
    // Values of eight bits cannot be Hounsfield units, whatever the modality.
    let may_be_hounsfield = fields.modality_is_ct && stored.bytes() > 1;
    Ok(Header {
        components: array.components,
        times: array.times,
        meaning: array.meaning.clone(),
        hounsfield: is_hounsfield || may_be_hounsfield,
        is_patient: space::is_patient(fields),
        length_metres: space::length_metres(fields),
        notes,
        ..Header::new(Format::Nrrd, array.dims, stored, world_from_voxel)
    })
}

/// The names of section 5 of the definition.
fn stored_type(fields: &Fields) -> Result<VoxelType, Problem> {
    let text = fields.required("type")?;
    let words: Vec<&str> = text.split_ascii_whitespace().collect();
    Ok(match words.join(" ").to_ascii_lowercase().as_str() {
        "signed char" | "int8" | "int8_t" => VoxelType::I8,
        "uchar" | "unsigned char" | "uint8" | "uint8_t" => VoxelType::U8,
        "short" | "short int" | "signed short" | "signed short int" | "int16" | "int16_t" => {
            VoxelType::I16
        }
        "ushort" | "unsigned short" | "unsigned short int" | "uint16" | "uint16_t" => {
            VoxelType::U16
        }
        "int" | "signed int" | "int32" | "int32_t" => VoxelType::I32,
        "uint" | "unsigned int" | "uint32" | "uint32_t" => VoxelType::U32,
        "longlong"
        | "long long"
        | "long long int"
        | "signed long long"
        | "signed long long int"
        | "int64"
        | "int64_t" => VoxelType::I64,
        "ulonglong" | "unsigned long long" | "unsigned long long int" | "uint64" | "uint64_t" => {
            VoxelType::U64
        }
        "float" => VoxelType::F32,
        "double" => VoxelType::F64,
        "block" => return Err(unsupported(NRRD, "type `block`")),
        _ => {
            let wanted = "a type of the format, such as `unsigned char` or `int16`";
            return Err(invalid(NRRD, "type", wanted, text));
        }
    })
}

fn encoding(fields: &Fields) -> Result<Encoding, Problem> {
    let text = fields.required("encoding")?;
    Ok(match text.to_ascii_lowercase().as_str() {
        "raw" => Encoding::Raw,
        "gz" | "gzip" => Encoding::Gzip,
        "bz2" | "bzip2" => Encoding::Bzip2,
        "txt" | "text" | "ascii" => Encoding::Ascii,
        "hex" => Encoding::Hex,
        "zrl" => return Err(unsupported(NRRD, "encoding `zrl`")),
        _ => {
            let wanted = "raw, gzip, bzip2, ascii or hex";
            return Err(invalid(NRRD, "encoding", wanted, text));
        }
    })
}

fn endian(fields: &Fields, stored: VoxelType, encoding: Encoding) -> Result<Endian, Problem> {
    match fields.get("endian").map(str::to_ascii_lowercase).as_deref() {
        Some("little") => Ok(Endian::Little),
        Some("big") => Ok(Endian::Big),
        None if stored.bytes() == 1 || encoding == Encoding::Ascii => Ok(Endian::Little),
        None => Err(missing(NRRD, "endian")),
        Some(text) => Err(invalid(NRRD, "endian", "little or big", text)),
    }
}
