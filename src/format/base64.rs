//! Base64 to bytes, as a stream (RFC 4648, section 4).
//!
//! White space may stand anywhere. Padding ends a group and not the stream: VTK encodes the sizes of an array
//! and its blocks one after the other, each padded by itself.

use super::decode::damaged;
use std::io::{self, BufRead, Read};

/// The bytes that `input` encodes.
pub(crate) struct Base64<R> {
    input: R,
    /// Six bits a letter of the group that has begun, and how many letters it has.
    group: u32,
    letters: u32,
    /// True between the first and the last `=` of a group.
    padding: bool,
    /// Decoded, and how many of them are given.
    ready: Vec<u8>,
    given: usize,
    /// What came behind the ready bytes.
    failed: Option<io::Error>,
}

impl<R: BufRead> Base64<R> {
    pub(crate) fn new(input: R) -> Self {
        Self {
            input,
            group: 0,
            letters: 0,
            padding: false,
            ready: Vec::new(),
            given: 0,
            failed: None,
        }
    }

    /// Decodes what the input has at hand. A wrong letter counts only once the bytes before it are given:
    /// what stands behind an array belongs to somebody else.
    fn refill(&mut self) -> io::Result<()> {
        self.ready.clear();
        self.given = 0;
        while self.ready.is_empty() {
            if let Some(error) = self.failed.take() {
                return Err(error);
            }
            let input = self.input.fill_buf()?;
            if input.is_empty() {
                return match self.letters {
                    0 => Ok(()),
                    _ => Err(io::ErrorKind::UnexpectedEof.into()),
                };
            }
            let count = input.len();
            let mut group = Group {
                bits: self.group,
                letters: self.letters,
                padding: self.padding,
            };
            for &byte in input {
                if let Err(error) = group.add(byte, &mut self.ready) {
                    self.failed = Some(error);
                    break;
                }
            }
            self.group = group.bits;
            self.letters = group.letters;
            self.padding = group.padding;
            self.input.consume(count);
        }
        Ok(())
    }
}

/// Up to four letters.
struct Group {
    bits: u32,
    letters: u32,
    padding: bool,
}

impl Group {
    fn add(&mut self, byte: u8, out: &mut Vec<u8>) -> io::Result<()> {
        let value = match byte {
            b'A'..=b'Z' => byte.wrapping_sub(b'A'),
            b'a'..=b'z' => byte.wrapping_sub(b'a').wrapping_add(26),
            b'0'..=b'9' => byte.wrapping_sub(b'0').wrapping_add(52),
            b'+' => 62,
            b'/' => 63,
            b' ' | b'\t' | b'\r' | b'\n' => return Ok(()),
            b'=' => return self.pad(out),
            _ => return Err(damaged(format!("byte 0x{byte:02x} is no letter of base64"))),
        };
        if self.padding {
            return Err(damaged("a letter of base64 between `=` and `=`"));
        }
        self.bits = self.bits << 6 | u32::from(value);
        self.letters = self.letters.wrapping_add(1);
        if self.letters == 4 {
            let [_, bytes @ ..] = self.bits.to_be_bytes();
            out.extend(bytes);
            self.start_again();
        }
        Ok(())
    }

    /// `=`: the group holds one or two bytes. Its last, unused bits must be zero, or letters were changed.
    fn pad(&mut self, out: &mut Vec<u8>) -> io::Result<()> {
        match (self.letters, self.padding) {
            (2, false) => self.padding = true,
            (2, true) if self.bits & 0xf == 0 => {
                out.extend(u8::try_from(self.bits >> 4));
                self.start_again();
            }
            (3, false) if self.bits & 3 == 0 => {
                out.extend(u16::try_from(self.bits >> 2).unwrap_or(0).to_be_bytes());
                self.start_again();
            }
            _ => return Err(damaged("`=` in the wrong place of base64")),
        }
        Ok(())
    }

    fn start_again(&mut self) {
        *self = Self {
            bits: 0,
            letters: 0,
            padding: false,
        };
    }
}

impl<R: BufRead> Read for Base64<R> {
    fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
        if self.given >= self.ready.len() && !out.is_empty() {
            self.refill()?;
        }
        let rest = self.ready.get(self.given..).unwrap_or(&[]);
        let count = rest.len().min(out.len());
        for (to, from) in out.iter_mut().zip(rest) {
            *to = *from;
        }
        self.given = self.given.saturating_add(count);
        Ok(count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn decoded(text: &str) -> io::Result<Vec<u8>> {
        let mut out = Vec::new();
        // A small buffer, so that groups are cut in the middle.
        let input = io::BufReader::with_capacity(3, text.as_bytes());
        Base64::new(input).read_to_end(&mut out)?;
        Ok(out)
    }

    #[test]
    fn the_examples_of_the_definition_are_decoded() {
        for (text, bytes) in [
            ("", ""),
            ("Zg==", "f"),
            ("Zm8=", "fo"),
            ("Zm9v", "foo"),
            ("Zm9vYg==", "foob"),
            ("Zm9vYmE=", "fooba"),
            ("Zm9v\n YmFy ", "foobar"),
            ("Zg==Zm8=Zm9v", "ffofoo"),
        ] {
            assert_eq!(decoded(text).unwrap(), bytes.as_bytes(), "{text}");
        }
        assert_eq!(decoded("+/+/").unwrap(), [0xfb, 0xff, 0xbf]);
    }

    #[test]
    fn a_cut_a_strange_letter_and_padding_in_the_wrong_place_are_errors() {
        for text in [
            "Z", "Zm", "Zm9", "Zg=", "Zm9v-", "====", "Zg=a", "Zh==", "Zm9=", "Z===", "Zm9v=",
        ] {
            assert!(decoded(text).is_err(), "{text}");
        }
    }

    #[test]
    fn what_stands_before_a_strange_letter_is_given_first() {
        let mut stream = Base64::new(&b"Zm9v</A>"[..]);
        let mut out = [0; 3];
        stream.read_exact(&mut out).unwrap();
        assert_eq!(&out, b"foo");
        assert!(stream.read(&mut out).is_err());
    }
}
