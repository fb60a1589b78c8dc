//! `--keyframes`: what changes along a film, in one JSON file.
//!
//! ```json
//! { "stratavox_keyframes": 1,
//!   "frames": 120,
//!   "easing": "smooth",
//!   "keys": [
//!     { "at": 0,   "azimuth": 0,   "zoom": 1, "clip": [[1, 0, 0, -90]] },
//!     { "at": 0.5, "azimuth": 180, "tf": "bone.json" },
//!     { "at": 1,   "azimuth": 360, "zoom": 2, "clip": [[1, 0, 0, 0]], "tf": "skin.json" } ] }
//! ```
//!
//! Each word has a course of its own over the keys that hold it; without a key it is that of the command line.
//! `at` goes from 0, the first frame, to 1, the last one; `frame` counts frames from 0 in its place. `seconds`
//! in place of `frames` takes `--fps` times as many. Words are those of the flags, lists are arrays, `tf` is
//! a file (found from the folder of this one) or what stands in one, `light` the way to the only light.

use super::{
    functions,
    keys::{self, Key},
    rate::Rate,
    track::{Easing, Track},
    tracks::Tracks,
};
use crate::{
    cli::{Error, small_file},
    transfer::{TransferFunction, transfer_function_to_json},
};
use serde::Deserialize;
use serde_json::Value;
use std::path::{Path, PathBuf};

const VERSION: u32 = 1;
/// The largest file that is read.
const MAX_FILE_BYTES: u64 = 16 << 20;
/// The most frames of a film: an hour at 25 a second and some.
pub const MAX_FRAMES: u32 = 100_000;

/// A film as a file tells it.
#[derive(Debug)]
pub struct Keyframes {
    /// How many frames.
    pub frame_count: u32,
    /// What changes.
    pub tracks: Tracks,
    /// The file, transfer functions put in: what a journal compares.
    pub text: Value,
    /// Files that were read.
    pub inputs: Vec<PathBuf>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Words {
    #[serde(rename = "stratavox_keyframes")]
    _version: u32,
    frames: Option<u32>,
    seconds: Option<f64>,
    #[serde(default)]
    easing: Easing,
    keys: Vec<Key>,
}

/// The film of the file at `path`.
pub fn read(path: &Path, rate: Rate) -> Result<Keyframes, Error> {
    let folder = path.parent().unwrap_or(Path::new("."));
    let mut film = small_file::parsed(path, "a film of keyframes", MAX_FILE_BYTES, |text| {
        parse(text, folder, rate)
    })?;
    film.inputs.push(path.to_owned());
    Ok(film)
}

fn parse(text: &[u8], folder: &Path, rate: Rate) -> Result<Keyframes, String> {
    let mut value: Value = serde_json::from_slice(text).map_err(|e| format!("not JSON: {e}"))?;
    match value.get("stratavox_keyframes") {
        None => return Err("no keyframes: it has no key `stratavox_keyframes`".to_owned()),
        Some(version) if version == VERSION => {}
        Some(version) => {
            return Err(format!(
                "keyframes version {version}: this program knows {VERSION}"
            ));
        }
    }
    // From the text again: only so are keys that stand twice found.
    let words: Words = serde_json::from_slice(text).map_err(|error| place_of(&value, &error))?;
    let frame_count = words.frame_count(rate)?;
    let places = words.places(frame_count)?;
    let mut inputs = Vec::new();
    let mut functions = Vec::new();
    for (k, (key, &u)) in words.keys.iter().zip(&places).enumerate() {
        let Some(tf) = &key.tf else { continue };
        let function =
            functions::of_key(tf, folder, &mut inputs).map_err(|e| format!("keys[{k}].tf: {e}"))?;
        let inside = serde_json::from_str(&transfer_function_to_json(&function));
        value["keys"][k]["tf"] = inside.expect("what we have just written as JSON");
        functions.push((u, function));
    }
    Ok(Keyframes {
        frame_count,
        tracks: words.tracks(&places, functions)?,
        text: value,
        inputs,
    })
}

/// The sentence of serde, with the key of the list that it is about.
fn place_of(value: &Value, error: &serde_json::Error) -> String {
    let keys = value["keys"].as_array().map_or(&[][..], Vec::as_slice);
    keys.iter()
        .enumerate()
        .find_map(|(k, key)| {
            let error = serde_json::from_value::<Key>(key.clone()).err()?;
            Some(format!("keys[{k}]: {error}"))
        })
        .unwrap_or_else(|| error.to_string())
}

impl Words {
    fn frame_count(&self, rate: Rate) -> Result<u32, String> {
        let count = match (self.frames, self.seconds) {
            (Some(frames), None) => f64::from(frames),
            (None, Some(seconds)) => (seconds * rate.per_second()).round().max(1.0),
            _ => return Err("wanted either `frames` or `seconds`".to_owned()),
        };
        if self.seconds.is_some_and(|seconds| seconds <= 0.0)
            || !(1.0..=f64::from(MAX_FRAMES)).contains(&count)
        {
            let field = if self.frames.is_some() {
                "frames"
            } else {
                "seconds"
            };
            return Err(format!(
                "`{field}`: wanted 1 to {MAX_FRAMES} frames, found {count}"
            ));
        }
        Ok(count as u32)
    }

