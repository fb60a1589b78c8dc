//! Version 3: `zarr.json`, with a list of codecs from the numbers to the file.
//!
//! zarr-specs.readthedocs.io/en/latest/v3: core, and the codecs bytes, transpose, gzip, zstd, blosc, crc32c,
//! sharding_indexed.

use super::ZARR;
use super::array::{Array, Codecs, Fill, Keys, Shards, not_read};
use super::codec::Codec;
use super::json::{Object, child, optional, required, sizes, text, wrong};
use crate::format::convert::Endian;
use crate::format::problem::invalid;
use crate::volume::{Limits, Problem, VoxelType};
use serde_json::Value;

/// The array that a `zarr.json` describes.
pub(super) fn array(path: &str, metadata: &Object, limits: &Limits) -> Result<Array, Problem> {
    let version = required(metadata, "zarr_format")?;
    if version.as_u64() != Some(3) {
        return Err(wrong("zarr_format", "3", version));
    }
    if let Some(list) = optional(metadata, "storage_transformers")
        && list.as_array().is_none_or(|list| !list.is_empty())
    {
        return Err(not_read("the storage transformer", &list.to_string()));
    }
    let shape = sizes(required(metadata, "shape")?, "shape")?;
    let stored = number_type(required(metadata, "data_type")?)?;
    let (grid, settings) = named(required(metadata, "chunk_grid")?, "chunk_grid")?;
    if grid != "regular" {
        return Err(not_read("the chunk grid", &grid));
    }
    let chunk = sizes(required(&settings, "chunk_shape")?, "chunk_shape")?;
    let list = required(metadata, "codecs")?;
    let (codecs, shards) = file_codecs(list, shape.len(), stored)?;
    let array = Array {
        path: path.to_owned(),
        stored,
        chunk,
        keys: keys(required(metadata, "chunk_key_encoding")?)?,
        codecs,
        shards,
        fill: Fill::of(required(metadata, "fill_value")?, stored)?,
        dimension_names: optional(metadata, "dimension_names").and_then(names),
        attributes: child(metadata, "attributes")?,
        shape,
    };
    array.check(limits)
}

/// A name of an axis may be null.
fn names(value: &Value) -> Option<Vec<String>> {
    let names = value.as_array()?;
    let name = |value: &Value| value.as_str().unwrap_or("").to_owned();
    Some(names.iter().map(name).collect())
}

/// A name with its configuration: `{"name": .., "configuration": {..}}` or the name alone.
fn named(value: &Value, field: &str) -> Result<(String, Object), Problem> {
    match value {
        Value::String(name) => Ok((name.clone(), Object::new())),
        Value::Object(object) => Ok((
            text(object, "name")?.to_owned(),
            child(object, "configuration")?,
        )),
        _ => Err(wrong(field, "a name with a configuration", value)),
    }
}

fn number_type(value: &Value) -> Result<VoxelType, Problem> {
    let Some(name) = value.as_str() else {
        return Err(not_read("the data type", &value.to_string()));
    };
    Ok(match name {
        "bool" | "uint8" => VoxelType::U8,
        "int8" => VoxelType::I8,
        "uint16" => VoxelType::U16,
        "int16" => VoxelType::I16,
        "uint32" => VoxelType::U32,
        "int32" => VoxelType::I32,
        "uint64" => VoxelType::U64,
        "int64" => VoxelType::I64,
        "float16" => VoxelType::F16,
        "float32" => VoxelType::F32,
        "float64" => VoxelType::F64,
        other => return Err(not_read("the data type", other)),
    })
}

fn keys(value: &Value) -> Result<Keys, Problem> {
    let (name, settings) = named(value, "chunk_key_encoding")?;
    let (prefixed, usual) = match name.as_str() {
        "default" => (true, '/'),
        "v2" => (false, '.'),
        _ => return Err(not_read("the chunk key encoding", &name)),
    };
    let separator = match optional(&settings, "separator") {
        None => usual,
        Some(value) => match value.as_str() {
            Some(".") => '.',
            Some("/") => '/',
            _ => return Err(wrong("separator", "`.` or `/`", value)),
        },
    };
    Ok(Keys {
        prefixed,
        separator,
    })
}

