//! Files that other programs wrote, with what those programs read from them.
#![allow(dead_code, reason = "each test uses a part of it")]

use serde_json::Value;
use std::path::PathBuf;
use stratavox::format;
use stratavox::volume::{Limits, ReadError, Source, TimeComponent, VolumeSelection};

/// A file under `tests/fixtures`.
pub fn path(name: &str) -> PathBuf {
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    root.join("tests/fixtures").join(name)
}

/// The JSON that a fixture's script wrote.
pub fn json(name: &str) -> Value {
    let text = std::fs::read_to_string(path(name)).expect("a table of expected numbers");
    serde_json::from_str(&text).expect("JSON")
}

/// The variable as the file stores it.
pub fn open(name: &str, variable: Option<&str>) -> Result<Box<dyn Source>, ReadError> {
    open_as(name, variable, true)
}

pub fn open_as(
    name: &str,
    variable: Option<&str>,
    as_stored: bool,
) -> Result<Box<dyn Source>, ReadError> {
    let wanted = VolumeSelection {
        variable: variable.map(str::to_owned),
        as_stored,
        ..VolumeSelection::default()
    };
    format::open(&path(name), &wanted, &Limits::default())
}

/// Values of one time, x fastest; `None` where there is no data.
pub fn values(source: &dyn Source, pick: TimeComponent) -> Vec<Option<f64>> {
    let header = source.header();
    let piece = source.read(pick, header.whole()).expect("voxels");
    let fill = header.fill.map(|fill| fill as f32);
    (0..piece.voxels.len())
        .map(|i| piece.voxels.stored(i))
        .map(|stored| {
            let valid = stored.is_finite() && Some(stored) != fill;
            valid.then_some(f64::from(stored) * header.rescale.slope + header.rescale.intercept)
        })
        .collect()
}
