//! The skeleton of a TIFF: its directories (IFDs), and the values their entries point to.
//!
//! TIFF 6.0 (Adobe, 1992), section 2, and BigTIFF (awaresystems.be/imaging/tiff/bigtiff.html):
//!
//! ```text
//! TIFF     II|MM 42 first(u32)         count(u16) { tag(u16) kind(u16) count(u32) value|place(u32) } next(u32)
//! BigTIFF  II|MM 43 8 0 first(u64)     count(u64) { tag(u16) kind(u16) count(u64) value|place(u64) } next(u64)
//! ```

use super::TIFF;
use crate::format::convert::{Endian, to_u64};
use crate::format::place::open_regular;
use crate::format::problem::{self, invalid};
use crate::volume::Problem;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;

/// An open file, of which we know that it is a TIFF.
#[derive(Debug)]
pub(super) struct Reader {
    file: File,
    pub length: u64,
    pub endian: Endian,
    is_big: bool,
    pub first_ifd: u64,
}

/// One directory.
#[derive(Debug)]
pub(super) struct Directory {
    entries: BTreeMap<u16, Entry>,
    /// Where the next one is; 0 behind the last.
    pub next: u64,
}

#[derive(Clone, Copy, Debug)]
struct Entry {
    kind: u16,
    count: u64,
    /// Where the value is: in the entry itself if it fits.
    place: u64,
}

impl Reader {
    pub(super) fn open(path: &Path) -> Result<Self, Problem> {
        let (file, metadata) = open_regular(path)?;
        let mut reader = Self {
            file,
            length: metadata.len(),
            endian: Endian::Little,
            is_big: false,
            first_ifd: 0,
        };
        let head = reader.bytes(0, 8, "header")?;
        if !super::recognizes(&head) {
            return Err(Problem::UnknownFormat(
                ": a TIFF was wanted, this is none".to_owned(),
            ));
        }
        if head.starts_with(b"M") {
            reader.endian = Endian::Big;
        }
        reader.is_big = reader.number(head.get(2..4)) == 43;
        reader.first_ifd = if reader.is_big {
            // The size of an offset, and nothing.
            if reader.number(head.get(4..6)) != 8 || reader.number(head.get(6..8)) != 0 {
                return Err(invalid(TIFF, "offset size", "8", &format!("{head:?}")));
            }
            let bytes = reader.bytes(8, 8, "header")?;
            reader.number(Some(&bytes))
        } else {
            reader.number(head.get(4..8))
        };
        Ok(reader)
    }

    /// Bytes of the file; those that are not there are an error, not an allocation.
    pub(super) fn bytes(&mut self, at: u64, count: u64, what: &str) -> Result<Vec<u8>, Problem> {
        let mut bytes = Vec::new();
        self.append(&mut bytes, at, count, what)?;
        Ok(bytes)
    }

    /// The same, behind what is in `bytes`.
    pub(super) fn append(
        &mut self,
        bytes: &mut Vec<u8>,
        at: u64,
        count: u64,
        what: &str,
    ) -> Result<(), Problem> {
        self.check_inside(at, count, what)?;
        self.file
            .seek(SeekFrom::Start(at))
            .map_err(problem::io("seeking in the file"))?;
        let read = (&mut self.file)
            .take(count)
            .read_to_end(bytes)
            .map_err(problem::io("reading the file"))?;
        if to_u64(read) != count {
            return Err(Problem::Size {
                format: TIFF,
                wanted_bytes: count,
                found_bytes: to_u64(read),
            });
        }
        Ok(())
    }

    /// `count` bytes at `at` lie inside the file.
    pub(super) fn check_inside(&self, at: u64, count: u64, what: &str) -> Result<(), Problem> {
        match at.checked_add(count) {
            Some(end) if end <= self.length => Ok(()),
            _ => {
                let wanted = format!("bytes inside the {} of the file", self.length);
                let found = format!("{count} bytes at {at}");
                Err(invalid(TIFF, what, wanted, &found))
            }
        }
    }

