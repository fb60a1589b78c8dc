//! NIfTI-1 and NIfTI-2: `.nii`, `.hdr` with `.img`, each of them compressed with gzip or not.
//!
//! By nifti1.h and nifti2.h, the definition of the format (nifti.nimh.nih.gov). Axes 1 to 3 are space, 4 is
//! time, 5 to 7 are components of a voxel; the channels of RGB24 and RGBA32 are components too. Analyze 7.5,
//! of the same layout without a magic, is refused: nothing in it says which side is left.

mod affine;
mod fields;
mod files;

use super::convert::Endian;
use super::data::{Data, Part, Promise, Start};
use super::decode::Encoding;
use super::file_source::FileSource;
use super::place::{first_bytes, open_regular};
use super::problem::{at, invalid, unsupported};
use super::select::{Axis, Role};
use super::text::whole;
use crate::volume::{
    ComponentKind, Format, Header, Limits, Problem, ReadError, Rescale, VoxelType,
};
use fields::{Fields, Version, is_gzip};
use std::path::Path;

pub(super) use fields::recognizes;

/// The word of errors.
const NIFTI: &str = "nifti";

/// Opens a header with its voxels, from the path of either file of a pair.
pub(super) fn open(path: &Path, limits: &Limits) -> Result<FileSource, ReadError> {
    let header_path = files::header_of(path)?;
    let fields = Fields::read(&header_path).map_err(at(&header_path))?;
    let number = Number::of(fields.datatype).map_err(at(&header_path))?;
    let array = Array::of(&fields, &number).map_err(at(&header_path))?;
    let mut header = header(&fields, &number, &array).map_err(at(&header_path))?;
    let image_path = match fields.is_single_file {
        true => header_path.clone(),
        false => files::image_of(&header_path)?,
    };
    let (encoding, start) =
        start(&fields, &image_path, &mut header.notes).map_err(at(&image_path))?;
    let promise = Promise {
        format: NIFTI,
        stored: number.stored,
        endian: match number.stored.bytes() {
            1 => Endian::Little,
            _ => fields.endian,
        },
        encoding,
        axes: array.axes,
        parts: vec![Part {
            path: image_path,
            start,
            encoded_bytes: None,
        }],
    };
    let data = Data::find(promise, &header_path)?;
    Ok(FileSource::new(path, header, data, limits))
}

/// What `datatype` stands for.
struct Number {
    stored: VoxelType,
    /// Channels of a color.
    channels: u32,
}

impl Number {
    fn of(datatype: i64) -> Result<Self, Problem> {
        let refused = |name| Err(unsupported(NIFTI, format!("datatype {datatype} ({name})")));
        let (stored, channels) = match datatype {
            2 => (VoxelType::U8, 1),
            4 => (VoxelType::I16, 1),
            8 => (VoxelType::I32, 1),
            16 => (VoxelType::F32, 1),
            64 => (VoxelType::F64, 1),
            128 => (VoxelType::U8, 3),
            256 => (VoxelType::I8, 1),
            512 => (VoxelType::U16, 1),
            768 => (VoxelType::U32, 1),
            1024 => (VoxelType::I64, 1),
            1280 => (VoxelType::U64, 1),
            2304 => (VoxelType::U8, 4),
            0 => return refused("unknown"),
            1 => return refused("one bit a voxel"),
            32 => return refused("complex of two f32"),
            1536 => return refused("128-bit float"),
            1792 => return refused("complex of two f64"),
            2048 => return refused("complex of two 128-bit floats"),
            _ => {
                let wanted = "a number that nifti1.h lists, such as 4 for i16";
                return Err(invalid(NIFTI, "datatype", wanted, &datatype.to_string()));
            }
        };
        Ok(Self { stored, channels })
    }

    fn bits(&self) -> i64 {
        let bytes = u32::try_from(self.stored.bytes()).unwrap_or(u32::MAX);
        i64::from(bytes.saturating_mul(8).saturating_mul(self.channels))
    }
}

/// The stored array: channels fastest, then x, y, z, time, further components.
struct Array {
    axes: Vec<Axis>,
    dims: [u32; 3],
    times: u32,
    components: u32,
}

impl Array {
    fn of(fields: &Fields, number: &Number) -> Result<Self, Problem> {
        let [rank, sizes @ ..] = fields.dim;
        let rank = usize::try_from(rank)
            .ok()
            .filter(|rank| (1..=7).contains(rank))
            .ok_or_else(|| invalid(NIFTI, "dim[0]", "1 to 7", &rank.to_string()))?;
        let mut found = [1; 7];
        for (k, (to, &size)) in found.iter_mut().zip(&sizes).take(rank).enumerate() {
            *to = u32::try_from(size).ok().filter(|&n| n > 0).ok_or_else(|| {
                let field = format!("dim[{}]", k.saturating_add(1));
                invalid(NIFTI, &field, "1 to 2^32 - 1", &size.to_string())
            })?;
        }
        let [x, y, z, times, others @ ..] = found;
        let roles = [
            (Role::Component, number.channels),
            (Role::Space(0), x),
            (Role::Space(1), y),
            (Role::Space(2), z),
            (Role::Time, times),
        ];
        let others = others.map(|size| (Role::Component, size));
        let components = others
            .iter()
            .try_fold(number.channels, |product, &(_, size)| {
                product.checked_mul(size)
            })
            .ok_or_else(|| invalid(NIFTI, "dim", "fewer than 2^32 components", "more"))?;
        let axis = |(role, size): (Role, u32)| Axis {
            role,
            size: size.into(),
        };
        Ok(Self {
            axes: roles.into_iter().chain(others).map(axis).collect(),
            dims: [x, y, z],
            times,
            components,
        })
    }
}

