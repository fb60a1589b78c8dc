//! `--untrusted`: a volume is read by another process of this program, which the system holds to limits of memory,
//! processor time and open files, to writing no file, and to opening none but its input.
//!
//! ```text
//! this process -- what to open, what to read --> reader
//!              <-- header, voxels, or an error --
//! ```
//!
//! A reader that the system ended is an error of the file like any other.

#[cfg(target_os = "linux")]
mod child;
#[cfg(target_os = "linux")]
mod parent;
#[cfg(target_os = "linux")]
mod sandbox;
#[cfg(target_os = "linux")]
mod wire;

#[cfg(target_os = "linux")]
pub use child::ReadUntrusted;
#[cfg(target_os = "linux")]
pub use parent::open;

/// The verb of the child, like no word that a person may mean.
#[cfg(target_os = "linux")]
pub const VERB: &str = "child-of-untrusted";

/// Limits of processes are Linux's here.
#[cfg(not(target_os = "linux"))]
pub fn open(
    path: &std::path::Path,
    _: Option<&str>,
    _: &crate::volume::VolumeSelection,
    _: &crate::volume::Limits,
) -> Result<Box<dyn crate::volume::Source>, crate::volume::ReadError> {
    Err(crate::volume::ReadError {
        path: path.to_owned(),
        problem: crate::volume::Problem::Unsupported {
            format: "--untrusted",
            what: "a reader with limits of its own on this system".to_owned(),
        },
    })
}
