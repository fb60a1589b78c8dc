//! Small files for one test, and reading them back.
#![allow(dead_code, reason = "each test uses a part of it")]

use std::error::Error;
use std::path::PathBuf;
use stratavox::format;
use stratavox::volume::{Header, Limits, Piece, ReadError, TimeComponent, VolumeSelection, Voxels};

/// A folder that goes away with the test.
pub struct Folder(tempfile::TempDir);

impl Folder {
    pub fn new() -> Self {
        Self(tempfile::tempdir().expect("a folder for the test"))
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub fn write(&self, name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
        let path = self.path(name);
        std::fs::write(&path, bytes).expect("a file for the test");
        path
    }

    /// Writes a file, opens it and reads all of its first time and component.
    pub fn read(&self, name: &str, bytes: impl AsRef<[u8]>) -> Result<(Header, Piece), ReadError> {
        let source = format::open(
            &self.write(name, bytes),
            &VolumeSelection::default(),
            &Limits::default(),
        )?;
        let header = source.header().clone();
        let piece = source.read(TimeComponent::default(), header.whole())?;
        Ok((header, piece))
    }

    /// The message of the error that reading gives.
    #[track_caller]
    pub fn refused(&self, name: &str, bytes: impl AsRef<[u8]>) -> String {
        match self.read(name, bytes) {
            Ok((header, piece)) => panic!("read {:?} voxels: {header:?}", piece.voxels.len()),
            Err(error) => message(&error),
        }
    }
}

/// An error with all its causes.
pub fn message(error: &ReadError) -> String {
    let mut message = error.to_string();
    let mut cause = error.source();
    while let Some(next) = cause {
        if !message.ends_with(&next.to_string()) {
            message += &format!(": {next}");
        }
        cause = next.source();
    }
    message
}

/// All numbers as f32.
pub fn numbers(voxels: &Voxels) -> Vec<f32> {
    (0..voxels.len()).map(|i| voxels.stored(i)).collect()
}
