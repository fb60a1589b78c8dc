//! Codecs of bytes, undone: what comes out has exactly the wanted length, and memory follows what came out.

use super::blosc;
use crate::format::convert::{Endian, to_u64};
use crate::format::decode::Encoding;
use crate::format::zstd;
use crate::volume::VoxelType;
use std::io::{Cursor, Read};

/// One codec of bytes, or a filter of numbers that keeps their count.
#[derive(Clone, Debug)]
pub(super) enum Codec {
    Gzip,
    Zlib,
    Bzip2,
    Zstd,
    /// A length of four bytes, little-endian, and a block of LZ4.
    Lz4,
    Blosc,
    /// Four bytes of checksum at the end.
    Crc32c,
    /// First bytes of all numbers, then second bytes, and so on.
    Shuffle(usize),
    Delta(Delta),
}

/// Each number as the difference to the one before.
#[derive(Clone, Copy, Debug)]
pub(super) struct Delta {
    pub stored: VoxelType,
    pub endian: Endian,
}

/// What is wrong with encoded bytes, in words.
pub(super) type Damage = String;

/// How many bytes must come out.
#[derive(Clone, Copy, Debug)]
pub(super) enum Length {
    Exactly(usize),
    AtMost(usize),
}

impl Length {
    pub(super) fn most(self) -> usize {
        match self {
            Self::Exactly(n) | Self::AtMost(n) => n,
        }
    }

    /// An error where `found` bytes are not what was wanted.
    pub(super) fn check(self, found: usize) -> Result<(), Damage> {
        match self {
            Self::Exactly(wanted) if found != wanted => {
                Err(format!("{wanted} bytes were wanted, {found} came out"))
            }
            Self::AtMost(most) if found > most => Err(format!(
                "at most {most} bytes were wanted, {found} came out"
            )),
            _ => Ok(()),
        }
    }
}

/// The most bytes that any codec makes of `decoded` bytes: none grows them by more than a part in sixteen.
pub(super) fn most_encoded(decoded: u64, codecs: &[Codec]) -> u64 {
    const HEADER_BYTES: u64 = 1 << 12;
    codecs.iter().fold(decoded, |bytes, codec| match codec {
        Codec::Shuffle(_) | Codec::Delta(_) => bytes,
        Codec::Crc32c => bytes.saturating_add(4),
        _ => bytes
            .saturating_add(bytes / 16)
            .saturating_add(HEADER_BYTES),
    })
}

/// Undoes `codecs`, which stand from the numbers to the file. Exactly `wanted` bytes come out.
pub(super) fn decode(
    codecs: &[Codec],
    encoded: Vec<u8>,
    wanted: usize,
) -> Result<Vec<u8>, (&'static str, Damage)> {
    let mut bytes = encoded;
    for (place, codec) in codecs.iter().enumerate().rev() {
        let inner = codecs.get(..place).unwrap_or(&[]);
        let keeps_length = inner
            .iter()
            .all(|codec| matches!(codec, Codec::Shuffle(_) | Codec::Delta(_)));
        let length = if keeps_length {
            Length::Exactly(wanted)
        } else {
            let most = most_encoded(to_u64(wanted), inner);
            Length::AtMost(usize::try_from(most).unwrap_or(usize::MAX))
        };
        bytes = codec
            .decode(bytes, length)
            .and_then(|bytes| length.check(bytes.len()).map(|()| bytes))
            .map_err(|damage| (codec.name(), damage))?;
    }
    let length = Length::Exactly(wanted);
    length
        .check(bytes.len())
        .map_err(|damage| ("raw", damage))?;
    Ok(bytes)
}

impl Codec {
    /// The word for errors.
    fn name(&self) -> &'static str {
        match self {
            Self::Gzip => "gzip",
            Self::Zlib => "zlib",
            Self::Bzip2 => "bz2",
            Self::Zstd => "zstd",
            Self::Lz4 => "lz4",
            Self::Blosc => "blosc",
            Self::Crc32c => "crc32c",
            Self::Shuffle(_) => "shuffle",
            Self::Delta(_) => "delta",
        }
    }

    fn decode(&self, bytes: Vec<u8>, length: Length) -> Result<Vec<u8>, Damage> {
        match self {
            Self::Gzip | Self::Zlib => expand(Encoding::Gzip, bytes, length),
            Self::Bzip2 => expand(Encoding::Bzip2, bytes, length),
            Self::Zstd => zstd(&bytes, length),
            Self::Lz4 => lz4_with_length(&bytes, length),
            Self::Blosc => blosc::decode(&bytes, length),
            Self::Crc32c => without_checksum(bytes),
            Self::Shuffle(size) => unshuffled(&bytes, *size),
            Self::Delta(delta) => Ok(delta.undone(bytes)),
        }
    }
}

