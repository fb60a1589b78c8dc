//! The camera fitted to what a person wants to see, as `--target` and `--zoom`.
//!
//! ```text
//! bounding sphere -> corners of the box fill the frame -> small frame -> pixels that let less than .97 through fill it
//! ```

use super::light::{Use, with_light};
use super::side::{best_side, with_side};
use super::work::{MOST_SAMPLES, samples};
use crate::camera::{Camera, PixelBox};
use crate::cli::Error;
use crate::cli::flags::{Depth, FrameWord, Numbers, SceneFlags};
use crate::cli::shown::Shown;
use crate::picture::Picture;
use crate::technique::{Mode, Settings};
use crate::volume::Grid;
use glam::DVec3;

/// Part of the smaller room that is filled.
pub const SHARE: f64 = 0.9;
/// A pixel is visible where less than this of what lies behind comes through.
const MOST_TRANSMITTANCE: f32 = 0.97;
/// Pixels of the longer side of a small frame.
const SMALL_PIXELS: u32 = 160;
/// Small frames until the fit is given up as it is. Two are enough but in steep perspective.
const ROUNDS: usize = 4;
/// How far from [`SHARE`] the larger side of what is visible may be.
const NEAR: f64 = 0.02;
/// How far what is visible may be from the middle, in parts of the picture's side.
const CENTERED: f64 = 0.01;

/// Everything about a picture that a renderer wants to know.
#[derive(Clone, Debug)]
pub struct View {
    /// Flags that say all that was chosen of the camera and the samples.
    pub scene: SceneFlags,
    /// Who looks.
    pub camera: Camera,
    /// What is computed.
    pub settings: Settings,
    /// What a person should know of it.
    pub notes: Vec<String>,
}

/// What is framed, and how.
#[derive(Clone, Debug)]
pub struct Framing<'a> {
    /// The flags, with light and samples.
    scene: SceneFlags,
    /// Whether the number of samples is the program's choice.
    chose_samples: bool,
    /// Whether the side to look from is.
    may_choose_side: bool,
    shown: &'a Shown,
    /// Pixels of the picture.
    extent_pixels: [u32; 2],
    depth: Depth,
    /// Whether empty space is left out.
    skip: bool,
}

/// Draws a frame of a few pixels.
pub type Small<'a> = dyn FnMut(&Camera, &Settings, [u32; 2]) -> Result<Picture, Error> + 'a;

impl<'a> Framing<'a> {
    /// Of a picture that `scene` asks for, with the light, the samples and the background of its look.
    pub fn new(
        scene: &SceneFlags,
        shown: &'a Shown,
        made_for: Use,
        extent_pixels: [u32; 2],
        skip: bool,
    ) -> Self {
        let lit = with_light(scene, shown.seen(), made_for);
        let sided = with_side(&lit, &shown.subject(), shown.has_named_axes());
        let is_open = sided.camera == lit.camera && !scene.camera.names_a_side();
        Self {
            chose_samples: lit.sampling.samples_per_voxel != scene.sampling.samples_per_voxel,
            may_choose_side: scene.is_auto() && is_open && !shown.has_named_axes(),
            scene: sided,
            shown,
            extent_pixels,
            depth: made_for.depth,
            skip,
        }
    }

    /// What is framed.
    pub fn shown(&self) -> &'a Shown {
        self.shown
    }

    /// Pixels of the picture.
    pub fn extent_pixels(&self) -> [u32; 2] {
        self.extent_pixels
    }

    /// True where [`Self::fit`] may draw small frames.
    pub fn draws(&self) -> bool {
        self.word().is_some() || self.chose_samples
    }

    /// The view that the flags say, as they stand.
    pub fn view(&self) -> Result<View, Error> {
        self.view_of(self.scene.clone())
    }

    fn view_of(&self, scene: SceneFlags) -> Result<View, Error> {
        let mut settings = scene.settings(self.depth)?;
        settings.skip = self.skip;
        let camera = self
            .shown
            .camera(&scene, self.extent_pixels, &mut settings)?;
        Ok(View {
            scene,
            camera,
            settings,
            notes: Vec::new(),
        })
    }

    /// What the camera is to be fitted to.
    fn word(&self) -> Option<FrameWord> {
        let camera = &self.scene.camera;
        let word = camera.framed(self.scene.is_auto());
        word.filter(|_| self.scene.section.section.is_none())
    }
}

