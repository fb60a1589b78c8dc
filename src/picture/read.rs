//! Picture files to numbers, for `compare`.

use super::compare::Image;
use super::npy;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

/// Memory that the pixels of one picture may take, and size of the largest file that is read.
pub const MAX_PICTURE_BYTES: u64 = 1 << 31;
/// Of a pixel in memory.
const PIXEL_BYTES: u64 = 16;
/// No compression in use makes one byte of more than this many; deflate ends at 1032.
#[cfg(any(feature = "png", feature = "exr"))]
const MAX_EXPANSION: u64 = 8192;

/// What went wrong with a picture file, and with which one.
#[derive(Debug, thiserror::Error)]
#[error("cannot read picture {}: {problem}", path.display())]
pub struct PictureError {
    /// The file.
    pub path: PathBuf,
    /// What was found there.
    #[source]
    pub problem: PictureProblem,
}

/// What can be wrong with a picture file.
#[derive(Debug, thiserror::Error)]
pub enum PictureProblem {
    /// The system would not let us.
    #[error("the file cannot be read")]
    Io(#[source] std::io::Error),
    /// Neither PNG nor EXR nor npy, or one that this build leaves out.
    #[error("wanted a PNG, EXR or npy file, found one that begins with {first_bytes:02x?}")]
    UnknownFormat {
        /// At most four.
        first_bytes: Vec<u8>,
    },
    /// Not what the format asks for; the decoder's word.
    #[error("{format}: {what}")]
    Broken {
        /// The kind of file.
        format: &'static str,
        /// What is wrong.
        what: String,
    },
    /// A field says something that cannot be, or that is not read.
    #[error("{format} field `{field}`: wanted {wanted}, found {found}")]
    Invalid {
        /// The kind of file.
        format: &'static str,
        /// The field.
        field: &'static str,
        /// What would do.
        wanted: &'static str,
        /// What stands there.
        found: String,
    },
    /// Fewer or more bytes than the shape needs.
    #[error("{format}: its shape needs {wanted_bytes} bytes of numbers, found {found_bytes}")]
    Size {
        /// The kind of file.
        format: &'static str,
        /// What the shape needs.
        wanted_bytes: u64,
        /// What is there.
        found_bytes: u64,
    },
    /// More than is read.
    #[error("{format}: {width} x {height} pixels are too many, at most 2^27 are read")]
    TooLarge {
        /// The kind of file.
        format: &'static str,
        /// Pixels across.
        width: u64,
        /// Pixels down.
        height: u64,
    },
}

impl PictureProblem {
    #[cfg(any(feature = "png", feature = "exr"))]
    pub(super) fn broken(format: &'static str, what: impl ToString) -> Self {
        let what = what.to_string().chars().take(200).collect();
        Self::Broken { format, what }
    }

    pub(super) fn too_large(format: &'static str, width: u64, height: u64) -> Self {
        Self::TooLarge {
            format,
            width,
            height,
        }
    }

    /// An error where a file of `file_bytes` cannot hold the `raw_bytes` that its header promises.
    #[cfg(any(feature = "png", feature = "exr"))]
    pub(super) fn check_expansion(
        format: &'static str,
        raw_bytes: u64,
        file_bytes: usize,
    ) -> Result<(), Self> {
        if raw_bytes <= (file_bytes as u64).saturating_mul(MAX_EXPANSION) {
            return Ok(());
        }
        Err(Self::Size {
            format,
            wanted_bytes: raw_bytes,
            found_bytes: file_bytes as u64,
        })
    }

    /// The size, if it is not too large.
    pub(super) fn check_size(
        format: &'static str,
        width: u64,
        height: u64,
    ) -> Result<(u32, u32), Self> {
        let pixels = width.saturating_mul(height);
        match (u32::try_from(width), u32::try_from(height)) {
            (Ok(w), Ok(h)) if pixels <= MAX_PICTURE_BYTES / PIXEL_BYTES => Ok((w, h)),
            _ => Err(Self::too_large(format, width, height)),
        }
    }
}

/// The picture in the PNG, Radiance HDR, EXR or npy file at `path`, told apart by their first bytes.
pub fn read_image(path: &Path) -> Result<Image, PictureError> {
    let of_file = |problem| PictureError {
        path: path.to_owned(),
        problem,
    };
    let mut bytes = Vec::new();
    File::open(path)
        .and_then(|file| file.take(MAX_PICTURE_BYTES + 1024).read_to_end(&mut bytes))
        .map_err(|cause| of_file(PictureProblem::Io(cause)))?;
    decode(&bytes).map_err(of_file)
}

fn decode(bytes: &[u8]) -> Result<Image, PictureProblem> {
    match bytes {
        #[cfg(feature = "png")]
        [0x89, b'P', b'N', b'G', ..] => super::png::decode(bytes),
        #[cfg(feature = "png")]
        _ if bytes.starts_with(super::hdr::MAGIC) => super::hdr::decode(bytes),
        #[cfg(feature = "exr")]
        [0x76, 0x2f, 0x31, 0x01, ..] => super::exr::decode(bytes),
        [0x93, b'N', b'U', b'M', ..] => npy::decode(bytes),
        _ => Err(PictureProblem::UnknownFormat {
            first_bytes: bytes.iter().take(4).copied().collect(),
        }),
    }
}
