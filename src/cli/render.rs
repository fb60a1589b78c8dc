//! `stratavox render`: one picture of one volume.

use super::{
    Error,
    annotation::{annotation, finish},
    flags::{Classification, Depth, InputFlags, PHANTOM, SceneFlags},
    flow,
    kept_samples::{KeptSamples, PictureOf},
    load::open,
    look::{Chosen, Framing, Use, View, Views, prepared},
    output::{self, write_whole},
    planes::Panels,
    progress::{Progress, ProgressWord},
    reasons::{Shows, why_empty},
    renderer::{Device, REFERENCE},
    scene_file,
    scene_inputs::SceneInputs,
    show::ShowFlags,
    signals::Gate,
    stdin::STANDARD,
    timings::{FrameTime, Timings, ms_since, peak_rss_bytes},
};
use crate::annotate::Annotation;
use crate::format::{self, write::has_coarser_levels};
use crate::offscreen::Traced;
use crate::picture::{
    BitDepth, EncodedPicture, LayerKind, PictureFormat, WriteOptions, write_picture,
};
use crate::technique::Settings;
use clap::Args;
use std::{
    io::IsTerminal,
    path::{Path, PathBuf},
    sync::PoisonError,
    time::Instant,
};

/// Draw a volume into a picture
#[derive(Args, Clone, Debug)]
#[command(help_template = "{about}\n\n{usage-heading} {usage}\n\n\
    Examples:\n  \
    stratavox phantom:head\n  \
    stratavox render phantom:head --preset ct-bone --view left --size 800x800 -o bone.png\n  \
    stratavox render phantom:head --section axial --window -100,300 -o axial.png\n  \
    stratavox render phantom:head --mode mip --aov value,depth -o mip.exr\n\n\
    {all-args}{after-help}")]
#[command(after_help = "Examples of other flags:\n  \
    stratavox render phantom:head --technique slices-3d --view left --background 0,0,0 -o left.png\n  \
    cat scan.nii.gz | stratavox render - -o - | display\n  \
    stratavox render phantom:storm,n=64 --variable w --mode iso --iso-color-by vapor -o w.png\n  \
    stratavox render phantom:cells --channel 0,color=cyan --channel 1,color=1:0.3:0 -o cells.png\n  \
    stratavox render phantom:storm --variable temperature --opacity-variable cloud -o storm.png\n  \
    stratavox convert phantom:sphere,n=64 -o ball.nrrd --type u8 --window 0,1\n  \
    stratavox render phantom:head,n=64 --labels ball.nrrd --label-show 128-255 -o ball.png\n  \
    stratavox render phantom:head,n=64 --labels ball.nrrd --label-dim 0-127:0.05 -o dimmed.png")]
pub struct Render {
    /// The picture: its ending says whether .png, .exr or .npy; - writes a PNG to the standard output [default: the
    /// name of INPUT with .png, in this folder]
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    #[command(flatten)]
    scene: SceneFlags,
    #[command(flatten)]
    show: ShowFlags,
    /// Flags from a file; those of the command line win
    #[arg(long = "scene", value_name = "FILE.json", help_heading = "Run")]
    scene_file: Option<PathBuf>,
    /// Write all flags of this picture into a file
    #[arg(long, value_name = "FILE.json", help_heading = "Run")]
    save_scene: Option<PathBuf>,
    /// Write what the work took into a file
    #[arg(long, value_name = "FILE.json", help_heading = "Run")]
    timings: Option<PathBuf>,
    /// Draw so many times; the last picture is written
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..), help_heading = "Run")]
    repeat: u32,
    /// Say on stderr how far the work is
    #[arg(long, value_enum, default_value_t, help_heading = "Run")]
    progress: ProgressWord,
    /// Keep the samples of --technique pathtrace in a file, every 30 seconds and at the end, so that a later run can go on
    #[arg(
        long,
        value_name = "FILE",
        conflicts_with = "refine",
        help_heading = "Run"
    )]
    keep_samples: Option<PathBuf>,
    /// Go on with the samples that --keep-samples has kept, of this very picture, up to --spp
    #[arg(long, requires = "keep_samples", help_heading = "Run")]
    resume: bool,
    /// Replace files that exist
    #[arg(long, help_heading = "Run")]
    force: bool,
    /// Draw from the coarsest resolution of the file to the finest, each written as soon as it is drawn
    #[arg(long, conflicts_with_all = ["level", "fit"], help_heading = "Run")]
    refine: bool,
    /// No empty-space skipping: slower, the same picture
    #[arg(long, conflicts_with = "empty_space")]
    no_skip: bool,
}

impl Render {
    /// Draws and writes.
    pub fn run(self, gate: &Gate) -> Result<(), Error> {
        for coarse in self.coarse()? {
            coarse.draw(gate)?;
        }
        let force = self.force || self.refine;
        Self { force, ..self }.draw(gate)
    }

