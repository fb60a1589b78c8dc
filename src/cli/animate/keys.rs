//! The keys of a film, and what a curve could not go through.

use serde::Deserialize;
use serde_json::{Value, json};

/// What stands at one moment of a film.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(missing_docs, reason = "the names are the words of the flags")]
pub struct Key {
    pub at: Option<f64>,
    pub frame: Option<u32>,
    pub azimuth: Option<f64>,
    pub elevation: Option<f64>,
    pub roll: Option<f64>,
    pub zoom: Option<f64>,
    pub fov: Option<f64>,
    pub view_height: Option<f64>,
    pub eye: Option<[f64; 3]>,
    pub target: Option<[f64; 3]>,
    pub up: Option<[f64; 3]>,
    pub window: Option<[f64; 2]>,
    pub tf: Option<Value>,
    pub crop: Option<[f64; 6]>,
    pub clip: Option<Vec<[f64; 4]>>,
    pub light: Option<[f64; 3]>,
    pub time: Option<f64>,
}

/// What a curve could not go through.
pub fn check(keys: &[Key]) -> Result<(), String> {
    let has_eye = keys.iter().any(|key| key.eye.is_some());
    let planes = keys.iter().find_map(|key| key.clip.as_ref()).map(Vec::len);
    for (k, key) in keys.iter().enumerate() {
        for (field, found) in [
            ("zoom", key.zoom),
            ("fov", key.fov),
            ("view_height", key.view_height),
        ] {
            if let Some(found) = found.filter(|&x| x <= 0.0) {
                return Err(format!(
                    "keys[{k}].{field}: wanted a number over 0, found {found}"
                ));
            }
        }
        for (field, found) in [
            ("azimuth", key.azimuth),
            ("elevation", key.elevation),
            ("roll", key.roll),
        ] {
            if has_eye && found.is_some() {
                return Err(format!(
                    "keys[{k}].{field}: another key has an `eye`, which excludes it"
                ));
            }
        }
        if let Some([low, high]) = key.window.filter(|[low, high]| low >= high) {
            return Err(format!(
                "keys[{k}].window: wanted a low value and a higher one, found {}",
                json!([low, high])
            ));
        }
        if key.time.is_some_and(|time| time < 0.0) {
            return Err(format!(
                "keys[{k}].time: wanted a number from 0 on, found {}",
                json!(key.time)
            ));
        }
        if key.light == Some([0.0; 3]) {
            return Err(format!(
                "keys[{k}].light: a way to a light needs a direction, found 0, 0, 0"
            ));
        }
        let Some(clip) = &key.clip else { continue };
        if Some(clip.len()) != planes {
            return Err(format!(
                "keys[{k}].clip: wanted {} planes as in the keys before, found {}",
                planes.unwrap_or(0),
                clip.len()
            ));
        }
        if let Some(i) = clip.iter().position(|plane| plane[..3] == [0.0; 3]) {
            return Err(format!(
                "keys[{k}].clip[{i}]: a plane needs a direction, found 0, 0, 0"
            ));
        }
    }
    Ok(())
}
