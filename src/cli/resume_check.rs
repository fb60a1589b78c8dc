//! What tells whether words and inputs are still those of a run before, which is gone on with.
//!
//! ```text
//! file    its size, and when it last changed; of a folder names, sizes and changes of all that is in it
//! words   JSON, compared place by place
//! ```

use super::Error;
use crate::volume::{Volume, Voxels};
use serde_json::{Value, json};
use std::{
    fs,
    hash::{DefaultHasher, Hash, Hasher},
    io,
    path::{Path, PathBuf},
    time::UNIX_EPOCH,
};

/// What is known of a file without reading it.
pub fn stamp_of(path: Option<&Path>) -> Result<Value, Error> {
    let Some(path) = path else {
        return Ok(Value::Null);
    };
    stamp(path).map_err(|cause| Error::Input {
        path: path.to_owned(),
        problem: cause.to_string(),
    })
}

/// Size and last change of a file, or of all files in a folder.
fn stamp(path: &Path) -> io::Result<Value> {
    let mut facts = Vec::new();
    let mut bytes = 0;
    let mut rest = vec![path.to_owned()];
    while let Some(path) = rest.pop() {
        // A link to a folder inside could lead in a circle.
        let is_link = path.symlink_metadata()?.is_symlink() && !facts.is_empty();
        let metadata = path.metadata()?;
        if metadata.is_dir() && !is_link {
            let entries = fs::read_dir(&path)?.map(|entry| entry.map(|entry| entry.path()));
            let mut entries = entries.collect::<io::Result<Vec<PathBuf>>>()?;
            entries.sort();
            rest.extend(entries);
        } else {
            bytes += metadata.len();
        }
        let changed = metadata
            .modified()?
            .duration_since(UNIX_EPOCH)
            .unwrap_or_default();
        facts.push(format!(
            "{:?} {} {changed:?}",
            path.file_name(),
            metadata.len()
        ));
    }
    let hash = hash_of(|hasher| facts.hash(hasher));
    Ok(json!({ "bytes": bytes, "names_sizes_and_changes": hash }))
}

/// A hash as it stands in a journal: of one build of the program, to find damage and change, not forgery.
pub fn hash_of(write: impl FnOnce(&mut DefaultHasher)) -> String {
    let mut hasher = DefaultHasher::new();
    write(&mut hasher);
    format!("{:016x}", hasher.finish())
}

/// Puts all voxels of a volume into a hash, and which of them have no data.
pub fn hash_voxels(volume: &Volume, hasher: &mut DefaultHasher) {
    match &volume.voxels {
        Voxels::U8(v) => hasher.write(v),
        Voxels::I8(v) => hasher.write(bytemuck::cast_slice(v)),
        Voxels::U16(v) => hasher.write(bytemuck::cast_slice(v)),
        Voxels::I16(v) => hasher.write(bytemuck::cast_slice(v)),
        Voxels::F16(v) => hasher.write(bytemuck::cast_slice(v)),
        Voxels::F32(v) => hasher.write(bytemuck::cast_slice(v)),
    }
    volume.validity.hash(hasher);
}

/// Where two values part, as in "`scene.camera.zoom` was 2.0, is 3.0".
pub fn difference(place: &str, was: &Value, is: &Value) -> Option<String> {
    if was == is {
        return None;
    }
    let nothing = serde_json::Map::new();
    // A topic that is left out has no words.
    let (a, b) = match (was, is) {
        (Value::Object(a), Value::Null) => (Some(a), Some(&nothing)),
        (Value::Null, Value::Object(b)) => (Some(&nothing), Some(b)),
        (was, is) => (was.as_object(), is.as_object()),
    };
    if let (Some(a), Some(b)) = (a, b) {
        let mut keys: Vec<_> = a.keys().chain(b.keys()).collect();
        keys.sort();
        return keys.into_iter().find_map(|key| {
            let place = if place.is_empty() {
                key.clone()
            } else {
                format!("{place}.{key}")
            };
            difference(
                &place,
                a.get(key).unwrap_or(&Value::Null),
                b.get(key).unwrap_or(&Value::Null),
            )
        });
    }
    let shown = |value: &Value| {
        let text = value.to_string();
        match text.char_indices().nth(60) {
            Some((end, _)) => format!("{}...", &text[..end]),
            None => text,
        }
    };
    Some(format!("`{place}` was {}, is {}", shown(was), shown(is)))
}
