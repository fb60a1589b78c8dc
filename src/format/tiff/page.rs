//! One picture of a TIFF: what its directory says about pixels, and where its strips or tiles are.
//!
//! TIFF 6.0, sections 3 to 8, 14, 15 and 22. A page is cut into chunks, strips as wide as the page or tiles
//! that may stick out of it, row by row; with separate planes the chunks of one sample follow those of another.

use super::TIFF;
use super::chunk::Compression;
use super::ifd::{self, Directory, Reader, Tag};
use super::kind::{color, stored_type};
use crate::format::convert::to_u64;
use crate::format::problem::{invalid, unsupported};
use crate::volume::{Limits, Problem, VoxelType};

/// What pages of one volume have in common.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Look {
    pub width: u32,
    pub height: u32,
    pub samples: u32,
    /// Of one sample in the file: 1, 2, 4, 8, 16, 32 or 64.
    pub bits: u32,
    /// The type of a sample; of 1, 2 and 4 bits it is u8.
    pub stored: VoxelType,
    pub color: Color,
    /// What the first sample beyond the color is.
    pub extra: Option<Extra>,
}

/// What samples mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Color {
    Gray,
    /// Gray, the largest number being black.
    WhiteIsZero,
    Rgb,
    /// Indices into a color map.
    Palette,
    /// Luma and two color differences, from JPEG.
    YCbCr,
}

/// A sample beyond the color.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Extra {
    Unspecified,
    /// Opacity that the color is multiplied with already.
    Associated,
    Opacity,
}

/// One page.
#[derive(Debug)]
pub(super) struct Page {
    pub look: Look,
    pub compression: Compression,
    pub predictor: u16,
    pub is_planar: bool,
    pub is_tiled: bool,
    pub chunk_width: u32,
    pub chunk_height: u32,
    offsets: Vec<u64>,
    /// Empty for uncompressed chunks: their size is known.
    byte_counts: Vec<u64>,
    pub jpeg_tables: Vec<u8>,
}

impl Page {
    /// Reads a directory's entries about pixels, and compares them with the length of the file and the limits.
    pub(super) fn read(
        reader: &mut Reader,
        directory: &Directory,
        limits: &Limits,
    ) -> Result<Self, Problem> {
        let look = look(reader, directory)?;
        let compression = Compression::read(reader, directory)?;
        if look.color == Color::YCbCr && (compression != Compression::Jpeg || look.bits != 8) {
            return Err(unsupported(TIFF, "YCbCr colors outside JPEG"));
        }
        let is_planar = match reader.integer(directory, ifd::PLANAR_CONFIGURATION)? {
            None | Some(1) => false,
            Some(2) => look.samples > 1,
            Some(n) => {
                let name = ifd::PLANAR_CONFIGURATION.name;
                return Err(invalid(TIFF, name, "1 or 2", &n.to_string()));
            }
        };
        if look.color == Color::YCbCr && is_planar {
            return Err(unsupported(TIFF, "YCbCr colors in separate planes"));
        }
        let predictor = match reader.integer(directory, ifd::PREDICTOR)?.unwrap_or(1) {
            // libtiff's codecs other than LZW and deflate know no predictor.
            _ if !compression.has_predictor() => 1,
            1 => 1,
            2 if look.bits >= 8 => 2,
            3 if look.stored.is_float() => 3,
            n => {
                let wanted = "1, 2 for whole bytes or 3 for floats";
                return Err(invalid(TIFF, "Predictor", wanted, &n.to_string()));
            }
        };
        let is_tiled = reader.count(directory, ifd::TILE_OFFSETS) > 0;
        let (chunk_width, chunk_height) = if is_tiled {
            let mut side = |tag| positive(reader, directory, tag);
            (side(ifd::TILE_WIDTH)?, side(ifd::TILE_LENGTH)?)
        } else {
            let rows = reader.integer(directory, ifd::ROWS_PER_STRIP)?;
            let rows = rows.unwrap_or(u64::MAX).min(look.height.into());
            let rows = u32::try_from(rows).ok().filter(|&rows| rows > 0);
            let rows =
                rows.ok_or_else(|| invalid(TIFF, "RowsPerStrip", "a number above 0", "0"))?;
            (look.width, rows)
        };
        let jpeg_tables = match compression {
            Compression::Jpeg => reader
                .blob(directory, ifd::JPEG_TABLES, limits.max_header_bytes)?
                .unwrap_or_default(),
            _ => Vec::new(),
        };
        let mut page = Self {
            look,
            compression,
            predictor,
            is_planar,
            is_tiled,
            chunk_width,
            chunk_height,
            offsets: Vec::new(),
            byte_counts: Vec::new(),
            jpeg_tables,
        };
        page.read_chunk_places(reader, directory, limits)?;
        Ok(page)
    }

