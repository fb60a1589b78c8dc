//! One strip or tile: its bytes in the file to the bytes of its pixels.
//!
//! Deflate is inflated here, to its checksum, and so is Zstandard. For LZW, PackBits, JPEG and predictors the chunk is wrapped as a TIFF of
//! its own, one strip of gray samples, and the `tiff` crate decodes that: it sees sizes that were checked, in memory,
//! and never follows an offset of the file.

use super::TIFF;
use super::ifd::{self, Directory, Reader};
use super::jpeg;
use super::page::Page;
use crate::fence::fenced;
use crate::format::convert::{Endian, to_u64};
use crate::format::decode::Encoding;
use crate::format::problem::{escape, invalid, unsupported};
use crate::format::zstd;
use crate::volume::{Problem, VoxelType};
use std::io::{Cursor, Read};

/// How chunks are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Compression {
    None,
    Lzw,
    Deflate,
    PackBits,
    Jpeg,
    Zstd,
}

impl Compression {
    pub(super) fn read(reader: &mut Reader, directory: &Directory) -> Result<Self, Problem> {
        let number = reader.integer(directory, ifd::COMPRESSION)?.unwrap_or(1);
        let name = match number {
            1 => return Ok(Self::None),
            5 => return Ok(Self::Lzw),
            7 => return Ok(Self::Jpeg),
            8 | 32946 => return Ok(Self::Deflate),
            32773 => return Ok(Self::PackBits),
            34926 | 50000 => return Ok(Self::Zstd),
            2 => "CCITT Huffman",
            3 => "CCITT fax group 3",
            4 => "CCITT fax group 4",
            6 => "JPEG of the old kind",
            9 | 10 => "JBIG",
            32809 => "ThunderScan",
            32908 => "PixarFilm",
            32909 => "PixarLog",
            33003 | 33004 | 33005 | 34712 => "JPEG 2000",
            33007 => "JPEG 2000 of NDPI",
            34676 | 34677 => "SGI LogLuv",
            34887 => "LERC",
            34892 => "lossy JPEG of DNG",
            34925 => "LZMA",
            34927 | 50001 => "WebP",
            34933 => "PNG",
            34934 => "JPEG XR",
            50002 | 52546 => "JPEG XL",
            _ => {
                let wanted = "a known number";
                return Err(invalid(TIFF, "Compression", wanted, &number.to_string()));
            }
        };
        let what = format!("compression {number} ({name})");
        Err(unsupported(TIFF, what))
    }

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::None => "raw",
            Self::Lzw => "lzw",
            Self::Deflate => "deflate",
            Self::PackBits => "packbits",
            Self::Jpeg => "jpeg",
            Self::Zstd => "zstd",
        }
    }

    pub(super) fn has_predictor(self) -> bool {
        matches!(self, Self::Lzw | Self::Deflate | Self::Zstd)
    }

    /// The most bytes that `encoded_bytes` can hold.
    pub(super) fn most_bytes(self, encoded_bytes: u64) -> u64 {
        match self {
            Self::None => encoded_bytes,
            // The longest string of a table of 4096, each one byte longer than the last, from 9 bits or more.
            Self::Lzw => encoded_bytes.saturating_mul(4096),
            Self::Deflate => Encoding::Gzip.most_bytes(encoded_bytes, VoxelType::U8),
            Self::PackBits => encoded_bytes.saturating_mul(64),
            // A progressive scan may end 32 767 blocks of 64 samples with one code.
            Self::Jpeg => encoded_bytes.saturating_mul(1 << 21),
            Self::Zstd => zstd::most_bytes(encoded_bytes),
        }
    }
}

/// The pixels of a chunk: rows of packed samples, each of [`Page::packed_row_bytes`] bytes.
pub(super) struct Pixels {
    pub bytes: Vec<u8>,
    pub endian: Endian,
}

