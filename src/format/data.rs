//! Where the voxels of a file are, and whether they are: what a header promises is compared with the lengths of
//! the files before anything is allocated.

use super::convert::{Endian, to_u64};
use super::decode::Encoding;
use super::place::open_regular;
use super::problem::{at, invalid};
use super::select::Axis;
use crate::volume::{Problem, ReadError, VoxelType};
use std::path::{Path, PathBuf};

/// What a header says about its voxels.
#[derive(Debug)]
pub(crate) struct Promise {
    /// The word for errors: `nrrd`.
    pub format: &'static str,
    pub stored: VoxelType,
    pub endian: Endian,
    pub encoding: Encoding,
    /// The stored array, fastest first.
    pub axes: Vec<Axis>,
    /// Files that hold equal shares of the array, one after the other.
    pub parts: Vec<Part>,
}

/// One file of voxels.
#[derive(Debug)]
pub(crate) struct Part {
    pub path: PathBuf,
    pub start: Start,
    /// Bytes of encoded voxels and the field that says so.
    pub encoded_bytes: Option<(u64, &'static str)>,
}

/// Where in a file voxels begin.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Start {
    /// `file_bytes` into the file, and then `decoded_bytes` into what is decoded from there.
    Skip { file_bytes: u64, decoded_bytes: u64 },
    /// So that `after_bytes` follow them in the file, and never before `earliest`: a header is no voxels.
    End { after_bytes: u64, earliest: u64 },
}

/// Voxels in files, checked to be there.
#[derive(Debug)]
pub(crate) struct Data {
    pub format: &'static str,
    pub stored: VoxelType,
    pub endian: Endian,
    pub encoding: Encoding,
    pub axes: Vec<Axis>,
    pub parts: Vec<FoundPart>,
    /// Decoded bytes of voxels in each part.
    pub part_bytes: u64,
    /// What is odd about the files and yet no error.
    pub notes: Vec<String>,
}

/// One file whose length was seen.
#[derive(Debug)]
pub(crate) struct FoundPart {
    pub path: PathBuf,
    /// Where the encoded bytes begin.
    pub offset: u64,
    /// How many there are.
    pub encoded_bytes: u64,
    /// Decoded bytes before the voxels.
    pub skip_bytes: u64,
}

impl Data {
    /// Compares the promise with the files. Opens each once and reads none.
    pub(crate) fn find(promise: Promise, header_path: &Path) -> Result<Self, ReadError> {
        let Promise {
            format,
            stored,
            endian,
            encoding,
            axes,
            parts,
        } = promise;
        let total = total_bytes(&axes, stored).ok_or_else(|| {
            at(header_path)(invalid(
                format,
                "sizes",
                "a number of bytes below 2^64",
                &axes
                    .iter()
                    .map(|axis| axis.size.to_string())
                    .collect::<Vec<_>>()
                    .join(" "),
            ))
        })?;
        let part_bytes = total
            .checked_div(to_u64(parts.len()))
            .filter(|bytes| bytes.checked_rem(to_u64(stored.bytes())) == Some(0))
            .filter(|bytes| bytes.checked_mul(to_u64(parts.len())) == Some(total))
            .ok_or_else(|| {
                at(header_path)(Problem::Invalid {
                    format,
                    field: "data files".to_owned(),
                    wanted: format!("a number of files that divides {total} bytes of voxels"),
                    found: parts.len().to_string(),
                })
            })?;
        let mut data = Self {
            format,
            stored,
            // Numbers in words have no byte order; ours come out little-endian.
            endian: match encoding {
                Encoding::Ascii => Endian::Little,
                _ => endian,
            },
            encoding,
            axes,
            parts: Vec::new(),
            part_bytes,
            notes: Vec::new(),
        };
        let mut left_over_bytes = 0_u64;
        for part in parts {
            let (found, left_over) = data.find_part(&part).map_err(at(&part.path))?;
            left_over_bytes = left_over_bytes.saturating_add(left_over);
            data.parts.push(found);
        }
        if left_over_bytes > 0 {
            data.notes.push(format!(
                "{left_over_bytes} bytes behind the voxels are not read"
            ));
        }
        Ok(data)
    }

    /// The part, and how many bytes follow its voxels.
    fn find_part(&mut self, part: &Part) -> Result<(FoundPart, u64), Problem> {
        let (_, metadata) = open_regular(&part.path)?;
        let file_bytes = metadata.len();
        let (offset, skip_bytes) = match part.start {
            Start::Skip {
                file_bytes,
                decoded_bytes,
            } => (file_bytes, decoded_bytes),
            Start::End {
                after_bytes,
                earliest,
            } => {
                let encoded = part.encoded_bytes.map_or(self.part_bytes, |(n, _)| n);
                let wanted = encoded.saturating_add(after_bytes);
                let present = file_bytes.saturating_sub(earliest);
                if wanted > present {
                    return Err(self.too_short(wanted, present));
                }
                (file_bytes.saturating_sub(wanted), 0)
            }
        };
        let encoded_bytes = file_bytes
            .checked_sub(offset)
            .ok_or_else(|| self.too_short(offset.saturating_add(self.part_bytes), file_bytes))?;
        if let Some((promised, field)) = part.encoded_bytes {
            if promised > encoded_bytes {
                return Err(Problem::Invalid {
                    format: self.format,
                    field: field.to_owned(),
                    wanted: format!("at most the {encoded_bytes} bytes that are there"),
                    found: promised.to_string(),
                });
            }
            // A stream knows its own end, and there are files in which this field is too small.
            if promised < encoded_bytes {
                self.notes.push(format!(
                    "{field} is {promised}, the file has {encoded_bytes} bytes there; the stream's own end counts"
                ));
            }
        }
        let wanted = skip_bytes.saturating_add(self.part_bytes);
        let left_over = match self.encoding {
            Encoding::Raw => encoded_bytes
                .checked_sub(wanted)
                .ok_or_else(|| self.too_short(wanted, encoded_bytes))?,
            _ if wanted > self.encoding.most_bytes(encoded_bytes, self.stored) => {
                return Err(Problem::TooFewEncoded {
                    format: self.format,
                    encoding: self.encoding.name(),
                    wanted_bytes: wanted,
                    encoded_bytes,
                });
            }
            _ => 0,
        };
        let found = FoundPart {
            path: part.path.clone(),
            offset,
            encoded_bytes,
            skip_bytes,
        };
        Ok((found, left_over))
    }

    fn too_short(&self, wanted_bytes: u64, found_bytes: u64) -> Problem {
        Problem::Size {
            format: self.format,
            wanted_bytes,
            found_bytes,
        }
    }
}

fn total_bytes(axes: &[Axis], stored: VoxelType) -> Option<u64> {
    axes.iter()
        .try_fold(to_u64(stored.bytes()), |product, axis| {
            product.checked_mul(axis.size)
        })
        .filter(|&total| total > 0)
}
