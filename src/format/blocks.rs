//! The data of an array in a VTK XML file: sizes first, then the bytes, whole or in blocks that are compressed
//! one by one.
//!
//! By "VTK XML Formats", docs.vtk.org/en/latest/vtk_file_formats/vtkxml_file_format.html; each size is a u32 or u64:
//!
//! ```text
//! not compressed:   bytes | data
//! compressed:       blocks | bytes of a block | bytes of the last block, 0: as the others | bytes of each, compressed | data
//! ```

use super::base64::Base64;
use super::convert::{Endian, to_u64};
use super::decode::damaged;
use super::textual::Numbers;
use crate::fence::fenced;
use crate::volume::VoxelType;
use flate2::{Decompress, FlushDecompress, Status};
use std::io::{self, BufRead, Read};

/// How the bytes of one array are written, and how many they must be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Coding {
    pub letters: Letters,
    pub codec: Codec,
    /// True where sizes have eight bytes.
    pub wide_sizes: bool,
    /// Of the sizes; that of the numbers is the same.
    pub endian: Endian,
    /// Decoded bytes of the array: what the sizes must come to.
    pub wanted_bytes: u64,
}

/// What the file is made of where the array stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Letters {
    /// Decimal numbers; no sizes stand before them.
    Ascii,
    Base64,
    Bytes,
}

/// What blocks are compressed with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Codec {
    /// Not at all.
    None,
    Zlib,
    /// LZ4's block format, without frames.
    Lz4,
}

/// No writer makes blocks that are larger by itself: VTK's have 32 KiB.
const MOST_BLOCK_BYTES: u64 = 1 << 28;

impl Coding {
    pub(crate) fn name(self) -> &'static str {
        match (self.letters, self.codec) {
            (Letters::Ascii, _) => "ascii",
            (Letters::Base64, Codec::None) => "base64",
            (Letters::Bytes, Codec::None) => "raw",
            (_, Codec::Zlib) => "zlib",
            (_, Codec::Lz4) => "lz4",
        }
    }

    /// The decoded bytes; numbers in words come out little-endian.
    pub(crate) fn decode(self, input: impl BufRead + 'static, stored: VoxelType) -> Box<dyn Read> {
        let input: Box<dyn Read> = match self.letters {
            // The place of the text is known to its end: its last number is whole.
            Letters::Ascii => return Box::new(Numbers::new(input.chain(&b" "[..]), stored)),
            Letters::Base64 => Box::new(Base64::new(input)),
            Letters::Bytes => Box::new(input),
        };
        Box::new(Blocks {
            input,
            coding: self,
            sizes: None,
            block: Vec::new(),
            given: 0,
        })
    }

    /// Compares the sizes that stand before the data with what is wanted and with the bytes that are there.
    pub(crate) fn check(self, input: impl BufRead + 'static, encoded_bytes: u64) -> io::Result<()> {
        let mut input: Box<dyn Read> = match self.letters {
            Letters::Ascii => return Ok(()),
            Letters::Base64 => Box::new(Base64::new(input)),
            Letters::Bytes => Box::new(input),
        };
        let sizes = Sizes::read(&mut input, self)?;
        let present = match self.letters {
            Letters::Base64 => encoded_bytes.div_ceil(4).saturating_mul(3),
            _ => encoded_bytes,
        };
        if sizes.encoded_bytes > present {
            return Err(io::ErrorKind::UnexpectedEof.into());
        }
        Ok(())
    }
}

/// What stands before the data.
struct Sizes {
    /// Of sizes and data together.
    encoded_bytes: u64,
    /// Of each block that is left, compressed; the next one last.
    left: Vec<u64>,
    block_bytes: u64,
    last_bytes: u64,
    /// Without compression: bytes that are left.
    plain_left: u64,
}

impl Sizes {
    fn read(input: &mut impl Read, coding: Coding) -> io::Result<Self> {
        let wrong = |what: &str, found: u64| {
            let wanted = coding.wanted_bytes;
            damaged(format!(
                "the sizes before the data come to {found} bytes in {what}, not to {wanted}"
            ))
        };
        let size_bytes = if coding.wide_sizes { 8 } else { 4 };
        let count = size(input, coding)?;
        if coding.codec == Codec::None {
            if count != coding.wanted_bytes {
                return Err(wrong("one piece", count));
            }
            return Ok(Self {
                encoded_bytes: count.saturating_add(size_bytes),
                left: Vec::new(),
                block_bytes: 0,
                last_bytes: 0,
                plain_left: count,
            });
        }
        let block_bytes = size(input, coding)?;
        let last_bytes = match size(input, coding)? {
            0 => block_bytes,
            bytes => bytes,
        };
        let total = count
            .checked_sub(1)
            .and_then(|whole| whole.checked_mul(block_bytes)?.checked_add(last_bytes));
        // Checked before the table is read: its length is the count.
        if total != Some(coding.wanted_bytes) || last_bytes > block_bytes {
            return Err(wrong("blocks", total.unwrap_or(u64::MAX)));
        }
        if block_bytes > MOST_BLOCK_BYTES {
            let what = format!("a block of {block_bytes} bytes, more than {MOST_BLOCK_BYTES}");
            return Err(damaged(what));
        }
        let mut sizes = Self {
            encoded_bytes: count.saturating_add(3).saturating_mul(size_bytes),
            left: Vec::new(),
            block_bytes,
            last_bytes,
            plain_left: 0,
        };
        for index in 1..=count {
            let compressed = size(input, coding)?;
            let bytes = if index == count {
                last_bytes
            } else {
                block_bytes
            };
            // Deflate's and LZ4's longest runs; a block that promises more is a lie.
            let most = match coding.codec {
                Codec::Lz4 => 255,
                _ => 1032,
            };
            if bytes > compressed.saturating_mul(most) || compressed > 2 * MOST_BLOCK_BYTES {
                return Err(damaged(format!(
                    "block {index} of {bytes} bytes cannot have {compressed} compressed ones"
                )));
            }
            sizes.encoded_bytes = sizes.encoded_bytes.saturating_add(compressed);
            sizes.left.push(compressed);
        }
        sizes.left.reverse();
        Ok(sizes)
    }
}