    /// The pictures before the one that is wanted, the coarsest first.
    fn coarse(&self) -> Result<Vec<Self>, Error> {
        if !self.refine {
            return Ok(Vec::new());
        }
        let scene = self.clone().whole_scene()?;
        let source = open(&scene.input, &scene.input.limits())?;
        let last = source.header().levels - 1;
        if last == 0 {
            return Err(Error::usage(
                "--refine is for files of several resolutions, and this one has one",
                match has_coarser_levels(source.header().dims) {
                    true => {
                        "`stratavox convert INPUT -o FILE.svb` makes a file with coarser levels"
                    }
                    false => {
                        "leave --refine out: a volume that fits into one brick is drawn at once"
                    }
                },
            ));
        }
        let coarse = |level: u32| {
            let mut coarse = self.clone();
            coarse.scene.input.level = Some(level);
            coarse.force = self.force || level < last;
            (coarse.timings, coarse.save_scene) = (None, None);
            coarse
        };
        Ok((1..=last).rev().map(coarse).collect())
    }

    /// One picture.
    fn draw(mut self, gate: &Gate) -> Result<(), Error> {
        let mut scene = self.whole_scene()?;
        let shown_by = self.show.expand(&mut scene)?;
        let output = match &self.output {
            Some(output) => output.clone(),
            None => default_output(&scene.input, self.force),
        };
        let is_stdout = output == Path::new(STANDARD);
        let format = match is_stdout {
            true => PictureFormat::Png,
            false => picture_format(&output)?,
        };
        if is_stdout && std::io::stdout().is_terminal() {
            return Err(Error::usage(
                "-o -: the standard output is a terminal, and a PNG is no text",
                "-o FILE.png, or send it on: -o - | program",
            ));
        }
        let layers = scene.picture.layers();
        if format == PictureFormat::Png && !layers.is_empty() {
            return Err(Error::usage(
                "a .png has no room for the layers of --aov",
                "write a .exr or a .npy",
            ));
        }
        let depth = match (format, scene.picture.bit_depth()) {
            (PictureFormat::Png, BitDepth::Eight) => Depth::Eight,
            _ => Depth::More,
        };
        let settings = scene.settings(depth)?;
        let extent_pixels = scene.picture.extent_pixels()?;
        scene.classification.check()?;
        scene.annotate.check()?;
        let inputs = scene_file::inputs(&scene, self.scene_file.as_deref());
        let is_annotated = scene.annotate.annotate.is_some();
        let kept = self.kept(&scene, &settings, extent_pixels)?;
        // A better picture takes the place of that of the run before.
        let force = self.force || kept.as_ref().is_some_and(|kept| kept.replaces(&output));
        let outputs = self.outputs(&output, format, &layers, is_annotated);
        output::check(&outputs, &inputs, force)?;
        let files: Vec<_> = outputs
            .into_iter()
            .chain(self.keep_samples.clone())
            .collect();
        output::check(&files, &inputs, true)?;

        let progress = Progress::new(self.progress);
        shown_by.iter().for_each(|words| progress.note(words));
        progress.stage("prepare", 0, 1);
        let device = Device::begin(scene.one_device()?);
        progress.stage("read", 0, 1);
        let start = Instant::now();
        let shown = SceneInputs::read(&mut scene, &settings, &device, &progress);
        // Without a device nothing else that is wrong matters.
        device.wait()?;
        let shown = shown?;
        progress.device(&device.name()?);
        let SceneInputs {
            volume,
            classification,
            ..
        } = &shown;
        let load_ms = ms_since(start);

        progress.stage("prepare", 0, 1);
        let parts = shown.parts();
        let made_for = Use {
            is_film: false,
            is_opaque: format == PictureFormat::Png,
            depth,
        };
        let panels = Panels::of(&scene, &shown, extent_pixels)?;
        let frame = |scene| Framing::new(scene, &shown, made_for, panels.extent(), !self.no_skip);
        if panels.are_several() && !layers.is_empty() {
            return Err(Error::usage(
                "--aov is of one view, and --section has several planes",
                "name one plane, or leave out --aov",
            ));
        }
        let framing = frame(&panels.scenes()[0]);
        let views = Views::default();
        let (mut renderer, view) = prepared(&framing, &parts, &layers, device, &views)?;
        // Of the scene with its look: a light that is given falls on what the look lights.
        let idle = view.scene.idle().into_iter();
        for note in idle.chain(view.notes.iter().cloned()) {
            progress.note(&note);
        }
        let said = self.scene_file.is_none().then_some(&self.scene);
        let of_lines = flow::notes(said, &scene, shown.lines(), &view.camera, extent_pixels);
        of_lines.iter().for_each(|note| progress.note(note));
        let View {
            camera, settings, ..
        } = view;
        renderer.watch(|part| progress.part(part));
        renderer.watch_paths(|traced| {
            progress.paths(
                [traced.paths, settings.path.samples],
                traced.noise,
                traced.seconds_left(&settings.path),
            );
        });
        renderer.end_paths_by(gate);
        let base = shown.base(&scene, settings.mode)?;
        let frozen = |integrals| {
            let chosen = Chosen::of_picture(view, &shown, parts.beside(), integrals, base.as_ref());
            chosen.frozen(&view.scene)
        };
        let mut failed_to_keep = None;
        if let Some(kept) = kept {
            if panels.are_several() {
                return Err(Error::usage(
                    "--keep-samples is of one picture, and --section has several planes",
                    "name one plane",
                ));
            }
            let of = PictureOf {
                scene: &frozen(None),
                extent: panels.extent(),
                volume,
                settings,
                device: renderer.device(),
                driver: renderer.driver(),
            };
            let (begun, keeper) = kept.begin(&output, &of, self.force)?;
            if begun.paths() > 0 {
                progress.note(&format!("{} paths a pixel are there", begun.paths()));
            }
            failed_to_keep = Some(keeper.failed());
            renderer.keep_paths(begun, move |sums| keeper.keep(sums, gate));
        }
        let mut frames = Vec::new();
        let mut last = None;
        for done in 0..self.repeat {
            progress.stage("draw", done as usize, self.repeat as usize);
            let start = Instant::now();
            let frame = renderer.draw(camera)?;
            frames.push(FrameTime {
                gpu_ms: frame.gpu_ms,
                wall_ms: ms_since(start),
            });
            last = Some(frame.picture);
        }
        let mut picture = last.expect("at least one picture is drawn");
        let traced = renderer.traced();
        if let Some(note) = traced.and_then(|traced| said_of(traced, settings)) {
            progress.note(&note);
        }
        let start = Instant::now();
        let reasoned = parts.only(classification);
        let shows = Shows::of(shown.lines().is_some(), scene.hides_volume());
        if !panels.are_several()
            && let Some(reason) = why_empty(&picture, shows, volume, reasoned, camera, settings)
        {
            progress.note(&reason.to_string());
        }
        let annotation = annotation(&scene, &shown.header, settings.mode)?;
        if let Some(note) = annotation.as_ref().and_then(Annotation::note) {
            progress.note(&note);
        }
        let background = view.scene.picture.background();
        let annotation = annotation.as_ref();
        finish(
            &mut picture,
            annotation,
            &shown,
            view,
            &mut renderer,
            background,
            format,
        )?;
        let mut pictures = vec![picture];
        for scene in &panels.scenes()[1..] {
            let view = frame(scene).view()?;
            let mut picture = renderer.draw_other(&view.camera, &view.settings, panels.extent())?;
            finish(
                &mut picture,
                annotation,
                &shown,
                &view,
                &mut renderer,
                background,
                format,
            )?;
            pictures.push(picture);
        }
        let picture = panels.together(pictures, background);

        progress.stage("write", 0, 1);
        let own = &self.scene.picture;
        if format != PictureFormat::Png && (own.tone.is_some() || own.exposure.is_some()) {
            progress.note(
                "--tone and --exposure have no effect on this file, which holds light as it is",
            );
        }
        let options = WriteOptions {
            bit_depth: scene.picture.bit_depth(),
            force,
        };
        if is_stdout {
            let encoded = EncodedPicture::new(&picture, Path::new("picture.png"), options)?;
            for (_, bytes) in encoded.into_files() {
                output::write_out(&bytes)?;
            }
        } else {
            gate.whole(|| write_picture(&picture, &output, options))?;
        }
        if self.output.is_none() {
            progress.note(&format!("drawn into {}", output.display()));
        }
        let stages = renderer.stages(camera, &progress, gate, Some(ms_since(start)));
        if let Some(path) = &self.save_scene {
            let integrals = match classification {
                Classification::RangeOfPicture => Some(renderer.projected_range(camera)?),
                Classification::Function(_) => None,
            };
            let mut frozen = frozen(integrals);
            if panels.are_several() {
                frozen.section = scene.section.clone();
                frozen.camera.view_height = scene.camera.view_height;
            }
            let text = scene_file::text(&frozen, path);
            write_whole(path, text.as_bytes(), self.force, gate)?;
        }
        if let Some(path) = &self.timings {
            let timings = Timings {
                device: renderer.device(),
                driver: renderer.driver(),
                load_ms,
                upload_ms: renderer.upload_ms,
                prepare_ms: renderer.prepare_ms,
                first_frame_ms: frames.first().map_or(0.0, |frame| frame.wall_ms),
                frames,
                samples: renderer.samples(camera)?,
                samples_per_s: renderer.paths_per_s(),
                collisions_per_sample: renderer.collisions_per_sample(camera)?,
                peak_rss_bytes: peak_rss_bytes(),
                device_bytes: renderer.device_bytes(),
                stages,
            };
            write_whole(path, timings.json().as_bytes(), self.force, gate)?;
        }
        if let Some(failed) = failed_to_keep
            && let Some(error) = failed.lock().unwrap_or_else(PoisonError::into_inner).take()
        {
            return Err(error);
        }
        match gate.was_asked() {
            true => Err(Error::Interrupted),
            false => Ok(()),
        }
    }

