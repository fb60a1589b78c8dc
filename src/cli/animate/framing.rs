//! The camera of a film fitted to what is visible in its frames, as `--target` and `--zoom`.
//!
//! ```text
//! camera stands still    the union of what is visible in all frames fills the frame
//! camera moves           the sphere around what is visible, seen along x and along y, fills it
//! ```

use super::{
    Plan,
    draw::Content,
    keeps_transparency,
    ready::{self, Ready},
    shots::FilmFrame,
    sphere::{along_axes, around, around_corners, sphere_of},
    union::Union,
    volumes::Volumes,
};
use crate::{
    camera::{Camera, PixelBox},
    cli::{
        Error,
        flags::{Depth, FrameWord, SceneFlags},
        look::{Seen, Use, short, side_words, target_word, with_light, with_side},
        progress::Progress,
        renderer::Device,
    },
    look::{SHARE, corners, frames_the_box, small_of},
    picture::PictureFormat,
    technique::{Jitter, Settings, pathtrace::PathTracing},
    volume::{Grid, Volume},
};
use glam::DVec3;

/// Pixels of the longer side of small frames.
const SMALL_PIXELS: u32 = 64;
/// How often all frames are looked at: once more from nearer where what is visible was small.
const ROUNDS: usize = 2;
/// It is small where it fills less of the frame: pixels of small frames would count too much.
const COARSE: f64 = 0.5;

/// The scene of a film with the light, the background and the camera of its look.
pub fn framed(
    plan: &Plan,
    content: &Content,
    grid: &Grid,
    devices: &mut Vec<Device>,
    progress: &Progress,
) -> Result<SceneFlags, Error> {
    let is_auto = plan.scene.is_auto();
    let word = plan.scene.camera.framed(is_auto);
    // Words that are given win over the look, in a key as in a flag; a section shows its whole plane.
    let is_open = !plan.film.places_the_camera() && plan.scene.section.section.is_none();
    let word = word.filter(|_| is_open);
    if !is_auto && word.is_none() {
        return Ok(plan.scene.clone());
    }
    let header = &plan.header;
    let has_named_axes = header.is_patient || header.is_earth;
    let sided = with_side(&plan.scene, grid, header.is_earth, has_named_axes);
    let (mut scene, known) = lit(plan, content, grid, sided, progress)?;
    let Some(word) = word else {
        return Ok(scene);
    };
    scene.camera.zoom = None;
    let shots = plan.film.shots(&scene, plan.depth, header, grid)?;
    let ready = match (content, known) {
        (Content::Times(..), Some(known)) => known,
        (Content::Times(..), None) => of_times(content, &shots, &scene)?,
        (Content::Still(shown) | Content::Together(shown, _), _) => {
            ready::of_still(&shots, &scene, shown)?
        }
    };
    let extent_pixels = scene.picture.extent_pixels()?;
    let film = Fit {
        moves: shots.iter().any(|shot| shot.camera != shots[0].camera),
        camera: shots[0].camera,
        corners: corners(grid, cropped(&shots)),
        extent_pixels,
    };
    let first = &shots[0].settings;
    let is_box = word == FrameWord::Box || frames_the_box(first.mode, first.crop.is_some());
    let mut visible = None;
    if !is_box {
        let ready = seen_alone(ready, &shots);
        let union = Union::new(&scene, content, &ready);
        visible =
            film.to_visible(|cameras, small| union.seen(cameras, small, devices, progress))?;
    }
    let what = match (&visible, first.crop, is_box) {
        (Some(_), ..) => "what is visible in any frame",
        (None, Some(_), _) => "the cropped box of all frames",
        (None, None, true) => "the box",
        (None, None, false) => "the box, because nothing is visible",
    };
    let fitted = visible.unwrap_or_else(|| film.to_box());
    let nearer = plan.scene.camera.zoom.unwrap_or(1.0);
    let target = target_word(&fitted);
    let zoom = short(fitted.zoom * nearer);
    let flags = &mut scene.camera;
    flags.frame = None;
    (flags.target, flags.zoom) = (Some(target), Some(zoom));
    let side = side_words(&scene.camera, &plan.scene.camera);
    progress.note(&format!(
        "framed to {what}: {side}--target {target} --zoom {zoom}"
    ));
    Ok(scene)
}

