//! MetaImage, `.mha` and `.mhd`: a text header, with the voxels behind it or in other files.
//!
//! By the documentation of MetaIO, docs.itk.org/en/latest/learn/metaio.html, and where it is silent by what
//! ITK's reader does: row k of the matrix is the direction of axis k, coordinates are LPS, the centre of
//! rotation and `AnatomicalOrientation` do not move an image, `MET_LONG` has four bytes, compressed data may be
//! zlib or gzip. Unlike there, a list that is short or data that does not inflate is an error.

mod fields;
mod files;

use super::convert::Endian;
use super::data::{Data, Promise};
use super::decode::Encoding;
use super::file_source::FileSource;
use super::geometry::{RAS_FROM_LPS, with_missing_axes, world_from_voxel};
use super::problem::{at, escape, invalid, unsupported};
use super::select::{Axis, Role};
use super::text::integers;
use crate::volume::{
    ComponentKind, Format, Header, Limits, Problem, ReadError, Rescale, VoxelType,
};
use fields::Fields;
use glam::{DAffine3, DVec3};
use std::path::Path;

/// The word of errors.
const METAIMAGE: &str = "metaimage";

/// True where a file begins with lines `Name = value` that a MetaImage has.
pub(super) fn recognizes(first: &[u8]) -> bool {
    let text = String::from_utf8_lossy(first);
    let names = text
        .lines()
        .map_while(|line| Some(line.split_once(['=', ':'])?.0.trim()));
    names.into_iter().any(|name| {
        matches!(
            name,
            "NDims" | "DimSize" | "ElementType" | "ElementDataFile"
        )
    })
}

/// Opens a header, attached or detached.
pub(super) fn open(path: &Path, limits: &Limits) -> Result<FileSource, ReadError> {
    let fields = Fields::read(path, limits.max_header_bytes).map_err(at(path))?;
    let array = Array::of(&fields).map_err(at(path))?;
    let stored = stored_type(&fields).map_err(at(path))?;
    let encoding = encoding(&fields).map_err(at(path))?;
    let mut notes = Vec::new();
    let endian = endian(&fields, stored, &mut notes).map_err(at(path))?;
    let header = header(&fields, &array, stored, notes).map_err(at(path))?;
    let promise = Promise {
        format: METAIMAGE,
        stored,
        endian,
        encoding,
        parts: files::parts(path, &fields, &array, encoding, limits)?,
        axes: array.axes,
    };
    let data = Data::find(promise, path)?;
    Ok(FileSource::new(path, header, data, limits))
}

/// The stored array: channels fastest, then x, y, z, time.
struct Array {
    axes: Vec<Axis>,
    /// `DimSize`.
    sizes: Vec<u32>,
    dims: [u32; 3],
    times: u32,
    components: u32,
}

impl Array {
    fn of(fields: &Fields) -> Result<Self, Problem> {
        if let Some(kind) = fields.get("ObjectType").filter(|kind| *kind != "Image") {
            let what = format!("object type `{}`", escape(kind));
            return Err(unsupported(METAIMAGE, what));
        }
        let text = fields.required("NDims")?;
        let dimension = fields
            .integer("NDims")?
            .and_then(|n| usize::try_from(n).ok())
            .filter(|n| (1..=4).contains(n))
            .ok_or_else(|| invalid(METAIMAGE, "NDims", "a number from 1 to 4", text))?;
        let text = fields.required("DimSize")?;
        let positive = |n: i64| u32::try_from(n).ok().filter(|&n| n > 0);
        let sizes: Vec<u32> = integers(text)
            .filter(|sizes| sizes.len() == dimension)
            .and_then(|sizes| sizes.into_iter().map(positive).collect())
            .ok_or_else(|| {
                let wanted = format!("{dimension} whole numbers from 1 to 2^32 - 1");
                invalid(METAIMAGE, "DimSize", wanted, text)
            })?;
        let components = match fields.integer("ElementNumberOfChannels")? {
            None => 1,
            Some(n) => positive(n).ok_or_else(|| {
                let name = "ElementNumberOfChannels";
                invalid(METAIMAGE, name, "a number above 0", &n.to_string())
            })?,
        };
        let size = |k: usize| sizes.get(k).copied().unwrap_or(1);
        let channels = Axis {
            role: Role::Component,
            size: components.into(),
        };
        let others = sizes.iter().enumerate().map(|(k, &size)| Axis {
            role: if k < 3 { Role::Space(k) } else { Role::Time },
            size: size.into(),
        });
        Ok(Self {
            axes: std::iter::once(channels).chain(others).collect(),
            dims: [size(0), size(1), size(2)],
            times: size(3),
            components,
            sizes,
        })
    }
}