    /// The file of `--keep-samples`, and what a run before has left in it.
    fn kept(
        &self,
        scene: &SceneFlags,
        settings: &Settings,
        extent: [u32; 2],
    ) -> Result<Option<KeptSamples>, Error> {
        let Some(path) = &self.keep_samples else {
            return Ok(None);
        };
        if !settings.technique.traces_paths() {
            return Err(Error::usage(
                "--keep-samples is for --technique pathtrace: other pictures have all samples at once",
                "leave it out",
            ));
        }
        if scene.one_device()? == Some(REFERENCE) {
            return Err(Error::usage(
                "--keep-samples is of devices, and --device reference traces all paths at once",
                "leave out --device reference",
            ));
        }
        if self.repeat > 1 {
            return Err(Error::usage(
                "--keep-samples is of one picture, and --repeat draws several",
                "leave out --repeat",
            ));
        }
        KeptSamples::open(path, extent, self.resume, self.force).map(Some)
    }

    /// The flags laid over those of `--scene`.
    fn whole_scene(&mut self) -> Result<SceneFlags, Error> {
        self.scene.inline_files()?;
        let mut scene = match &self.scene_file {
            Some(path) => scene_file::overlay(scene_file::read(path)?, &self.scene),
            None => self.scene.clone(),
        };
        scene.default_to_auto();
        Ok(scene)
    }

