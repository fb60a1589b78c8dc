//! A legacy file read forward: words and lines in bounded text, and arrays that are stepped over.

use super::VTK;
use crate::format::convert::to_u64;
use crate::format::place::open_regular;
use crate::format::problem::{self, invalid};
use crate::volume::Problem;
use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::Path;

/// The longest word that means anything.
const MOST_WORD_BYTES: usize = 4096;

/// Reads forward through a file. Arrays do not count as text.
pub(super) struct Scan {
    input: BufReader<File>,
    position: u64,
    pub file_bytes: u64,
    text_left: u64,
    text_limit: u64,
    /// True where arrays are bytes. Known from the third line on.
    pub is_binary: bool,
}

impl Scan {
    pub(super) fn open(path: &Path, limit_bytes: usize) -> Result<Self, Problem> {
        let (file, metadata) = open_regular(path)?;
        Ok(Self {
            input: BufReader::new(file),
            position: 0,
            file_bytes: metadata.len(),
            text_left: to_u64(limit_bytes),
            text_limit: to_u64(limit_bytes),
            is_binary: false,
        })
    }

    /// The next byte, taken.
    fn byte(&mut self) -> Result<Option<u8>, Problem> {
        let bytes = self.fill()?;
        let Some(&byte) = bytes.first() else {
            return Ok(None);
        };
        self.take(1);
        if self.text_left == 0 {
            return Err(Problem::Limit {
                what: "the header".to_owned(),
                wanted_bytes: self.text_limit.saturating_add(1),
                limit_bytes: self.text_limit,
            });
        }
        self.text_left = self.text_left.saturating_sub(1);
        Ok(Some(byte))
    }

    fn fill(&mut self) -> Result<&[u8], Problem> {
        self.input
            .fill_buf()
            .map_err(problem::io("reading the header"))
    }

    fn take(&mut self, count: usize) {
        self.input.consume(count);
        self.position = self.position.saturating_add(to_u64(count));
    }

    /// The rest of the line without its end; `None` at the end of the file.
    pub(super) fn line(&mut self) -> Result<Option<String>, Problem> {
        let mut line = Vec::new();
        loop {
            match self.byte()? {
                None if line.is_empty() => return Ok(None),
                None | Some(b'\n') => break,
                Some(byte) => line.push(byte),
            }
        }
        line.pop_if(|byte| *byte == b'\r');
        Ok(Some(String::from_utf8_lossy(&line).into_owned()))
    }

    /// The next word; `None` at the end of the file. The white space behind it is not taken.
    pub(super) fn word(&mut self) -> Result<Option<String>, Problem> {
        let mut word = Vec::new();
        while let Some(&byte) = self.fill()?.first() {
            if byte.is_ascii_whitespace() {
                if !word.is_empty() {
                    break;
                }
            } else {
                word.push(byte);
            }
            if word.len() > MOST_WORD_BYTES {
                return Err(invalid(
                    VTK,
                    "header",
                    "words",
                    "4096 letters without space",
                ));
            }
            self.byte()?;
        }
        let text = String::from_utf8_lossy(&word).into_owned();
        Ok((!word.is_empty()).then_some(text))
    }

    /// The next word, in capitals or not.
    pub(super) fn keyword(&mut self) -> Result<Option<String>, Problem> {
        Ok(self.word()?.map(|word| word.to_ascii_uppercase()))
    }

    /// The word that must follow `field`.
    pub(super) fn after(&mut self, field: &str) -> Result<String, Problem> {
        let word = self.word()?;
        word.ok_or_else(|| invalid(VTK, field, "a word behind it", "the end of the file"))
    }

    /// The number that must follow `field`.
    pub(super) fn number<T: std::str::FromStr>(
        &mut self,
        field: &str,
        wanted: &str,
    ) -> Result<T, Problem> {
        let word = self.after(field)?;
        word.parse().map_err(|_| invalid(VTK, field, wanted, &word))
    }

    /// Steps over an array of `count` numbers of `bytes` bytes together. Gives where it begins and ends.
    pub(super) fn array(&mut self, count: u64, bytes: u64) -> Result<(u64, u64), Problem> {
        if !self.is_binary {
            let start = self.position;
            self.skip_words(count)?;
            return Ok((start, self.position));
        }
        let start = self.position;
        let end = start
            .checked_add(bytes)
            .filter(|&end| end <= self.file_bytes);
        let end = end.ok_or(Problem::Size {
            format: VTK,
            wanted_bytes: bytes,
            found_bytes: self.file_bytes.saturating_sub(start),
        })?;
        self.input
            .seek_relative(i64::try_from(bytes).unwrap_or(i64::MAX))
            .map_err(problem::io("stepping over an array"))?;
        self.position = end;
        Ok((start, end))
    }

    /// The one number that stands here, not taken; `None` where it cannot be seen at a glance.
    pub(super) fn peek_number(&mut self, kind: &str) -> Result<Option<f64>, Problem> {
        let is_binary = self.is_binary;
        let bytes = self.fill()?;
        if is_binary {
            return Ok(match kind {
                "double" => bytes.first_chunk().map(|b| f64::from_be_bytes(*b)),
                "float" => bytes.first_chunk().map(|b| f32::from_be_bytes(*b).into()),
                "int" => bytes.first_chunk().map(|b| i32::from_be_bytes(*b).into()),
                _ => None,
            });
        }
        let line = bytes.split(|&byte| byte == b'\n').next().unwrap_or(&[]);
        Ok(String::from_utf8_lossy(line).trim().parse().ok())
    }

    /// Steps over words, and one white space behind the last: without it the last one may be cut.
    fn skip_words(&mut self, count: u64) -> Result<(), Problem> {
        let mut ended = 0_u64;
        let mut inside = false;
        while ended < count {
            let bytes = self.fill()?;
            if bytes.is_empty() {
                return Err(Problem::Invalid {
                    format: VTK,
                    field: "data".to_owned(),
                    wanted: format!("{count} numbers, each with white space behind it"),
                    found: ended.to_string(),
                });
            }
            let mut used = 0_usize;
            for byte in bytes {
                used = used.saturating_add(1);
                let is_space = byte.is_ascii_whitespace();
                if inside && is_space {
                    ended = ended.saturating_add(1);
                    if ended == count {
                        break;
                    }
                }
                inside = !is_space;
            }
            self.take(used);
        }
        Ok(())
    }

    /// Steps over lines up to and with an empty one, or the end of the file.
    pub(super) fn skip_to_empty_line(&mut self) -> Result<(), Problem> {
        // The rest of the line of the word that was read.
        self.line()?;
        while let Some(line) = self.line()? {
            if line.trim().is_empty() {
                break;
            }
        }
        Ok(())
    }
}
