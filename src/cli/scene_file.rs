//! `--scene` and `--save-scene`: the flags of a picture in one JSON file.
//!
//! ```json
//! { "stratavox_scene": 2,
//!   "input": { "path": "phantom:head" },
//!   "sampling": { "technique": "slices-3d", "samples_per_voxel": 2.0 },
//!   "classification": { "preset": "ct-bone" },
//!   "camera": { "view": "left", "zoom": 1.5 },
//!   "picture": { "size": "640x480", "background": "0,0,0,1" },
//!   "device": "cpu" }
//! ```
//!
//! Keys are the words of the flags with `_` for `-`, lists of numbers are written as on the command line, a
//! transfer function file stands inside as `classification.transfer_function`. The path of the input is
//! looked for from the scene file's own folder.

use super::{
    Error,
    flags::{Look, SceneFlags, relative},
    small_file,
};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Version 1 knew no look: its files are drawn plain.
const VERSION: u32 = 2;
/// The largest file that is read; a transfer function inside has its own limit of the same size.
const MAX_FILE_BYTES: u64 = 4 << 20;

/// The scene in the file at `path`, its input as seen from here.
pub fn read(path: &Path) -> Result<SceneFlags, Error> {
    let mut scene = small_file::parsed(path, "a scene", MAX_FILE_BYTES, parse)?;
    scene.input = scene.input.found_in(folder_of(path));
    scene.labels = scene.labels.with_paths(|file| folder_of(path).join(file));
    scene.opacity = scene.opacity.with_paths(|file| folder_of(path).join(file));
    scene.with = scene.with.with_paths(|file| folder_of(path).join(file));
    scene.path = scene.path.with_paths(|file| folder_of(path).join(file));
    scene.map = scene.map.with_paths(|file| folder_of(path).join(file));
    Ok(scene)
}

/// The text of a scene file that will stand at `path`. The file of `--tf` must have been read.
pub fn text(scene: &SceneFlags, path: &Path) -> String {
    let scene = SceneFlags {
        stratavox_scene: VERSION,
        input: scene.input.relative_to(folder_of(path)),
        labels: scene
            .labels
            .with_paths(|file| relative(file, folder_of(path))),
        opacity: scene
            .opacity
            .with_paths(|file| relative(file, folder_of(path))),
        with: scene
            .with
            .with_paths(|file| relative(file, folder_of(path))),
        path: scene
            .path
            .with_paths(|file| relative(file, folder_of(path))),
        map: scene.map.with_paths(|file| relative(file, folder_of(path))),
        ..scene.clone()
    };
    let mut value = serde_json::to_value(scene).expect("flags as JSON");
    if let Value::Object(topics) = &mut value {
        topics.retain(|_, topic| topic.as_object().is_none_or(|flags| !flags.is_empty()));
    }
    format!("{value:#}\n")
}

/// `flags` where they say something, `scene` where they do not.
pub fn overlay(mut scene: SceneFlags, flags: &SceneFlags) -> SceneFlags {
    // What picks a volume in one file means nothing in another one.
    if flags.input.path.is_some() {
        scene.input = Default::default();
        scene.opacity = Default::default();
        scene.with = Default::default();
        (scene.flow, scene.flow_style, scene.map) = Default::default();
    }
    if flags.opacity.are_given() {
        scene.opacity = Default::default();
    }
    if flags.channels.are_given() {
        scene.channels = Default::default();
    }
    scene.camera.give_way_to(&flags.camera);
    if flags.section.section.is_some() {
        // Positions are those of planes that face as they did.
        scene.section.at.clear();
        scene.camera.leave_the_eye();
    } else if flags.camera.places_the_eye() {
        scene.section = Default::default();
    }
    scene.sampling.give_way_to(&flags.sampling);
    scene.classification.give_way_to(&flags.classification);
    let below = serde_json::to_value(scene).expect("flags as JSON");
    let above = serde_json::to_value(flags).expect("flags as JSON");
    serde_json::from_value(laid_over(below, above)).expect("two sets of flags make one")
}

fn laid_over(below: Value, above: Value) -> Value {
    match (below, above) {
        (Value::Object(mut below), Value::Object(above)) => {
            for (key, above) in above {
                let merged = match below.remove(&key) {
                    // A transfer function is one thing, not a list of flags.
                    Some(under) if key != "transfer_function" => laid_over(under, above),
                    _ => above,
                };
                below.insert(key, merged);
            }
            Value::Object(below)
        }
        (_, above) => above,
    }
}

fn parse(text: &[u8]) -> Result<SceneFlags, String> {
    let value: Value = serde_json::from_slice(text).map_err(|e| format!("not JSON: {e}"))?;
    match value.get("stratavox_scene") {
        None => return Err("no scene: it has no key `stratavox_scene`".to_owned()),
        Some(version) if *version == 1 || *version == VERSION => {}
        Some(version) => {
            return Err(format!(
                "scene version {version}: this program knows {VERSION}"
            ));
        }
    }
    // From the text again: only so are keys that stand twice found.
    let mut scene: SceneFlags = serde_json::from_slice(text).map_err(|e| e.to_string())?;
    if scene.stratavox_scene == 1 {
        scene.look.get_or_insert(Look::Plain);
    }
    Ok(scene)
}

fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    }
}

