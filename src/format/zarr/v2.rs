//! Version 2: `.zarray`, and the names that numcodecs gives its codecs.
//!
//! zarr-specs.readthedocs.io/en/latest/v2/v2.0.html; numcodecs.readthedocs.io for the configuration of each codec.

use super::array::{Array, Codecs, Fill, Keys, not_read};
use super::codec::{Codec, Delta};
use super::json::{Object, optional, required, sizes, text, words, wrong};
use crate::format::convert::Endian;
use crate::volume::{Limits, Problem, VoxelType};
use serde_json::Value;

/// The array that a `.zarray` and a `.zattrs` describe.
pub(super) fn array(
    path: &str,
    metadata: &Object,
    attributes: Object,
    limits: &Limits,
) -> Result<Array, Problem> {
    let version = required(metadata, "zarr_format")?;
    if version.as_u64() != Some(2) {
        return Err(wrong("zarr_format", "2", version));
    }
    let shape = sizes(required(metadata, "shape")?, "shape")?;
    let dtype = required(metadata, "dtype")?;
    let (stored, endian) = match dtype {
        Value::String(dtype) => number_type(dtype)?,
        _ => return Err(not_read("the structured dtype", &dtype.to_string())),
    };
    let rank = shape.len();
    let order = match text(metadata, "order")? {
        "C" => (0..rank).collect(),
        "F" => (0..rank).rev().collect(),
        _ => {
            let found = required(metadata, "order")?;
            return Err(wrong("order", "C or F", found));
        }
    };
    let separator = match optional(metadata, "dimension_separator") {
        None => '.',
        Some(value) => match value.as_str() {
            Some(".") => '.',
            Some("/") => '/',
            _ => return Err(wrong("dimension_separator", "`.` or `/`", value)),
        },
    };
    let mut bytes = Vec::new();
    if let Some(filters) = optional(metadata, "filters") {
        let list = filters.as_array();
        let list = list.ok_or_else(|| wrong("filters", "a list or null", filters))?;
        for filter in list {
            bytes.push(filter_codec(filter, stored, endian)?);
        }
    }
    if let Some(compressor) = optional(metadata, "compressor") {
        bytes.push(codec(compressor, "compressor")?);
    }
    let array = Array {
        path: path.to_owned(),
        stored,
        chunk: sizes(required(metadata, "chunks")?, "chunks")?,
        keys: Keys {
            prefixed: false,
            separator,
        },
        codecs: Codecs {
            order,
            endian,
            bytes,
        },
        shards: None,
        fill: Fill::of(metadata.get("fill_value").unwrap_or(&Value::Null), stored)?,
        dimension_names: attributes.get("_ARRAY_DIMENSIONS").and_then(words),
        shape,
        attributes,
    };
    array.check(limits)
}

/// NumPy's word for a type: byte order, kind, bytes.
fn number_type(dtype: &str) -> Result<(VoxelType, Endian), Problem> {
    let endian = match dtype.chars().next() {
        Some('>') => Endian::Big,
        _ => Endian::Little,
    };
    let stored = match dtype.get(1..) {
        Some("b1" | "u1") => VoxelType::U8,
        Some("i1") => VoxelType::I8,
        Some("u2") => VoxelType::U16,
        Some("i2") => VoxelType::I16,
        Some("u4") => VoxelType::U32,
        Some("i4") => VoxelType::I32,
        Some("u8") => VoxelType::U64,
        Some("i8") => VoxelType::I64,
        Some("f2") => VoxelType::F16,
        Some("f4") => VoxelType::F32,
        Some("f8") => VoxelType::F64,
        _ => return Err(not_read("the dtype", dtype)),
    };
    match dtype.starts_with(['<', '>']) || (dtype.starts_with('|') && stored.bytes() == 1) {
        true => Ok((stored, endian)),
        false => Err(not_read("the dtype", dtype)),
    }
}

fn configuration<'a>(value: &'a Value, field: &str) -> Result<&'a Object, Problem> {
    let object = value.as_object();
    object.ok_or_else(|| wrong(field, "a JSON object with an `id`", value))
}

fn filter_codec(value: &Value, stored: VoxelType, endian: Endian) -> Result<Codec, Problem> {
    let object = configuration(value, "filters")?;
    if text(object, "id")? != "delta" {
        return codec(value, "filters");
    }
    let dtype = text(object, "dtype")?;
    let kept = optional(object, "astype").map_or(Some(dtype), Value::as_str);
    if kept != Some(dtype) || number_type(dtype)? != (stored, endian) {
        return Err(not_read("the filter delta with another type,", dtype));
    }
    if stored == VoxelType::F16 {
        return Err(not_read("the filter delta of", "f16"));
    }
    Ok(Codec::Delta(Delta { stored, endian }))
}

/// A compressor, or a filter that works on bytes.
fn codec(value: &Value, field: &str) -> Result<Codec, Problem> {
    let object = configuration(value, field)?;
    let id = text(object, "id")?;
    Ok(match id {
        "zlib" => Codec::Zlib,
        "gzip" => Codec::Gzip,
        "bz2" => Codec::Bzip2,
        "zstd" => Codec::Zstd,
        "lz4" => Codec::Lz4,
        "blosc" => Codec::Blosc,
        "crc32c" => Codec::Crc32c,
        "shuffle" => {
            let size = required(object, "elementsize")?;
            let bytes = size.as_u64().and_then(|n| usize::try_from(n).ok());
            let bytes = bytes.filter(|bytes| (1..=256).contains(bytes));
            Codec::Shuffle(bytes.ok_or_else(|| wrong("elementsize", "1 to 256", size))?)
        }
        other => return Err(not_read("the codec", other)),
    })
}
