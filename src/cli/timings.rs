//! What the work took: the file of `--timings`.

use crate::offscreen::Renderer;
use crate::resident::{MadeBy, RunsSize};
use crate::technique::shear_warp::base_plane;
use crate::technique::splat::Sheets;
use crate::technique::{Technique, View};
use crate::volume::{Header, Limits, Piece, ReadError, Source, TimeComponent, Volume, VoxelBox};
use serde::Serialize;
use std::path::Path;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Times in milliseconds, sizes in bytes.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Timings {
    /// The device's name.
    pub device: String,
    /// Its driver and the driver's version.
    pub driver: String,
    /// From the words to a volume in memory.
    pub load_ms: f64,
    /// From memory to the device.
    pub upload_ms: f64,
    /// Device, pipelines, tables.
    pub prepare_ms: f64,
    /// From the end of all preparation to the first picture in memory.
    pub first_frame_ms: f64,
    /// Each picture, in order.
    pub frames: Vec<FrameTime>,
    /// Samples that the last picture took; paths of --technique pathtrace.
    pub samples: u64,
    /// Paths a second that were traced for the last picture; `null` for other techniques.
    pub samples_per_s: Option<f64>,
    /// Tentative collisions of a path and its shadow rays, of two more paths a pixel; `null` for other techniques.
    pub collisions_per_sample: Option<f64>,
    /// The most memory that the process had.
    pub peak_rss_bytes: Option<u64>,
    /// Device memory.
    pub device_bytes: u64,
    /// The same work in finer parts.
    #[serde(flatten)]
    pub stages: Stages,
}

/// Parts of the work, in milliseconds, and of the device's work.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Stages {
    /// Of `load_ms`: bytes from files, decoded.
    pub read_ms: f64,
    /// Of `load_ms`: voxels without data, and the range of the others.
    pub statistics_ms: f64,
    /// Of `prepare_ms`: finding drivers and making the device.
    pub device_ms: f64,
    /// Of `prepare_ms`: making pipelines.
    pub pipelines_ms: f64,
    /// Of `prepare_ms`: finding out what rays need not look at.
    pub empty_space_ms: f64,
    /// The picture to a file; `null` where none is written.
    pub encode_ms: Option<f64>,
    /// Since the program began.
    pub total_ms: f64,
    /// In how many parts the device was given its work.
    pub submissions: u64,
    /// What the longest of them took.
    pub longest_submission_ms: f64,
    /// What made values between voxels: `sampler`, `fetch`, or `corners`, which are fetches from words that software
    /// devices have; `null` on the CPU references.
    pub filtered_by: Option<&'static str>,
    /// Why that.
    pub filtered_because: Option<&'static str>,
    /// The intermediate image of the last picture by shear-warp; `null` for other techniques.
    pub intermediate: Option<IntermediateImage>,
    /// The runs of classified voxels that the last picture read, on the device; `null` for other pictures.
    pub runs: Option<RunsHeld>,
    /// The splats of the last picture; `null` for other techniques.
    pub splat: Option<SplatSize>,
}

/// Where base rays of shear-warp begin.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct IntermediateImage {
    /// Across and down, in base pixels.
    pub extent_base_pixels: [u32; 2],
    /// Base pixels per voxel.
    pub per_voxel: f64,
}

/// Classified voxels as runs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct RunsHeld {
    /// Voxels whose optical depth is over 0.
    pub full: u64,
    /// Longest sequences of them in rows along x.
    pub runs: u64,
    /// Bytes of all of it.
    pub bytes: u64,
    /// `device` or `host`.
    pub made_by: &'static str,
}

impl RunsHeld {
    /// Those that the last picture of a renderer read.
    pub fn of(renderer: &Renderer) -> Option<Self> {
        let RunsSize { full, runs, bytes } = renderer.runs()?;
        let made_by = match renderer.runs_made_by()? {
            MadeBy::Host => "host",
            MadeBy::Device => "device",
        };
        Some(Self {
            full,
            runs,
            bytes,
            made_by,
        })
    }
}

/// How large splats of a volume are.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SplatSize {
    /// Standard deviation, in voxels.
    pub std_voxels: f64,
    /// No splat is thinner than so many pixels.
    pub low_pass_pixels: f64,
    /// Into how many image-aligned sheets a slice of splats reaches at most; `null` where there are none.
    pub open_sheets: Option<f64>,
}

impl Stages {
    /// With what a technique makes of this view.
    pub fn with_view(self, view: &View) -> Self {
        let technique = view.settings.technique;
        let base = match technique {
            Technique::ShearWarp => base_plane(view).ok(),
            _ => None,
        };
        let splat = view.settings.splat;
        let is_volume = technique == Technique::Splat && !splat.of_points;
        let has_sheets = splat.sheets == Sheets::Image;
        Self {
            intermediate: base.map(|base| IntermediateImage {
                extent_base_pixels: base.extent,
                per_voxel: base.per_voxel,
            }),
            splat: is_volume.then(|| SplatSize {
                std_voxels: splat.std,
                low_pass_pixels: splat.low_pass,
                open_sheets: has_sheets.then(|| view.open_sheets().ceil()),
            }),
            ..self
        }
    }
}

