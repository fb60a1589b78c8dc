//! Voxels without a header: a spec on the command line, or a sidecar file, says what they are.
//!
//! ```text
//! 256x256x109,i16[,0.9x0.9x1.5][,le|be]      dims, type, spacing (1), byte order (le)
//! ```
//!
//! A sidecar is JSON beside the voxels, `NAME.json` or `NAME.raw.json` for `NAME.raw`:
//!
//! ```text
//! { "file": "walnut.raw", "dims": [128, 96, 114], "type": "u16", "endian": "little",
//!   "spacing": [0.5, 0.5, 0.5],      left out: 1
//!   "header_bytes": 0 }              left out: 0
//! ```
//!
//! The center of voxel (0, 0, 0) is the origin of the world, the axes are the world's. A file of any other
//! length than the spec says is an error.

use super::convert::Endian;
use super::data::{Data, Part, Promise, Start};
use super::decode::Encoding;
use super::file_source::FileSource;
use super::geometry::world_from_voxel;
use super::place::open_regular;
use super::problem::{at, invalid};
use super::select::{Axis, Role};
use super::text::number;
use crate::volume::{Format, Header, Limits, Problem, ReadError, Source, VoxelType};
use glam::{DMat3, DVec3};
use std::path::{Path, PathBuf};

#[cfg(feature = "json")]
mod sidecar;

/// The word of errors.
const RAW: &str = "raw";

/// What raw voxels are.
#[derive(Clone, Debug, PartialEq)]
pub struct RawSpec {
    /// Voxels along x, y, z.
    pub dims: [u32; 3],
    /// The type in the file.
    pub stored: VoxelType,
    /// World length of a voxel's sides.
    pub spacing: [f64; 3],
    /// True where the first byte of a number is the most significant one.
    pub is_big_endian: bool,
    /// Bytes before the first voxel.
    pub header_bytes: u64,
}

impl RawSpec {
    /// The spec that `text` is, such as `256x256x109,i16,0.9x0.9x1.5,be`.
    ///
    /// # Errors
    /// Where a word is missing, unknown, given twice or cannot be.
    pub fn parse(text: &str) -> Result<Self, Problem> {
        let mut words = text.split(',').map(str::trim);
        let dims = words.next().unwrap_or("");
        let dims = three(dims)
            .map(|sides| sides.map(|side| side.parse().ok().filter(|&n: &u32| n > 0)))
            .and_then(all)
            .ok_or_else(|| invalid(RAW, "dims", "three numbers above 0: 256x256x109", dims))?;
        let stored = words.next().unwrap_or("");
        let stored = type_of(stored).ok_or_else(|| invalid(RAW, "type", TYPES, stored))?;
        let (mut spacing, mut is_big_endian) = (None, None);
        for word in words {
            let is_new = match word {
                "le" => is_big_endian.replace(false).is_none(),
                "be" => is_big_endian.replace(true).is_none(),
                _ => {
                    let lengths = three(word).and_then(|sides| all(sides.map(length)));
                    let wanted = "a spacing such as 0.9x0.9x1.5, le or be";
                    let lengths = lengths.ok_or_else(|| invalid(RAW, "spec", wanted, word))?;
                    spacing.replace(lengths).is_none()
                }
            };
            if !is_new {
                return Err(invalid(RAW, "spec", "one spacing and one byte order", word));
            }
        }
        Ok(Self {
            dims,
            stored,
            spacing: spacing.unwrap_or([1.0; 3]),
            is_big_endian: is_big_endian.unwrap_or(false),
            header_bytes: 0,
        })
    }
}

