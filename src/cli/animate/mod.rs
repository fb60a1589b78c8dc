//! `stratavox animate`: many pictures of one input, as files or as a film.
//!
//! ```text
//! words, header -> shots (one set of flags a frame, all checked) -> store (which frames are there)
//!     -> draw (one device, one volume after another) -> store -> film, where one file is asked for
//! ```

mod check;
mod draw;
mod drawer;
mod feed;
mod film;
mod framing;
mod functions;
mod identity;
mod journal;
mod kept;
mod keyframes;
mod keys;
mod rate;
mod ready;
mod shots;
mod sphere;
mod store;
mod target;
mod together;
mod track;
mod tracks;
mod union;
mod volumes;

use super::{
    Error,
    annotation::annotation,
    exaggerate,
    flags::{Depth, PictureFlags, SceneFlags},
    flow,
    ground::Ground,
    load,
    memory::{DeviceRoom, Held, fitting},
    output::{self, write_whole},
    progress::{Progress, ProgressWord},
    renderer::Device,
    scene_file,
    scene_inputs::{self, SceneInputs, wants_stream},
    show::ShowFlags,
    signals::Gate,
    timings::Timings,
};
use crate::{
    annotate::Annotation,
    picture::{BitDepth, LayerKind, PictureFormat, WriteOptions},
    volume::{Grid, Header, Source},
};
use clap::Args;
use draw::{Content, Drawing, Sink};
use film::{FilmFormat, Reel};
use kept::Kept;
use rate::Rate;
use shots::{Film, FilmFrame};
use std::{
    path::{Path, PathBuf},
    sync::Arc,
    time::Instant,
};
use store::{Store, Wishes};
use target::{Frames, Target};
use together::Together;

/// Draw many pictures of a volume: a turn, its times, or a film by keyframes
#[derive(Args, Debug)]
#[command(after_help = "Examples:\n  \
    stratavox animate phantom:head,n=64 --turntable 24 --size 320x240 -o head.gif\n  \
    stratavox animate phantom:storm,n=64,variable=cloud --times --fps 4 --size 320x240 -o storm.apng\n  \
    stratavox animate phantom:head,n=64 --turntable 8 --size 320x240 -o frames/%04d.png --resume\n  \
    stratavox animate phantom:head,n=64 --turntable 24 --size 320x240 -o - | ffmpeg -i - head.webm\n\n\
    Keyframes, each word of a key with a course of its own:\n  \
    { \"stratavox_keyframes\": 1, \"frames\": 120, \"easing\": \"smooth\", \"keys\": [\n    \
    { \"at\": 0, \"azimuth\": 0, \"zoom\": 1 }, { \"at\": 1, \"azimuth\": 360, \"zoom\": 2 } ] }\n  \
    Keys of a keyframe: azimuth, elevation, roll, zoom, fov, view_height, eye, target, up, window, tf, crop, clip, light, time")]
