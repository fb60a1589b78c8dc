//! Where the numbers of a `DataArray` stand in the file, and whether they are there.

use super::VTI;
use super::xml::{Document, Element, Span};
use crate::format::blocks::{Codec, Coding, Letters};
use crate::format::convert::{Endian, to_u64};
use crate::format::data::{Data, FoundPart};
use crate::format::decode::Encoding;
use crate::format::place::open_regular;
use crate::format::problem::{self, invalid, missing, unsupported};
use crate::format::select::Axis;
use crate::volume::{Problem, VoxelType};
use std::io::{BufReader, ErrorKind, Read, Seek, SeekFrom};
use std::path::Path;

/// What the root says about all numbers.
#[derive(Clone, Copy, Debug)]
pub(in crate::format) struct Binary {
    endian: Endian,
    wide_sizes: bool,
    codec: Codec,
}

impl Binary {
    pub(in crate::format) fn of(root: &Element) -> Result<Self, Problem> {
        let endian = match root.get("byte_order") {
            Some("LittleEndian") | None => Endian::Little,
            Some("BigEndian") => Endian::Big,
            Some(text) => {
                let wanted = "LittleEndian or BigEndian";
                return Err(invalid(VTI, "byte_order", wanted, text));
            }
        };
        let wide_sizes = match root.get("header_type") {
            Some("UInt32") | None => false,
            Some("UInt64") => true,
            Some(text) => return Err(invalid(VTI, "header_type", "UInt32 or UInt64", text)),
        };
        let codec = match root.get("compressor") {
            None | Some("") => Codec::None,
            Some("vtkZLibDataCompressor") => Codec::Zlib,
            Some("vtkLZ4DataCompressor") => Codec::Lz4,
            Some("vtkLZMADataCompressor") => {
                return Err(unsupported(VTI, "LZMA compression (vtkLZMADataCompressor)"));
            }
            Some(text) => {
                let wanted = "vtkZLibDataCompressor or vtkLZ4DataCompressor";
                return Err(invalid(VTI, "compressor", wanted, text));
            }
        };
        Ok(Self {
            endian,
            wide_sizes,
            codec,
        })
    }
}

/// The type of the numbers of an array.
pub(in crate::format) fn stored_type(array: &Element) -> Result<VoxelType, Problem> {
    let text = array.required("type")?;
    Ok(match text {
        "Int8" => VoxelType::I8,
        "UInt8" => VoxelType::U8,
        "Int16" => VoxelType::I16,
        "UInt16" => VoxelType::U16,
        "Int32" => VoxelType::I32,
        "UInt32" => VoxelType::U32,
        "Int64" => VoxelType::I64,
        "UInt64" => VoxelType::U64,
        "Float32" => VoxelType::F32,
        "Float64" => VoxelType::F64,
        "Bit" | "String" => return Err(unsupported(VTI, format!("an array of type {text}"))),
        _ => return Err(invalid(VTI, "type", "a type such as Int16", text)),
    })
}

/// The numbers of an array, seen to be there.
pub(in crate::format) fn find(
    path: &Path,
    document: &Document,
    binary: Binary,
    array: &Element,
    axes: Vec<Axis>,
) -> Result<Data, Problem> {
    let stored = stored_type(array)?;
    let part_bytes = axes
        .iter()
        .try_fold(to_u64(stored.bytes()), |product, axis| {
            product.checked_mul(axis.size)
        })
        .ok_or_else(|| {
            let wanted = "below 2^64 bytes of voxels";
            invalid(VTI, "WholeExtent", wanted, "more")
        })?;
    let (letters, span) = place(document, array)?;
    let coding = Coding {
        letters,
        codec: match letters {
            Letters::Ascii => Codec::None,
            _ => binary.codec,
        },
        wide_sizes: binary.wide_sizes,
        endian: binary.endian,
        wanted_bytes: part_bytes,
    };
    let present = span.end.saturating_sub(span.start);
    check(path, coding, span, present, stored)?;
    let sizes_bytes = if binary.wide_sizes { 8 } else { 4 };
    // Bytes as they are can be read from any place on.
    let (encoding, offset) = match (letters, coding.codec) {
        (Letters::Bytes, Codec::None) => (Encoding::Raw, span.start.saturating_add(sizes_bytes)),
        _ => (Encoding::Vtk(coding), span.start),
    };
    Ok(Data {
        format: VTI,
        stored,
        endian: match letters {
            Letters::Ascii => Endian::Little,
            _ => binary.endian,
        },
        encoding,
        axes,
        parts: vec![FoundPart {
            path: path.to_owned(),
            offset,
            encoded_bytes: span.end.saturating_sub(offset),
            skip_bytes: 0,
        }],
        part_bytes,
        notes: Vec::new(),
    })
}

