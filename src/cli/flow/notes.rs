//! What a person should know of how geometry beside a volume is drawn.

use super::drawn::{DrawnLines, Width};
use super::placed::pixel_at_target;
use super::style::THINNEST_PIXELS;
use crate::camera::Camera;
use crate::cli::flags::SceneFlags;
use crate::figure::short;

/// Said where the number of rays a pixel is the program's choice.
const FOUR_RAYS: &str =
    "four rays a pixel, for the edges of what lies beside the volume; --aa 1 sends one";

/// What is to be said of a picture, or of the first frame of a film, whose scene was filled in from what a person `said`; `None` where a
/// file says all, how many rays there are too.
pub fn notes(
    said: Option<&SceneFlags>,
    scene: &SceneFlags,
    lines: Option<&DrawnLines>,
    camera: &Camera,
    extent_pixels: [u32; 2],
) -> Vec<String> {
    let is_left = said.is_some_and(|said| said.sampling.aa.is_none());
    let is_chosen = is_left && scene.sampling.aa == Some(4);
    let four = (is_chosen && scene.has_lines()).then(|| FOUR_RAYS.to_owned());
    let thin = lines.and_then(|lines| lines.thin(camera, extent_pixels));
    four.into_iter().chain(thin).collect()
}

impl DrawnLines {
    /// That lines are wider than they were asked for: pixels miss thinner ones.
    fn thin(&self, camera: &Camera, extent_pixels: [u32; 2]) -> Option<String> {
        let pixel = pixel_at_target(camera, extent_pixels);
        let widths = self.sets.iter().filter_map(|set| match set.width {
            Width::World(width) => Some(width / pixel),
            Width::Pixels(_) => None,
        });
        let thinnest = widths.reduce(f64::min)?;
        (thinnest < THINNEST_PIXELS).then(|| {
            format!(
                "--flow-width: {} pixels where the camera is turned to, and lines are drawn {THINNEST_PIXELS} pixels wide: thinner ones \
                 are missed by pixels",
                short(thinnest)
            )
        })
    }
}