/// The files that a scene reads, so that no output is put in their place.
pub fn inputs(scene: &SceneFlags, scene_file: Option<&Path>) -> Vec<PathBuf> {
    let [labels, label_tf] = scene.labels.files();
    let files = [
        scene.input.file(),
        scene.classification.tf.as_deref(),
        scene.classification.color_tf.as_deref(),
        scene.classification.opacity_tf.as_deref(),
        labels,
        label_tf,
        scene.opacity.file(),
        scene.path.file(),
        scene.map.file(),
        scene_file,
    ];
    let files = files.into_iter().flatten();
    files
        .chain(scene.with.files())
        .map(Path::to_owned)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    #[derive(Parser)]
    struct Words {
        #[command(flatten)]
        scene: SceneFlags,
    }

    fn flags(words: &str) -> SceneFlags {
        let words = ["x"].into_iter().chain(words.split_whitespace());
        Words::try_parse_from(words).expect("flags").scene
    }

    const ALL: &str = "phantom:head --time 3 --technique slices-2d --mode mip --filter nearest --filter-by fetch \
        --lattice planes --order front-to-back --samples-per-voxel 0.3 --aa 4 --color-space display \
        --crop 0,1,0,1,0.5,1 --clip 1,0,0,5 --clip -1,0,0,-9.1 --conformance --preset mri --colormap vik,reverse --window -1,2 \
        --projection orthographic --fov 31.7 --zoom 1.1 --azimuth 12.3 --elevation -4 --roll 7 \
        --target 1,2,3 --up 0,0,1 --view-height 77 --exaggerate 3 --size 64x48 --background 0,0.1,1 --aov value,depth --bit-depth 16 \
        --device cpu --component 1 --raw 2x2x2,u8 --variable T --channel 0,color=red,window=0:3 --channel 2 \
        --lmip-threshold 5 --mida-gamma -0.5 --attenuation 3 --depth-cue 0.4 --exact-maximum --iso -3,4.5 \
        --iso-color red,0:0.5:1 --iso-opacity 0.3,1 --labels l.nrrd --opacity-variable q --opacity-component 2 --opacity-from o.nrrd --opacity-window -1,2 --with p,q.nrrd,preset=pet,window=0:5 --with phantom:gauss,n=32,color=red --label-tf l.txt --label-show 1,3-5 --map coast --coast c.shp --coast-by arrays --point-light -1,2,3.5,1,0.5,0.25,4 --disc-light 1,2,3,4";

    #[test]
    fn a_saved_scene_comes_back_as_it_was() {
        let scene = flags(ALL);
        let text = text(&scene, Path::new("scene.json"));
        let back = parse(text.as_bytes()).expect("a scene");
        let wanted = SceneFlags {
            stratavox_scene: 2,
            ..scene
        };
        assert_eq!(back, wanted, "{text}");
    }

    #[test]
    fn a_flag_wins_over_the_scene_and_leaves_the_rest() {
        let scene = flags("phantom:head --zoom 2 --fov 40 --clip 1,0,0,5 --view left");
        let merged = overlay(scene, &flags("--zoom 3 --clip 0,1,0,6"));
        let wanted = flags("phantom:head --zoom 3 --fov 40 --clip 0,1,0,6 --view left");
        assert_eq!(merged, wanted);
    }

    #[test]
    fn another_input_leaves_the_scenes_picks_behind() {
        let scene = flags("a.raw --raw 2x2x2,u8 --time 3 --zoom 2");
        assert_eq!(overlay(scene, &flags("b.nrrd")), flags("b.nrrd --zoom 2"));
    }

    #[test]
    fn an_eye_takes_the_place_of_the_scenes_view() {
        let merged = overlay(flags("--view left --roll 3"), &flags("--eye 1,2,3"));
        assert_eq!(merged, flags("--eye 1,2,3"));
    }

    #[test]
    fn a_key_that_is_not_known_is_refused_by_its_name() {
        for (text, word) in [
            (r#"{"stratavox_scene":1,"colour":{}}"#, "colour"),
            (r#"{"stratavox_scene":1,"camera":{"fow":3}}"#, "fow"),
            (
                r#"{"stratavox_scene":1,"camera":{"eye":"1,2"}}"#,
                "3 numbers",
            ),
            (
                r#"{"stratavox_scene":1,"camera":{},"camera":{}}"#,
                "duplicate",
            ),
            (r#"{"stratavox_scene":3}"#, "version 3"),
            (r#"{"camera":{}}"#, "stratavox_scene"),
            ("{", "not JSON"),
        ] {
            let problem = parse(text.as_bytes()).expect_err(text);
            assert!(problem.contains(word), "{text}: {problem}");
        }
    }

    #[test]
    fn the_path_of_an_input_is_kept_from_the_scenes_folder() {
        let folder = tempfile::tempdir().expect("a folder");
        std::fs::write(folder.path().join("a.nrrd"), "").expect("a file");
        let file = folder.path().join("a.nrrd");
        let scene = flags(file.to_str().expect("a plain path"));
        let saved = text(&scene, &folder.path().join("scene.json"));
        assert!(saved.contains(r#""path": "a.nrrd""#), "{saved}");
        let back = parse(saved.as_bytes()).expect("a scene").input;
        assert_eq!(back.found_in(folder.path()).file(), Some(file.as_path()));
    }
}
