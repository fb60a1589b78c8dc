//! The camera fitted to what a person wants to see, as `--target` and `--zoom`.
//!
//! ```text
//! bounding sphere -> corners of the box fill the frame -> small frame -> pixels that let less than .97 through fill it
//! ```

use super::light::{Use, with_light};
use super::side::{side_words, turn_to_best, with_side};
use crate::camera::Camera;
use crate::cli::Error;
use crate::cli::flags::{CameraFlags, Depth, FrameWord, Numbers, SceneFlags};
use crate::cli::scene_inputs::{Parts, SceneInputs};
use crate::look::{
    MOST_SAMPLES, SHARE, SMALL_PIXELS, corners, fit_to_visible, frames_the_box, samples, small_of,
    visible_in,
};
use crate::picture::Picture;
use crate::technique::{Settings, Technique};

/// More points than this are framed by their box.
const MANY_POINTS: usize = 50_000;

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
    /// Those of the camera as they were given.
    given: CameraFlags,
    /// Whether the number of samples is the program's choice.
    chose_samples: bool,
    /// Whether the side to look from is.
    may_choose_side: bool,
    shown: &'a SceneInputs,
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
        shown: &'a SceneInputs,
        made_for: Use,
        extent_pixels: [u32; 2],
        skip: bool,
    ) -> Self {
        let lit = with_light(scene, shown.seen(), made_for);
        let (grid, is_earth) = (shown.volume.grid(), shown.header.is_earth);
        let sided = with_side(&lit, &grid, is_earth, shown.has_named_axes());
        let is_open = sided.camera == lit.camera && !scene.camera.names_a_side();
        Self {
            chose_samples: lit.sampling.samples_per_voxel != scene.sampling.samples_per_voxel,
            may_choose_side: scene.is_auto() && is_open && !shown.has_named_axes(),
            scene: sided,
            given: scene.camera.clone(),
            shown,
            extent_pixels,
            depth: made_for.depth,
            skip,
        }
    }

    /// What is framed.
    pub fn shown(&self) -> &'a SceneInputs {
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
        settings.skip &= self.skip;
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

    /// A frame of many points takes as long however small it is.
    fn draws_small_frames(&self) -> bool {
        match self.shown.parts() {
            Parts::Points(points) => points.len() <= MANY_POINTS,
            _ => true,
        }
    }

    /// What the camera is to be fitted to.
    fn word(&self) -> Option<FrameWord> {
        let camera = &self.scene.camera;
        let word = camera.framed(self.scene.is_auto());
        word.filter(|_| self.scene.section.section.is_none())
    }
}

/// The same by the rays of pixels, where the technique casts other ones; scattered points are splatted.
fn by_rays(settings: &Settings) -> Settings {
    let technique = match settings.technique.casts_rays() && !settings.splat.of_points {
        true => Technique::Raycast,
        false => settings.technique,
    };
    Settings {
        technique,
        ..settings.clone()
    }
}

impl Framing<'_> {
    /// The view with the camera fitted, where a word or the look asks for it, and with the samples that the work allows.
    ///
    /// Small frames are drawn by rays of pixels where the technique casts other ones: what is visible is nearly the same.
    pub fn fit(&self, draw: &mut Small) -> Result<View, Error> {
        let draw: &mut Small =
            &mut |camera, settings, extent| draw(camera, &by_rays(settings), extent);
        let mut notes = Vec::new();
        let mut scene = self.scene.clone();
        if self.may_choose_side && self.word().is_some() && self.draws_small_frames() {
            turn_to_best(
                &mut scene,
                |scene| self.boxed(scene),
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
            let is_box = word == FrameWord::Box
                || frames_the_box(mode, is_cropped)
                || !self.draws_small_frames();
            if !is_box {
                visible = fit_to_visible(&mut camera, self.extent_pixels, |camera, small| {
                    draw(camera, &view.settings, small)
                })?;
            }
            let said = match (&visible, is_cropped, is_box) {
                (Some(_), ..) => "what is visible",
                (None, true, _) => "the cropped box",
                (None, false, true) => "the box",
                (None, false, false) => "the box, because nothing is visible",
            };
            let nearer = self.scene.camera.zoom.unwrap_or(1.0);
            let target = target_word(&camera);
            let zoom = short(camera.zoom * nearer);
            let flags = &mut scene.camera;
            flags.frame = None;
            (flags.target, flags.zoom) = (Some(target), Some(zoom));
            let side = side_words(flags, &self.given);
            notes.push(format!(
                "framed to {said}: {side}--target {target} --zoom {zoom}"
            ));
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

/// The target in six digits each, and in more where the eye is nearer to it than the origin is; what rounding left of a 0
/// is one.
pub fn target_word(camera: &Camera) -> Numbers<3> {
    let distance = camera.eye.distance(camera.target);
    let digits = |number: f64| match number.abs() < 1e-12 * distance {
        true => 0.0,
        false => rounded(
            number,
            DIGITS + (number.abs() / distance).log10().clamp(0.0, 9.0) as usize,
        ),
    };
    Numbers(camera.target.to_array().map(digits))
}

/// More than pixels show, and few enough to be read.
const DIGITS: usize = 6;

/// That many digits.
pub fn short(number: f64) -> f64 {
    rounded(number, DIGITS)
}

fn rounded(number: f64, digits: usize) -> f64 {
    format!("{number:.0$e}", digits - 1)
        .parse()
        .expect("a number that was just written")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::Projection;
    use glam::{DVec3, dvec3};

    /// A pixel is a thousandth of the distance or more.
    #[test]
    fn the_target_is_written_to_a_small_part_of_the_distance_however_far_the_origin() {
        for from_origin in [0.0, 1.0, 37.0, 5e6, 1e9] {
            let target = dvec3(from_origin + 1.0 / 3.0, -1.234_567_89, from_origin);
            let camera = Camera {
                eye: target + dvec3(0.0, -3.0, 0.0),
                target,
                up: DVec3::Z,
                projection: Projection::Perspective { fov_degrees: 30.0 },
                zoom: 1.0,
            };
            let Numbers(written) = target_word(&camera);
            let off = (DVec3::from(written) - target).abs().max_element();
            assert!(off < 1e-4, "{written:?} is {off} off at {from_origin}");
        }
        assert_eq!(short(1.234_567_89), 1.23457);
    }
}
