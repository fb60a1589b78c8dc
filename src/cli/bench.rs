//! `stratavox bench`: what a picture costs on this device.
//!
//! Without `--cameras`: the medians of some pictures for each volume, technique, mode and projection. With it: one
//! scene from a list of views, each picture finished before the next.

mod table;

use super::{
    Error, cameras_file,
    flags::{Classification, Depth, ProjectionWord, SceneFlags},
    output::{self, say, write_whole},
    progress::{Progress, ProgressWord},
    renderer::{Device, Job, Renderer},
    scene_file,
    scene_inputs::SceneInputs,
    signals::Gate,
    timings::{FrameTime, Timings, median, ms_since, peak_rss_bytes},
};
use crate::{
    camera::Camera,
    technique::{Mode, Settings, Technique},
    transfer::{Classified, Window},
};
use clap::Args;
use std::{path::PathBuf, time::Instant};

/// Measure what pictures cost on this device
#[derive(Args, Debug)]
#[command(after_help = "Examples:\n  \
    stratavox bench\n  \
    stratavox bench phantom:shells,n=128 --size 512x512 --json times.json\n  \
    stratavox bench phantom:shells,n=64 phantom:fog,n=64 --techniques raycast,slices-3d --modes composite,xray --projections orthographic")]
pub struct Bench {
    #[command(flatten)]
    scene: SceneFlags,
    /// Further volumes of the table
    #[arg(value_name = "INPUT")]
    more: Vec<String>,
    /// Techniques of the table [default: that of --technique, else all but pathtrace, whose samples are paths]
    #[arg(
        long,
        value_name = "NAME,...",
        value_enum,
        value_delimiter = ',',
        help_heading = "Run"
    )]
    techniques: Vec<Technique>,
    /// Modes of the table [default: that of --mode, else composite,mip]
    #[arg(
        long,
        value_name = "NAME,...",
        value_enum,
        value_delimiter = ',',
        help_heading = "Run"
    )]
    modes: Vec<Mode>,
    /// Projections of the table [default: that of --projection, else both]
    #[arg(
        long,
        value_name = "NAME,...",
        value_enum,
        value_delimiter = ',',
        help_heading = "Run"
    )]
    projections: Vec<ProjectionWord>,
    /// Flags from a file; those of the command line win
    #[arg(long = "scene", value_name = "FILE.json", help_heading = "Run")]
    scene_file: Option<PathBuf>,
    /// Views to draw, one after the other
    #[arg(long, value_name = "FILE.json", help_heading = "Run")]
    cameras: Option<PathBuf>,
    /// Write the times into a file
    #[arg(long, value_name = "FILE", help_heading = "Run")]
    json: Option<PathBuf>,
    /// Pictures to take the median of, for each row of the table [default: 9, fewer where they take seconds]; with
    /// --cameras how often to go through the views [default: 1]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..), help_heading = "Run")]
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

/// What is drawn where no INPUT is given.
const DEFAULT_INPUT: &str = "phantom:head";

impl Bench {
    /// Measures, prints, writes.
    pub fn run(mut self, gate: &Gate) -> Result<(), Error> {
        self.scene.inline_files()?;
        let mut scene = match &self.scene_file {
            Some(path) => scene_file::overlay(scene_file::read(path)?, &self.scene),
            None => self.scene.clone(),
        };
        if scene.input.path.is_none() {
            scene.input.path = Some(DEFAULT_INPUT.to_owned());
        }
        scene.choose_for_points();
        let mut inputs = scene_file::inputs(&scene, self.scene_file.as_deref());
        inputs.extend(self.cameras.clone());
        let files = self
            .more
            .iter()
            .filter(|input| !input.starts_with("phantom:"));
        inputs.extend(files.map(PathBuf::from));
        output::check(self.json.as_slice(), &inputs, self.force)?;
        scene.classification.check()?;
        scene.path.check_no_focus("a bench")?;
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
            Some(cameras) => {
                self.check_no_table()?;
                self.views(&scene, &cameras, gate)?
            }
            None => table::measured(&self, &scene)?,
        };
        match &self.json {
            Some(path) => write_whole(path, text.as_bytes(), self.force, gate),
            None => Ok(()),
        }
    }

    /// Views are of one picture.
    fn check_no_table(&self) -> Result<(), Error> {
        let is_table = !(self.more.is_empty()
            && self.techniques.is_empty()
            && self.modes.is_empty()
            && self.projections.is_empty());
        match is_table {
            true => Err(Error::usage(
                "further INPUTs, --techniques, --modes and --projections are rows of the table, and --cameras draws none",
                "leave out --cameras, or say --technique, --mode and one INPUT",
            )),
            false => Ok(()),
        }
    }

    /// One scene from each of the views.
    fn views(&self, scene: &SceneFlags, cameras: &[Camera], gate: &Gate) -> Result<String, Error> {
        let progress = Progress::new(self.progress);
        let settings = Settings {
            skip: !self.no_skip,
            ..scene.settings(Depth::Eight)?
        };
        progress.stage("prepare", 0, 1);
        let word = scene.one_device()?;
        let device = Device::find(word)?;
        progress.device(&device.name()?);
        progress.stage("read", 0, 1);
        let start = Instant::now();
        let shown = SceneInputs::read(&mut scene.clone(), &settings, &device, &progress)?;
        let settings = filtered(settings, scene, &shown);
        let parts = shown.parts();
        let load_ms = ms_since(start);
        progress.stage("prepare", 0, 1);
        let mut job = Job {
            volume: &shown.volume,
            classification: &shown.classification,
            stream: shown.stream(),
            beside: parts.beside(),
            lines: shown.lines(),
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
        let rounds = self.repeat.unwrap_or(1) as usize;
        let count = cameras.len().saturating_mul(rounds);
        let mut frames = Vec::new();
        for (done, camera) in cameras.iter().cycle().take(count).enumerate() {
            progress.stage("draw", done, count);
            frames.push(timed(&mut renderer, camera)?);
        }
        let stages = renderer.stages(&cameras[cameras.len() - 1], &progress, gate, None);
        let timings = Timings {
            device: renderer.device(),
            driver: renderer.driver(),
            load_ms,
            upload_ms: renderer.upload_ms,
            prepare_ms: renderer.prepare_ms,
            first_frame_ms: frames[0].wall_ms,
            frames,
            samples: renderer.samples(&cameras[cameras.len() - 1])?,
            samples_per_s: renderer.paths_per_s(),
            collisions_per_sample: renderer.collisions_per_sample(&cameras[cameras.len() - 1])?,
            peak_rss_bytes: peak_rss_bytes(),
            device_bytes: renderer.device_bytes(),
            stages,
        };
        say(&format!(
            "{}: views {}, frames {count}, median {:.3} ms\n",
            timings.device,
            cameras.len(),
            median_wall(&timings.frames),
        ))?;
        Ok(timings.json())
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

/// The settings, with what depends on the values.
fn filtered(settings: Settings, scene: &SceneFlags, shown: &SceneInputs) -> Settings {
    let per_mode = shown.per_mode.clone();
    let filter = match (scene.sampling.filter, shown.filter) {
        (None, Some(filter)) => filter,
        _ => settings.filter,
    };
    Settings {
        filter,
        filter_by: shown.filter_by(scene, settings.filter_by),
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