pub struct Animate {
    /// frames/%04d.png (or .exr, .npy), a film that ends in .apng, .gif, .y4m or .mp4, or - for Y4M on the standard
    /// output
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// Turn the camera once around in so many frames
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..), conflicts_with = "keyframes", help_heading = "Film")]
    turntable: Option<u32>,
    /// Show every time of the input; with a turn or keyframes, time runs once through all of them
    #[arg(long, help_heading = "Film")]
    times: bool,
    /// Frames between two times, whose values are mixed [default: 0; with --show as many as make a film of 96 frames]
    #[arg(long, value_name = "K", value_parser = clap::value_parser!(u32).range(0..10_000), conflicts_with_all = ["turntable", "keyframes"], help_heading = "Film")]
    between: Option<u32>,
    /// Change camera, colours, planes and time by the keys of a file
    #[arg(long, value_name = "FILE.json", help_heading = "Film")]
    keyframes: Option<PathBuf>,
    /// Go on with a film that was stopped; frames that are whole stay
    #[arg(long, help_heading = "Film")]
    resume: bool,
    /// Frames a second: 25, 29.97, 30000/1001
    #[arg(long, value_name = "F", default_value = "25", help_heading = "Film")]
    fps: Rate,
    #[command(flatten)]
    scene: SceneFlags,
    #[command(flatten)]
    show: ShowFlags,
    /// Flags from a file; those of the command line win. A scene keeps the pictures, not the motion: --turntable,
    /// --times, --keyframes and --fps are said again
    #[arg(long = "scene", value_name = "FILE.json", help_heading = "Run")]
    scene_file: Option<PathBuf>,
    /// Write all flags of the pictures into a file, not those of the motion
    #[arg(long, value_name = "FILE.json", help_heading = "Run")]
    save_scene: Option<PathBuf>,
    /// Write what the work took into a file
    #[arg(long, value_name = "FILE.json", help_heading = "Run")]
    timings: Option<PathBuf>,
    /// Taken as `render` takes it; a film draws each frame once
    #[arg(long, value_name = "N", hide = true)]
    repeat: Option<u32>,
    /// Say on stderr how far the work is
    #[arg(long, value_enum, default_value_t, help_heading = "Run")]
    progress: ProgressWord,
    /// Replace files that exist
    #[arg(long, help_heading = "Run")]
    force: bool,
    /// No empty-space skipping: the picture is the same without
    #[arg(long, conflicts_with = "empty_space")]
    no_skip: bool,
}

/// Frames of the turntable that a film is where nothing says what it shows: 5 degrees each.
const TURN_FRAMES: u32 = 72;

/// Frames behind the first of a film of the weather, at least.
const FRAMES_SHOWN: u32 = 95;

/// Everything that was checked before the first voxel is read.
struct Plan {
    scene: SceneFlags,
    target: Target,
    layers: Vec<LayerKind>,
    /// Of the input as it lies in its file.
    header: Header,
    film: Film,
    shots: Vec<FilmFrame>,
    depth: Depth,
    inputs: Vec<PathBuf>,
}

impl Animate {
    /// Draws and writes.
    pub fn run(mut self, gate: &Gate) -> Result<(), Error> {
        let progress = Progress::new(self.progress);
        let (plan, source) = self.plan(&progress)?;
        let mut outputs: Vec<PathBuf> = self
            .save_scene
            .iter()
            .chain(&self.timings)
            .cloned()
            .collect();
        if let Target::Film { path, .. } = &plan.target {
            outputs.push(path.clone());
        }
        output::check(&outputs, &plan.inputs, self.force)?;
        let store = self.store(&plan, gate)?;
        if self.repeat.is_some() {
            progress.note("--repeat has no effect on a film");
        }
        let sink = match &store {
            Some(store) => Sink::Store(store),
            None => Sink::Stream(self.fps),
        };
        let is_done = store
            .as_ref()
            .is_some_and(|store| store.missing().is_empty());
        if is_done {
            progress.note("all frames are there already");
        }
        // A scene keeps what is chosen only now.
        let drawn = match is_done && self.save_scene.is_none() {
            true => Ok((Timings::default(), None)),
            false => self.draw(&plan, source, &sink, &progress),
        };
        if let (Err(_), Some(store), Target::Film { .. }) = (&drawn, &store, &plan.target) {
            store.say_what_is_kept(&progress);
        }
        let (timings, frozen) = drawn?;
        if let (Some(store), Target::Film { path, format }) = (&store, &plan.target) {
            let reel = Reel {
                frames: store.frames(),
                count: plan.shots.len() as u32,
                extent_pixels: plan.scene.picture.extent_pixels()?,
                rate: self.fps,
                path,
                progress: &progress,
            };
            film::write(*format, &reel, self.force, gate)?;
            store.remove()?;
        }
        if let (Some(path), Some(frozen)) = (&self.save_scene, &frozen) {
            let text = scene_file::text(frozen, path);
            write_whole(path, text.as_bytes(), self.force, gate)?;
        }
        if let Some(path) = &self.timings {
            write_whole(path, timings.json().as_bytes(), self.force, gate)?;
        }
        Ok(())
    }