fn expand(encoding: Encoding, bytes: Vec<u8>, length: Length) -> Result<Vec<u8>, Damage> {
    collect(encoding.decode(Cursor::new(bytes), VoxelType::U8), length)
}

/// zlib or gzip, as blosc uses it.
pub(super) fn inflate(bytes: &[u8], length: Length) -> Result<Vec<u8>, Damage> {
    expand(Encoding::Gzip, bytes.to_vec(), length)
}

fn collect(input: impl Read, length: Length) -> Result<Vec<u8>, Damage> {
    let out = zstd::collect(input, length.most())?;
    length.check(out.len()).map(|()| out)
}

pub(super) fn zstd(bytes: &[u8], length: Length) -> Result<Vec<u8>, Damage> {
    let out = zstd::decode(bytes, length.most())?;
    length.check(out.len()).map(|()| out)
}

/// A block of LZ4 with its length in front, as numcodecs writes it.
fn lz4_with_length(bytes: &[u8], length: Length) -> Result<Vec<u8>, Damage> {
    let Some((head, block)) = bytes.split_first_chunk() else {
        return Err("the length in front is missing".to_owned());
    };
    let promised = usize::try_from(u32::from_le_bytes(*head)).unwrap_or(usize::MAX);
    length.check(promised)?;
    lz4(block, promised)
}

/// A block of LZ4 of known length.
pub(super) fn lz4(block: &[u8], decoded: usize) -> Result<Vec<u8>, Damage> {
    // A byte of a block stands for at most 255, and a few more for each match.
    if decoded > block.len().saturating_mul(255).saturating_add(64) {
        return Err(format!("{} bytes cannot hold {decoded}", block.len()));
    }
    let mut out = zeros(decoded)?;
    let count = lz4_flex::block::decompress_into(block, &mut out);
    let count = count.map_err(|error| error.to_string())?;
    Length::Exactly(decoded).check(count).map(|()| out)
}

/// `count` zeros, if there is memory for them.
pub(super) fn zeros(count: usize) -> Result<Vec<u8>, Damage> {
    let mut out = Vec::new();
    out.try_reserve_exact(count)
        .map_err(|_| format!("no memory for {count} bytes"))?;
    out.resize(count, 0);
    Ok(out)
}

/// The bytes before a checksum that is right.
pub(super) fn without_checksum(mut bytes: Vec<u8>) -> Result<Vec<u8>, Damage> {
    let Some((body, checksum)) = bytes.split_last_chunk() else {
        return Err("the checksum is missing".to_owned());
    };
    let (wanted, found) = (u32::from_le_bytes(*checksum), crc32c(body));
    if wanted != found {
        return Err(format!(
            "the checksum says {wanted:08x}, the bytes have {found:08x}"
        ));
    }
    bytes.truncate(body.len());
    Ok(bytes)
}

/// RFC 3720, appendix B.4: the polynomial 0x1edc6f41, here with its bits reversed.
fn crc32c(bytes: &[u8]) -> u32 {
    #[allow(
        clippy::indexing_slicing,
        clippy::arithmetic_side_effects,
        reason = "done by the compiler, which would refuse an index or a sum out of range"
    )]
    const TABLE: [u32; 256] = {
        let mut table = [0_u32; 256];
        let mut index = 0_u32;
        while index < 256 {
            let mut rest = index;
            let mut bit = 0;
            while bit < 8 {
                rest = (rest >> 1) ^ (0x82f6_3b78 * (rest & 1));
                bit += 1;
            }
            table[index as usize] = rest;
            index += 1;
        }
        table
    };
    let rest = bytes.iter().fold(u32::MAX, |rest, &byte| {
        let [low, ..] = rest.to_le_bytes();
        let entry = TABLE.get(usize::from(low ^ byte)).copied().unwrap_or(0);
        (rest >> 8) ^ entry
    });
    !rest
}

