//! Voxels written with letters: decimal numbers, or two hexadecimal digits a byte.
//!
//! Both streams hold nothing but their numbers: a character that belongs to none is an error.

use super::decode::damaged;
use super::text::whole;
use crate::volume::VoxelType;
use half::f16;
use std::io::{self, BufRead, BufReader, Read};

/// The longest word that is still a number: the 309 digits of the largest f64, and some.
const LONGEST_WORD: usize = 400;

/// Decimal numbers between white space or commas, given as little-endian bytes of one type.
pub(crate) struct Numbers<R> {
    input: R,
    stored: VoxelType,
    /// Bytes of the number that did not fit the caller's buffer, and how many of them are given.
    pending: Vec<u8>,
    given: usize,
}

impl<R: BufRead> Numbers<R> {
    pub(crate) fn new(input: R, stored: VoxelType) -> Self {
        Self {
            input,
            stored,
            pending: Vec::new(),
            given: 0,
        }
    }

    /// The next word, empty at the end. A last word that nothing follows may have lost digits.
    fn word(&mut self) -> io::Result<String> {
        let mut word = String::new();
        loop {
            let input = self.input.fill_buf()?;
            let Some(&byte) = input.first() else {
                return match word.as_str() {
                    "" => Ok(word),
                    _ => Err(damaged(
                        "the file ends within the last number, or its line end is missing",
                    )),
                };
            };
            self.input.consume(1);
            match byte {
                b' ' | b'\t' | b'\n' | b'\r' | 0x0b | 0x0c | b',' => {
                    if !word.is_empty() {
                        return Ok(word);
                    }
                }
                _ if word.len() >= LONGEST_WORD => {
                    return Err(damaged("a number longer than any"));
                }
                _ => word.push(char::from(byte)),
            }
        }
    }
}

impl<R: BufRead> Read for Numbers<R> {
    fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
        if self.given >= self.pending.len() {
            let word = self.word()?;
            if word.is_empty() {
                return Ok(0);
            }
            self.pending = bytes_of(&word, self.stored).ok_or_else(|| {
                let name = self.stored.name();
                damaged(format!("`{}` is no {name}", super::problem::escape(&word)))
            })?;
            self.given = 0;
        }
        let rest = self.pending.get(self.given..).unwrap_or(&[]);
        let count = rest.len().min(out.len());
        for (to, from) in out.iter_mut().zip(rest) {
            *to = *from;
        }
        self.given = self.given.saturating_add(count);
        Ok(count)
    }
}

/// Bytes written as decimal fractions of 255, as VTK writes colors in words.
pub(crate) struct Fractions<R>(Numbers<R>);

impl<R: BufRead> Fractions<R> {
    pub(crate) fn new(input: R) -> Self {
        Self(Numbers::new(input, VoxelType::F64))
    }
}

impl<R: BufRead> Read for Fractions<R> {
    fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
        let mut count = 0_usize;
        for to in out {
            let word = self.0.word()?;
            if word.is_empty() {
                break;
            }
            let fraction = word.parse::<f64>().ok();
            *to = fraction
                .and_then(|fraction| whole((fraction * 255.0).round_ties_even()))
                .and_then(|byte| u8::try_from(byte).ok())
                .ok_or_else(|| {
                    let word = super::problem::escape(&word);
                    damaged(format!("`{word}` is no fraction of 1"))
                })?;
            count = count.saturating_add(1);
        }
        Ok(count)
    }
}

/// The number that `word` means as bytes of `stored`, or `None` where it is none or does not fit.
fn bytes_of(word: &str, stored: VoxelType) -> Option<Vec<u8>> {
    // Some writers print every type through a float: 7 as 7.0 or 7e0.
    let integer = || -> Option<i128> {
        word.parse()
            .ok()
            .or_else(|| whole(word.parse().ok()?).map(i128::from))
    };
    Some(match stored {
        VoxelType::U8 => u8::try_from(integer()?).ok()?.to_le_bytes().to_vec(),
        VoxelType::I8 => i8::try_from(integer()?).ok()?.to_le_bytes().to_vec(),
        VoxelType::U16 => u16::try_from(integer()?).ok()?.to_le_bytes().to_vec(),
        VoxelType::I16 => i16::try_from(integer()?).ok()?.to_le_bytes().to_vec(),
        VoxelType::U32 => u32::try_from(integer()?).ok()?.to_le_bytes().to_vec(),
        VoxelType::I32 => i32::try_from(integer()?).ok()?.to_le_bytes().to_vec(),
        VoxelType::U64 => u64::try_from(integer()?).ok()?.to_le_bytes().to_vec(),
        VoxelType::I64 => i64::try_from(integer()?).ok()?.to_le_bytes().to_vec(),
        VoxelType::F16 => f16::from_f32(word.parse().ok()?).to_le_bytes().to_vec(),
        VoxelType::F32 => word.parse::<f32>().ok()?.to_le_bytes().to_vec(),
        VoxelType::F64 => word.parse::<f64>().ok()?.to_le_bytes().to_vec(),
    })
}