    /// Where each key stands, 0 to 1.
    fn places(&self, frame_count: u32) -> Result<Vec<f64>, String> {
        if self.keys.is_empty() {
            return Err("`keys` is empty: wanted at least one".to_owned());
        }
        let mut places: Vec<f64> = Vec::with_capacity(self.keys.len());
        for (k, key) in self.keys.iter().enumerate() {
            let last = frame_count - 1;
            let place = match (key.at, key.frame) {
                (Some(at), None) if (0.0..=1.0).contains(&at) => at,
                (Some(at), None) => return Err(format!("keys[{k}].at: wanted 0 to 1, found {at}")),
                (None, Some(frame)) if frame <= last => place_of_frame(frame, frame_count),
                (None, Some(frame)) => {
                    return Err(format!(
                        "keys[{k}].frame: wanted 0 to {last}, found {frame}"
                    ));
                }
                _ => return Err(format!("keys[{k}]: wanted either `at` or `frame`")),
            };
            if places.last().is_some_and(|&before| before >= place) {
                return Err(format!("keys[{k}] does not come after the key before it"));
            }
            places.push(place);
        }
        Ok(places)
    }

    fn tracks(
        &self,
        places: &[f64],
        functions: Vec<(f64, TransferFunction)>,
    ) -> Result<Tracks, String> {
        keys::check(&self.keys)?;
        let interpolations: Vec<_> = functions.iter().map(|(_, f)| f.interpolation).collect();
        if interpolations.windows(2).any(|pair| pair[0] != pair[1]) {
            return Err(
                "`tf`: some are \"linear\" and some are \"step\", nothing lies between them"
                    .to_owned(),
            );
        }
        let number = |of: fn(&Key) -> Option<f64>| self.track(places, |key| of(key).map(|x| [x]));
        // A number that multiplies goes by equal factors.
        let factor =
            |of: fn(&Key) -> Option<f64>| self.track(places, |key| of(key).map(|x| [x.ln()]));
        let planes = self
            .keys
            .iter()
            .find_map(|key| key.clip.as_ref())
            .map_or(0, Vec::len);
        let clip = (0..planes).map(|i| self.track(places, |key| Some(unit(key.clip.as_ref()?[i]))));
        Ok(Tracks {
            azimuth: number(|key| key.azimuth),
            elevation: number(|key| key.elevation),
            roll: number(|key| key.roll),
            fov: number(|key| key.fov),
            ln_zoom: factor(|key| key.zoom),
            ln_view_height: factor(|key| key.view_height),
            eye: self.track(places, |key| key.eye),
            target: self.track(places, |key| key.target),
            up: self.track(places, |key| key.up),
            window: self.track(places, |key| key.window),
            crop: self.track(places, |key| key.crop),
            light: self.track(places, |key| key.light.map(direction)),
            clip: clip.collect(),
            time: number(|key| key.time),
            functions,
        })
    }