    fn read_chunk_places(
        &mut self,
        reader: &mut Reader,
        directory: &Directory,
        limits: &Limits,
    ) -> Result<(), Problem> {
        let (offsets, byte_counts) = if self.is_tiled {
            (ifd::TILE_OFFSETS, ifd::TILE_BYTE_COUNTS)
        } else {
            (ifd::STRIP_OFFSETS, ifd::STRIP_BYTE_COUNTS)
        };
        let largest = self.chunk_bytes(self.chunk_height);
        if largest > limits.max_bytes {
            return Err(Problem::Limit {
                what: format!("a {} of the page", self.chunk_word()),
                wanted_bytes: largest,
                limit_bytes: limits.max_bytes,
            });
        }
        let planes = if self.is_planar { self.look.samples } else { 1 };
        let count = u64::from(self.across())
            .saturating_mul(self.down().into())
            .saturating_mul(planes.into());
        self.offsets = reader
            .integers(directory, offsets, count)?
            .ok_or_else(|| invalid(TIFF, offsets.name, "an entry", "none"))?;
        if self.compression != Compression::None {
            self.byte_counts = reader
                .integers(directory, byte_counts, count)?
                .ok_or_else(|| invalid(TIFF, byte_counts.name, "an entry", "none"))?;
        } else if reader.count(directory, byte_counts) == count {
            self.check_raw_byte_counts(reader, directory, byte_counts)?;
        }
        for index in 0..self.offsets.len() {
            let (offset, bytes) = self.place(index);
            reader.check_inside(offset, bytes, offsets.name)?;
            let wanted_bytes = self.chunk_bytes(self.rows_of(index));
            if wanted_bytes > self.compression.most_bytes(bytes) {
                return Err(Problem::TooFewEncoded {
                    format: TIFF,
                    encoding: self.compression.name(),
                    wanted_bytes,
                    encoded_bytes: bytes,
                });
            }
        }
        Ok(())
    }

    /// What is not compressed has a known size; a directory that says less is wrong.
    fn check_raw_byte_counts(
        &self,
        reader: &mut Reader,
        directory: &Directory,
        tag: Tag,
    ) -> Result<(), Problem> {
        let counts = reader.integers(directory, tag, to_u64(self.offsets.len()))?;
        for (index, count) in counts.unwrap_or_default().into_iter().enumerate() {
            let wanted_bytes = self.chunk_bytes(self.rows_of(index));
            if count < wanted_bytes {
                return Err(Problem::Size {
                    format: TIFF,
                    wanted_bytes,
                    found_bytes: count,
                });
            }
        }
        Ok(())
    }

    pub(super) fn chunk_word(&self) -> &'static str {
        if self.is_tiled { "tile" } else { "strip" }
    }

    /// Chunks side by side.
    pub(super) fn across(&self) -> u32 {
        self.look.width.div_ceil(self.chunk_width.max(1))
    }

    /// Chunks one below the other.
    pub(super) fn down(&self) -> u32 {
        self.look.height.div_ceil(self.chunk_height.max(1))
    }

    /// Samples that lie side by side in a chunk.
    pub(super) fn samples_in_chunk(&self) -> u32 {
        if self.is_planar { 1 } else { self.look.samples }
    }

    /// Bytes of one row of a chunk as the file packs them.
    pub(super) fn packed_row_bytes(&self) -> u64 {
        u64::from(self.chunk_width)
            .saturating_mul(self.samples_in_chunk().into())
            .saturating_mul(self.look.bits.into())
            .div_ceil(8)
    }

    /// Bytes of `rows` rows of a chunk.
    pub(super) fn chunk_bytes(&self, rows: u32) -> u64 {
        self.packed_row_bytes().saturating_mul(rows.into())
    }

    /// Rows that a chunk holds: the last strip may be shorter, a tile never is.
    pub(super) fn rows_of(&self, index: usize) -> u32 {
        if self.is_tiled {
            return self.chunk_height;
        }
        let index = u32::try_from(index).unwrap_or(u32::MAX);
        let strip = index.checked_rem(self.down()).unwrap_or(0);
        let first = strip.saturating_mul(self.chunk_height);
        self.chunk_height
            .min(self.look.height.saturating_sub(first))
    }

    /// Where a chunk begins in the file, and how many bytes it has there.
    pub(super) fn place(&self, index: usize) -> (u64, u64) {
        let offset = self.offsets.get(index).copied().unwrap_or(u64::MAX);
        let bytes = self.byte_counts.get(index).copied();
        let bytes = bytes.unwrap_or_else(|| self.chunk_bytes(self.rows_of(index)));
        (offset, bytes)
    }

    /// True where strips follow one another without gaps.
    pub(super) fn is_one_piece(&self) -> bool {
        let places: Vec<(u64, u64)> = (0..self.offsets.len()).map(|k| self.place(k)).collect();
        places.windows(2).all(|pair| match pair {
            [(offset, bytes), (next, _)] => offset.checked_add(*bytes) == Some(*next),
            _ => false,
        })
    }

    /// Where the first pixel is.
    pub(super) fn first_offset(&self) -> u64 {
        self.offsets.first().copied().unwrap_or(u64::MAX)
    }
}

