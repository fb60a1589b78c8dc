//! What makes a film the film it is: all that a journal compares before a run goes on with another one's frames.

use super::{Plan, keeps_transparency, target::Frames};
use crate::{
    cli::{
        Error,
        resume_check::{hash_of, stamp_of},
        scene_file,
    },
    picture::BitDepth,
};
use serde_json::{Value, json};

/// Every word that decides what a frame shows, and what is known of the input without reading it.
pub fn of_film(plan: &Plan, frames: &Frames) -> Result<Value, Error> {
    let mut scene = plan.scene.clone();
    let depth = scene.picture.bit_depth();
    // 8 bits are the same film whether a word says them or none does: `bits` below has them.
    scene.picture.bit_depth = None;
    let scene = scene_file::text(&scene, &frames.path(0));
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
        "environment": stamp_of(plan.scene.path.file())?,
        "opacity_from": stamp_of(plan.scene.opacity.file())?,
        "with": plan.scene.with.files().map(|file| stamp_of(Some(file))).collect::<Result<Vec<_>, _>>()?,
        "header": hash_of(|hasher| std::hash::Hasher::write(hasher, header.as_bytes())),
        "bits": match depth { BitDepth::Eight => 8, BitDepth::Sixteen => 16 },
        "black_behind": !keeps_transparency(&plan.target),
    }))
}