    fn draw(
        &self,
        plan: &Plan,
        source: Box<dyn Source>,
        sink: &Sink,
        progress: &Progress,
    ) -> Result<(Timings, Option<SceneFlags>), Error> {
        progress.stage("prepare", 0, 1);
        let words = plan.scene.devices().into_iter();
        let devices = words.map(Device::find).collect::<Result<Vec<_>, _>>()?;
        for device in &devices {
            progress.device(&device.name()?);
        }
        let device = &devices[0];
        let Plan {
            scene,
            depth,
            header,
            shots,
            ..
        } = plan;
        let start = Instant::now();
        let content = match shots::still_time(shots) {
            Some(time) => {
                progress.stage("read", 0, 1);
                let mut scene = scene.clone();
                if plan.film.changes_time() {
                    scene.input.time = Some(time.to_string());
                }
                let settings = &shots[0].settings;
                let shown = SceneInputs::of_source(source, &scene, settings, device, progress)?;
                Content::Still(Box::new(shown.at_level(&scene)))
            }
            None if scene_inputs::shows_several(scene, header)? => {
                progress.stage("read", 0, 1);
                let settings = &shots[0].settings;
                let scene = Ground::with_range_of_film(scene)?;
                let times = header.times;
                let scene =
                    scene_inputs::with_range_of_film(&scene, settings, times, device, progress)?;
                let scene = flow::with_range_of_film(&scene, shots[0].time, times, progress)?;
                let mut first = scene.clone();
                first.input.time = Some(shots[0].time.to_string());
                let shown = SceneInputs::of_source(source, &first, settings, device, progress)?;
                let shown = shown.at_level(&first);
                progress.note(
                    "windows are those of the first time; colours of lines, surfaces and the ground go over all times",
                );
                let together = Together::new(&scene, &shown, settings, device.memory()?);
                Content::Together(Box::new(shown), Box::new(together))
            }
            None => {
                let is_whole = shots.iter().all(|shot| shot.time.fract() == 0.0);
                let held = if is_whole {
                    Held::of(scene, 1)
                } else {
                    Held::Blend
                };
                let settings = &shots[0].settings;
                let is_streamed =
                    is_whole && wants_stream(source.as_ref(), scene, settings, device)?;
                let memory = device.memory()?;
                match memory.filter(|_| is_streamed) {
                    Some(memory) => Content::Times(Arc::from(source), Some(memory)),
                    None => Content::Times(fitting(source, scene, memory, held)?.into(), None),
                }
            }
        };
        // A volume that is reduced to fit has a grid of its own.
        let (grid, height_factor) = match &content {
            Content::Still(shown) | Content::Together(shown, _) => {
                (shown.volume.grid(), shown.height_factor)
            }
            Content::Times(source, _) => {
                let header = source.header();
                let stored = Grid {
                    dims: header.dims,
                    world_from_voxel: header.world_from_voxel,
                };
                let (factor, _) = exaggerate::factor(scene, &stored, header.is_earth)?;
                (shots::grid(scene, header)?, factor)
            }
        };
        let mut devices = devices;
        let scene = &framing::framed(plan, &content, &grid, &mut devices, progress)?;
        for note in scene.idle() {
            progress.note(&note);
        }
        let annotation = annotation(scene, header, shots[0].settings.mode)?;
        let note = annotation.as_ref().and_then(Annotation::note);
        note.iter().for_each(|note| progress.note(note));
        let mut shots = plan.film.shots(scene, *depth, header, &grid)?;
        for shot in &mut shots {
            shot.settings.skip &= !self.no_skip;
        }
        let said = self.scene_file.is_none().then_some(&self.scene);
        let lines = match &content {
            Content::Still(shown) | Content::Together(shown, _) => shown.lines(),
            Content::Times(..) => None,
        };
        let of_lines = flow::notes(
            said,
            scene,
            lines,
            &shots[0].camera,
            scene.picture.extent_pixels()?,
        );
        of_lines.iter().for_each(|note| progress.note(note));
        let kept = Kept::new(self.save_scene.is_some());
        let drawing = Drawing {
            scene,
            shots: &shots,
            layers: &plan.layers,
            content: &content,
            annotation,
            format: match &plan.target {
                Target::Frames(frames) => frames.format,
                Target::Film { .. } | Target::Stream => PictureFormat::Png,
            },
            placed: (grid, height_factor),
            start,
            background: self.background(plan, scene, progress),
            progress,
            wants_timings: self.timings.is_some(),
            film: &plan.film,
            kept: &kept,
        };
        let timings = drawing.draw(sink, devices)?;
        let frozen = self
            .save_scene
            .is_some()
            .then(|| kept.frozen(scene, &content, &shots, &plan.film, height_factor));
        Ok((timings, frozen))
    }