/// Two hexadecimal digits a byte, white space anywhere.
pub(crate) struct HexBytes<R> {
    digits: io::Bytes<BufReader<R>>,
}

impl<R: Read> HexBytes<R> {
    pub(crate) fn new(input: R) -> Self {
        Self {
            digits: BufReader::new(input).bytes(),
        }
    }

    fn digit(&mut self) -> io::Result<Option<u8>> {
        for byte in self.digits.by_ref() {
            let byte = byte?;
            if byte.is_ascii_whitespace() || byte == 0x0b {
                continue;
            }
            let digit = char::from(byte).to_digit(16);
            return digit
                .and_then(|digit| u8::try_from(digit).ok())
                .map(Some)
                .ok_or_else(|| damaged(format!("byte 0x{byte:02x} is no hexadecimal digit")));
        }
        Ok(None)
    }
}

impl<R: Read> Read for HexBytes<R> {
    fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
        let mut count = 0_usize;
        for to in out {
            let Some(high) = self.digit()? else { break };
            let low = self
                .digit()?
                .ok_or_else(|| damaged("an odd number of hexadecimal digits"))?;
            *to = high << 4 | low;
            count = count.saturating_add(1);
        }
        Ok(count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbers(text: &str, stored: VoxelType) -> io::Result<Vec<u8>> {
        let mut out = Vec::new();
        Numbers::new(text.as_bytes(), stored).read_to_end(&mut out)?;
        Ok(out)
    }

    #[test]
    fn a_number_that_does_not_fit_its_type_is_an_error_and_never_wraps() {
        for (word, stored) in [
            ("256", VoxelType::U8),
            ("-1", VoxelType::U8),
            ("-129", VoxelType::I8),
            ("1.5", VoxelType::I16),
            ("18446744073709551616", VoxelType::U64),
            ("nan", VoxelType::I32),
            ("0x10", VoxelType::F32),
        ] {
            let line = format!("{word}\n");
            let error = numbers(&line, stored).expect_err(word).to_string();
            assert!(error.contains(word), "{error}");
        }
        assert_eq!(
            numbers("18446744073709551615 ", VoxelType::U64).unwrap(),
            [255; 8]
        );
        assert!(numbers(&"9".repeat(100_000), VoxelType::F64).is_err());
    }

    #[test]
    fn a_last_number_that_nothing_follows_is_not_believed() {
        assert!(numbers("10 12", VoxelType::U8).is_err());
        assert_eq!(numbers("10 12\n", VoxelType::U8).unwrap(), [10, 12]);
    }

    #[test]
    fn words_stand_between_white_space_and_commas_and_may_be_written_as_floats() {
        let found = numbers("1,2 , 3\n\t4.0\r\n 5e0 ", VoxelType::U8).unwrap();
        assert_eq!(found, [1, 2, 3, 4, 5]);
        let found = numbers("-inf nan 0.25\n", VoxelType::F32).unwrap();
        assert_eq!(found[..4], f32::NEG_INFINITY.to_le_bytes());
        assert_eq!(found[8..], 0.25_f32.to_le_bytes());
    }

    #[test]
    fn hexadecimal_digits_come_in_pairs_of_either_case() {
        let read = |text: &'static str| {
            let mut out = Vec::new();
            HexBytes::new(text.as_bytes())
                .read_to_end(&mut out)
                .map(|_| out)
        };
        assert_eq!(read("00 fF\n7 a").unwrap(), [0, 255, 0x7a]);
        assert!(read("0").is_err());
        assert!(read("0g").is_err());
    }
}