fn header(
    fields: &Fields,
    array: &Array,
    stored: VoxelType,
    mut notes: Vec<String>,
) -> Result<Header, Problem> {
    let world_from_voxel = affine(fields, array.sizes.len(), &mut notes)?;
    let slope = fields.number("ElementToIntensityFunctionSlope")?;
    let intercept = fields.number("ElementToIntensityFunctionOffset")?;
    if slope == Some(0.0) {
        let name = "ElementToIntensityFunctionSlope";
        return Err(invalid(METAIMAGE, name, "a number other than 0", "0"));
    }
    let meaning = meaning(array, stored, &mut notes);
    Ok(Header {
        meaning,
        components: array.components,
        times: array.times,
        rescale: Rescale {
            slope: slope.unwrap_or(1.0),
            intercept: intercept.unwrap_or(0.0),
        },
        modality: fields
            .get("Modality")
            .and_then(|word| word.strip_prefix("MET_MOD_"))
            .filter(|word| matches!(*word, "CT" | "MR"))
            .map(str::to_owned),
        // Values of eight bits cannot be Hounsfield units, whatever the modality.
        hounsfield: fields.get("Modality") == Some("MET_MOD_CT") && stored.bytes() > 1,
        is_patient: fields
            .get("AnatomicalOrientation")
            .is_some_and(|axes| axes.chars().all(|axis| "RLAPSI".contains(axis))),
        length_metres: Some(1e-3),
        notes,
        ..Header::new(Format::MetaImage, array.dims, stored, world_from_voxel)
    })
}

/// The format has no word for it. Its writers write colours as bytes, and vectors as floats of as many numbers as
/// there are axes.
fn meaning(array: &Array, stored: VoxelType, notes: &mut Vec<String>) -> ComponentKind {
    let axes = array.dims.iter().filter(|&&size| size > 1).count();
    let (meaning, what) = match (array.components, stored) {
        (3, VoxelType::U8) => (ComponentKind::Rgb, "colours"),
        (4, VoxelType::U8) => (ComponentKind::Rgba, "colours with opacity"),
        (n @ 2..=3, VoxelType::F32 | VoxelType::F64) if usize::try_from(n) == Ok(axes) => {
            (ComponentKind::Vector, "vectors")
        }
        _ => return ComponentKind::Numbers,
    };
    notes.push(format!(
        "{} channels of {} are taken as {what}",
        array.components,
        stored.name()
    ));
    meaning
}