/// The scene with light and background, and frames of several times, where those were asked for.
fn lit(
    plan: &Plan,
    content: &Content,
    grid: &Grid,
    scene: SceneFlags,
    progress: &Progress,
) -> Result<(SceneFlags, Option<Vec<Ready>>), Error> {
    let made_for = Use {
        is_film: true,
        is_opaque: match &plan.target {
            super::Target::Frames(frames) => frames.format == PictureFormat::Png,
            target => !keeps_transparency(target) || plan.depth == Depth::Eight,
        },
        depth: plan.depth,
    };
    Ok(match content {
        Content::Still(shown) | Content::Together(shown, _) => {
            (with_light(&scene, shown.seen(), made_for), None)
        }
        Content::Times(..) if !scene.is_auto() => (scene, None),
        Content::Times(source, bricks) => {
            let shots = plan.film.shots(&scene, plan.depth, &plan.header, grid)?;
            let ready = of_times(content, &shots, &scene)?;
            let quiet = Progress::of_part();
            let unseen = |_, _: &[&Volume]| Ok(());
            let mut volumes = Volumes::new(source, *bricks, &scene, &quiet, &unseen);
            let moment = volumes.at(ready[0].time)?;
            progress.stage("prepare", 0, 1);
            let seen = Seen {
                volume: moment.looked_at(),
                context: scene.classification.context.as_ref(),
                classification: &ready[0].classification,
                is_alone: true,
                is_beside_others: false,
            };
            (with_light(&scene, seen, made_for), Some(ready))
        }
    })
}

/// How frames of several times are seen, without a word to anybody.
fn of_times(
    content: &Content,
    shots: &[FilmFrame],
    scene: &SceneFlags,
) -> Result<Vec<Ready>, Error> {
    let Content::Times(source, bricks) = content else {
        unreachable!("of several times");
    };
    let quiet = Progress::of_part();
    let unseen = |_, _: &[&Volume]| Ok(());
    let mut volumes = Volumes::new(source, *bricks, scene, &quiet, &unseen);
    let is_labels = source.header().is_labels;
    ready::of_times(shots, scene, is_labels, &mut volumes, &quiet)
}

/// The frames of `shots` without light and grain, which change no opacity: those that differ in nothing else look alike.
fn seen_alone(ready: Vec<Ready>, shots: &[FilmFrame]) -> Vec<Ready> {
    let dark = |(ready, shot): (Ready, &FilmFrame)| Ready {
        settings: Settings {
            per_mode: ready.settings.per_mode,
            filter: ready.settings.filter,
            shading: None,
            ambient_occlusion: None,
            jitter: Jitter::default(),
            path: PathTracing {
                seed: 0,
                ..shot.settings.path.clone()
            },
            ..shot.settings.clone()
        },
        ..ready
    };
    ready.into_iter().zip(shots).map(dark).collect()
}

/// The box around what `--crop` leaves in any frame.
fn cropped(shots: &[FilmFrame]) -> Option<[DVec3; 2]> {
    let crops = shots.iter().filter_map(|shot| shot.settings.crop);
    crops.reduce(|[low, high], [a, b]| [low.min(a), high.max(b)])
}

/// What a camera is fitted to.
struct Fit {
    /// The camera changes from frame to frame.
    moves: bool,
    /// That of the first frame, without a zoom.
    camera: Camera,
    /// Of the box, or of what is left of it.
    corners: Vec<DVec3>,
    extent_pixels: [u32; 2],
}

/// What cameras see in any frame, of so many pixels.
type SeenBy<'a> = dyn FnMut(&[Camera], [u32; 2]) -> Result<Vec<Option<PixelBox>>, Error> + 'a;

impl Fit {
    /// All of the box in every frame.
    fn to_box(&self) -> Camera {
        match self.moves {
            true => around(
                &self.camera,
                &around_corners(&self.corners),
                self.extent_pixels,
            ),
            false => self
                .camera
                .fitted_to_points(&self.corners, self.extent_pixels, SHARE),
        }
    }

    /// What is visible in any frame; `None` where nothing is.
    fn to_visible(
        &self,
        mut seen: impl FnMut(&[Camera], [u32; 2]) -> Result<Vec<Option<PixelBox>>, Error>,
    ) -> Result<Option<Camera>, Error> {
        match self.moves {
            true => self.to_sphere(&mut seen),
            false => self.to_union(&mut seen),
        }
    }

    fn to_union(&self, seen: &mut SeenBy) -> Result<Option<Camera>, Error> {
        let small = small_of(self.extent_pixels, SMALL_PIXELS);
        let mut camera = self.to_box();
        for _ in 0..ROUNDS {
            let Some(part) = seen(&[camera], small)?[0] else {
                return Ok(None);
            };
            camera = camera.fitted(&part, small, SHARE);
            let filled = |k: usize| part.size()[k] / f64::from(small[k]);
            if filled(0).max(filled(1)) >= COARSE {
                break;
            }
        }
        Ok(Some(camera))
    }

    fn to_sphere(&self, seen: &mut SeenBy) -> Result<Option<Camera>, Error> {
        let small = [SMALL_PIXELS; 2];
        let mut bounds = around_corners(&self.corners);
        for _ in 0..ROUNDS {
            let cameras = along_axes(&bounds);
            let [Some(a), Some(b)] = seen(&cameras, small)?[..] else {
                return Ok(None);
            };
            let before = std::mem::replace(&mut bounds, sphere_of(&cameras, [a, b], small));
            if bounds.radius >= COARSE * before.radius {
                break;
            }
        }
        Ok(Some(around(&self.camera, &bounds, self.extent_pixels)))
    }
}
