//! Blosc 1 buffers, undone: blocks that were shuffled, split by byte of the number and compressed each.
//!
//! github.com/Blosc/c-blosc, README_CHUNK_FORMAT.rst:
//!
//! ```text
//! 0 version  1 version of the codec  2 flags  3 type size  4 bytes  8 block bytes  12 buffer bytes   (u32, little-endian)
//! 16 start of each block (u32), unless flag 1: then the bytes follow as they are
//! block: for each split: encoded bytes (i32), encoded split; as many as it decodes to: as they are
//! flags: 0 shuffled, 1 as they are, 2 bits shuffled, 4 not split, 5 to 7 codec
//! ```

use super::blosclz;
use super::codec::{Damage, Length, inflate, lz4, unshuffled, zeros, zstd};
use crate::format::convert::to_u64;

const HEADER_BYTES: usize = 16;

struct Header {
    is_shuffled: bool,
    is_raw: bool,
    are_bits_shuffled: bool,
    is_split: bool,
    codec: u8,
    type_bytes: usize,
    bytes: usize,
    block_bytes: usize,
}

impl Header {
    fn of(buffer: &[u8], length: Length) -> Result<Self, Damage> {
        let [version, _, flags, type_bytes, ..] = *buffer else {
            return Err(format!("{} bytes are no header", buffer.len()));
        };
        if version != 2 {
            return Err(format!("the format version is {version}, we read 2"));
        }
        let header = Self {
            is_shuffled: flags & 1 != 0,
            is_raw: flags & 2 != 0,
            are_bits_shuffled: flags & 4 != 0,
            is_split: flags & 0x10 == 0,
            codec: flags >> 5,
            type_bytes: usize::from(type_bytes),
            bytes: word(buffer, 4)?,
            block_bytes: word(buffer, 8)?,
        };
        let buffer_bytes = word(buffer, 12)?;
        if buffer_bytes != buffer.len() {
            let found = buffer.len();
            return Err(format!(
                "it says it has {buffer_bytes} bytes, it has {found}"
            ));
        }
        length.check(header.bytes)?;
        if header.type_bytes == 0 || (header.block_bytes == 0 && header.bytes != 0) {
            return Err("a type or a block has no bytes".to_owned());
        }
        Ok(header)
    }
}

/// Four bytes at `start` as a number.
fn word(buffer: &[u8], start: usize) -> Result<usize, Damage> {
    buffer
        .get(start..)
        .and_then(<[u8]>::first_chunk)
        .and_then(|bytes| usize::try_from(u32::from_le_bytes(*bytes)).ok())
        .ok_or_else(|| format!("it ends before byte {start}"))
}

/// The bytes that a buffer holds.
pub(super) fn decode(buffer: &[u8], length: Length) -> Result<Vec<u8>, Damage> {
    let header = Header::of(buffer, length)?;
    if header.is_raw {
        let bytes = buffer.get(HEADER_BYTES..).unwrap_or(&[]);
        return Length::Exactly(header.bytes)
            .check(bytes.len())
            .map(|()| bytes.to_vec());
    }
    let mut out = Vec::new();
    let blocks = header.bytes.div_ceil(header.block_bytes);
    let most_blocks = buffer.len().saturating_sub(HEADER_BYTES) / 4;
    if blocks > most_blocks {
        return Err(format!("{blocks} blocks have no room for their starts"));
    }
    for block in 0..blocks {
        let at = block.saturating_mul(4).saturating_add(HEADER_BYTES);
        let start = word(buffer, at)?;
        let left = header.bytes.saturating_sub(out.len());
        let bytes = left.min(header.block_bytes);
        let encoded = buffer.get(start..).unwrap_or(&[]);
        let decoded = header.block(encoded, bytes)?;
        out.try_reserve(decoded.len())
            .map_err(|_| format!("no memory for {} bytes", header.bytes))?;
        out.extend_from_slice(&decoded);
    }
    Ok(out)
}