/// `world = offset + sum of index[k] * spacing[k] * row[k]`, LPS, to voxel space and RAS+.
#[allow(
    clippy::arithmetic_side_effects,
    reason = "vectors of f64: nothing wraps or panics"
)]
fn affine(fields: &Fields, dimension: usize, notes: &mut Vec<String>) -> Result<DAffine3, Problem> {
    let spacing = match fields.numbers(&["ElementSize", "ElementSpacing"], dimension)? {
        Some(spacing) => spacing,
        None => {
            notes.push("the file gives no spacing: 1 is taken".to_owned());
            vec![1.0; dimension]
        }
    };
    for (step, axis) in spacing.iter().zip(["x", "y", "z"]) {
        if *step < 0.0 {
            notes.push(format!(
                "the spacing along {axis} is negative, {step}: the axis is taken to run the other way"
            ));
        }
    }
    let offset = fields.numbers(
        &["Position", "Offset", "Origin", "ImagePosition"],
        dimension,
    )?;
    let matrix_names = ["Orientation", "Rotation", "TransformMatrix"];
    let matrix = fields.numbers(&matrix_names, dimension.saturating_mul(dimension))?;
    let center = fields.numbers(&["CenterOfRotation"], dimension)?;
    if center.is_some_and(|center| center.iter().any(|&x| x != 0.0)) && matrix.is_some() {
        notes.push("the center of rotation does not move the image".to_owned());
    }
    let in_space = |numbers: &[f64]| {
        let coordinate = |k| numbers.get(k).copied().unwrap_or(0.0);
        DVec3::new(coordinate(0), coordinate(1), coordinate(2))
    };
    let columns: Vec<DVec3> = spacing
        .iter()
        .take(3)
        .enumerate()
        .map(|(k, &step)| {
            let direction = match &matrix {
                Some(matrix) => in_space(matrix.chunks(dimension).nth(k).unwrap_or(&[])),
                None => DVec3::AXES.get(k).copied().unwrap_or(DVec3::ZERO),
            };
            direction * step * RAS_FROM_LPS
        })
        .collect();
    let first_center = in_space(offset.as_deref().unwrap_or(&[])) * RAS_FROM_LPS;
    world_from_voxel(with_missing_axes(&columns), first_center).ok_or_else(|| {
        let name = match matrix {
            Some(_) => "TransformMatrix",
            None => "ElementSpacing",
        };
        let text = fields.get(name).unwrap_or("");
        invalid(METAIMAGE, name, "steps that span a volume", text)
    })
}

fn stored_type(fields: &Fields) -> Result<VoxelType, Problem> {
    let text = fields.required("ElementType")?;
    Ok(match text.strip_suffix("_ARRAY").unwrap_or(text) {
        "MET_CHAR" | "MET_ASCII_CHAR" => VoxelType::I8,
        "MET_UCHAR" => VoxelType::U8,
        "MET_SHORT" => VoxelType::I16,
        "MET_USHORT" => VoxelType::U16,
        "MET_INT" | "MET_LONG" => VoxelType::I32,
        "MET_UINT" | "MET_ULONG" => VoxelType::U32,
        "MET_LONG_LONG" => VoxelType::I64,
        "MET_ULONG_LONG" => VoxelType::U64,
        "MET_FLOAT" => VoxelType::F32,
        "MET_DOUBLE" => VoxelType::F64,
        "MET_NONE" | "MET_OTHER" | "MET_STRING" | "MET_FLOAT_MATRIX" => {
            let what = format!("ElementType `{}`", escape(text));
            return Err(unsupported(METAIMAGE, what));
        }
        _ => {
            let wanted = "a type such as MET_SHORT";
            return Err(invalid(METAIMAGE, "ElementType", wanted, text));
        }
    })
}

fn encoding(fields: &Fields) -> Result<Encoding, Problem> {
    let is_binary = fields.flag("BinaryData")?.unwrap_or(true);
    let is_compressed = fields.flag("CompressedData")?.unwrap_or(false);
    // Numbers in words are never compressed, whatever `CompressedData` says.
    Ok(match (is_binary, is_compressed) {
        (false, _) => Encoding::Ascii,
        (true, true) => Encoding::Gzip,
        (true, false) => Encoding::Raw,
    })
}

fn endian(fields: &Fields, stored: VoxelType, notes: &mut Vec<String>) -> Result<Endian, Problem> {
    let element = fields.flag("ElementByteOrderMSB")?;
    let is_big = fields.flag("BinaryDataByteOrderMSB")?.or(element);
    if is_big.is_none() && stored.bytes() > 1 {
        notes.push("the file does not say its byte order: little-endian is taken".to_owned());
    }
    Ok(match is_big {
        Some(true) => Endian::Big,
        _ => Endian::Little,
    })
}
