//! A camera fitted to what a person wants to see.
//!
//! ```text
//! corners of the box fill the frame -> small frame -> pixels that let less than .97 through fill it
//! ```

use crate::camera::{Camera, PixelBox};
use crate::picture::Picture;
use crate::technique::Mode;
use crate::volume::Grid;
use glam::DVec3;

/// Part of the picture that the larger side of what is visible fills.
pub const SHARE: f64 = 0.9;
/// A pixel is visible where less than this of what lies behind comes through.
const MOST_TRANSMITTANCE: f32 = 0.97;
/// Pixels of the longer side of a small frame.
pub const SMALL_PIXELS: u32 = 160;
/// Small frames until the fit is given up as it is. Two are enough but in steep perspective.
const ROUNDS: usize = 4;
/// How far from [`SHARE`] the larger side of what is visible may be.
const NEAR: f64 = 0.02;
/// How far what is visible may be from the middle, in parts of the picture's side.
const CENTERED: f64 = 0.01;

/// True where a frame is fitted to the box whatever is visible: an X-ray darkens gradually, and a cropped box is what was
/// asked for.
pub fn frames_the_box(mode: Mode, is_cropped: bool) -> bool {
    mode == Mode::Xray || is_cropped
}

/// Fits a camera to the visible pixels of small frames; it should see all of the volume. `draw` gives the picture of a
/// camera, without its background, with so many pixels. The result is which pixels of the last small frame are visible,
/// and its width and height; `None` where none is, and the camera stays.
///
/// # Errors
/// Those of `draw`.
pub fn fit_to_visible<E>(
    camera: &mut Camera,
    extent_pixels: [u32; 2],
    mut draw: impl FnMut(&Camera, [u32; 2]) -> Result<Picture, E>,
) -> Result<Option<Vec<bool>>, E> {
    let small = small_of(extent_pixels, SMALL_PIXELS);
    let mut found = None;
    for _ in 0..ROUNDS {
        let visible = visible_in(&draw(camera, small)?);
        let Some(part) = box_of(&visible, small[0]) else {
            break;
        };
        found = Some(visible);
        if is_fitted(&part, small) {
            break;
        }
        *camera = camera.fitted(&part, small, SHARE);
    }
    Ok(found)
}

fn is_fitted(part: &PixelBox, small: [u32; 2]) -> bool {
    let side = |k: usize| f64::from(small[k]);
    let filled = [0, 1].map(|k| part.size()[k] / side(k));
    let filled = filled[0].max(filled[1]);
    let off = |k: usize| (0.5 * (part.min[k] + part.max[k]) / side(k) - 0.5).abs();
    (filled - SHARE).abs() <= NEAR && off(0).max(off(1)) <= CENTERED
}

/// Which pixels of a picture without its background let less than 97 % of what lies behind through.
pub fn visible_in(picture: &Picture) -> Vec<bool> {
    let is_visible = |pixel: &[f32; 4]| 1.0 - pixel[3] < MOST_TRANSMITTANCE;
    picture.pixels.iter().map(is_visible).collect()
}

/// The box around visible pixels of a picture of this width, whole pixels; `None` where none is visible.
pub fn box_of(visible: &[bool], width: u32) -> Option<PixelBox> {
    let pixels = (0_u32..)
        .zip(visible)
        .filter(|(_, is_visible)| **is_visible);
    let corners = pixels.flat_map(|(at, _)| {
        let [x, y] = [at % width, at / width].map(f64::from);
        [[x, y], [x + 1.0, y + 1.0]]
    });
    PixelBox::around(corners)
}

/// A picture of the same shape with so many pixels on the longer side, or the picture itself.
pub fn small_of(extent: [u32; 2], most: u32) -> [u32; 2] {
    let longer = extent[0].max(extent[1]);
    let side = |side: u32| {
        let side = u64::from(side) * u64::from(most.min(longer)) / u64::from(longer);
        (side as u32).max(1)
    };
    extent.map(side)
}

/// The corners of the grid box, or of what `crop`, two corners in voxel space, leaves of it, in the world.
pub fn corners(grid: &Grid, crop: Option<[DVec3; 2]>) -> Vec<DVec3> {
    let whole = [DVec3::ZERO, grid.far_corner()];
    let [low, high] = match crop {
        Some(crop) => crop.map(|corner| corner.clamp(whole[0], whole[1])),
        None => whole,
    };
    let corner = |k: usize| {
        let side = |axis: usize| if k >> axis & 1 == 0 { low } else { high };
        let voxel = DVec3::new(side(0).x, side(1).y, side(2).z);
        grid.world_from_voxel.transform_point3(voxel)
    };
    (0..8).map(corner).collect()
}
