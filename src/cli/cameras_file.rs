//! `--cameras`: a list of views in one JSON file.
//!
//! ```json
//! [ { "eye": [0, 500, 0], "target": [0, 0, 0], "up": [0, 0, 1], "fov": 30 },
//!   { "eye": [0, 500, 0], "target": [0, 0, 0], "up": [0, 0, 1], "view_height": 250 } ]
//! ```

use super::{Error, small_file};
use crate::camera::{Camera, Projection};
use glam::DVec3;
use serde::Deserialize;
use std::path::Path;

/// The largest file that is read.
const MAX_FILE_BYTES: u64 = 16 << 20;

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct View {
    eye: [f64; 3],
    target: [f64; 3],
    up: [f64; 3],
    view_height: Option<f64>,
    fov: Option<f64>,
}

/// The cameras of the file at `path`; at least one.
pub fn read(path: &Path) -> Result<Vec<Camera>, Error> {
    small_file::parsed(path, "a list of views", MAX_FILE_BYTES, parse)
}

fn parse(text: &[u8]) -> Result<Vec<Camera>, String> {
    let views: Vec<View> = serde_json::from_slice(text).map_err(|error| error.to_string())?;
    if views.is_empty() {
        return Err("the list holds no view".to_owned());
    }
    let numbered = |(index, view): (usize, View)| {
        view.camera()
            .map_err(|problem| format!("view {index}: {problem}"))
    };
    views.into_iter().enumerate().map(numbered).collect()
}

impl View {
    fn camera(self) -> Result<Camera, String> {
        let projection = match (self.view_height, self.fov) {
            (Some(view_height), None) => Projection::Orthographic { view_height },
            (None, Some(fov_degrees)) => Projection::Perspective { fov_degrees },
            _ => return Err("wanted either `view_height` or `fov`".to_owned()),
        };
        let camera = Camera {
            eye: DVec3::from(self.eye),
            target: DVec3::from(self.target),
            up: DVec3::from(self.up),
            projection,
            zoom: 1.0,
        };
        camera.check().map_err(|error| error.to_string())?;
        Ok(camera)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_view_is_perspective_or_orthographic_by_the_key_it_has() {
        let text = br#"[{"eye":[0,5,0],"target":[0,0,0],"up":[0,0,1],"fov":30},
                        {"eye":[0,5,0],"target":[0,0,0],"up":[0,0,1],"view_height":7}]"#;
        let cameras = parse(text).expect("two views");
        let projections: Vec<_> = cameras.iter().map(|camera| camera.projection).collect();
        let wanted = [
            Projection::Perspective { fov_degrees: 30.0 },
            Projection::Orthographic { view_height: 7.0 },
        ];
        assert_eq!(projections, wanted);
    }

    #[test]
    fn a_wrong_view_is_named_by_its_place() {
        for (text, word) in [
            ("[]", "no view"),
            (
                r#"[{"eye":[0,5,0],"target":[0,0,0],"up":[0,0,1]}]"#,
                "view 0: wanted either",
            ),
            (
                r#"[{"eye":[0,5,0],"target":[0,5,0],"up":[0,0,1],"fov":3}]"#,
                "view 0: the camera's eye",
            ),
            (
                r#"[{"eye":[0,5,0],"target":[0,0,0],"up":[0,0,1],"fow":3}]"#,
                "`fow`",
            ),
            ("{}", "sequence"),
        ] {
            let problem = parse(text.as_bytes()).expect_err(text);
            assert!(problem.contains(word), "{text}: {problem}");
        }
    }
}