/// Numbers of `size` bytes whose bytes were sorted by their place in the number. Bytes that fill no number stay last.
pub(super) fn unshuffled(bytes: &[u8], size: usize) -> Result<Vec<u8>, Damage> {
    let mut out = zeros(bytes.len())?;
    let count = bytes.len().checked_div(size).unwrap_or(0);
    let whole = count.saturating_mul(size);
    if size < 2 || count == 0 {
        return Ok(bytes.to_vec());
    }
    for (place, plane) in bytes.chunks_exact(count).take(size).enumerate() {
        let numbers = out.get_mut(place..).unwrap_or(&mut []);
        for (to, from) in numbers.iter_mut().step_by(size).zip(plane) {
            *to = *from;
        }
    }
    let rest = out.iter_mut().zip(bytes).skip(whole);
    rest.for_each(|(to, from)| *to = *from);
    Ok(out)
}

impl Delta {
    /// Running sums. Those of integers wrap around, as those of NumPy do.
    fn undone(self, mut bytes: Vec<u8>) -> Vec<u8> {
        macro_rules! sums {
            ($number:ty, $add:expr) => {{
                let mut sum: $number = Default::default();
                let mut is_first = true;
                for piece in bytes.as_chunks_mut::<{ size_of::<$number>() }>().0 {
                    let step = match self.endian {
                        Endian::Little => <$number>::from_le_bytes(*piece),
                        Endian::Big => <$number>::from_be_bytes(*piece),
                    };
                    // Not 0 + step: that would lose the sign of a negative zero.
                    sum = if is_first { step } else { $add(sum, step) };
                    is_first = false;
                    *piece = match self.endian {
                        Endian::Little => sum.to_le_bytes(),
                        Endian::Big => sum.to_be_bytes(),
                    };
                }
            }};
        }
        match self.stored {
            VoxelType::U8 | VoxelType::I8 => sums!(u8, u8::wrapping_add),
            VoxelType::U16 | VoxelType::I16 | VoxelType::F16 => sums!(u16, u16::wrapping_add),
            VoxelType::U32 | VoxelType::I32 => sums!(u32, u32::wrapping_add),
            VoxelType::U64 | VoxelType::I64 => sums!(u64, u64::wrapping_add),
            VoxelType::F32 => sums!(f32, |a: f32, b: f32| a + b),
            VoxelType::F64 => sums!(f64, |a: f64, b: f64| a + b),
        }
        bytes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_checksum_is_that_of_the_rfc() {
        // RFC 3720, B.4: 32 bytes of zeros, of ones, and counting up.
        assert_eq!(crc32c(&[0; 32]), 0x8a91_36aa);
        assert_eq!(crc32c(&[0xff; 32]), 0x62a8_ab43);
        let counting: Vec<u8> = (0..32).collect();
        assert_eq!(crc32c(&counting), 0x46dd_794e);
    }

    #[test]
    fn bytes_that_fill_no_number_stay_where_they_are() {
        assert_eq!(unshuffled(&[1, 3, 2, 4, 9], 2).unwrap(), [1, 2, 3, 4, 9]);
        assert_eq!(unshuffled(&[7], 4).unwrap(), [7]);
    }

    #[test]
    fn no_codec_gives_more_or_fewer_bytes_than_wanted() {
        let plain = [5_u8; 100];
        let zipped = {
            let mut encoder =
                flate2::read::ZlibEncoder::new(&plain[..], flate2::Compression::best());
            let mut bytes = Vec::new();
            encoder.read_to_end(&mut bytes).unwrap();
            bytes
        };
        let lz4 = [
            &100_u32.to_le_bytes()[..],
            &lz4_flex::block::compress(&plain),
        ]
        .concat();
        for (codec, encoded) in [(Codec::Zlib, zipped), (Codec::Lz4, lz4)] {
            let of = |wanted| decode(std::slice::from_ref(&codec), encoded.clone(), wanted);
            assert_eq!(of(100).unwrap(), plain, "{codec:?}");
            assert!(of(99).is_err() && of(101).is_err(), "{codec:?}");
        }
    }
}
