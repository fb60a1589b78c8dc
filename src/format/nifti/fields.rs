//! The fields of a NIfTI header that say where voxels are and what they mean, of both versions.
//!
//! Offsets are those of nifti1.h and nifti2.h. `sizeof_hdr` tells the version and the byte order.

use super::NIFTI;
use crate::format::convert::{Endian, to_u64};
use crate::format::decode::Encoding;
use crate::format::place::open_regular;
use crate::format::problem::{self, unsupported};
use crate::volume::{Problem, VoxelType};
use std::io::{BufReader, Cursor, ErrorKind, Read};
use std::path::Path;

/// Bytes of the larger of the two headers.
const LONGEST: usize = 540;

/// What a header says, numbers as they stand.
#[derive(Debug)]
pub(super) struct Fields {
    pub version: Version,
    pub endian: Endian,
    /// True where the voxels follow in the same file.
    pub is_single_file: bool,
    pub dim: [i64; 8],
    pub datatype: i64,
    pub bitpix: i64,
    pub pixdim: [f64; 8],
    pub vox_offset: f64,
    pub scl_slope: f64,
    pub scl_inter: f64,
    pub qform_code: i64,
    pub sform_code: i64,
    /// b, c, d.
    pub quatern: [f64; 3],
    pub qoffset: [f64; 3],
    pub srow: [[f64; 4]; 3],
    pub xyzt_units: i64,
    /// What values are for, `NIFTI_INTENT_...`.
    pub intent_code: i64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Version {
    One,
    Two,
}

impl Version {
    /// Of header and the four bytes behind it: no voxels lie before that.
    pub fn header_bytes(self) -> u32 {
        match self {
            Self::One => 352,
            Self::Two => 544,
        }
    }
}

/// True where the first bytes of a file, compressed or not, are a NIfTI header or the older Analyze one.
pub(in crate::format) fn recognizes(first: &[u8]) -> bool {
    let header = if is_gzip(first) {
        let mut bytes = Vec::new();
        // The piece ends in the middle of the stream; what comes out before that is enough.
        let _ = Encoding::Gzip
            .decode(Cursor::new(first.to_vec()), VoxelType::U8)
            .take(to_u64(LONGEST))
            .read_to_end(&mut bytes);
        bytes
    } else {
        first.to_vec()
    };
    version_and_order(&header).is_some()
}

impl Fields {
    /// Reads the header at the start of a file.
    pub fn read(path: &Path) -> Result<Self, Problem> {
        let (mut file, _) = open_regular(path)?;
        let mut first = Vec::new();
        file.by_ref()
            .take(to_u64(LONGEST))
            .read_to_end(&mut first)
            .map_err(problem::io("reading the header"))?;
        if !is_gzip(&first) {
            return Self::of(&first);
        }
        let input = BufReader::new(Cursor::new(first).chain(file));
        let mut bytes = Vec::new();
        let outcome = Encoding::Gzip
            .decode(input, VoxelType::U8)
            .take(to_u64(LONGEST))
            .read_to_end(&mut bytes);
        match (Self::of(&bytes), outcome) {
            // Where the header came out whole, reading the voxels will tell what is wrong behind it.
            (Err(_), Err(error)) => Err(match error.kind() {
                ErrorKind::InvalidData | ErrorKind::UnexpectedEof => Problem::Damaged {
                    format: NIFTI,
                    encoding: Encoding::Gzip.name(),
                    decoded_bytes: to_u64(bytes.len()),
                    cause: error.to_string(),
                },
                _ => problem::io("reading the header")(error),
            }),
            (fields, _) => fields,
        }
    }

