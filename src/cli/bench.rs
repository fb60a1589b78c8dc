//! `stratavox bench`: what a picture costs on this device.
//!
//! Without `--cameras`: the median of some pictures for each technique, composite and MIP. With it: one
//! scene from a list of views, each picture finished before the next.

use super::{
    Error, cameras_file,
    flags::{Classification, Depth, SceneFlags},
    output::{self, say, say_aside, write_whole},
    progress::{Progress, ProgressWord},
    renderer::{Device, Job, Renderer},
    scene_file,
    shown::Shown,
    signals::Gate,
    timings::{FrameTime, Timings, median, ms_since, peak_rss_bytes},
};
use crate::{
    camera::Camera,
    technique::{Mode, Settings, Shadows, Technique},
    transfer::{Classified, Window},
};
use clap::Args;
use serde_json::json;
use std::{fmt::Write, path::PathBuf, time::Instant};

/// Measure what pictures cost on this device
#[derive(Args, Debug)]
#[command(after_help = "Examples:\n  \
    stratavox bench\n  \
    stratavox bench phantom:shells,n=128 --size 512x512 --json times.json")]
pub struct Bench {
    #[command(flatten)]
    scene: SceneFlags,
    /// Flags from a file; those of the command line win
    #[arg(long = "scene", value_name = "FILE.json", help_heading = "Run")]
    scene_file: Option<PathBuf>,
    /// Views to draw, one after the other
    #[arg(long, value_name = "FILE.json", help_heading = "Run")]
    cameras: Option<PathBuf>,
    /// Write the times into a file
    #[arg(long, value_name = "FILE", help_heading = "Run")]
    json: Option<PathBuf>,
    /// Pictures to take the median of, for each technique
    #[arg(long, value_name = "N", default_value_t = 9, value_parser = clap::value_parser!(u32).range(1..), help_heading = "Run")]
    repeat: u32,
    /// Say on stderr how far the work is
    #[arg(long, value_enum, default_value_t, help_heading = "Run")]
    progress: ProgressWord,
    /// Replace files that exist
    #[arg(long, help_heading = "Run")]
    force: bool,
    /// No empty-space skipping: the picture is the same without
    #[arg(long)]
    no_skip: bool,
}

/// What is drawn where no INPUT is given.
const DEFAULT_INPUT: &str = "phantom:head";

impl Bench {
    /// Measures, prints, writes.
    pub fn run(mut self, gate: &Gate) -> Result<(), Error> {
        self.scene.classification.inline_file()?;
        let mut scene = match &self.scene_file {
            Some(path) => scene_file::overlay(scene_file::read(path)?, &self.scene),
            None => self.scene.clone(),
        };
        if scene.input.path.is_none() {
            scene.input.path = Some(DEFAULT_INPUT.to_owned());
        }
        let mut inputs = scene_file::inputs(&scene, self.scene_file.as_deref());
        inputs.extend(self.cameras.clone());
        output::check(self.json.as_slice(), &inputs, self.force)?;
        scene.classification.check()?;
        if scene.section.section.is_some() {
            return Err(Error::usage(
                "--section is for one picture: a bench looks from all around",
                "leave out --section",
            ));
        }
        let cameras = self
            .cameras
            .as_deref()
            .map(cameras_file::read)
            .transpose()?;
        let text = match cameras {
            Some(cameras) => self.views(&scene, &cameras, gate)?,
            None => {
                if scene.sampling.technique.is_some() || scene.sampling.mode.is_some() {
                    say_aside(
                        "--technique and --mode have no effect without --cameras, the table has its own",
                    );
                }
                self.techniques(&scene)?
            }
        };
        match &self.json {
            Some(path) => write_whole(path, text.as_bytes(), self.force, gate),
            None => Ok(()),
        }
    }

    /// One scene from each of the views.
    fn views(&self, scene: &SceneFlags, cameras: &[Camera], gate: &Gate) -> Result<String, Error> {
        let progress = Progress::new(self.progress);
        let settings = scene.settings(Depth::Eight)?;
        progress.stage("prepare", 0, 1);
        let word = scene.device.as_deref();
        let device = Device::find(word)?;
        progress.device(&device.name()?);
        progress.stage("read", 0, 1);
        let start = Instant::now();
        let shown = Shown::read(scene, &settings, &device, &progress)?;
        let settings = filtered(settings, scene, &shown);
        let parts = shown.parts();
        let load_ms = ms_since(start);
        progress.stage("prepare", 0, 1);
        let mut job = Job {
            volume: &shown.volume,
            classification: &shown.classification,
            beside: parts.beside(),
            settings: &settings,
            extent_pixels: scene.picture.extent_pixels()?,
            layers: &[],
        };
        // The window of an X-ray is the range of the first view, in all views.
        let of_first = window_of(job, &cameras[0], word)?;
        job.classification = of_first.as_ref().unwrap_or(&shown.classification);
        let mut renderer = Renderer::new(job, &cameras[0], device)?;
        // Pipelines are made on first use: that is not what is measured.
        renderer.draw(&cameras[0])?;
        let mut frames = Vec::new();
        for (done, camera) in cameras.iter().enumerate() {
            progress.stage("draw", done, cameras.len());
            frames.push(timed(&mut renderer, camera)?);
        }
        let stages = renderer.stages(&progress, gate, None);
        let timings = Timings {
            device: renderer.device(),
            driver: renderer.driver(),
            load_ms,
            upload_ms: renderer.upload_ms,
            prepare_ms: renderer.prepare_ms,
            first_frame_ms: frames[0].wall_ms,
            frames,
            samples: renderer.samples(&cameras[cameras.len() - 1])?,
            peak_rss_bytes: peak_rss_bytes(),
            device_bytes: renderer.device_bytes(),
            stages,
        };
        say(&format!(
            "{}: median of {} views {:.3} ms\n",
            timings.device,
            timings.frames.len(),
            median_wall(&timings.frames),
        ))?;
        Ok(timings.json())
    }

