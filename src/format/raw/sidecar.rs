//! The JSON beside raw voxels. A key that is not known is an error: it may be one of ours, misspelled.

use super::{RAW, RawSpec, TYPES, type_of};
use crate::format::convert::to_u64;
use crate::format::place::{Folder, first_bytes, open_regular};
use crate::format::problem::{at, escape, invalid, missing};
use crate::volume::{Limits, Problem, ReadError};
use serde::Deserialize;
use std::path::{Path, PathBuf};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Sidecar {
    file: String,
    dims: [u32; 3],
    r#type: String,
    endian: Option<String>,
    spacing: Option<[f64; 3]>,
    #[serde(default)]
    header_bytes: u64,
}

/// The file that a sidecar names, and what is in it.
pub(super) fn read(path: &Path, limits: &Limits) -> Result<(PathBuf, RawSpec), ReadError> {
    let text = text(path, limits).map_err(at(path))?;
    let sidecar: Sidecar = serde_json::from_slice(&text).map_err(|error| {
        at(path)(Problem::Invalid {
            format: RAW,
            field: "sidecar".to_owned(),
            wanted: "an object with `file`, `dims` and `type`".to_owned(),
            found: escape(&error.to_string()),
        })
    })?;
    let spec = spec(&sidecar).map_err(at(path))?;
    let voxels =
        Folder::of(path, RAW, limits)
            .map_err(at(path))?
            .resolve(&sidecar.file, RAW, "file")?;
    Ok((voxels, spec))
}

fn text(path: &Path, limits: &Limits) -> Result<Vec<u8>, Problem> {
    let (mut file, metadata) = open_regular(path)?;
    let limit_bytes = to_u64(limits.max_header_bytes);
    if metadata.len() > limit_bytes {
        return Err(Problem::Limit {
            what: "the sidecar".to_owned(),
            wanted_bytes: metadata.len(),
            limit_bytes,
        });
    }
    first_bytes(&mut file, limit_bytes)
}

fn spec(sidecar: &Sidecar) -> Result<RawSpec, Problem> {
    if sidecar.dims.contains(&0) {
        let found = format!("{:?}", sidecar.dims);
        return Err(invalid(RAW, "dims", "three numbers above 0", &found));
    }
    let stored =
        type_of(&sidecar.r#type).ok_or_else(|| invalid(RAW, "type", TYPES, &sidecar.r#type))?;
    let is_big_endian = match sidecar.endian.as_deref() {
        Some("little") => false,
        Some("big") => true,
        None if stored.bytes() == 1 => false,
        None => return Err(missing(RAW, "endian")),
        Some(other) => return Err(invalid(RAW, "endian", "little or big", other)),
    };
    let spacing = sidecar.spacing.unwrap_or([1.0; 3]);
    if !spacing.iter().all(|&length| length > 0.0) {
        let found = format!("{spacing:?}");
        return Err(invalid(RAW, "spacing", "three lengths above 0", &found));
    }
    Ok(RawSpec {
        dims: sidecar.dims,
        stored,
        spacing,
        is_big_endian,
        header_bytes: sidecar.header_bytes,
    })
}
