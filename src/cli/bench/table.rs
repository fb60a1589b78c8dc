//! The table: volume x technique x mode x projection, each row compared with the measured ceiling of the device.
//!
//! ```text
//! samples / s    = samples of the picture, counted / median time of the device (of the wall where it has no clock)
//! of the ceiling = samples / s : trilinear samples / s that a probe measured on the texture of the volume
//! ```
//!
//! A picture with empty-space skipping or early termination takes fewer samples, each at the price of finding that
//! out: its share of the ceiling says how good the loop is, its time how good the picture is to wait for.
//! Where samples are read by another way than the sampler, as on software devices, the share may be above one.

use super::{Bench, filtered, median_gpu, median_wall, timed};
use crate::cli::{
    Error,
    flags::{Depth, ProjectionWord, SceneFlags},
    output::{say, say_aside},
    progress::Progress,
    renderer::{Device, Job, Renderer},
    scene_inputs::SceneInputs,
    timings::{FrameTime, ms_since},
};
use crate::{
    offscreen::Ceilings,
    technique::{Mode, Settings, Shadows, Technique},
};
use clap::ValueEnum;
use serde_json::{Value, json};
use std::{fmt::Write, time::Instant};

/// Pictures of a row, where no word says how many.
const REPEAT: u32 = 9;
/// After so long a row of at least [`LEAST`] pictures is long enough, where no word says how many.
const ENOUGH_MS: f64 = 3000.0;
const LEAST: usize = 3;

/// One line.
struct Row {
    way: Way,
    volume: String,
    frames: Vec<FrameTime>,
    samples: u64,
    /// Trilinear samples a second.
    ceiling: Option<f64>,
}

/// How a picture of a row is made.
#[derive(Clone, Copy)]
struct Way {
    technique: Technique,
    mode: Mode,
    projection: ProjectionWord,
}

/// A volume and what the device does with its texture at most.
struct Probed {
    volume: String,
    /// `None` where there is no device.
    ceilings: Option<Ceilings>,
}

/// What became of a row.
enum Measured {
    /// Its frames, the samples of one of them, and the device.
    Frames(Vec<FrameTime>, u64, String),
    /// There is no such picture.
    Cannot(String),
}

/// Measures all rows, prints them, and gives the JSON.
pub fn measured(bench: &Bench, scene: &SceneFlags) -> Result<String, Error> {
    let progress = Progress::new(bench.progress);
    let extent_pixels = scene.picture.extent_pixels()?;
    let inputs: Vec<_> = scene.input.path.iter().chain(&bench.more).collect();
    let modes = words_of(
        &bench.modes,
        scene.sampling.mode,
        &[Mode::Composite, Mode::Mip],
    );
    // Labels are not projected.
    let has_labels = scene.labels.labels.is_some();
    let modes = modes.into_iter();
    let modes: Vec<_> = modes
        .filter(|mode| !has_labels || !mode.is_projection())
        .collect();
    let total = inputs.len() * modes.len();
    let (mut rows, mut probes, mut device) = (Vec::new(), Vec::new(), String::new());
    let mut left_out = Vec::new();
    for (at, (input, mode)) in inputs
        .iter()
        .flat_map(|i| modes.iter().map(move |m| (i, m)))
        .enumerate()
    {
        progress.stage("measure", at, total);
        let mut scene = scene.clone();
        scene.input.path = Some((*input).clone());
        scene.choose_for_points();
        let base = Settings {
            skip: !bench.no_skip,
            ..scene.settings(Depth::Eight)?
        };
        let base = of_mode(&base, *mode);
        // What is shown depends on the mode: channels are read for each.
        let here = Device::find(scene.one_device()?)?;
        let shown = SceneInputs::read(&mut scene.clone(), &base, &here, &progress)?;
        if probes
            .last()
            .is_none_or(|last: &Probed| last.volume != **input)
        {
            let volume = (*input).clone();
            let ceilings = here.ceilings(&shown.volume)?;
            probes.push(Probed { volume, ceilings });
        }
        let ceilings = probes.last().and_then(|probed| probed.ceilings);
        for way in bench.ways(&scene, *mode) {
            let measured = bench.row(&scene, &base, &shown, way, extent_pixels)?;
            let (frames, samples, name) = match measured {
                Measured::Frames(frames, samples, name) => (frames, samples, name),
                Measured::Cannot(why) => {
                    left_out.push(format!("{} is left out: {why}", way.name()));
                    continue;
                }
            };
            device = name;
            rows.push(Row {
                way,
                volume: (*input).clone(),
                frames,
                samples,
                ceiling: ceilings.and_then(|ceilings| ceilings.samples_per_second),
            });
        }
    }
    drop(progress);
    if rows.is_empty() {
        let why = left_out
            .first()
            .cloned()
            .unwrap_or_else(|| "labels are drawn in no mode that projects".to_owned());
        return Err(Error::usage(
            format!("no picture of the table can be drawn: {why}"),
            "docs/matrix.md shows which technique, mode, filter and feature go together",
        ));
    }
    left_out.iter().for_each(|why| say_aside(why));
    let repeat = bench.repeat.unwrap_or(REPEAT);
    let often = match bench.repeat {
        Some(repeat) => repeat.to_string(),
        None => format!("{REPEAT}, of fewer where they take seconds"),
    };
    say(&table(&device, extent_pixels, &often, &probes, &rows))?;
    let value = json!({
        "device": device,
        "size": extent_pixels,
        "repeat": repeat,
        "ceilings": probes.iter().map(Probed::json).collect::<Vec<_>>(),
        "rows": rows.iter().map(Row::json).collect::<Vec<_>>(),
    });
    Ok(format!("{value:#}\n"))
}