    fn outputs(
        &self,
        output: &Path,
        format: PictureFormat,
        layers: &[LayerKind],
        is_annotated: bool,
    ) -> Vec<PathBuf> {
        let mut outputs = match output == Path::new(STANDARD) {
            true => Vec::new(),
            false => vec![output.to_owned()],
        };
        if format == PictureFormat::Npy {
            let name = |layer: &LayerKind| format!("{}.npy", layer.name());
            let annotation = is_annotated.then_some(LayerKind::Annotation);
            outputs.extend(
                layers
                    .iter()
                    .chain(&annotation)
                    .map(|layer| output.with_extension(name(layer))),
            );
        }
        outputs.extend(self.save_scene.iter().chain(&self.timings).cloned());
        outputs
    }
}

/// Of a picture of paths whose number no flag has said.
fn said_of(traced: Traced, settings: &Settings) -> Option<String> {
    let path = &settings.path;
    let is_known = path.noise.is_none() && path.seconds.is_none() && traced.paths == path.samples;
    let paths = traced.paths;
    (!is_known).then(|| match traced.noise {
        Some(noise) => format!("{paths} paths a pixel, noise {noise:.2e} of the light"),
        None => format!("{paths} paths a pixel"),
    })
}

/// The name of a picture whose volume has none.
const NAMELESS: &str = "volume";

/// The name of a file without its ending; of `.` and `..` that of the folder which they are.
fn name_of(path: &Path) -> String {
    let whole = match path.file_name() {
        Some(_) => path.to_owned(),
        None => path.canonicalize().unwrap_or_default(),
    };
    let name = format::stem(&whole);
    let name = if name.is_empty() { NAMELESS } else { name };
    name.to_owned()
}

/// `NAME.png` in this folder for `NAME.nii.gz`; the first of `NAME-2.png`, `NAME-3.png` that is not there, unless
/// `force` replaces it.
fn default_output(input: &InputFlags, force: bool) -> PathBuf {
    let path = input.path.as_deref().unwrap_or_default();
    let name = match path.strip_prefix(PHANTOM) {
        Some(words) => words.split(',').next().unwrap_or(words).to_owned(),
        None if path == STANDARD => NAMELESS.to_owned(),
        None => name_of(Path::new(path)),
    };
    let free = (1..).map(|n| match n {
        1 => PathBuf::from(format!("{name}.png")),
        n => PathBuf::from(format!("{name}-{n}.png")),
    });
    let is_free = |path: &PathBuf| force || path.symlink_metadata().is_err();
    let mut free = free.filter(is_free);
    free.next().expect("names do not end")
}

fn picture_format(path: &Path) -> Result<PictureFormat, Error> {
    PictureFormat::of_path(path).ok_or_else(|| {
        Error::usage(
            format!("-o {}: the ending says no kind of picture", path.display()),
            "end the name in .png, .exr or .npy",
        )
    })
}