    /// An unsigned number of up to eight bytes in the file's order; 0 where there are none.
    fn number(&self, bytes: Option<&[u8]>) -> u64 {
        let shift = |number: u64, byte: &u8| number.wrapping_shl(8) | u64::from(*byte);
        let bytes = bytes.unwrap_or(&[]);
        match self.endian {
            Endian::Big => bytes.iter().fold(0, shift),
            Endian::Little => bytes.iter().rev().fold(0, shift),
        }
    }

    /// The directory at a place in the file.
    pub(super) fn directory(&mut self, at: u64) -> Result<Directory, Problem> {
        // Sizes of the number of entries, of an entry, of a count or offset.
        let (head, size, word) = if self.is_big {
            (8_u64, 20_u64, 8_usize)
        } else {
            (2, 12, 4)
        };
        let count = self.bytes(at, head, "directory")?;
        let count = self.number(Some(&count));
        let body_at = at.saturating_add(head);
        let body = count
            .checked_mul(size)
            .filter(|_| count <= u64::from(u16::MAX))
            .ok_or_else(|| {
                let wanted = "at most 65535 entries";
                invalid(TIFF, "directory", wanted, &count.to_string())
            })?;
        let bytes = self.bytes(body_at, body.saturating_add(to_u64(word)), "directory")?;
        let mut entries = BTreeMap::new();
        let entry_bytes = usize::try_from(size).unwrap_or(usize::MAX);
        let (table, next) = bytes
            .split_at_checked(bytes.len().saturating_sub(word))
            .unwrap_or_default();
        for (index, entry) in table.chunks_exact(entry_bytes).enumerate() {
            let tag = self.number(entry.get(..2));
            let kind = self.number(entry.get(2..4));
            let (Ok(tag), Ok(kind)) = (u16::try_from(tag), u16::try_from(kind)) else {
                continue;
            };
            let value_at = word.saturating_add(4);
            let count = self.number(entry.get(4..value_at));
            let bytes = size_of_kind(kind).and_then(|size| size.checked_mul(count));
            // A kind that nobody knows is passed over, as the specification asks.
            let Some(bytes) = bytes else { continue };
            let place = if bytes <= to_u64(word) {
                body_at
                    .saturating_add(to_u64(index).saturating_mul(size))
                    .saturating_add(to_u64(value_at))
            } else {
                self.number(entry.get(value_at..))
            };
            // Of two entries of one tag the first counts.
            entries.entry(tag).or_insert(Entry { kind, count, place });
        }
        Ok(Directory {
            entries,
            next: self.number(Some(next)),
        })
    }

    /// How many numbers a tag has; 0 where it is not there.
    pub(super) fn count(&self, directory: &Directory, tag: Tag) -> u64 {
        directory
            .entries
            .get(&tag.number)
            .map_or(0, |entry| entry.count)
    }

    /// The whole numbers of a tag, which has to have `count` of them; `None` where the tag is not there.
    pub(super) fn integers(
        &mut self,
        directory: &Directory,
        tag: Tag,
        count: u64,
    ) -> Result<Option<Vec<u64>>, Problem> {
        let Some(&entry) = directory.entries.get(&tag.number) else {
            return Ok(None);
        };
        if entry.count != count {
            let wanted = format!("{count} numbers");
            return Err(invalid(TIFF, tag.name, wanted, &entry.count.to_string()));
        }
        let size = match entry.kind {
            1 | 7 => 1,
            3 => 2,
            4 | 13 => 4,
            16 | 18 => 8,
            kind => {
                let found = format!("type {kind}");
                return Err(invalid(TIFF, tag.name, "whole numbers", &found));
            }
        };
        let bytes = self.bytes(entry.place, count.saturating_mul(size), tag.name)?;
        let size = usize::try_from(size).unwrap_or(1);
        let numbers = bytes.chunks_exact(size).map(|n| self.number(Some(n)));
        Ok(Some(numbers.collect()))
    }

    /// The first whole number of a tag.
    pub(super) fn integer(
        &mut self,
        directory: &Directory,
        tag: Tag,
    ) -> Result<Option<u64>, Problem> {
        let Some(&entry) = directory.entries.get(&tag.number) else {
            return Ok(None);
        };
        let first = Directory {
            entries: BTreeMap::from([(tag.number, Entry { count: 1, ..entry })]),
            next: 0,
        };
        if entry.count == 0 {
            return Err(invalid(TIFF, tag.name, "a number", "none"));
        }
        let numbers = self.integers(&first, tag, 1)?;
        Ok(numbers.and_then(|numbers| numbers.first().copied()))
    }