/// What the array is written in, and between which bytes of the file.
fn place(document: &Document, array: &Element) -> Result<(Letters, Span), Problem> {
    let inline = || {
        array
            .text
            .ok_or_else(|| missing(VTI, "text inside DataArray"))
    };
    match array.get("format").unwrap_or("ascii") {
        "ascii" => Ok((Letters::Ascii, inline()?)),
        "binary" => Ok((Letters::Base64, inline()?)),
        "appended" => {
            let (appended, span) = document
                .appended
                .as_ref()
                .ok_or_else(|| missing(VTI, "AppendedData"))?;
            let text = array.required("offset")?;
            let start = text
                .trim()
                .parse::<u64>()
                .ok()
                .and_then(|offset| span.start.checked_add(offset))
                .filter(|&start| start < span.end)
                .ok_or_else(|| {
                    let wanted = "a number of bytes inside the appended data";
                    invalid(VTI, "offset", wanted, text)
                })?;
            let letters = match appended.get("encoding").unwrap_or("base64") {
                "raw" => Letters::Bytes,
                "base64" => Letters::Base64,
                text => return Err(invalid(VTI, "encoding", "raw or base64", text)),
            };
            Ok((letters, Span { start, ..*span }))
        }
        text => Err(invalid(VTI, "format", "ascii, binary or appended", text)),
    }
}

/// Compares what stands before the data with what is wanted and what is there.
fn check(
    path: &Path,
    coding: Coding,
    span: Span,
    present: u64,
    stored: VoxelType,
) -> Result<(), Problem> {
    if coding.letters == Letters::Ascii {
        // A digit and a space each; the last space may be missing.
        let most = present.div_ceil(2).saturating_mul(to_u64(stored.bytes()));
        return match coding.wanted_bytes <= most {
            true => Ok(()),
            false => Err(Problem::TooFewEncoded {
                format: VTI,
                encoding: coding.name(),
                wanted_bytes: coding.wanted_bytes,
                encoded_bytes: present,
            }),
        };
    }
    let input = part_of(path, span)?;
    coding
        .check(input, present)
        .map_err(|error| match error.kind() {
            ErrorKind::UnexpectedEof => Problem::TooFewEncoded {
                format: VTI,
                encoding: coding.name(),
                wanted_bytes: coding.wanted_bytes,
                encoded_bytes: present,
            },
            ErrorKind::InvalidData => Problem::Damaged {
                format: VTI,
                encoding: coding.name(),
                decoded_bytes: 0,
                cause: error.to_string(),
            },
            _ => problem::io("reading the sizes before the data")(error),
        })
}

fn part_of(path: &Path, span: Span) -> Result<BufReader<std::io::Take<std::fs::File>>, Problem> {
    let (mut file, _) = open_regular(path)?;
    file.seek(SeekFrom::Start(span.start))
        .map_err(problem::io("going to the data"))?;
    let length = span.end.saturating_sub(span.start);
    Ok(BufReader::new(file.take(length)))
}

/// The one number of an array of `FieldData`; `None` where it holds something else.
pub(in crate::format) fn one_number(
    path: &Path,
    document: &Document,
    binary: Binary,
    array: &Element,
) -> Option<f64> {
    let stored = stored_type(array).ok()?;
    let (letters, span) = place(document, array).ok()?;
    let coding = Coding {
        letters,
        codec: match letters {
            Letters::Ascii => Codec::None,
            _ => binary.codec,
        },
        wide_sizes: binary.wide_sizes,
        endian: binary.endian,
        wanted_bytes: to_u64(stored.bytes()),
    };
    let mut decoded = coding.decode(part_of(path, span).ok()?, stored);
    let big = letters != Letters::Ascii && binary.endian == Endian::Big;
    let mut bytes = [0; 8];
    decoded.read_exact(bytes.get_mut(..stored.bytes())?).ok()?;
    if big {
        bytes.get_mut(..stored.bytes())?.reverse();
    }
    let [a, b, c, d, ..] = bytes;
    match stored {
        VoxelType::F32 => Some(f32::from_le_bytes([a, b, c, d]).into()),
        VoxelType::F64 => Some(f64::from_le_bytes(bytes)),
        VoxelType::I32 => Some(i32::from_le_bytes([a, b, c, d]).into()),
        _ => None,
    }
}