    /// All that the words say, checked as far as it can be without a voxel.
    fn plan(&mut self, progress: &Progress) -> Result<(Plan, Box<dyn Source>), Error> {
        self.scene.inline_files()?;
        let mut scene = match &self.scene_file {
            Some(path) => scene_file::overlay(scene_file::read(path)?, &self.scene),
            None => self.scene.clone(),
        };
        scene.default_to_auto();
        if let Some(words) = self.show.expand(&mut scene)? {
            progress.note(&words);
            self.times |= self.turntable.is_none() && self.keyframes.is_none();
        }
        scene.annotate.check()?;
        scene.path.check_no_focus("a film")?;
        let target = Target::new(&self.output)?;
        let layers = scene.picture.layers();
        self.check_target(&target, &scene.picture)?;
        let keyframes = self
            .keyframes
            .as_deref()
            .map(|path| keyframes::read(path, self.fps));
        let is_still = self.turntable.is_none() && !self.times && self.keyframes.is_none();
        if is_still && scene.is_auto() {
            self.turntable = Some(TURN_FRAMES);
            progress.note(&format!(
                "a turntable of {TURN_FRAMES} frames; --turntable N, --times and --keyframes FILE make other films"
            ));
        }
        if is_still && !scene.is_auto() && self.scene_file.is_some() {
            return Err(Error::usage(
                "nothing says what changes from frame to frame: a scene keeps the pictures, not the motion",
                "say it again: --turntable 120, --times or --keyframes FILE, with its --fps",
            ));
        }
        if self.between.is_some() && !self.times {
            return Err(Error::usage(
                "--between is for the times of the input",
                "add --times",
            ));
        }
        let mut film = Film {
            turntable: self.turntable,
            times: self.times,
            between: self.between.unwrap_or(0),
            keyframes: keyframes.transpose()?,
        };
        let mut inputs = scene_file::inputs(&scene, self.scene_file.as_deref());
        if let Some(keyframes) = &film.keyframes {
            inputs.extend(keyframes.inputs.iter().cloned());
        }
        let depth = match &target {
            Target::Frames(frames) if frames.format != PictureFormat::Png => Depth::More,
            _ if scene.picture.bit_depth() == BitDepth::Sixteen => Depth::More,
            _ => Depth::Eight,
        };
        let limits = scene_inputs::limits(&scene);
        let source = load::open_first(&mut scene, &limits, progress)?;
        let header = source.header();
        if self.show.show.is_some() && self.between.is_none() && header.times > 1 {
            film.between = FRAMES_SHOWN.div_ceil(header.times - 1);
        }
        scene.classification.context = scene.context(header);
        let mode = scene.sampling.mode.unwrap_or_default();
        if let Some(with_level) = scene_inputs::with_level(&scene, mode, source.as_ref(), progress)?
        {
            scene = with_level;
        }
        let mut shots = film.shots(&scene, depth, header, &shots::grid(&scene, header)?)?;
        for shot in &mut shots {
            shot.settings.skip &= !self.no_skip;
        }
        scene_inputs::check(&scene, &shots[0].settings)?;
        check::several(&scene, header, &shots)?;
        check::frame(&scene, &film)?;
        let plan = Plan {
            scene,
            target,
            layers,
            header: source.header().clone(),
            film,
            shots,
            depth,
            inputs,
        };
        Ok((plan, source))
    }

