//! Zarr stores that other programs wrote: `tests/fixtures/zarr/variants.json`, and `make.py` that made it.
#![allow(dead_code, reason = "each test uses a part of it")]

use serde_json::Value;
use std::path::{Path, PathBuf};
use stratavox::format;
use stratavox::volume::{Limits, ReadError, Source, TimeComponent, VolumeSelection, VoxelBox};

/// All stores, by name.
pub fn variants() -> serde_json::Map<String, Value> {
    let text = include_str!("../fixtures/zarr/variants.json");
    let variants = serde_json::from_str::<Value>(text).expect("JSON");
    variants.as_object().expect("an object").clone()
}

/// The files of one store.
pub fn files(name: &str) -> Vec<(String, Vec<u8>)> {
    let variants = variants();
    let files = variants[name]["files"].as_object().expect("files");
    files
        .iter()
        .map(|(key, value)| (key.clone(), bytes(value)))
        .collect()
}

/// JSON stands as it is, other files in hexadecimal digits.
fn bytes(value: &Value) -> Vec<u8> {
    match value {
        Value::String(digits) => {
            let byte = |at: usize| u8::from_str_radix(&digits[at..at + 2], 16).expect("hex");
            (0..digits.len()).step_by(2).map(byte).collect()
        }
        json => json.to_string().into_bytes(),
    }
}

/// A store in a folder that goes away with the test.
pub struct Store(tempfile::TempDir);

impl Store {
    pub fn new(files: &[(String, Vec<u8>)]) -> Self {
        let store = Self(tempfile::tempdir().expect("a folder for the test"));
        for (key, bytes) in files {
            store.write(key, bytes);
        }
        store
    }

    pub fn of(name: &str) -> Self {
        Self::new(&files(name))
    }

    pub fn path(&self) -> PathBuf {
        self.0.path().to_owned()
    }

    pub fn write(&self, key: &str, bytes: impl AsRef<[u8]>) {
        let path = self.0.path().join(key);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        std::fs::write(path, bytes).expect("a file for the test");
    }

    /// Changes one JSON file.
    pub fn edit(&self, key: &str, change: impl FnOnce(&mut Value)) {
        let path = self.0.path().join(key);
        let mut value = serde_json::from_slice(&std::fs::read(&path).expect(key)).expect("JSON");
        change(&mut value);
        std::fs::write(path, value.to_string()).expect("a file");
    }

    pub fn open(&self) -> Result<Box<dyn Source>, ReadError> {
        open(self.0.path(), None)
    }

    /// The message of the error that opening or reading gives.
    #[track_caller]
    pub fn refused(&self) -> String {
        let read = self.open().and_then(|source| all(&*source));
        match read {
            Ok(numbers) => panic!("read {} numbers", numbers.len()),
            Err(error) => message(&error),
        }
    }
}

pub fn open(path: &Path, variable: Option<&str>) -> Result<Box<dyn Source>, ReadError> {
    let wanted = VolumeSelection {
        variable: variable.map(str::to_owned),
        ..VolumeSelection::default()
    };
    format::open(path, &wanted, &Limits::default())
}

/// Every number of a source: times, then components, then z, y, x.
pub fn all(source: &dyn Source) -> Result<Vec<f64>, ReadError> {
    let header = source.header();
    let mut numbers = Vec::new();
    for time in 0..header.times {
        for component in 0..header.components {
            numbers.extend(region(
                source,
                TimeComponent { time, component },
                header.whole(),
            )?);
        }
    }
    Ok(numbers)
}

pub fn region(
    source: &dyn Source,
    pick: TimeComponent,
    region: VoxelBox,
) -> Result<Vec<f64>, ReadError> {
    let piece = source.read(pick, region)?;
    Ok((0..piece.voxels.len())
        .map(|i| f64::from(piece.voxels.stored(i)))
        .collect())
}

/// An error with all its causes.
pub fn message(error: &ReadError) -> String {
    let mut message = error.to_string();
    let mut cause = std::error::Error::source(error);
    while let Some(next) = cause {
        if !message.ends_with(&next.to_string()) {
            message += &format!(": {next}");
        }
        cause = next.source();
    }
    message
}