    fn of(header: &[u8]) -> Result<Self, Problem> {
        let Some((version, endian)) = version_and_order(header) else {
            let what = ": the header begins with neither 348 nor 540, the sizes of a NIfTI header";
            return Err(Problem::UnknownFormat(what.to_owned()));
        };
        let bytes = Bytes { header, endian };
        let length = match version {
            Version::One => 348,
            Version::Two => LONGEST,
        };
        if header.len() < length {
            return Err(problem::invalid(
                NIFTI,
                "sizeof_hdr",
                format!("a file of at least {length} bytes"),
                &header.len().to_string(),
            ));
        }
        match version {
            Version::One => {
                let is_single_file = match bytes.array(344) {
                    Some(b"n+1\0") => true,
                    Some(b"ni1\0") => false,
                    _ => {
                        let what = "an Analyze 7.5 header (no NIfTI magic: nothing says which side is left)";
                        return Err(unsupported(NIFTI, what));
                    }
                };
                Ok(bytes.version_one(is_single_file))
            }
            Version::Two => {
                let is_single_file = match bytes.array(4) {
                    Some(b"n+2\0\r\n\x1a\n") => true,
                    Some(b"ni2\0\r\n\x1a\n") => false,
                    found => {
                        let found: &[u8; 8] = found.unwrap_or(&[0; 8]);
                        return Err(problem::invalid(
                            NIFTI,
                            "magic",
                            "n+2 or ni2 and a line end that no transfer changed",
                            &found.iter().copied().map(char::from).collect::<String>(),
                        ));
                    }
                };
                Ok(bytes.version_two(is_single_file))
            }
        }
    }
}

pub(super) fn is_gzip(first: &[u8]) -> bool {
    first.starts_with(&[0x1f, 0x8b])
}

fn version_and_order(header: &[u8]) -> Option<(Version, Endian)> {
    let size = header.first_chunk::<4>()?;
    Some(
        match (i32::from_le_bytes(*size), i32::from_be_bytes(*size)) {
            (348, _) => (Version::One, Endian::Little),
            (_, 348) => (Version::One, Endian::Big),
            (540, _) => (Version::Two, Endian::Little),
            (_, 540) => (Version::Two, Endian::Big),
            _ => return None,
        },
    )
}

/// A header that is known to be long enough; what lies beyond its end is 0.
struct Bytes<'a> {
    header: &'a [u8],
    endian: Endian,
}

impl Bytes<'_> {
    fn version_one(&self, is_single_file: bool) -> Fields {
        let f32s = |at| f64::from(self.f32(at));
        Fields {
            version: Version::One,
            endian: self.endian,
            is_single_file,
            dim: steps(40, 2).map(|at| self.i16(at)),
            intent_code: self.i16(68),
            datatype: self.i16(70),
            bitpix: self.i16(72),
            pixdim: steps(76, 4).map(f32s),
            vox_offset: f32s(108),
            scl_slope: f32s(112),
            scl_inter: f32s(116),
            xyzt_units: i64::from(self.array::<1>(123).map_or(0, |&[units]| units)),
            qform_code: self.i16(252),
            sform_code: self.i16(254),
            quatern: steps(256, 4).map(f32s),
            qoffset: steps(268, 4).map(f32s),
            srow: steps(280, 16).map(|row| steps(row, 4).map(f32s)),
        }
    }

    #[allow(
        clippy::cast_precision_loss,
        reason = "an offset beyond 2^53 is refused for being longer than any file"
    )]
    fn version_two(&self, is_single_file: bool) -> Fields {
        let f64s = |at| self.f64(at);
        Fields {
            version: Version::Two,
            endian: self.endian,
            is_single_file,
            datatype: self.i16(12),
            bitpix: self.i16(14),
            dim: steps(16, 8).map(|at| self.i64(at)),
            pixdim: steps(104, 8).map(f64s),
            vox_offset: self.i64(168) as f64,
            scl_slope: self.f64(176),
            scl_inter: self.f64(184),
            qform_code: self.i32(344),
            sform_code: self.i32(348),
            quatern: steps(352, 8).map(f64s),
            qoffset: steps(376, 8).map(f64s),
            srow: steps(400, 32).map(|row| steps(row, 8).map(f64s)),
            xyzt_units: self.i32(500),
            intent_code: self.i32(504),
        }
    }

    fn array<const N: usize>(&self, at: usize) -> Option<&[u8; N]> {
        self.header.get(at..)?.first_chunk()
    }

    /// The bytes of one number, little-endian.
    fn number<const N: usize>(&self, at: usize) -> [u8; N] {
        let mut bytes = self.array(at).copied().unwrap_or([0; N]);
        if self.endian == Endian::Big {
            bytes.reverse();
        }
        bytes
    }

    fn i16(&self, at: usize) -> i64 {
        i16::from_le_bytes(self.number(at)).into()
    }

    fn i32(&self, at: usize) -> i64 {
        i32::from_le_bytes(self.number(at)).into()
    }

    fn i64(&self, at: usize) -> i64 {
        i64::from_le_bytes(self.number(at))
    }

    fn f32(&self, at: usize) -> f32 {
        f32::from_le_bytes(self.number(at))
    }

    fn f64(&self, at: usize) -> f64 {
        f64::from_le_bytes(self.number(at))
    }
}

/// `start` and the offsets that follow it in steps.
fn steps<const N: usize>(start: usize, step: usize) -> [usize; N] {
    std::array::from_fn(|k| start.saturating_add(step.saturating_mul(k)))
}