    /// Each technique, as a table.
    fn techniques(&self, scene: &SceneFlags) -> Result<String, Error> {
        let progress = Progress::new(self.progress);
        progress.stage("read", 0, 1);
        let base = scene.settings(Depth::Eight)?;
        let word = scene.device.as_deref();
        let extent_pixels = scene.picture.extent_pixels()?;
        let mut rows = Vec::new();
        let mut device = String::new();
        for (mode, of_mode) in MEASURED {
            // Labels are not projected.
            if mode.is_projection() && scene.labels.labels.is_some() {
                continue;
            }
            // No light falls on projections.
            let shading = base.shading.clone().filter(|_| !mode.is_projection());
            let base = Settings {
                mode,
                shading,
                ambient_occlusion: base.ambient_occlusion.filter(|_| !mode.is_projection()),
                ..base.clone()
            };
            // What is shown depends on the mode: channels are read for each.
            let shown = Shown::read(scene, &base, &Device::find(word)?, &progress)?;
            let camera = scene.camera.camera(&shown.subject(), extent_pixels)?;
            let base = filtered(base, scene, &shown);
            let parts = shown.parts();
            for (name, technique) in of_mode {
                progress.stage("measure", rows.len(), 2 * of_mode.len());
                let mut settings = Settings {
                    technique,
                    ..base.clone()
                };
                // Half-angle slices are those of one technique and mode.
                let has_them = technique == Technique::Slices3d && mode == Mode::Composite;
                if let Some(shading) = settings.shading.as_mut().filter(|_| !has_them) {
                    shading.shadows = Shadows::Off;
                }
                let job = Job {
                    volume: &shown.volume,
                    classification: &shown.classification,
                    beside: parts.beside(),
                    settings: &settings,
                    extent_pixels,
                    layers: &[],
                };
                let mut renderer = Renderer::new(job, &camera, Device::find(word)?)?;
                renderer.draw(&camera)?;
                let frames = (0..self.repeat).map(|_| timed(&mut renderer, &camera));
                let frames = frames.collect::<Result<Vec<_>, _>>()?;
                rows.push((name, median_gpu(&frames), median_wall(&frames)));
                device = format!("{}, {}", renderer.device(), renderer.driver());
            }
        }
        drop(progress);
        let [width, height] = extent_pixels;
        let mut table = format!(
            "{device}\n{width}x{height}, median of {}\n{:<20} {:>10} {:>10}\n",
            self.repeat, "", "gpu ms", "wall ms"
        );
        for (name, gpu_ms, wall_ms) in &rows {
            let gpu_ms = gpu_ms.map_or("-".to_owned(), |ms| format!("{ms:.3}"));
            let _ = writeln!(table, "{name:<20} {gpu_ms:>10} {wall_ms:>10.3}");
        }
        say(&table)?;
        let rows: Vec<_> = rows
            .iter()
            .map(|(name, gpu_ms, wall_ms)| json!({ "name": name, "gpu_ms": gpu_ms, "wall_ms": wall_ms }))
            .collect();
        let value =
            json!({ "device": device, "size": extent_pixels, "repeat": self.repeat, "rows": rows });
        Ok(format!("{value:#}\n"))
    }
}

/// Preset `grey` over the range of what the first view projects, where nothing else says how to classify.
fn window_of(
    job: Job,
    camera: &Camera,
    device: Option<&str>,
) -> Result<Option<Classification>, Error> {
    if *job.classification != Classification::RangeOfPicture {
        return Ok(None);
    }
    let device = Device::find(device)?;
    let range = Renderer::new(job, camera, device)?.projected_range(camera)?;
    let function = Window::of_range(range).grey(Classified::Projection);
    Ok(Some(Classification::Function(function)))
}

/// The rows of the table.
const MEASURED: [(Mode, [(&str, Technique); 3]); 2] = [
    (
        Mode::Composite,
        [
            ("raycast composite", Technique::Raycast),
            ("slices-3d composite", Technique::Slices3d),
            ("slices-2d composite", Technique::Slices2d),
        ],
    ),
    (
        Mode::Mip,
        [
            ("raycast mip", Technique::Raycast),
            ("slices-3d mip", Technique::Slices3d),
            ("slices-2d mip", Technique::Slices2d),
        ],
    ),
];

/// The settings, with what depends on the values.
fn filtered(settings: Settings, scene: &SceneFlags, shown: &Shown) -> Settings {
    let per_mode = shown.per_mode.clone();
    let filter = match (scene.sampling.filter, shown.filter) {
        (None, Some(filter)) => filter,
        _ => settings.filter,
    };
    Settings {
        filter,
        per_mode,
        ..settings
    }
}

fn timed(renderer: &mut Renderer, camera: &Camera) -> Result<FrameTime, Error> {
    let start = Instant::now();
    let frame = renderer.draw(camera)?;
    Ok(FrameTime {
        gpu_ms: frame.gpu_ms,
        wall_ms: ms_since(start),
    })
}

fn median_wall(frames: &[FrameTime]) -> f64 {
    median(frames.iter().map(|frame| frame.wall_ms).collect())
}

fn median_gpu(frames: &[FrameTime]) -> Option<f64> {
    let times: Option<Vec<f64>> = frames.iter().map(|frame| frame.gpu_ms).collect();
    times.map(median)
}
