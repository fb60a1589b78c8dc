//! The text at the head of a file: lines of bounded length, and the numbers in them.

use super::problem;
use crate::volume::Problem;
use std::io::{BufRead, Read};

/// A header, line by line; never more than `limit` bytes of it.
pub(crate) struct Lines<R> {
    input: R,
    read_bytes: u64,
    limit_bytes: u64,
}

/// One line without its end.
pub(crate) struct Line {
    /// UTF-8, or else Latin-1.
    pub text: String,
    /// False where the file stopped before a line end came.
    pub ended: bool,
}

impl<R: BufRead> Lines<R> {
    pub(crate) fn new(input: R, limit_bytes: usize) -> Self {
        Self {
            input,
            read_bytes: 0,
            limit_bytes: u64::try_from(limit_bytes).unwrap_or(u64::MAX),
        }
    }

    /// The next line; `None` at the end of the file.
    pub(crate) fn next(&mut self) -> Result<Option<Line>, Problem> {
        let left = self.limit_bytes.saturating_sub(self.read_bytes);
        let mut bytes = Vec::new();
        // One byte more than allowed, so that "just fits" and "too long" differ.
        self.input
            .by_ref()
            .take(left.saturating_add(1))
            .read_until(b'\n', &mut bytes)
            .map_err(problem::io("reading the header"))?;
        let length = u64::try_from(bytes.len()).unwrap_or(u64::MAX);
        if length > left {
            return Err(Problem::Limit {
                what: "the header".to_owned(),
                wanted_bytes: self.read_bytes.saturating_add(length),
                limit_bytes: self.limit_bytes,
            });
        }
        self.read_bytes = self.read_bytes.saturating_add(length);
        if bytes.is_empty() {
            return Ok(None);
        }
        let ended = bytes.pop_if(|byte| *byte == b'\n').is_some();
        bytes.pop_if(|byte| *byte == b'\r');
        let text = String::from_utf8(bytes)
            .unwrap_or_else(|error| error.into_bytes().into_iter().map(char::from).collect());
        Ok(Some(Line { text, ended }))
    }

    /// Bytes read so far: where the next line, or the data behind the header, begins.
    pub(crate) fn position(&self) -> u64 {
        self.read_bytes
    }
}

/// A decimal number; `nan` and `inf` are numbers here.
pub(crate) fn number(word: &str) -> Option<f64> {
    word.trim().parse().ok()
}

/// The words of `text` as numbers, or `None` where one is not a number.
pub(crate) fn numbers(text: &str) -> Option<Vec<f64>> {
    text.split_ascii_whitespace().map(number).collect()
}

/// The words of `text` as whole numbers, or `None` where one is not.
pub(crate) fn integers(text: &str) -> Option<Vec<i64>> {
    text.split_ascii_whitespace()
        .map(|word| word.parse().ok().or_else(|| whole(number(word)?)))
        .collect()
}

/// The whole number that `x` is. The one way from a float of a file to an integer.
pub(crate) fn whole(x: f64) -> Option<i64> {
    const EXACT: f64 = 9_007_199_254_740_992.0; // 2^53: above, not every whole number is an f64
    #[allow(
        clippy::cast_possible_truncation,
        reason = "checked in the same line to be whole and in range"
    )]
    (x.fract() == 0.0 && x.abs() <= EXACT).then_some(x as i64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_float_becomes_an_integer_only_where_it_is_one() {
        assert_eq!(whole(-3.0), Some(-3));
        assert_eq!(whole(9_007_199_254_740_992.0), Some(1 << 53));
        for x in [0.5, f64::NAN, f64::INFINITY, -f64::INFINITY, 1e16, -1e300] {
            assert_eq!(whole(x), None, "{x}");
        }
    }

    #[test]
    fn a_header_line_longer_than_the_limit_is_refused_and_one_that_fits_is_not() {
        let text = b"12345\r\n6789";
        let mut lines = Lines::new(&text[..], 11);
        let first = lines.next().unwrap().unwrap();
        assert_eq!((first.text.as_str(), first.ended), ("12345", true));
        assert_eq!(lines.position(), 7);
        let last = lines.next().unwrap().unwrap();
        assert_eq!((last.text.as_str(), last.ended), ("6789", false));
        assert!(lines.next().unwrap().is_none());

        let mut lines = Lines::new(&text[..], 6);
        assert!(matches!(
            lines.next(),
            Err(Problem::Limit { limit_bytes: 6, .. })
        ));
    }
}