/// Fetches and decodes a chunk.
pub(super) fn pixels(reader: &mut Reader, page: &Page, index: usize) -> Result<Pixels, Problem> {
    let (offset, encoded_bytes) = page.place(index);
    let rows = page.rows_of(index);
    let wanted_bytes = page.chunk_bytes(rows);
    let wanted = usize::try_from(wanted_bytes).unwrap_or(usize::MAX);
    let mut plain = Vec::new();
    match page.compression {
        Compression::None => {
            let bytes = reader.bytes(offset, wanted_bytes, page.chunk_word())?;
            return Ok(Pixels {
                bytes,
                endian: reader.endian,
            });
        }
        Compression::Deflate => {
            let encoded = reader.bytes(offset, encoded_bytes, page.chunk_word())?;
            plain = wrapping();
            let begins = plain.len();
            let mut stream = Encoding::Gzip.decode(Cursor::new(encoded), VoxelType::U8);
            let damaged = |cause: &dyn std::fmt::Display, decoded: usize| Problem::Damaged {
                format: TIFF,
                encoding: "deflate",
                decoded_bytes: to_u64(decoded),
                cause: escape(&cause.to_string()),
            };
            let read = stream.by_ref().take(wanted_bytes).read_to_end(&mut plain);
            let decoded = plain.len().saturating_sub(begins);
            read.map_err(|cause| damaged(&cause, decoded))?;
            if decoded != wanted {
                return Err(damaged(&"the stream ends early", decoded));
            }
            // Only at its end does a stream compare its checksum. The last strip may be written in full.
            let room = page.chunk_bytes(page.chunk_height);
            let rest = std::io::copy(
                &mut stream.take(room.saturating_add(1)),
                &mut std::io::sink(),
            );
            let rest = rest.map_err(|cause| damaged(&cause, decoded))?;
            if wanted_bytes.saturating_add(rest) > room {
                return Err(damaged(&"the stream goes on behind the pixels", decoded));
            }
        }
        Compression::Zstd => {
            let encoded = reader.bytes(offset, encoded_bytes, page.chunk_word())?;
            // The last strip may be written in full.
            let room = page.chunk_bytes(page.chunk_height);
            let most = usize::try_from(room).unwrap_or(usize::MAX);
            let damaged = |cause: &str, decoded: usize| Problem::Damaged {
                format: TIFF,
                encoding: "zstd",
                decoded_bytes: to_u64(decoded),
                cause: escape(cause),
            };
            let decoded = zstd::decode(&encoded, most).map_err(|cause| damaged(&cause, 0))?;
            let pixels = decoded.get(..wanted);
            let pixels = pixels.ok_or_else(|| damaged("the stream ends early", decoded.len()))?;
            plain = wrapping();
            plain.extend(pixels);
        }
        Compression::Lzw | Compression::PackBits | Compression::Jpeg => {
            plain.extend(wrapping());
            reader.append(&mut plain, offset, encoded_bytes, page.chunk_word())?;
            if page.compression == Compression::Jpeg {
                let found = plain.get(wrapping().len()..).unwrap_or_default();
                jpeg::check(found, page, rows)?;
            }
        }
    }
    let is_plain = matches!(page.compression, Compression::Deflate | Compression::Zstd);
    if is_plain && page.predictor == 1 {
        plain.drain(..wrapping().len());
        return Ok(Pixels {
            bytes: plain,
            endian: reader.endian,
        });
    }
    let wrapped = wrap(plain, reader.endian, page, rows)?;
    let bytes = decode(wrapped, page, wanted)?;
    Ok(Pixels {
        bytes,
        // With a predictor, and only then, the crate has put the bytes of each sample into the machine's order.
        endian: match page.predictor {
            1 => reader.endian,
            _ if cfg!(target_endian = "big") => Endian::Big,
            _ => Endian::Little,
        },
    })
}

/// Room for the head of a TIFF, before its one strip.
fn wrapping() -> Vec<u8> {
    vec![0; 8]
}