impl Header {
    /// A block of `bytes` bytes at the beginning of `encoded`.
    fn block(&self, mut encoded: &[u8], bytes: usize) -> Result<Vec<u8>, Damage> {
        // A last block that is shorter is never split.
        let splits = match self.is_split && bytes == self.block_bytes {
            true => self.type_bytes,
            false => 1,
        };
        let split_bytes = bytes.checked_div(splits).unwrap_or(0);
        let mut block = Vec::new();
        for _ in 0..splits {
            let encoded_bytes = word(encoded, 0)?;
            let end = encoded_bytes.saturating_add(4);
            let split = encoded.get(4..end).ok_or_else(|| {
                format!("a split of {encoded_bytes} bytes ends behind the buffer")
            })?;
            encoded = encoded.get(end..).unwrap_or(&[]);
            let decoded = match encoded_bytes == split_bytes {
                true => split.to_vec(),
                false => self.split(split, split_bytes)?,
            };
            block
                .try_reserve(decoded.len())
                .map_err(|_| format!("no memory for {bytes} bytes"))?;
            block.extend_from_slice(&decoded);
        }
        Length::Exactly(bytes).check(block.len())?;
        if self.is_shuffled && self.type_bytes > 1 {
            unshuffled(&block, self.type_bytes)
        } else if self.are_bits_shuffled {
            bits_unshuffled(block, self.type_bytes)
        } else {
            Ok(block)
        }
    }

    fn split(&self, encoded: &[u8], bytes: usize) -> Result<Vec<u8>, Damage> {
        match self.codec {
            0 => blosclz::decode(encoded, bytes),
            1 => lz4(encoded, bytes),
            2 => Err("its codec snappy is not supported".to_owned()),
            3 => inflate(encoded, Length::Exactly(bytes)),
            4 => zstd(encoded, Length::Exactly(bytes)),
            other => Err(format!("its codec has the unknown number {other}")),
        }
    }
}

/// Numbers of `size` bytes whose bits were sorted by their place in the number:
/// bit `i` of number `n` lies in row `i` of `count / 8` bytes, there in bit `n % 8` of byte `n / 8`.
/// Numbers that are no multiple of eight were left as they are.
fn bits_unshuffled(block: Vec<u8>, size: usize) -> Result<Vec<u8>, Damage> {
    let count = block.len().checked_div(size).unwrap_or(0);
    let row = count / 8;
    if row == 0 || count.checked_rem(8) != Some(0) {
        return Ok(block);
    }
    let whole = count.saturating_mul(size);
    let mut out = zeros(block.len())?;
    for (place, rows) in block
        .chunks_exact(row.saturating_mul(8))
        .take(size)
        .enumerate()
    {
        for group in 0..row {
            // Eight bytes, one a bit: a matrix of 8 x 8 bits to be turned about its diagonal.
            let bits = rows.iter().skip(group).step_by(row);
            let matrix = bits.fold(0_u64, |matrix, &byte| {
                (matrix >> 8) | (u64::from(byte) << 56)
            });
            let first = group
                .saturating_mul(8)
                .saturating_mul(size)
                .saturating_add(place);
            let numbers = out.get_mut(first..).unwrap_or(&mut []);
            let turned = transposed(matrix).to_le_bytes();
            for (to, from) in numbers.iter_mut().step_by(size).zip(turned) {
                *to = from;
            }
        }
    }
    let rest = out.iter_mut().zip(&block).skip(whole);
    rest.for_each(|(to, from)| *to = *from);
    debug_assert_eq!(to_u64(out.len()), to_u64(block.len()), "as many bytes");
    Ok(out)
}

/// Bit `8 r + c` to bit `8 c + r`, by swapping ever larger squares (Warren, "Hacker's Delight", 7-3).
fn transposed(matrix: u64) -> u64 {
    let swapped = |x: u64, shift: u32, mask: u64| {
        let moved = (x ^ (x >> shift)) & mask;
        x ^ moved ^ (moved << shift)
    };
    let pairs = swapped(matrix, 7, 0x00aa_00aa_00aa_00aa);
    let quads = swapped(pairs, 14, 0x0000_cccc_0000_cccc);
    swapped(quads, 28, 0x0000_0000_f0f0_f0f0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_matrix_of_bits_is_turned_about_its_diagonal() {
        for row in 0..8 {
            for column in 0..8 {
                let turned = transposed(1 << (8 * row + column));
                assert_eq!(turned, 1 << (8 * column + row), "{row} {column}");
            }
        }
    }

    #[test]
    fn shuffled_bits_come_back_and_bytes_that_fill_no_number_stay() {
        let numbers: Vec<u16> = (0..16).map(|n| n * 4099 + 7).collect();
        let mut shuffled = vec![0_u8; 33];
        for (n, number) in numbers.iter().enumerate() {
            for bit in 0..16 {
                shuffled[bit * 2 + n / 8] |= ((number >> bit) as u8 & 1) << (n % 8);
            }
        }
        shuffled[32] = 99;
        let out = bits_unshuffled(shuffled, 2).unwrap();
        let mut wanted: Vec<u8> = numbers.iter().flat_map(|n| n.to_le_bytes()).collect();
        wanted.push(99);
        assert_eq!(out, wanted);
    }
}