/// What reading a volume took.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Loaded {
    /// Bytes from files, decoded.
    pub read: Duration,
    /// All else that makes a volume of them.
    pub statistics: Duration,
}

impl Loaded {
    /// Both together.
    pub fn and(self, more: Self) -> Self {
        Self {
            read: self.read + more.read,
            statistics: self.statistics + more.statistics,
        }
    }

    /// One time and component of a source, and what reading it took.
    pub fn volume(
        source: &dyn Source,
        pick: TimeComponent,
        limits: &Limits,
    ) -> Result<(Volume, Self), ReadError> {
        let start = Instant::now();
        let clocked = Clocked {
            source,
            read: Mutex::default(),
        };
        let volume = Volume::read(&clocked, pick, source.header().whole(), limits)?;
        let read = *clocked.read.lock().unwrap_or_else(PoisonError::into_inner);
        let statistics = start.elapsed().saturating_sub(read);
        Ok((volume, Self { read, statistics }))
    }
}

/// A source under a clock.
struct Clocked<'a> {
    source: &'a dyn Source,
    read: Mutex<Duration>,
}

impl Source for Clocked<'_> {
    fn path(&self) -> &Path {
        self.source.path()
    }

    fn header(&self) -> &Header {
        self.source.header()
    }

    fn read(&self, pick: TimeComponent, region: VoxelBox) -> Result<Piece, ReadError> {
        let start = Instant::now();
        let piece = self.source.read(pick, region);
        *self.read.lock().unwrap_or_else(PoisonError::into_inner) += start.elapsed();
        piece
    }
}

/// Milliseconds of a duration.
pub fn in_ms(duration: Duration) -> f64 {
    1e3 * duration.as_secs_f64()
}

/// One picture.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct FrameTime {
    /// By the device's own clock; `null` where it has none.
    pub gpu_ms: Option<f64>,
    /// Until the picture was in memory.
    pub wall_ms: f64,
}

impl Timings {
    /// As the file has it.
    pub fn json(&self) -> String {
        let mut text = serde_json::to_string_pretty(self).expect("numbers as JSON");
        text.push('\n');
        text
    }
}

/// Milliseconds since `start`.
pub fn ms_since(start: Instant) -> f64 {
    in_ms(start.elapsed())
}

/// The middle of some times, half way between the two in the middle. Zero of none.
pub fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    let upper = times.get(times.len() / 2).copied().unwrap_or(0.0);
    match times.len() {
        0 => 0.0,
        count => 0.5 * (times[(count - 1) / 2] + upper),
    }
}

/// The most memory that this process had, where the system tells (Linux: `VmHWM`).
pub fn peak_rss_bytes() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status
        .lines()
        .find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kib: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kib * 1024)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_of_two_lies_between_them() {
        assert_eq!(median(vec![]), 0.0);
        assert_eq!(median(vec![3.0]), 3.0);
        assert_eq!(median(vec![4.0, 1.0]), 2.5);
        assert_eq!(median(vec![9.0, 1.0, 2.0]), 2.0);
    }

    #[test]
    fn the_file_has_the_keys_that_were_promised() {
        let timings = Timings {
            frames: vec![FrameTime {
                gpu_ms: None,
                wall_ms: 1.5,
            }],
            ..Timings::default()
        };
        let value: serde_json::Value = serde_json::from_str(&timings.json()).expect("JSON");
        for key in [
            "device",
            "driver",
            "load_ms",
            "upload_ms",
            "prepare_ms",
            "first_frame_ms",
            "frames",
            "samples",
            "samples_per_s",
            "collisions_per_sample",
            "peak_rss_bytes",
            "device_bytes",
            "read_ms",
            "statistics_ms",
            "device_ms",
            "pipelines_ms",
            "empty_space_ms",
            "encode_ms",
            "total_ms",
            "submissions",
            "longest_submission_ms",
            "filtered_by",
            "filtered_because",
            "intermediate",
            "runs",
            "splat",
        ] {
            assert!(value.get(key).is_some(), "no {key} in {value}");
        }
        assert_eq!(value["frames"][0]["wall_ms"], 1.5);
        assert!(value["frames"][0]["gpu_ms"].is_null());
    }

    #[test]
    fn the_median_is_the_time_in_the_middle() {
        assert_eq!(median(vec![9.0, 1.0, 5.0]), 5.0);
        assert_eq!(median(vec![]), 0.0);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn the_peak_of_memory_is_known_on_linux() {
        let peak = peak_rss_bytes().expect("a number");
        assert!(peak > 1 << 20, "{peak}");
    }
}
