//! Raw voxels, described by the command line: being built.

use crate::volume::{Limits, Problem, ReadError, Source};
use std::path::Path;

/// Placeholder until the reader lands.
#[derive(Clone, Debug)]
pub struct Layout;

impl Layout {
    /// Not yet.
    pub fn parse(_: &str) -> Result<Self, String> {
        Err("not built yet".into())
    }
}

/// Not yet.
pub fn open(path: &Path, _: &Layout, _: &Limits) -> Result<Box<dyn Source>, ReadError> {
    let problem = Problem::Unsupported {
        format: "raw",
        what: "raw".into(),
    };
    Err(ReadError {
        path: path.to_owned(),
        problem,
    })
}