fn header(fields: &Fields, number: &Number, array: &Array) -> Result<Header, Problem> {
    let mut notes = Vec::new();
    let (world_from_voxel, is_patient) = affine::affine(fields, &mut notes)?;
    if fields.bitpix != number.bits() {
        notes.push(format!(
            "bitpix is {}, the datatype has {} bits and counts",
            fields.bitpix,
            number.bits()
        ));
    }
    let format = match fields.version {
        Version::One => Format::Nifti1,
        Version::Two => Format::Nifti2,
    };
    Ok(Header {
        components: array.components,
        times: array.times,
        rescale: rescale(fields, number, &mut notes),
        meaning: meaning(fields, number, array),
        is_labels: fields.intent_code == LABEL && array.components == 1,
        is_patient,
        length_metres: Some(1e-3),
        notes,
        ..Header::new(format, array.dims, number.stored, world_from_voxel)
    })
}

/// `NIFTI_INTENT_LABEL`, `_DISPVECT`, `_VECTOR`, `_RGB_VECTOR`, `_RGBA_VECTOR`.
const LABEL: i64 = 1002;
const VECTORS: [i64; 2] = [1006, 1007];
const RGB: i64 = 2003;
const RGBA: i64 = 2004;

fn meaning(fields: &Fields, number: &Number, array: &Array) -> ComponentKind {
    match (number.channels, array.components, fields.intent_code) {
        (3, 3, _) | (1, 3, RGB) => ComponentKind::Rgb,
        (4, 4, _) | (1, 4, RGBA) => ComponentKind::Rgba,
        (1, 2.., code) if VECTORS.contains(&code) => ComponentKind::Vector,
        _ => ComponentKind::Numbers,
    }
}

/// A slope of 0 means that there is none, and so does one that is no number; colors have none.
fn rescale(fields: &Fields, number: &Number, notes: &mut Vec<String>) -> Rescale {
    let slope = fields.scl_slope;
    if slope.is_infinite() {
        notes.push(format!(
            "scl_slope is {slope}: values are taken as they are stored"
        ));
    }
    if number.channels > 1 || slope == 0.0 || !slope.is_finite() {
        return Rescale::default();
    }
    let intercept = match fields.scl_inter {
        intercept if intercept.is_finite() => intercept,
        _ => {
            notes.push("scl_inter is no number: 0 is taken".to_owned());
            0.0
        }
    };
    Rescale { slope, intercept }
}

/// How the voxels are written and where they begin.
fn start(
    fields: &Fields,
    image_path: &Path,
    notes: &mut Vec<String>,
) -> Result<(Encoding, Start), Problem> {
    let wrong = |wanted: String| {
        let found = fields.vox_offset.to_string();
        invalid(NIFTI, "vox_offset", wanted, &found)
    };
    let offset = whole(fields.vox_offset)
        .and_then(|offset| u64::try_from(offset).ok())
        .ok_or_else(|| wrong("a whole number of bytes".to_owned()))?;
    let earliest = u64::from(fields.version.header_bytes());
    let offset = match (fields.is_single_file, fields.version) {
        (false, _) => offset,
        // The definition of version 1: less than 352 means 352.
        (true, Version::One) if offset < earliest => {
            // 0 says that the voxels follow the header.
            if offset > 0 {
                notes.push(format!(
                    "vox_offset is {offset}, inside the header: {earliest} is taken"
                ));
            }
            earliest
        }
        (true, Version::One) => offset,
        (true, Version::Two) if offset == 0 => earliest,
        (true, Version::Two) if offset < earliest => {
            return Err(wrong(format!("0 or at least {earliest}")));
        }
        (true, Version::Two) => offset,
    };
    let is_compressed = match fields.is_single_file {
        true => is_gzip(&first_bytes(&mut open_regular(image_path)?.0, 2)?),
        // Voxels may begin with any bytes: the name alone tells.
        false => files::is_compressed(image_path),
    };
    let start = match is_compressed {
        true => (
            Encoding::Gzip,
            Start::Skip {
                file_bytes: 0,
                decoded_bytes: offset,
            },
        ),
        false => (
            Encoding::Raw,
            Start::Skip {
                file_bytes: offset,
                decoded_bytes: 0,
            },
        ),
    };
    Ok(start)
}