    fn track<const N: usize>(
        &self,
        places: &[f64],
        of: impl Fn(&Key) -> Option<[f64; N]>,
    ) -> Track<N> {
        let keys = self.keys.iter().zip(places);
        let keys = keys.filter_map(|(key, &u)| Some((u, of(key)?)));
        Track::new(keys.collect(), self.easing)
    }
}

/// Where frame `number` stands, 0 to 1.
pub fn place_of_frame(number: u32, frame_count: u32) -> f64 {
    f64::from(number) / f64::from(frame_count.max(2) - 1)
}

/// The same direction with the length 1.
fn direction(towards: [f64; 3]) -> [f64; 3] {
    let length = towards.iter().map(|x| x * x).sum::<f64>().sqrt();
    towards.map(|x| x / length)
}

/// The same plane with a normal of length 1.
fn unit([x, y, z, offset]: [f64; 4]) -> [f64; 4] {
    let length = (x * x + y * y + z * z).sqrt();
    [x, y, z, offset].map(|number| number / length)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn film(text: &str) -> Result<Keyframes, String> {
        parse(text.as_bytes(), Path::new("."), Rate::default())
    }

    #[test]
    fn each_word_has_a_course_over_the_keys_that_hold_it() {
        let film = film(
            r#"{"stratavox_keyframes":1,"frames":5,"keys":[
                {"at":0,"azimuth":10,"zoom":1},
                {"frame":2,"elevation":5},
                {"at":1,"azimuth":50,"zoom":4,"clip":[[0,0,2,6]],"light":[0,3,4]}]}"#,
        )
        .expect("a film");
        assert_eq!(film.frame_count, 5);
        let tracks = film.tracks;
        let azimuths: Vec<_> = (0..5)
            .map(|n| tracks.azimuth.number(place_of_frame(n, 5)))
            .collect();
        assert_eq!(azimuths, [10.0, 20.0, 30.0, 40.0, 50.0].map(Some));
        assert_eq!(tracks.elevation.number(0.9), Some(5.0));
        assert!(tracks.roll.is_empty());
        // Zoom goes by equal factors: halfway from 1 to 4 is 2.
        let zoom = tracks.ln_zoom.number(0.5).map(f64::exp).expect("a zoom");
        assert!((zoom - 2.0).abs() < 1e-15, "{zoom}");
        // A plane is that of a unit normal: z >= 3.
        assert_eq!(tracks.clip[0].at(0.0), Some([0.0, 0.0, 1.0, 3.0]));
        assert_eq!(tracks.light.at(0.5), Some([0.0, 0.6, 0.8]));
    }

    #[test]
    fn seconds_are_counted_by_the_rate() {
        let text = r#"{"stratavox_keyframes":1,"seconds":1.5,"keys":[{"at":0}]}"#;
        let rate = "30".parse().expect("a rate");
        let film = parse(text.as_bytes(), Path::new("."), rate).expect("a film");
        assert_eq!(film.frame_count, 45);
    }

    #[test]
    fn a_wrong_file_is_told_by_key_and_field() {
        let head = r#""stratavox_keyframes":1,"frames":3"#;
        for (text, word) in [
            ("{".to_owned(), "not JSON"),
            (r#"{"frames":3}"#.to_owned(), "no key `stratavox_keyframes`"),
            (r#"{"stratavox_keyframes":2}"#.to_owned(), "version 2"),
            (format!(r#"{{{head},"keys":[]}}"#), "`keys` is empty"),
            (
                format!(r#"{{{head},"seconds":1,"keys":[{{"at":0}}]}}"#),
                "either `frames` or `seconds`",
            ),
            (
                r#"{"stratavox_keyframes":1,"frames":0,"keys":[{"at":0}]}"#.to_owned(),
                "1 to 100000 frames, found 0",
            ),
            (
                r#"{"stratavox_keyframes":1,"seconds":1e300,"keys":[{"at":0}]}"#.to_owned(),
                "`seconds`",
            ),
            (
                format!(r#"{{{head},"keys":[{{"at":0}},{{"at":1,"fow":3}}]}}"#),
                "keys[1]: unknown field `fow`",
            ),
            (
                format!(r#"{{{head},"keys":[{{"at":0,"eye":[1,2]}}]}}"#),
                "keys[0]: invalid length 2",
            ),
            (
                format!(r#"{{{head},"keys":[{{"at":0,"at":0}}]}}"#),
                "duplicate field `at`",
            ),
            (
                format!(r#"{{{head},"keys":[{{"at":0,"frame":0}}]}}"#),
                "keys[0]: wanted either `at` or `frame`",
            ),
            (
                format!(r#"{{{head},"keys":[{{"at":1.5}}]}}"#),
                "keys[0].at: wanted 0 to 1, found 1.5",
            ),
            (
                format!(r#"{{{head},"keys":[{{"frame":3}}]}}"#),
                "keys[0].frame: wanted 0 to 2, found 3",
            ),
            (
                format!(r#"{{{head},"keys":[{{"at":0.5}},{{"frame":1}}]}}"#),
                "keys[1] does not come after",
            ),
            (
                format!(r#"{{{head},"keys":[{{"at":0,"zoom":0}}]}}"#),
                "keys[0].zoom: wanted a number over 0",
            ),
            (
                format!(r#"{{{head},"keys":[{{"at":0,"window":[3,3]}}]}}"#),
                "keys[0].window",
            ),
            (
                format!(r#"{{{head},"keys":[{{"at":0,"time":-1}}]}}"#),
                "keys[0].time",
            ),
            (
                format!(r#"{{{head},"keys":[{{"at":0,"light":[0,0,0]}}]}}"#),
                "keys[0].light: a way to a light needs a direction",
            ),
            (
                format!(r#"{{{head},"keys":[{{"at":0,"clip":[[0,0,0,1]]}}]}}"#),
                "keys[0].clip[0]",
            ),
            (
                format!(
                    r#"{{{head},"keys":[{{"at":0,"clip":[[1,0,0,1]]}},{{"at":1,"clip":[]}}]}}"#
                ),
                "keys[1].clip: wanted 1 planes",
            ),
            (
                format!(r#"{{{head},"keys":[{{"at":0,"eye":[1,2,3]}},{{"at":1,"roll":1}}]}}"#),
                "keys[1].roll: another key has an `eye`",
            ),
            (
                format!(r#"{{{head},"keys":[{{"at":0,"tf":"no such file"}}]}}"#),
                "keys[0].tf: cannot read",
            ),
            (
                format!(r#"{{{head},"keys":[{{"at":0,"tf":7}}]}}"#),
                "keys[0].tf: wanted the name",
            ),
            (
                format!(r#"{{{head},"keys":[{{"at":0,"tf":{{}}}}]}}"#),
                "keys[0].tf: missing field",
            ),
        ] {
            let problem = film(&text).expect_err(&text);
            assert!(problem.contains(word), "{text}: {problem}");
        }
    }
}