/// The codecs of an array's files; those of shards give way to the ones inside.
fn file_codecs(
    list: &Value,
    rank: usize,
    stored: VoxelType,
) -> Result<(Codecs, Option<Shards>), Problem> {
    let all = list
        .as_array()
        .ok_or_else(|| wrong("codecs", "a list", list))?;
    let mut sharding = None;
    for codec in all {
        let (name, settings) = named(codec, "codecs")?;
        if name == "sharding_indexed" {
            sharding = Some(settings);
        }
    }
    let Some(settings) = sharding else {
        return Ok((codecs(list, rank, stored)?, None));
    };
    if all.len() != 1 {
        let what = "sharding_indexed together with other codecs of the array,";
        return Err(not_read(what, &list.to_string()));
    }
    let inside = codecs(required(&settings, "codecs")?, rank, stored)?;
    let index_list = required(&settings, "index_codecs")?;
    let index = codecs(index_list, rank.saturating_add(1), VoxelType::U64)?;
    let index_has_checksum = match index.bytes.as_slice() {
        [] => false,
        [Codec::Crc32c] => true,
        _ => return Err(not_read("the index codecs", &index_list.to_string())),
    };
    let index_at_end = match optional(&settings, "index_location").map(|place| place.as_str()) {
        None | Some(Some("end")) => true,
        Some(Some("start")) => false,
        _ => {
            let found = required(&settings, "index_location")?;
            return Err(wrong("index_location", "start or end", found));
        }
    };
    let shards = Shards {
        chunk: sizes(required(&settings, "chunk_shape")?, "chunk_shape")?,
        index_endian: index.endian,
        index_has_checksum,
        index_at_end,
    };
    Ok((inside, Some(shards)))
}

/// Codecs of numbers: transpositions, one `bytes`, then codecs of bytes.
fn codecs(list: &Value, rank: usize, stored: VoxelType) -> Result<Codecs, Problem> {
    let all = list
        .as_array()
        .ok_or_else(|| wrong("codecs", "a list", list))?;
    let mut order: Vec<usize> = (0..rank).collect();
    let mut endian = None;
    let mut bytes = Vec::new();
    for value in all {
        let (name, settings) = named(value, "codecs")?;
        match (name.as_str(), endian.is_some()) {
            ("transpose", false) => order = transposed(&order, &settings)?,
            ("bytes", false) => endian = Some(byte_order(&settings, stored)?),
            ("gzip", true) => bytes.push(Codec::Gzip),
            ("zstd", true) => bytes.push(Codec::Zstd),
            ("blosc", true) => bytes.push(Codec::Blosc),
            ("crc32c", true) => bytes.push(Codec::Crc32c),
            ("transpose" | "bytes" | "gzip" | "zstd" | "blosc" | "crc32c", _) => {
                let wanted = "transpositions, one `bytes`, then codecs of bytes";
                return Err(wrong("codecs", wanted, list));
            }
            ("sharding_indexed", _) => return Err(not_read("shards in shards,", &name)),
            _ => return Err(not_read("the codec", &name)),
        }
    }
    let endian = endian.ok_or_else(|| wrong("codecs", "the codec `bytes` among them", list))?;
    Ok(Codecs {
        order,
        endian,
        bytes,
    })
}

/// What lies in the place of axis k is the axis `order[k]` of what was there before.
fn transposed(before: &[usize], settings: &Object) -> Result<Vec<usize>, Problem> {
    let value = required(settings, "order")?;
    let wanted = || format!("each of the {} axes once", before.len());
    // An early draft had words here.
    let order = match value.as_str() {
        Some("C") => (0..before.len()).collect(),
        Some("F") => (0..before.len()).rev().collect(),
        _ => sizes(value, "order")?
            .into_iter()
            .map(|axis| usize::try_from(axis).unwrap_or(usize::MAX))
            .collect::<Vec<usize>>(),
    };
    let after: Option<Vec<usize>> = order.iter().map(|&k| before.get(k).copied()).collect();
    let mut sorted = order;
    sorted.sort_unstable();
    after
        .filter(|_| sorted.iter().copied().eq(0..before.len()))
        .ok_or_else(|| wrong("order", wanted(), value))
}

fn byte_order(settings: &Object, stored: VoxelType) -> Result<Endian, Problem> {
    match optional(settings, "endian").map(|value| value.as_str().unwrap_or("")) {
        Some("little") => Ok(Endian::Little),
        Some("big") => Ok(Endian::Big),
        None if stored.bytes() == 1 => Ok(Endian::Little),
        found => {
            let found = found.unwrap_or("nothing");
            Err(invalid(ZARR, "endian", "little or big", found))
        }
    }
}
