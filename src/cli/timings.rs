//! What the work took: the file of `--timings`.

use serde::Serialize;
use std::time::Instant;

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
    /// Samples that the last picture took.
    pub samples: u64,
    /// The most memory that the process had.
    pub peak_rss_bytes: Option<u64>,
    /// Device memory.
    pub device_bytes: u64,
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
    1e3 * start.elapsed().as_secs_f64()
}

/// The middle of some times; the upper one of two. Zero of none.
pub fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times.get(times.len() / 2).copied().unwrap_or(0.0)
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
            "peak_rss_bytes",
            "device_bytes",
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