fn positive(reader: &mut Reader, directory: &Directory, tag: Tag) -> Result<u32, Problem> {
    let number = reader
        .integer(directory, tag)?
        .ok_or_else(|| invalid(TIFF, tag.name, "an entry", "none"))?;
    let fits = u32::try_from(number).ok().filter(|&n| n > 0);
    fits.ok_or_else(|| invalid(TIFF, tag.name, "1 to 2^32 - 1", &number.to_string()))
}

fn look(reader: &mut Reader, directory: &Directory) -> Result<Look, Problem> {
    let width = positive(reader, directory, ifd::IMAGE_WIDTH)?;
    let height = positive(reader, directory, ifd::IMAGE_LENGTH)?;
    if reader.integer(directory, ifd::IMAGE_DEPTH)?.unwrap_or(1) != 1 {
        return Err(unsupported(TIFF, "a page of several layers (ImageDepth)"));
    }
    if reader.integer(directory, ifd::FILL_ORDER)?.unwrap_or(1) != 1 {
        return Err(unsupported(TIFF, "bits from the low end (FillOrder 2)"));
    }
    let samples = reader
        .integer(directory, ifd::SAMPLES_PER_PIXEL)?
        .unwrap_or(1);
    let samples = u32::try_from(samples)
        .ok()
        .filter(|n| (1..=4096).contains(n))
        .ok_or_else(|| invalid(TIFF, "SamplesPerPixel", "1 to 4096", &samples.to_string()))?;
    let bits = alike(reader, directory, ifd::BITS_PER_SAMPLE, samples)?.unwrap_or(1);
    let format = alike(reader, directory, ifd::SAMPLE_FORMAT, samples)?.unwrap_or(1);
    let stored = stored_type(bits, format)?;
    let color = color(reader, directory)?;
    let of_color = match color {
        Color::Rgb | Color::YCbCr => 3,
        _ => 1,
    };
    if samples < of_color || (color == Color::Palette && (samples != 1 || bits > 16)) {
        let found = format!("{samples} of {bits} bits");
        return Err(invalid(
            TIFF,
            "SamplesPerPixel",
            "samples for the colors",
            &found,
        ));
    }
    let extra = match reader.count(directory, ifd::EXTRA_SAMPLES) {
        0 if color == Color::Rgb && samples == 4 => Some(Extra::Unspecified),
        0 => None,
        _ => Some(match reader.integer(directory, ifd::EXTRA_SAMPLES)? {
            Some(1) => Extra::Associated,
            Some(2) => Extra::Opacity,
            _ => Extra::Unspecified,
        }),
    };
    Ok(Look {
        width,
        height,
        samples,
        bits: u32::try_from(bits).unwrap_or(0),
        stored,
        color,
        extra: extra.filter(|_| samples > of_color),
    })
}

/// A number that each sample has to have alike; libtiff takes one for all.
fn alike(
    reader: &mut Reader,
    directory: &Directory,
    tag: Tag,
    samples: u32,
) -> Result<Option<u64>, Problem> {
    let count = reader.count(directory, tag);
    if count <= 1 {
        return match count {
            0 => Ok(None),
            _ => reader.integer(directory, tag),
        };
    }
    let numbers = reader
        .integers(directory, tag, samples.into())?
        .unwrap_or_default();
    if numbers.windows(2).any(|pair| pair.first() != pair.last()) {
        let what = format!("samples that differ in {}", tag.name);
        return Err(unsupported(TIFF, what));
    }
    Ok(numbers.first().copied())
}