impl Bench {
    /// The pictures of one mode. Paths, which take far longer, only where a word says so.
    fn ways(&self, scene: &SceneFlags, mode: Mode) -> Vec<Way> {
        let all = Technique::value_variants().iter().copied();
        let all: Vec<_> = all.filter(|one| !one.traces_paths()).collect();
        let techniques = words_of(&self.techniques, scene.sampling.technique, &all);
        let projections = words_of(
            &self.projections,
            scene.camera.projection,
            ProjectionWord::value_variants(),
        );
        let of_technique = |technique| {
            let ways = projections.iter();
            ways.map(move |&projection| Way {
                technique,
                mode,
                projection,
            })
        };
        techniques.iter().copied().flat_map(of_technique).collect()
    }

    /// One row.
    fn row(
        &self,
        scene: &SceneFlags,
        base: &Settings,
        shown: &SceneInputs,
        way: Way,
        extent_pixels: [u32; 2],
    ) -> Result<Measured, Error> {
        let mut camera = scene.camera.clone();
        camera.projection = Some(way.projection);
        let camera = camera.camera(&shown.subject(), extent_pixels)?;
        let technique = way.technique;
        let mut settings = filtered(
            Settings {
                technique,
                ..base.clone()
            },
            scene,
            shown,
        );
        // Half-angle slices are those of one technique and mode.
        let has_them = technique.desc().has_half_angle && settings.mode == Mode::Composite;
        if let Some(shading) = settings.shading.as_mut().filter(|_| !has_them) {
            shading.shadows = Shadows::Off;
        }
        let parts = shown.parts();
        let job = Job {
            volume: &shown.volume,
            classification: &shown.classification,
            stream: shown.stream(),
            beside: parts.beside(),
            lines: shown.lines(),
            settings: &settings,
            extent_pixels,
            layers: &[],
        };
        let device = Device::find(scene.one_device()?)?;
        // The first picture makes what is made on first use.
        let ready = Renderer::new(job, &camera, device).and_then(|mut renderer| {
            renderer.draw(&camera)?;
            Ok(renderer)
        });
        let mut renderer = match ready {
            Err(Error::Usage { message, .. }) => return Ok(Measured::Cannot(message)),
            ready => ready?,
        };
        let start = Instant::now();
        let mut frames = Vec::new();
        let is_enough = |frames: &[FrameTime]| match self.repeat {
            Some(repeat) => frames.len() >= repeat as usize,
            None if frames.len() >= LEAST && ms_since(start) > ENOUGH_MS => true,
            None => frames.len() >= REPEAT as usize,
        };
        while !is_enough(&frames) {
            frames.push(timed(&mut renderer, &camera)?);
        }
        let samples = renderer.samples(&camera)?;
        let name = format!("{}, {}", renderer.device(), renderer.driver());
        Ok(Measured::Frames(frames, samples, name))
    }
}