    /// What a kind of file has no room for.
    fn check_target(&self, target: &Target, picture: &PictureFlags) -> Result<(), Error> {
        let (has_layers, has_depth) = match target {
            Target::Frames(frames) => (frames.format != PictureFormat::Png, true),
            Target::Film { format, .. } => (false, format.is_as_good_as_png()),
            Target::Stream => (false, false),
        };
        let name = self.output.display();
        if !has_layers && !picture.layers().is_empty() {
            let message = format!("-o {name}: no room for the layers of --aov");
            return Err(Error::usage(message, "write frames/%04d.exr or .npy"));
        }
        if !has_depth && picture.bit_depth() == BitDepth::Sixteen {
            let message = format!("-o {name}: --bit-depth 16 is for PNG and APNG");
            return Err(Error::usage(message, "--bit-depth 8"));
        }
        match target {
            Target::Film {
                path,
                format: FilmFormat::Mp4,
            } => film::find_ffmpeg(path).map(drop),
            Target::Stream if self.resume => Err(Error::usage(
                "--resume: a stream leaves nothing to go on from",
                "-o film.y4m keeps what is done",
            )),
            _ => Ok(()),
        }
    }

    /// The frames that lie in files: those asked for, or those that a film in one file is made of.
    fn store(&self, plan: &Plan, gate: &Gate) -> Result<Option<Store>, Error> {
        let frames = match &plan.target {
            Target::Frames(frames) => frames.clone(),
            Target::Film { path, .. } => frames_of_film(path),
            Target::Stream => return Ok(None),
        };
        if matches!(plan.target, Target::Film { .. }) && self.force && !self.resume {
            store::clear(&frames)?;
        }
        let film = identity::of_film(plan, &frames)?;
        let annotation = plan.scene.annotate.annotate.is_some();
        let annotation = annotation.then_some(LayerKind::Annotation);
        let layers: Vec<_> = plan.layers.iter().copied().chain(annotation).collect();
        let wishes = Wishes {
            resume: self.resume,
            force: self.force,
            layers: &layers,
            inputs: &plan.inputs,
        };
        let options = WriteOptions {
            bit_depth: plan.scene.picture.bit_depth(),
            force: self.force,
        };
        Store::new(frames, plan.shots.len() as u32, film, wishes, options, gate).map(Some)
    }

    /// What lies behind every frame. Films without transparency have black there.
    fn background(&self, plan: &Plan, scene: &SceneFlags, progress: &Progress) -> Vec<[f64; 4]> {
        let mut layers: Vec<_> = scene.picture.background().into_iter().collect();
        if !keeps_transparency(&plan.target) {
            let is_open = layers.first().is_none_or(|color| color[3] < 1.0);
            if is_open && !scene.picture.shows_sky() {
                progress.note("this kind of film has no transparency: black lies behind");
            }
            layers.push([0.0, 0.0, 0.0, 1.0]);
        }
        layers
    }
}

fn keeps_transparency(target: &Target) -> bool {
    match target {
        Target::Frames(_) => true,
        Target::Film { format, .. } => format.is_as_good_as_png(),
        Target::Stream => false,
    }
}

/// In a hidden folder beside the film.
fn frames_of_film(path: &Path) -> Frames {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    Frames {
        folder: path.with_file_name(format!(".{name}.frames")),
        template: "%06d.png".to_owned(),
        format: PictureFormat::Png,
    }
}
