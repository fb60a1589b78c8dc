//! What can be wrong with a source: its file, the field, what was wanted and what was found.

use std::path::PathBuf;

/// What went wrong with a source, and with which one.
#[derive(Debug, thiserror::Error)]
#[error("cannot read {}: {problem}", path.display())]
pub struct ReadError {
    /// The file, folder or phantom.
    pub path: PathBuf,
    /// What was found there.
    #[source]
    pub problem: Problem,
}

/// What can be wrong with a source. Texts taken from a file are escaped before they get here.
#[derive(Debug, thiserror::Error)]
pub enum Problem {
    /// The system would not let us.
    #[error("{doing}")]
    Io {
        /// What was being done.
        doing: &'static str,
        /// The system's word.
        #[source]
        cause: std::io::Error,
    },
    /// No reader knows these bytes.
    #[error("unknown format{0}")]
    UnknownFormat(String),
    /// A field that must be there is not.
    #[error("the {format} header has no `{field}`")]
    Missing {
        /// The kind of file.
        format: &'static str,
        /// The field.
        field: String,
    },
    /// A field says something that cannot be.
    #[error("{format} field `{field}`: wanted {wanted}, found {found}")]
    Invalid {
        /// The kind of file.
        format: &'static str,
        /// The field.
        field: String,
        /// What would do.
        wanted: String,
        /// What stands there.
        found: String,
    },
    /// Fewer (or more) bytes than promised.
    #[error(
        "{format} data: {} promises {wanted_bytes} bytes of voxels, found {found_bytes}", promiser(.format)
    )]
    Size {
        /// The kind of file.
        format: &'static str,
        /// What the header promises.
        wanted_bytes: u64,
        /// What is there.
        found_bytes: u64,
    },
    /// So few encoded bytes cannot hold so many voxels.
    #[error(
        "{format} data: the header promises {wanted_bytes} bytes of voxels, which {encoded_bytes} bytes of {encoding} cannot hold"
    )]
    TooFewEncoded {
        /// The kind of file.
        format: &'static str,
        /// How the voxels are written.
        encoding: &'static str,
        /// What the header promises.
        wanted_bytes: u64,
        /// What is there, encoded.
        encoded_bytes: u64,
    },
    /// The encoded voxels cannot be decoded.
    #[error(
        "{format} data: the {encoding} voxels are damaged after {decoded_bytes} good bytes: {cause}"
    )]
    Damaged {
        /// The kind of file.
        format: &'static str,
        /// How the voxels are written.
        encoding: &'static str,
        /// How many bytes of voxels came out before.
        decoded_bytes: u64,
        /// What the decoder says.
        cause: String,
    },
    /// A valid file that we do not read yet; says what.
    #[error("{format}: {what} is not supported")]
    Unsupported {
        /// The kind of file.
        format: &'static str,
        /// The feature.
        what: String,
    },
    /// Cells that are no lattice; says who makes one of them.
    #[error("unstructured grids are not read; resample with vtkResampleToImage to .vti")]
    Unstructured,
    /// More than the limits allow.
    #[error("{what} needs {wanted_bytes} bytes, the limit is {limit_bytes}")]
    Limit {
        /// What is too large.
        what: String,
        /// What it needs.
        wanted_bytes: u64,
        /// What is allowed.
        limit_bytes: u64,
    },
}

/// Who says how many bytes there are: raw voxels have no header.
fn promiser(format: &str) -> &'static str {
    match format {
        "raw" => "the layout that was given",
        _ => "the header",
    }
}
