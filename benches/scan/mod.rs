//! A real scan beside the built-in head.

use std::path::{Path, PathBuf};

/// Where it lies in the folder of volumes.
pub const SCAN: &str = "ct-cranium/cranium.nrrd";

/// The file, in the folder that `STRATAVOX_DATA` names, else in that beside the project.
pub fn scan() -> PathBuf {
    let beside = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data");
    let folder = std::env::var_os("STRATAVOX_DATA").map_or_else(beside, PathBuf::from);
    folder.join(SCAN)
}
