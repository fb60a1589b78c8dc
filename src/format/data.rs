//! The voxels of a file: what the header promises is compared with the bytes that are there when the file is
//! opened, and again byte by byte when they are read.

use super::convert::{Builder, Endian, bytes_in_memory, to_u64};
use super::decode::Encoding;
use super::place::open_regular;
use super::problem::{at, invalid};
use super::select::{Axis, Role, rows};
use super::stream::Stream;
use crate::volume::{Header, Limits, Pick, Piece, Problem, ReadError, Source, VoxelBox, VoxelType};
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
    /// Bytes of encoded voxels and the field that says so; else all up to the end of the file.
    pub encoded_bytes: Option<(u64, &'static str)>,
}

/// Where in a file voxels begin.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Start {
    /// `file_bytes` into the file, and then `decoded_bytes` into what is decoded from there.
    Skip { file_bytes: u64, decoded_bytes: u64 },
    /// So that `after_bytes` follow them in the file.
    End { after_bytes: u64 },
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
    /// Bytes behind the voxels of raw files that nobody reads.
    pub left_over_bytes: u64,
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
            left_over_bytes: 0,
        };
        for part in parts {
            let found = data.find_part(&part).map_err(at(&part.path))?;
            data.parts.push(found);
        }
        Ok(data)
    }

    fn find_part(&mut self, part: &Part) -> Result<FoundPart, Problem> {
        let (_, metadata) = open_regular(&part.path)?;
        let file_bytes = metadata.len();
        let (offset, skip_bytes) = match part.start {
            Start::Skip {
                file_bytes,
                decoded_bytes,
            } => (file_bytes, decoded_bytes),
            Start::End { after_bytes } => {
                let encoded = part.encoded_bytes.map_or(self.part_bytes, |(n, _)| n);
                let wanted = encoded.saturating_add(after_bytes);
                let offset = file_bytes
                    .checked_sub(wanted)
                    .ok_or_else(|| self.too_short(wanted, file_bytes))?;
                (offset, 0)
            }
        };
        let present = file_bytes
            .checked_sub(offset)
            .ok_or_else(|| self.too_short(offset.saturating_add(self.part_bytes), file_bytes))?;
        let encoded_bytes = match part.encoded_bytes {
            Some((promised, field)) if promised > present => {
                return Err(Problem::Invalid {
                    format: self.format,
                    field: field.to_owned(),
                    wanted: format!("at most the {present} bytes that are there"),
                    found: promised.to_string(),
                });
            }
            Some((promised, _)) => promised,
            None => present,
        };
        let wanted = skip_bytes.saturating_add(self.part_bytes);
        if self.encoding == Encoding::Raw {
            self.left_over_bytes = encoded_bytes
                .checked_sub(wanted)
                .ok_or_else(|| self.too_short(wanted, encoded_bytes))?
                .saturating_add(self.left_over_bytes);
        } else if wanted > self.encoding.most_bytes(encoded_bytes, self.stored) {
            return Err(Problem::TooFewEncoded {
                format: self.format,
                encoding: self.encoding.name(),
                wanted_bytes: wanted,
                encoded_bytes,
            });
        }
        Ok(FoundPart {
            path: part.path.clone(),
            offset,
            encoded_bytes,
            skip_bytes,
        })
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

/// A [`Source`] over [`Data`]: every reader of files ends in one.
#[derive(Debug)]
pub(crate) struct FileSource {
    path: PathBuf,
    header: Header,
    data: Data,
    max_bytes: u64,
}

impl FileSource {
    /// `header` and `data` speak of the same array. Adds the notes that `data` gives rise to.
    pub(crate) fn new(path: &Path, mut header: Header, data: Data, limits: &Limits) -> Self {
        if data.left_over_bytes > 0 {
            header.notes.push(format!(
                "{} bytes behind the voxels are not read",
                data.left_over_bytes
            ));
        }
        if !data.stored.is_kept_exactly() {
            header.notes.push(format!(
                "voxels are stored as {} and kept as f32",
                data.stored.name()
            ));
        }
        Self {
            path: path.to_owned(),
            header,
            data,
            max_bytes: limits.max_bytes,
        }
    }

    /// Bytes that `count` voxels take in memory, as a `usize`, if the limit allows them.
    fn count_within_limit(&self, region: VoxelBox) -> Result<usize, Problem> {
        let count = (0..3).try_fold(1_u64, |product, k| {
            let side = region.max.get(k)?.checked_sub(*region.min.get(k)?)?;
            product.checked_mul(side.into())
        });
        let wanted_bytes = count
            .and_then(|count| count.checked_mul(to_u64(bytes_in_memory(self.data.stored))))
            .unwrap_or(u64::MAX);
        count
            .filter(|_| wanted_bytes <= self.max_bytes)
            .and_then(|count| usize::try_from(count).ok())
            .ok_or(Problem::Limit {
                what: "the volume".to_owned(),
                wanted_bytes,
                limit_bytes: self.max_bytes,
            })
    }

    fn check(&self, pick: Pick, region: VoxelBox) -> Result<(), Problem> {
        let wrong = |field: &str, wanted: String, found: String| {
            Err(Problem::Invalid {
                format: self.data.format,
                field: field.to_owned(),
                wanted,
                found,
            })
        };
        let header = &self.header;
        if pick.time >= header.times {
            let wanted = format!("a time below {}", header.times);
            return wrong("time", wanted, pick.time.to_string());
        }
        if pick.component >= header.components {
            let wanted = format!("a component below {}", header.components);
            return wrong("component", wanted, pick.component.to_string());
        }
        let inside = region
            .min
            .iter()
            .zip(&region.max)
            .zip(&header.dims)
            .all(|((min, max), size)| min < max && max <= size);
        if !inside {
            let wanted = format!("a box inside {:?} that is not empty", header.dims);
            return wrong(
                "box",
                wanted,
                format!("{:?} to {:?}", region.min, region.max),
            );
        }
        Ok(())
    }

    fn read_rows(&self, pick: Pick, region: VoxelBox, wanted: usize) -> Result<Piece, ReadError> {
        let data = &self.data;
        let here = at(&self.path);
        let number_bytes = to_u64(data.stored.bytes());
        let mut builder = Builder::new(data.stored, data.endian, wanted);
        // Raw bytes were seen to be there; of others only the plausible part is believed beforehand.
        let believed = match data.encoding {
            Encoding::Raw => wanted,
            _ => wanted.min(BELIEVED_NUMBERS),
        };
        let mut stream = Stream::new(data);
        if let Err(problem) = builder.reserve(believed) {
            return Err(here(problem));
        }
        for row in rows(&data.axes, pick, region) {
            let stride_bytes = row.stride.saturating_mul(number_bytes);
            let mut at_byte = row.start.saturating_mul(number_bytes);
            let mut left = row.count;
            // Where numbers lie far apart, each is fetched alone.
            let batch = CHUNK_BYTES.checked_div(stride_bytes).unwrap_or(0).max(1);
            while left > 0 {
                let count = left.min(batch);
                let span = count
                    .saturating_sub(1)
                    .saturating_mul(stride_bytes)
                    .saturating_add(number_bytes);
                let bytes = stream.read_at(at_byte, span)?;
                let stride = match count {
                    1 => 1,
                    _ => usize::try_from(row.stride).unwrap_or(usize::MAX),
                };
                builder.push(bytes, stride).map_err(at(&self.path))?;
                at_byte = at_byte.saturating_add(count.saturating_mul(stride_bytes));
                left = left.saturating_sub(count);
            }
        }
        stream.finish()?;
        if builder.len() != wanted {
            return Err(at(&self.path)(Problem::Size {
                format: data.format,
                wanted_bytes: to_u64(wanted).saturating_mul(number_bytes),
                found_bytes: to_u64(builder.len()).saturating_mul(number_bytes),
            }));
        }
        Ok(builder.finish())
    }
}

/// Numbers that are reserved before the first byte of a compressed stream is seen.
const BELIEVED_NUMBERS: usize = 1 << 24;

/// Bytes that are fetched and converted at once.
const CHUNK_BYTES: u64 = 1 << 18;

impl Source for FileSource {
    fn header(&self) -> &Header {
        &self.header
    }

    fn read(&self, pick: Pick, region: VoxelBox) -> Result<Piece, ReadError> {
        self.check(pick, region).map_err(at(&self.path))?;
        let wanted = self.count_within_limit(region).map_err(at(&self.path))?;
        self.read_rows(pick, region, wanted)
    }
}

/// Axes for space of the sizes `dims`, in the order x, y, z.
pub(crate) fn space_axes(dims: [u32; 3]) -> impl Iterator<Item = Axis> {
    dims.into_iter().enumerate().map(|(k, size)| Axis {
        role: Role::Space(k),
        size: size.into(),
    })
}
