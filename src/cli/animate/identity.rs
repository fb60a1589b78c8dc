//! What makes a film the film it is: all that a journal compares before a run goes on with another one's frames.

use super::{Plan, journal::hash_of, keeps_transparency, target::Frames};
use crate::{
    cli::{Error, scene_file},
    picture::BitDepth,
};
use serde_json::{Value, json};
use std::{
    fs, io,
    path::{Path, PathBuf},
    time::UNIX_EPOCH,
};

/// Every word that decides what a frame shows, and what is known of the input without reading it.
pub fn of_film(plan: &Plan, frames: &Frames, depth: BitDepth) -> Result<Value, Error> {
    let scene = scene_file::text(&plan.scene, &frames.path(0));
    let scene: Value = serde_json::from_str(&scene).expect("what we have just written as JSON");
    let input = stamp_of(plan.scene.input.file())?;
    let [labels, label_names] = plan.scene.labels.files().map(stamp_of);
    let header = format!("{:?}", plan.header);
    Ok(json!({
        "frames": plan.shots.len(),
        "turntable": plan.film.turntable,
        "times": plan.film.times,
        "keyframes": plan.film.keyframes.as_ref().map(|keyframes| &keyframes.text),
        "scene": scene,
        "input": input,
        "labels": labels?,
        "label_names": label_names?,
        "opacity_from": stamp_of(plan.scene.opacity.file())?,
        "header": hash_of(|hasher| std::hash::Hasher::write(hasher, header.as_bytes())),
        "bits": match depth { BitDepth::Eight => 8, BitDepth::Sixteen => 16 },
        "black_behind": !keeps_transparency(&plan.target),
    }))
}

fn stamp_of(path: Option<&Path>) -> Result<Value, Error> {
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
    let hash = hash_of(|hasher| std::hash::Hash::hash(&facts, hasher));
    Ok(json!({ "bytes": bytes, "names_sizes_and_changes": hash }))
}
