//! The Python literal of a `.npy` header: a dict of three known keys. Nothing else of Python is understood.

use super::NPY;
use crate::format::problem::{invalid, missing, unsupported};
use crate::volume::Problem;

/// The three entries.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Literal {
    pub descr: String,
    pub fortran_order: bool,
    pub shape: Vec<u64>,
}

impl Literal {
    pub(super) fn shape_text(&self) -> String {
        shape_text(&self.shape)
    }
}

/// As Python writes a tuple, nearly.
pub(super) fn shape_text(shape: &[u64]) -> String {
    let sizes: Vec<String> = shape.iter().map(u64::to_string).collect();
    format!("({})", sizes.join(", "))
}

/// Axes that are counted before a shape is refused; NumPy has at most 64.
const MOST_AXES: usize = 64;

/// `{'descr': '<f4', 'fortran_order': False, 'shape': (3, 4), }`, in any order of keys.
pub(super) fn parse(text: &str) -> Result<Literal, Problem> {
    let mut rest = Rest(text);
    let (mut descr, mut fortran_order, mut shape) = (None, None, None);
    rest.expect('{')?;
    while !rest.take('}') {
        let key = rest.string()?;
        rest.expect(':')?;
        let is_new = match key {
            "descr" => descr.replace(rest.descr()?.to_owned()).is_none(),
            "fortran_order" => fortran_order.replace(rest.boolean()?).is_none(),
            "shape" => shape.replace(rest.tuple()?).is_none(),
            _ => return Err(wrong("descr, fortran_order and shape alone", key)),
        };
        if !is_new {
            return Err(wrong("each key once", key));
        }
        if !rest.take(',') {
            rest.expect('}')?;
            break;
        }
    }
    rest.skip_space();
    if !rest.0.is_empty() {
        return Err(wrong("nothing behind the dict", rest.0));
    }
    Ok(Literal {
        descr: descr.ok_or_else(|| missing(NPY, "descr"))?,
        fortran_order: fortran_order.ok_or_else(|| missing(NPY, "fortran_order"))?,
        shape: shape.ok_or_else(|| missing(NPY, "shape"))?,
    })
}

fn wrong(wanted: &str, found: &str) -> Problem {
    invalid(NPY, "header", wanted, found)
}

/// What was not read yet.
struct Rest<'a>(&'a str);

impl<'a> Rest<'a> {
    fn skip_space(&mut self) {
        self.0 = self.0.trim_start_matches([' ', '\t', '\r', '\n']);
    }

    fn take(&mut self, c: char) -> bool {
        self.skip_space();
        match self.0.strip_prefix(c) {
            Some(rest) => {
                self.0 = rest;
                true
            }
            None => false,
        }
    }

    fn expect(&mut self, c: char) -> Result<(), Problem> {
        match self.take(c) {
            true => Ok(()),
            false => Err(wrong(&format!("`{c}`"), self.0)),
        }
    }

    /// Text between two quotes of one kind, without escapes.
    fn string(&mut self) -> Result<&'a str, Problem> {
        self.skip_space();
        ['\'', '"']
            .into_iter()
            .find_map(|quote| self.0.strip_prefix(quote)?.split_once(quote))
            .filter(|(text, _)| !text.contains(['\\', '\n']))
            .map(|(text, rest)| {
                self.0 = rest;
                text
            })
            .ok_or_else(|| wrong("a string in quotes", self.0))
    }

    /// The type; a list is a structured one.
    fn descr(&mut self) -> Result<&'a str, Problem> {
        if self.take('[') || self.take('(') {
            return Err(unsupported(NPY, "an array of records (a structured dtype)"));
        }
        self.string()
    }

    fn boolean(&mut self) -> Result<bool, Problem> {
        self.skip_space();
        for (word, value) in [("True", true), ("False", false)] {
            if let Some(rest) = self.0.strip_prefix(word) {
                self.0 = rest;
                return Ok(value);
            }
        }
        Err(wrong("True or False", self.0))
    }

    /// `(3, 4)`, `(3,)` or `()`; Python 2 wrote `3L`.
    fn tuple(&mut self) -> Result<Vec<u64>, Problem> {
        let mut numbers = Vec::new();
        self.expect('(')?;
        while !self.take(')') {
            self.skip_space();
            let end = self.0.find(|c: char| !c.is_ascii_digit());
            let (digits, rest) = self
                .0
                .split_at_checked(end.unwrap_or(0))
                .unwrap_or_default();
            let number = digits
                .parse()
                .map_err(|_| invalid(NPY, "shape", "whole numbers below 2^64", self.0))?;
            if numbers.len() >= MOST_AXES {
                return Err(invalid(NPY, "shape", "2 to 5 axes", "more than 64"));
            }
            numbers.push(number);
            self.0 = rest.strip_prefix('L').unwrap_or(rest);
            if !self.take(',') {
                self.expect(')')?;
                break;
            }
        }
        Ok(numbers)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_numpy_writes_is_understood_and_python_is_not() {
        let written = "{'descr': '<f4', 'fortran_order': False, 'shape': (3, 4), }          \n";
        let wanted = Literal {
            descr: "<f4".to_owned(),
            fortran_order: false,
            shape: vec![3, 4],
        };
        assert_eq!(parse(written).unwrap(), wanted);
        let other = r#"{"shape":(3L,4L),"descr":"<f4","fortran_order":False}"#;
        assert_eq!(parse(other).unwrap(), wanted);
        for bad in [
            "",
            "{",
            "{'descr': '<f4', 'fortran_order': False}",
            "{'descr': '<f4', 'fortran_order': False, 'shape': (3, 4)} x",
            "{'descr': '<f4', 'descr': '<f4', 'fortran_order': False, 'shape': (3, 4)}",
            "{'descr': '<f4', 'fortran_order': False, 'shape': (3 4)}",
            "{'descr': '<f4', 'fortran_order': False, 'shape': [3, 4]}",
            "{'descr': '<f4', 'fortran_order': False, 'shape': (-3, 4)}",
            "{'descr': '<f4', 'fortran_order': False, 'shape': (2**3, 4)}",
            "{'descr': '<f4', 'fortran_order': 0, 'shape': (3, 4)}",
            "{'descr': '\\x3cf4', 'fortran_order': False, 'shape': (3, 4)}",
            "{'descr': '<f4', 'fortran_order': False, 'shape': (3, 4), 'x': 1}",
        ] {
            assert!(parse(bad).is_err(), "{bad}");
        }
    }
}