    /// A fraction, where it is one above 0.
    pub(super) fn fraction(
        &mut self,
        directory: &Directory,
        tag: Tag,
    ) -> Result<Option<f64>, Problem> {
        let entry = directory.entries.get(&tag.number).copied();
        let Some(entry) = entry.filter(|entry| entry.kind == 5 && entry.count == 1) else {
            return Ok(None);
        };
        let bytes = self.bytes(entry.place, 8, tag.name)?;
        let [over, under] = [bytes.get(..4), bytes.get(4..)].map(|part| self.number(part));
        #[allow(clippy::cast_precision_loss, reason = "both have 32 bits")]
        let fraction = over as f64 / under as f64;
        Ok(Some(fraction).filter(|fraction| fraction.is_finite() && *fraction > 0.0))
    }

    /// The bytes of a tag, at most `limit_bytes` of them; `None` where the tag is not there.
    pub(super) fn blob(
        &mut self,
        directory: &Directory,
        tag: Tag,
        limit_bytes: usize,
    ) -> Result<Option<Vec<u8>>, Problem> {
        let entry = directory.entries.get(&tag.number).copied();
        let Some(entry) = entry.filter(|entry| matches!(entry.kind, 1 | 2 | 7)) else {
            return Ok(None);
        };
        if entry.count > to_u64(limit_bytes) {
            return Err(Problem::Limit {
                what: format!("the tag {}", tag.name),
                wanted_bytes: entry.count,
                limit_bytes: to_u64(limit_bytes),
            });
        }
        self.bytes(entry.place, entry.count, tag.name).map(Some)
    }
}

/// Bytes of one value of a kind.
fn size_of_kind(kind: u16) -> Option<u64> {
    Some(match kind {
        1 | 2 | 6 | 7 => 1,
        3 | 8 => 2,
        4 | 9 | 11 | 13 => 4,
        5 | 10 | 12 | 16 | 17 | 18 => 8,
        _ => return None,
    })
}

/// A tag, as the specification numbers and names it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tag {
    pub number: u16,
    pub name: &'static str,
}

macro_rules! tags {
    ($($constant:ident $number:literal $name:literal)*) => {$(
        pub(super) const $constant: Tag = Tag { number: $number, name: $name };
    )*};
}

tags! {
    NEW_SUBFILE_TYPE 254 "NewSubfileType"
    SUBFILE_TYPE 255 "SubfileType"
    IMAGE_WIDTH 256 "ImageWidth"
    IMAGE_LENGTH 257 "ImageLength"
    BITS_PER_SAMPLE 258 "BitsPerSample"
    COMPRESSION 259 "Compression"
    PHOTOMETRIC 262 "PhotometricInterpretation"
    FILL_ORDER 266 "FillOrder"
    IMAGE_DESCRIPTION 270 "ImageDescription"
    STRIP_OFFSETS 273 "StripOffsets"
    SAMPLES_PER_PIXEL 277 "SamplesPerPixel"
    ROWS_PER_STRIP 278 "RowsPerStrip"
    STRIP_BYTE_COUNTS 279 "StripByteCounts"
    X_RESOLUTION 282 "XResolution"
    Y_RESOLUTION 283 "YResolution"
    PLANAR_CONFIGURATION 284 "PlanarConfiguration"
    RESOLUTION_UNIT 296 "ResolutionUnit"
    PREDICTOR 317 "Predictor"
    COLOR_MAP 320 "ColorMap"
    TILE_WIDTH 322 "TileWidth"
    TILE_LENGTH 323 "TileLength"
    TILE_OFFSETS 324 "TileOffsets"
    TILE_BYTE_COUNTS 325 "TileByteCounts"
    EXTRA_SAMPLES 338 "ExtraSamples"
    SAMPLE_FORMAT 339 "SampleFormat"
    JPEG_TABLES 347 "JPEGTables"
    IMAGE_DEPTH 32997 "ImageDepth"
}
