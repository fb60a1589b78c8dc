//! Rows of a text table by RFC 4180: fields between delimiters, or in double quotes, in which a quote stands twice.
//!
//! Lines end with LF or CRLF. Before the first row, lines that begin with `#` are comments; blank lines are none anywhere. A row
//! never takes more memory than a limit, and its number is that of its first line.

use crate::format::convert::to_u64;
use crate::format::problem::{self, invalid};
use crate::volume::Problem;
use std::io::{BufRead, Read};

/// Columns of one table.
const MOST_FIELDS: usize = 4096;

/// A row.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct TextRow {
    /// Where it begins, from 1.
    pub line: u64,
    pub fields: Vec<String>,
}

/// Rows, the first one first.
#[derive(Debug)]
pub(super) struct TextRows<R> {
    input: R,
    format: &'static str,
    delimiter: u8,
    most_bytes: usize,
    lines: u64,
    is_first: bool,
    /// True once a line had no end.
    is_open: bool,
}

/// What a row goes on with.
enum State {
    /// Nothing of the field was read.
    Start,
    Plain,
    Quoted,
    /// Behind a quote inside of quotes: it ends them, or is one of two.
    Quote,
}

impl<R: BufRead> TextRows<R> {
    pub(super) fn new(input: R, format: &'static str, delimiter: u8, most_bytes: usize) -> Self {
        Self {
            input,
            format,
            delimiter,
            most_bytes,
            lines: 0,
            is_first: true,
            is_open: false,
        }
    }

    /// True where the last line has no end.
    pub(super) fn is_open(&self) -> bool {
        self.is_open
    }

    /// The next row; `None` at the end.
    pub(super) fn next(&mut self) -> Result<Option<TextRow>, Problem> {
        loop {
            let Some(bytes) = self.line(0)? else {
                return Ok(None);
            };
            let bytes = match self.lines {
                1 => bytes
                    .strip_prefix(b"\xef\xbb\xbf")
                    .unwrap_or(&bytes)
                    .to_vec(),
                _ => bytes,
            };
            let is_comment = self.is_first && bytes.first() == Some(&b'#');
            let is_blank = bytes.trim_ascii().is_empty() && !bytes.contains(&self.delimiter);
            if is_comment || is_blank {
                continue;
            }
            self.is_first = false;
            return self.row(bytes).map(Some);
        }
    }

    /// A line without its end, of a row that has so many bytes already.
    fn line(&mut self, taken: usize) -> Result<Option<Vec<u8>>, Problem> {
        let left = self.most_bytes.saturating_sub(taken);
        let mut bytes = Vec::new();
        self.input
            .by_ref()
            .take(to_u64(left).saturating_add(1))
            .read_until(b'\n', &mut bytes)
            .map_err(problem::io("reading rows"))?;
        if bytes.len() > left {
            return Err(Problem::Limit {
                what: "a row".to_owned(),
                wanted_bytes: to_u64(taken.saturating_add(bytes.len())),
                limit_bytes: to_u64(self.most_bytes),
            });
        }
        if bytes.is_empty() {
            return Ok(None);
        }
        self.lines = self.lines.saturating_add(1);
        if bytes.pop_if(|byte| *byte == b'\n').is_none() {
            self.is_open = true;
        }
        bytes.pop_if(|byte| *byte == b'\r');
        Ok(Some(bytes))
    }

    fn row(&mut self, first: Vec<u8>) -> Result<TextRow, Problem> {
        let (line, format) = (self.lines, self.format);
        let wrong = |wanted: &str, found: &[u8]| {
            let found = String::from_utf8_lossy(found);
            invalid(format, &format!("line {line}"), wanted, &found)
        };
        let mut taken = first.len();
        let mut fields = Vec::new();
        let mut field = Vec::new();
        let mut state = State::Start;
        let mut bytes = first;
        loop {
            for &byte in &bytes {
                state = match (state, byte) {
                    (State::Quoted, b'"') => State::Quote,
                    (State::Quoted, _) => {
                        field.push(byte);
                        State::Quoted
                    }
                    (State::Quote, b'"') => {
                        field.push(byte);
                        State::Quoted
                    }
                    (_, byte) if byte == self.delimiter => {
                        fields.push(text(&mut field));
                        if fields.len() >= MOST_FIELDS {
                            return Err(wrong("at most 4096 fields", b"more"));
                        }
                        State::Start
                    }
                    (State::Start, b'"') => State::Quoted,
                    (State::Quote, _) => return Err(wrong("a delimiter behind quotes", &bytes)),
                    (_, b'"') => return Err(wrong("quotes around a whole field", &bytes)),
                    _ => {
                        field.push(byte);
                        State::Plain
                    }
                };
            }
            if !matches!(state, State::Quoted) {
                fields.push(text(&mut field));
                return Ok(TextRow { line, fields });
            }
            // A line end inside of quotes is a part of the field.
            field.push(b'\n');
            let next = self.line(taken)?;
            bytes = next.ok_or_else(|| {
                let line = format!("line {line}");
                invalid(format, &line, "a quote that ends the field", "none")
            })?;
            taken = taken.saturating_add(bytes.len());
        }
    }
}

fn text(field: &mut Vec<u8>) -> String {
    let text = String::from_utf8_lossy(field).into_owned();
    field.clear();
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(text: &str) -> Result<Vec<(u64, Vec<String>)>, Problem> {
        let mut rows = TextRows::new(text.as_bytes(), "csv", b',', 64);
        let mut all = Vec::new();
        while let Some(row) = rows.next()? {
            all.push((row.line, row.fields));
        }
        Ok(all)
    }

    #[test]
    fn rows_have_the_numbers_of_their_lines() {
        for end in ["\n", "\r\n"] {
            let lines = [
                "\u{feff}# c",
                "x,y",
                "",
                "\"a,\"\"b\",2",
                "\"c",
                "d\",3",
                "5",
            ];
            let found = rows(&(lines.join(end) + end)).unwrap();
            let wanted: [(u64, &[&str]); 4] = [
                (2, &["x", "y"]),
                (4, &["a,\"b", "2"]),
                (5, &["c\nd", "3"]),
                (7, &["5"]),
            ];
            let wanted =
                wanted.map(|(line, row)| (line, row.iter().map(|f| (*f).to_owned()).collect()));
            assert_eq!(found, wanted);
        }
    }

    #[test]
    fn quotes_that_are_wrong_and_rows_without_an_end_are_errors() {
        for bad in ["a,\"b", "a\"b,c", "\"a\"b,c"] {
            assert!(
                rows(bad).unwrap_err().to_string().contains("line 1"),
                "{bad}"
            );
        }
        let endless = "\"".to_owned() + &"a\n".repeat(100_000);
        assert!(matches!(rows(&endless), Err(Problem::Limit { .. })));
        let wide = ",".repeat(100);
        assert!(matches!(rows(&wide), Err(Problem::Limit { .. })));
    }
}