/// Opens voxels that `spec` describes.
///
/// # Errors
/// Where the file cannot be read, or is not exactly as long as the spec says.
pub fn open(path: &Path, spec: &RawSpec, limits: &Limits) -> Result<Box<dyn Source>, ReadError> {
    let header = header(spec).map_err(at(path))?;
    let spaces = spec.dims.iter().enumerate();
    let promise = Promise {
        format: RAW,
        stored: spec.stored,
        endian: match spec.is_big_endian {
            true => Endian::Big,
            false => Endian::Little,
        },
        encoding: Encoding::Raw,
        axes: spaces
            .map(|(k, &size)| Axis {
                role: Role::Space(k),
                size: size.into(),
            })
            .collect(),
        parts: vec![Part {
            path: path.to_owned(),
            start: Start::Skip {
                file_bytes: spec.header_bytes,
                decoded_bytes: 0,
            },
            encoded_bytes: None,
        }],
    };
    let data = Data::find(promise, path)?;
    let (_, metadata) = open_regular(path).map_err(at(path))?;
    let found_bytes = metadata.len();
    let wanted_bytes = data.part_bytes.saturating_add(spec.header_bytes);
    if found_bytes != wanted_bytes {
        // With a number too many or too few in the spec, everything behind it would be shifted.
        return Err(at(path)(Problem::Size {
            format: RAW,
            wanted_bytes,
            found_bytes,
        }));
    }
    Ok(Box::new(FileSource::new(path, header, data, limits)))
}

/// The sidecar that describes `path`: `path` itself where it is one, or the one beside it.
pub(super) fn sidecar_of(path: &Path) -> Option<PathBuf> {
    let is = |wanted: &str| {
        path.extension()
            .is_some_and(|it| it.eq_ignore_ascii_case(wanted))
    };
    if is("json") {
        return Some(path.to_owned());
    }
    let beside = [
        path.with_extension("json"),
        path.with_added_extension("json"),
    ];
    beside.into_iter().find(|path| is("raw") && path.is_file())
}

/// Opens the voxels that a sidecar names.
#[cfg(feature = "json")]
pub(super) fn open_sidecar(path: &Path, limits: &Limits) -> Result<Box<dyn Source>, ReadError> {
    let (voxels, spec) = sidecar::read(path, limits)?;
    open(&voxels, &spec, limits)
}

/// Says that sidecars need another build.
#[cfg(not(feature = "json"))]
pub(super) fn open_sidecar(path: &Path, _limits: &Limits) -> Result<Box<dyn Source>, ReadError> {
    let what = "a sidecar in a build without the feature `json`";
    Err(at(path)(super::problem::unsupported(RAW, what)))
}

fn header(spec: &RawSpec) -> Result<Header, Problem> {
    let steps = DMat3::from_diagonal(DVec3::from_array(spec.spacing));
    let affine = world_from_voxel([steps.x_axis, steps.y_axis, steps.z_axis], DVec3::ZERO);
    let world_from_voxel = affine.ok_or_else(|| {
        let found = format!("{:?}", spec.spacing);
        invalid(RAW, "spacing", "three lengths from 1e-30 to 1e30", &found)
    })?;
    Ok(Header::new(
        Format::Raw,
        spec.dims,
        spec.stored,
        world_from_voxel,
    ))
}

const TYPES: &str = "one of u8, i8, u16, i16, u32, i32, u64, i64, f16, f32, f64";

/// The type of a word of ours, or of the names that C and numpy have for it.
fn type_of(word: &str) -> Option<VoxelType> {
    Some(match word {
        "u8" | "uint8" => VoxelType::U8,
        "i8" | "int8" => VoxelType::I8,
        "u16" | "uint16" => VoxelType::U16,
        "i16" | "int16" => VoxelType::I16,
        "u32" | "uint32" => VoxelType::U32,
        "i32" | "int32" => VoxelType::I32,
        "u64" | "uint64" => VoxelType::U64,
        "i64" | "int64" => VoxelType::I64,
        "f16" | "float16" => VoxelType::F16,
        "f32" | "float32" => VoxelType::F32,
        "f64" | "float64" => VoxelType::F64,
        _ => return None,
    })
}

/// `a`, `b`, `c` of `axbxc`.
fn three(text: &str) -> Option<[&str; 3]> {
    let sides: Vec<&str> = text.split('x').collect();
    sides.try_into().ok()
}

fn all<T>(numbers: [Option<T>; 3]) -> Option<[T; 3]> {
    let [a, b, c] = numbers;
    Some([a?, b?, c?])
}

fn length(text: &str) -> Option<f64> {
    number(text).filter(|x| x.is_finite() && *x > 0.0)
}
