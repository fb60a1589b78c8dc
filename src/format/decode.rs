//! Encoded voxels to bytes, as a stream: memory does not depend on what the stream expands to.
//!
//! gzip is RFC 1952, zlib RFC 1950; their checksums, and those of bzip2, are verified at the end of a stream.

use super::blocks::Coding;
use super::convert::to_u64;
use super::textual::{Fractions, HexBytes, Numbers};
use crate::volume::VoxelType;
use flate2::{Decompress, FlushDecompress, Status};
use std::io::{self, BufRead, Read};

/// How voxels are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Encoding {
    Raw,
    /// gzip (one or more members) or zlib; the first byte tells.
    Gzip,
    /// One or more bzip2 streams.
    Bzip2,
    /// Decimal numbers, white space or commas between.
    Ascii,
    /// Decimal fractions of 255, a byte each.
    Fractions,
    /// Two digits a byte.
    Hex,
    /// As VTK's XML files have it.
    Vtk(Coding),
}

impl Encoding {
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Raw => "raw",
            Self::Gzip => "gzip",
            Self::Bzip2 => "bzip2",
            Self::Ascii => "ascii",
            Self::Fractions => "ascii",
            Self::Hex => "hex",
            Self::Vtk(coding) => coding.name(),
        }
    }

    /// The most bytes of voxels that `encoded_bytes` can hold.
    pub(crate) fn most_bytes(self, encoded_bytes: u64, stored: VoxelType) -> u64 {
        match self {
            Self::Raw => encoded_bytes,
            // Deflate's longest match is 258 bytes from 2 bits: 1032 to 1.
            Self::Gzip => encoded_bytes.saturating_mul(1032),
            // A block of 900 000 bytes after run-length coding of 4 + 255 bytes in 5, in about 40 bytes.
            Self::Bzip2 => encoded_bytes.saturating_mul(1_200_000),
            // A digit and a space each.
            Self::Ascii => encoded_bytes
                .saturating_div(2)
                .saturating_mul(to_u64(stored.bytes())),
            Self::Fractions | Self::Hex => encoded_bytes.saturating_div(2),
            // Its own sizes tell, block by block; this is the most of all its encodings.
            Self::Vtk(_) => encoded_bytes.saturating_mul(1032),
        }
    }

    /// The bytes that `input` encodes; numbers in words come out little-endian.
    pub(crate) fn decode(self, input: impl BufRead + 'static, stored: VoxelType) -> Box<dyn Read> {
        match self {
            Self::Raw => Box::new(input),
            Self::Gzip => Box::new(Expand::new(input, Codec::Undecided)),
            Self::Bzip2 => Box::new(Expand::new(input, Codec::bzip2())),
            Self::Ascii => Box::new(Numbers::new(input, stored)),
            Self::Fractions => Box::new(Fractions::new(input)),
            Self::Hex => Box::new(HexBytes::new(input)),
            Self::Vtk(coding) => coding.decode(input, stored),
        }
    }
}

/// The expanded bytes of a compressed stream.
struct Expand<R> {
    input: R,
    codec: Codec,
    /// True between one member's end and the next one's begin.
    ended: bool,
}

enum Codec {
    /// gzip or zlib: no byte was seen yet.
    Undecided,
    Gzip(Decompress),
    Zlib(Decompress),
    Bzip2(Box<bzip2::Decompress>),
}

/// What one call of a decoder did.
struct Step {
    consumed: usize,
    produced: usize,
    ended: bool,
}

impl<R: BufRead> Expand<R> {
    fn new(input: R, codec: Codec) -> Self {
        Self {
            input,
            codec,
            ended: false,
        }
    }

    /// Starts on another member, or says that there is none. Bytes that begin none are left alone, as gzip(1) does.
    fn begin_next_member(&mut self) -> io::Result<bool> {
        let first = self.input.fill_buf()?.first().copied();
        let next = match (&self.codec, first) {
            (Codec::Gzip(_), Some(GZIP_FIRST)) => Codec::gzip(),
            (Codec::Bzip2(_), Some(b'B')) => Codec::bzip2(),
            _ => return Ok(false),
        };
        self.codec = next;
        self.ended = false;
        Ok(true)
    }
}

impl<R: BufRead> Read for Expand<R> {
    fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
        if out.is_empty() {
            return Ok(0);
        }
        loop {
            if self.ended && !self.begin_next_member()? {
                return Ok(0);
            }
            let input = self.input.fill_buf()?;
            let at_end = input.is_empty();
            let step = self.codec.step(input, out)?;
            self.input.consume(step.consumed);
            self.ended = step.ended;
            if step.produced > 0 {
                return Ok(step.produced);
            }
            if !step.ended && at_end {
                return Err(io::ErrorKind::UnexpectedEof.into());
            }
            if !step.ended && step.consumed == 0 {
                return Err(damaged("the decoder is stuck"));
            }
        }
    }
}

