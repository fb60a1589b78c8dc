//! What a container of arrays holds, and how parts of an array are read.

use crate::format::problem::unsupported;
use crate::volume::{Piece, Problem, VoxelType};
use std::path::{Path, PathBuf};

/// An open container of named arrays.
pub(crate) trait Arrays: Send + Sync {
    /// What it is called and what it holds.
    fn contents(&self) -> &Contents;

    fn path(&self) -> &Path {
        &self.contents().path
    }

    fn format(&self) -> &'static str {
        self.contents().format
    }

    fn variables(&self) -> &[Variable] {
        &self.contents().variables
    }

    fn attributes(&self) -> &Attributes {
        &self.contents().attributes
    }

    /// The numbers of a box of a variable, the last dimension fastest. `stored` is the variable's type, or the
    /// unsigned one of the same size.
    fn read(
        &self,
        variable: &Variable,
        start: &[u64],
        count: &[u64],
        stored: VoxelType,
    ) -> Result<Piece, Problem>;

    /// All numbers of a small variable, exactly.
    fn numbers(&self, _: &Variable) -> Result<Vec<f64>, Problem> {
        Err(unsupported(self.format(), "a coordinate"))
    }

    /// All strings of a small variable; those of an array of characters run along its last dimension.
    fn texts(&self, _: &Variable) -> Result<Vec<String>, Problem> {
        Err(unsupported(self.format(), "an array of text"))
    }
}

/// What a container is called and what it holds.
pub(crate) struct Contents {
    /// The file, as errors name it.
    pub path: PathBuf,
    /// The word of errors.
    pub format: &'static str,
    /// All arrays.
    pub variables: Vec<Variable>,
    /// What is said of the whole file.
    pub attributes: Attributes,
}

/// A named array.
#[derive(Clone, Debug)]
pub(crate) struct Variable {
    /// As `--variable` takes it: with its groups, `group/name`.
    pub name: String,
    /// Slowest first.
    pub dimensions: Vec<Dimension>,
    pub kind: Kind,
    pub attributes: Attributes,
}

impl Variable {
    /// The folder of groups that it lies in, with the slash: `group/`.
    pub(crate) fn group(&self) -> &str {
        let end = self.name.rfind('/').map_or(0, |at| at.saturating_add(1));
        self.name.get(..end).unwrap_or("")
    }

    /// How many numbers it has, at most `u64::MAX`.
    pub(crate) fn count(&self) -> u64 {
        let sizes = self.dimensions.iter().map(|dimension| dimension.size);
        sizes.fold(1, u64::saturating_mul)
    }
}

/// One axis of an array.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Dimension {
    pub name: String,
    pub size: u64,
}

/// What an array is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Numbers(VoxelType),
    Text,
    /// Records, references and the like: never read.
    Other,
}

/// Named facts about a variable or a file.
#[derive(Clone, Debug, Default)]
pub(crate) struct Attributes(pub Vec<(String, Value)>);

/// The value of an attribute.
#[derive(Clone, Debug)]
pub(crate) enum Value {
    Text(String),
    Numbers(Vec<f64>),
}

impl Attributes {
    pub(crate) fn get(&self, name: &str) -> Option<&Value> {
        let found = self.0.iter().find(|(other, _)| other == name);
        found.map(|(_, value)| value)
    }

    /// Without blanks and zero bytes at its ends; `None` where nothing is left.
    pub(crate) fn text(&self, name: &str) -> Option<&str> {
        match self.get(name)? {
            Value::Text(text) => Some(text.trim_matches(|c: char| c == '\0' || c.is_whitespace()))
                .filter(|text| !text.is_empty()),
            Value::Numbers(_) => None,
        }
    }

    pub(crate) fn numbers(&self, name: &str) -> Option<&[f64]> {
        match self.get(name)? {
            Value::Numbers(numbers) => Some(numbers),
            Value::Text(_) => None,
        }
    }

    /// The first number.
    pub(crate) fn number(&self, name: &str) -> Option<f64> {
        self.numbers(name)?.first().copied()
    }
}