/// The words of a list, or the one of the flag, or all of these.
fn words_of<T: Copy>(list: &[T], flag: Option<T>, all: &[T]) -> Vec<T> {
    match (list, flag) {
        ([], None) => all.to_vec(),
        ([], Some(flag)) => vec![flag],
        (list, _) => list.to_vec(),
    }
}

/// The settings in another mode. No light falls on projections.
fn of_mode(base: &Settings, mode: Mode) -> Settings {
    let is_lit = !mode.is_projection();
    Settings {
        mode,
        shading: base.shading.clone().filter(|_| is_lit),
        ambient_occlusion: base.ambient_occlusion.filter(|_| is_lit),
        ..base.clone()
    }
}

impl Way {
    fn name(self) -> String {
        let Self {
            technique,
            mode,
            projection,
        } = self;
        [word(technique), word(mode), word(projection)].join(" ")
    }
}

fn word<T: ValueEnum>(word: T) -> String {
    let value = word.to_possible_value();
    value.map_or_else(String::new, |value| value.get_name().to_owned())
}

impl Probed {
    fn json(&self) -> Value {
        let of = |number: fn(&Ceilings) -> Option<f64>| self.ceilings.as_ref().and_then(number);
        json!({
            "volume": self.volume,
            "samples_per_second": of(|ceilings| ceilings.samples_per_second),
            "bytes_per_second": of(|ceilings| Some(ceilings.bytes_per_second)),
        })
    }
}

impl Row {
    fn samples_per_second(&self) -> Option<f64> {
        let ms = median_gpu(&self.frames).unwrap_or_else(|| median_wall(&self.frames));
        (ms > 0.0).then(|| 1e3 * self.samples as f64 / ms)
    }

    fn of_ceiling(&self) -> Option<f64> {
        Some(self.samples_per_second()? / self.ceiling?)
    }

    fn json(&self) -> Value {
        let Way {
            technique,
            mode,
            projection,
        } = self.way;
        json!({
            "name": self.way.name(),
            "volume": self.volume,
            "technique": word(technique),
            "mode": word(mode),
            "projection": word(projection),
            "frames": self.frames.len(),
            "gpu_ms": median_gpu(&self.frames),
            "wall_ms": median_wall(&self.frames),
            "samples": self.samples,
            "samples_per_second": self.samples_per_second(),
            "of_ceiling": self.of_ceiling(),
        })
    }
}

fn table(
    device: &str,
    [width, height]: [u32; 2],
    often: &str,
    probes: &[Probed],
    rows: &[Row],
) -> String {
    let mut text = format!("{device}\n{width}x{height}, median of {often}\n");
    let number = |number: Option<f64>, digits: usize| {
        number.map_or("-".to_owned(), |number| format!("{number:.digits$}"))
    };
    for probed in probes {
        let ceilings = probed.ceilings.as_ref();
        let samples = ceilings.and_then(|ceilings| ceilings.samples_per_second);
        let bytes = ceilings.map(|ceilings| ceilings.bytes_per_second);
        let _ = writeln!(
            text,
            "\n{}: at most {} Msamples/s trilinear; copies read and write {} GB/s\n{:<36} {:>9} {:>9} {:>10} {:>11} {:>10}",
            probed.volume,
            number(samples.map(|n| 1e-6 * n), 1),
            number(bytes.map(|n| 1e-9 * n), 1),
            "",
            "gpu ms",
            "wall ms",
            "Msamples",
            "Msamples/s",
            "of ceiling",
        );
        for row in rows.iter().filter(|row| row.volume == probed.volume) {
            let share = row.of_ceiling().map(|share| 100.0 * share);
            let _ = writeln!(
                text,
                "{:<36} {:>9} {:>9.3} {:>10.3} {:>11} {:>10}",
                row.way.name(),
                number(median_gpu(&row.frames), 3),
                median_wall(&row.frames),
                1e-6 * row.samples as f64,
                number(row.samples_per_second().map(|n| 1e-6 * n), 1),
                share.map_or("-".to_owned(), |share| format!("{share:.1} %")),
            );
        }
    }
    text
}