const GZIP_FIRST: u8 = 0x1f;

impl Codec {
    fn gzip() -> Self {
        Self::Gzip(Decompress::new_gzip(15))
    }

    fn bzip2() -> Self {
        Self::Bzip2(Box::new(bzip2::Decompress::new(false)))
    }

    fn step(&mut self, input: &[u8], out: &mut [u8]) -> io::Result<Step> {
        if matches!(self, Self::Undecided) {
            *self = match input.first() {
                None => return Err(io::ErrorKind::UnexpectedEof.into()),
                Some(&GZIP_FIRST) => Self::gzip(),
                Some(_) => Self::Zlib(Decompress::new(true)),
            };
        }
        match self {
            Self::Undecided => Err(damaged("no data")),
            Self::Gzip(flate) | Self::Zlib(flate) => {
                let before = (flate.total_in(), flate.total_out());
                let status = flate
                    .decompress(input, out, FlushDecompress::None)
                    .map_err(damaged)?;
                Ok(Step {
                    consumed: since(before.0, flate.total_in()),
                    produced: since(before.1, flate.total_out()),
                    ended: status == Status::StreamEnd,
                })
            }
            Self::Bzip2(bzip2) => {
                let before = (bzip2.total_in(), bzip2.total_out());
                let status = bzip2.decompress(input, out).map_err(damaged)?;
                Ok(Step {
                    consumed: since(before.0, bzip2.total_in()),
                    produced: since(before.1, bzip2.total_out()),
                    ended: status == bzip2::Status::StreamEnd,
                })
            }
        }
    }
}

fn since(before: u64, after: u64) -> usize {
    usize::try_from(after.saturating_sub(before)).unwrap_or(usize::MAX)
}

/// An error that says that the bytes are wrong, not that they cannot be had.
pub(crate) fn damaged(cause: impl ToString) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, cause.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;

    fn gzip(bytes: &[u8]) -> Vec<u8> {
        let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
        encoder.write_all(bytes).unwrap();
        encoder.finish().unwrap()
    }

    fn zlib(bytes: &[u8]) -> Vec<u8> {
        let mut encoder = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::fast());
        encoder.write_all(bytes).unwrap();
        encoder.finish().unwrap()
    }

    fn bzip2(bytes: &[u8]) -> Vec<u8> {
        let mut encoder = ::bzip2::write::BzEncoder::new(Vec::new(), ::bzip2::Compression::fast());
        encoder.write_all(bytes).unwrap();
        encoder.finish().unwrap()
    }

    fn decoded(encoding: Encoding, bytes: &[u8]) -> io::Result<Vec<u8>> {
        let mut out = Vec::new();
        encoding
            .decode(io::Cursor::new(bytes.to_vec()), VoxelType::U8)
            .read_to_end(&mut out)?;
        Ok(out)
    }

    #[test]
    fn members_one_after_another_are_one_stream_and_garbage_behind_is_left_alone() {
        for (encoding, encode) in [
            (Encoding::Gzip, gzip as fn(&[u8]) -> Vec<u8>),
            (Encoding::Bzip2, bzip2),
        ] {
            let mut bytes = encode(b"one ");
            bytes.extend(encode(b""));
            bytes.extend(encode(b"two"));
            bytes.extend([0; 7]);
            assert_eq!(
                decoded(encoding, &bytes).unwrap(),
                b"one two",
                "{encoding:?}"
            );
        }
        assert_eq!(decoded(Encoding::Gzip, &zlib(b"three")).unwrap(), b"three");
    }

    #[test]
    fn a_stream_cut_anywhere_is_an_error_even_inside_its_checksum() {
        let plain: Vec<u8> = (0..500_u32).map(|i| (i * i % 251) as u8).collect();
        for (encoding, bytes) in [
            (Encoding::Gzip, gzip(&plain)),
            (Encoding::Gzip, zlib(&plain)),
            (Encoding::Bzip2, bzip2(&plain)),
        ] {
            assert_eq!(decoded(encoding, &bytes).unwrap(), plain, "{encoding:?}");
            for cut in 0..bytes.len() {
                let error = decoded(encoding, &bytes[..cut]).err();
                assert!(
                    error.is_some(),
                    "{encoding:?} cut at {cut} of {}",
                    bytes.len()
                );
            }
        }
    }

    #[test]
    fn a_flipped_bit_of_the_checksum_is_found() {
        for (encoding, mut bytes) in [
            (Encoding::Gzip, gzip(b"voxels")),
            (Encoding::Gzip, zlib(b"voxels")),
            (Encoding::Bzip2, bzip2(b"voxels")),
        ] {
            let at = bytes.len() - if bytes[0] == GZIP_FIRST { 8 } else { 3 };
            bytes[at] ^= 1;
            assert!(decoded(encoding, &bytes).is_err(), "{encoding:?}");
        }
    }
}