/// One of the sizes.
fn size(input: &mut impl Read, coding: Coding) -> io::Result<u64> {
    let mut wide = [0; 8];
    let mut narrow = [0; 4];
    if coding.wide_sizes {
        input.read_exact(&mut wide)?;
    } else {
        input.read_exact(&mut narrow)?;
    }
    Ok(match (coding.wide_sizes, coding.endian) {
        (true, Endian::Little) => u64::from_le_bytes(wide),
        (true, Endian::Big) => u64::from_be_bytes(wide),
        (false, Endian::Little) => u32::from_le_bytes(narrow).into(),
        (false, Endian::Big) => u32::from_be_bytes(narrow).into(),
    })
}

/// The bytes of an array, one block in memory at a time.
struct Blocks {
    input: Box<dyn Read>,
    coding: Coding,
    /// `None` before the first byte is wanted.
    sizes: Option<Sizes>,
    /// The block at hand, and how much of it is given.
    block: Vec<u8>,
    given: usize,
}

impl Read for Blocks {
    fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
        let sizes = match &mut self.sizes {
            Some(sizes) => sizes,
            none => none.insert(Sizes::read(&mut self.input, self.coding)?),
        };
        if self.coding.codec == Codec::None {
            let most = usize::try_from(sizes.plain_left).unwrap_or(usize::MAX);
            let length = out.len().min(most);
            let count = self.input.read(out.get_mut(..length).unwrap_or_default())?;
            if count == 0 && length > 0 {
                return Err(io::ErrorKind::UnexpectedEof.into());
            }
            sizes.plain_left = sizes.plain_left.saturating_sub(to_u64(count));
            return Ok(count);
        }
        if self.given >= self.block.len() && !out.is_empty() {
            let Some(compressed) = sizes.left.pop() else {
                return Ok(0);
            };
            let bytes = match sizes.left.is_empty() {
                true => sizes.last_bytes,
                false => sizes.block_bytes,
            };
            expand(
                &mut self.input,
                self.coding.codec,
                compressed,
                bytes,
                &mut self.block,
            )?;
            self.given = 0;
        }
        let rest = self.block.get(self.given..).unwrap_or(&[]);
        let count = rest.len().min(out.len());
        for (to, from) in out.iter_mut().zip(rest) {
            *to = *from;
        }
        self.given = self.given.saturating_add(count);
        Ok(count)
    }
}

/// Decodes one block of exactly `bytes` bytes into `block`.
fn expand(
    input: &mut impl Read,
    codec: Codec,
    compressed: u64,
    bytes: u64,
    block: &mut Vec<u8>,
) -> io::Result<()> {
    let mut encoded = Vec::new();
    input.take(compressed).read_to_end(&mut encoded)?;
    if to_u64(encoded.len()) != compressed {
        return Err(io::ErrorKind::UnexpectedEof.into());
    }
    block.clear();
    block.resize(usize::try_from(bytes).unwrap_or(usize::MAX), 0);
    // The decoder is not ours: whatever it does, it is this block that is wrong.
    let decoded = fenced(|| match codec {
        Codec::Lz4 => lz4_flex::block::decompress_into(&encoded, block).map_err(damaged),
        _ => inflate(&encoded, block),
    });
    let count = decoded.unwrap_or_else(|words| Err(damaged(words)))?;
    if count != block.len() {
        let wanted = block.len();
        return Err(damaged(format!(
            "a block holds {count} bytes, not {wanted}"
        )));
    }
    Ok(())
}

/// One whole zlib stream, checksum included; gives the number of bytes.
fn inflate(encoded: &[u8], out: &mut [u8]) -> io::Result<usize> {
    let mut zlib = Decompress::new(true);
    let status = zlib
        .decompress(encoded, out, FlushDecompress::Finish)
        .map_err(damaged)?;
    if status != Status::StreamEnd || zlib.total_in() != to_u64(encoded.len()) {
        return Err(damaged("a block does not end where its size says"));
    }
    usize::try_from(zlib.total_out()).map_err(damaged)
}