impl Framing<'_> {
    /// The view with the camera fitted, where a word or the look asks for it, and with the samples that the work allows.
    pub fn fit(&self, draw: &mut Small) -> Result<View, Error> {
        let mut notes = Vec::new();
        let mut scene = self.scene.clone();
        if self.may_choose_side && self.word().is_some() {
            best_side(
                &mut scene,
                |scene| self.boxed(scene.clone()),
                self.extent_pixels,
                draw,
            )?;
        }
        let mut view = self.view_of(scene.clone())?;
        let small = small_of(self.extent_pixels, SMALL_PIXELS);
        let mut visible = None;
        if let Some(word) = self.word() {
            let boxed = self.boxed(scene.clone())?;
            let (mut camera, mode) = (boxed.camera, view.settings.mode);
            let is_cropped = view.settings.crop.is_some();
            let is_box = word == FrameWord::Box || mode == Mode::Xray || is_cropped;
            if !is_box {
                visible = visible_fit(&mut camera, small, &view.settings, draw)?;
            }
            let said = match (&visible, is_cropped, is_box) {
                (Some(_), ..) => "what is visible",
                (None, true, _) => "the cropped box",
                (None, false, true) => "the box",
                (None, false, false) => "the box, because nothing is visible",
            };
            let nearer = self.scene.camera.zoom.unwrap_or(1.0);
            let target = Numbers(camera.target.to_array().map(short));
            let zoom = short(camera.zoom * nearer);
            let flags = &mut scene.camera;
            flags.frame = None;
            (flags.target, flags.zoom) = (Some(target), Some(zoom));
            notes.push(format!("framed to {said}: --target {target} --zoom {zoom}"));
            view = self.view_of(scene.clone())?;
        }
        if self.chose_samples && view.settings.samples_per_voxel > 1.0 {
            let visible = match visible {
                Some(visible) => visible,
                None => visible_in(&draw(&view.camera, &view.settings, small)?),
            };
            let grid = self.shown.volume.grid();
            let wanted = view.settings.samples_per_voxel;
            let work = wanted * samples(&grid, &view.camera, small, &visible, self.extent_pixels);
            if work > MOST_SAMPLES {
                scene.sampling.samples_per_voxel = Some(1.0);
                notes.push(format!(
                    "one sample a voxel: {wanted} would be {:.0} million samples; --samples-per-voxel {wanted} takes them",
                    work / 1e6
                ));
                view = self.view_of(scene)?;
            }
        }
        Ok(View { notes, ..view })
    }

    /// The view of these flags with the camera fitted to the box.
    fn boxed(&self, mut scene: SceneFlags) -> Result<View, Error> {
        scene.camera.zoom = None;
        let view = self.view_of(scene)?;
        let corners = corners(&self.shown.volume.grid(), view.settings.crop);
        let camera = view
            .camera
            .fitted_to_points(&corners, self.extent_pixels, SHARE);
        Ok(View { camera, ..view })
    }
}

/// Six digits: more than pixels show, and few enough to be read.
fn short(number: f64) -> f64 {
    format!("{number:.5e}")
        .parse()
        .expect("a number that was just written")
}

/// The camera fitted to visible pixels; which pixels of the last small frame are, `None` where none is.
fn visible_fit(
    camera: &mut Camera,
    small: [u32; 2],
    settings: &Settings,
    draw: &mut Small,
) -> Result<Option<Vec<bool>>, Error> {
    let mut found = None;
    for _ in 0..ROUNDS {
        let visible = visible_in(&draw(camera, settings, small)?);
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

/// Which pixels let less than [`MOST_TRANSMITTANCE`] through.
pub fn visible_in(picture: &Picture) -> Vec<bool> {
    let is_visible = |pixel: &[f32; 4]| 1.0 - pixel[3] < MOST_TRANSMITTANCE;
    picture.pixels.iter().map(is_visible).collect()
}

/// The box of pixels that are visible, whole pixels.
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

/// The corners of the grid box, or of what `--crop` leaves of it, in the world.
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