/// Makes a TIFF of one strip out of the strip, which begins behind eight bytes of room.
fn wrap(mut bytes: Vec<u8>, endian: Endian, page: &Page, rows: u32) -> Result<Vec<u8>, Problem> {
    let too_long = |_| unsupported(TIFF, "a strip or tile of 4 GiB");
    let strip_bytes = u32::try_from(bytes.len().saturating_sub(8)).map_err(too_long)?;
    let tables_at = u32::try_from(bytes.len()).map_err(too_long)?;
    bytes.extend(&page.jpeg_tables);
    if !bytes.len().is_multiple_of(2) {
        bytes.push(0);
    }
    let directory_at = u32::try_from(bytes.len()).map_err(too_long)?;
    let tables_bytes = u32::try_from(page.jpeg_tables.len()).map_err(too_long)?;
    // Samples of a predictor count as what they are, all others as bytes: nothing is swapped.
    let (bits, samples, format, width) = if page.predictor != 1 {
        let format = if page.look.stored.is_float() { 3 } else { 1 };
        let samples = page.samples_in_chunk();
        (page.look.bits, samples, format, page.chunk_width)
    } else if page.compression == Compression::Jpeg {
        (8, page.samples_in_chunk(), 1, page.chunk_width)
    } else {
        let row_bytes = u32::try_from(page.packed_row_bytes());
        (8, 1, 1, row_bytes.map_err(too_long)?)
    };
    let compression = match page.compression {
        Compression::Lzw => 5,
        Compression::Jpeg => 7,
        Compression::PackBits => 32773,
        Compression::None | Compression::Deflate | Compression::Zstd => 1,
    };
    const SHORT: u16 = 3;
    const LONG: u16 = 4;
    let mut entries = vec![
        (ifd::IMAGE_WIDTH, LONG, 1, width),
        (ifd::IMAGE_LENGTH, LONG, 1, rows),
        (ifd::BITS_PER_SAMPLE, SHORT, 1, bits),
        (ifd::COMPRESSION, SHORT, 1, compression),
        (ifd::PHOTOMETRIC, SHORT, 1, 1),
        (ifd::STRIP_OFFSETS, LONG, 1, 8),
        (ifd::SAMPLES_PER_PIXEL, SHORT, 1, samples),
        (ifd::ROWS_PER_STRIP, LONG, 1, rows),
        (ifd::STRIP_BYTE_COUNTS, LONG, 1, strip_bytes),
        (ifd::PREDICTOR, SHORT, 1, page.predictor.into()),
        (ifd::SAMPLE_FORMAT, SHORT, 1, format),
    ];
    if tables_bytes > 4 {
        entries.push((ifd::JPEG_TABLES, 7, tables_bytes, tables_at));
    }
    let short = |n: u16| match endian {
        Endian::Little => n.to_le_bytes(),
        Endian::Big => n.to_be_bytes(),
    };
    let long = |n: u32| match endian {
        Endian::Little => n.to_le_bytes(),
        Endian::Big => n.to_be_bytes(),
    };
    bytes.extend(short(u16::try_from(entries.len()).unwrap_or(0)));
    for (tag, kind, count, value) in entries {
        bytes.extend(short(tag.number));
        bytes.extend(short(kind));
        bytes.extend(long(count));
        match kind {
            SHORT => {
                bytes.extend(short(u16::try_from(value).unwrap_or(u16::MAX)));
                bytes.extend([0; 2]);
            }
            _ => bytes.extend(long(value)),
        }
    }
    bytes.extend(long(0));
    let order = match endian {
        Endian::Little => *b"II",
        Endian::Big => *b"MM",
    };
    let head = [&order[..], &short(42), &long(directory_at)].concat();
    for (to, from) in bytes.iter_mut().zip(head) {
        *to = from;
    }
    Ok(bytes)
}

/// Lets the crate decode the one strip of a TIFF in memory.
fn decode(wrapped: Vec<u8>, page: &Page, wanted: usize) -> Result<Vec<u8>, Problem> {
    let damaged = |cause: &str| Problem::Damaged {
        format: TIFF,
        encoding: page.compression.name(),
        decoded_bytes: 0,
        cause: escape(cause),
    };
    let mut limits = ::tiff::decoder::Limits::default();
    limits.ifd_value_size = wrapped.len();
    limits.intermediate_buffer_size = wrapped.len();
    limits.decoding_buffer_size = wanted;
    let mut bytes = Vec::new();
    bytes
        .try_reserve_exact(wanted)
        .map_err(|_| Problem::Limit {
            what: format!("a {} of the page", page.chunk_word()),
            wanted_bytes: to_u64(wanted),
            limit_bytes: 0,
        })?;
    bytes.resize(wanted, 0);
    let outcome = fenced(|| {
        let decoder = ::tiff::decoder::Decoder::new(Cursor::new(wrapped))?;
        decoder
            .with_limits(limits)
            .read_chunk_bytes(0, &mut bytes)?;
        Ok::<_, ::tiff::TiffError>(bytes)
    });
    match outcome {
        Ok(Ok(bytes)) => Ok(bytes),
        Ok(Err(cause)) => Err(damaged(&cause.to_string())),
        Err(words) => Err(damaged(&words)),
    }
}
