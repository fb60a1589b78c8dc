//! ImageJ's hyperstacks: lines `name=value` in the description of the first page.
//!
//! As ij.io.FileSaver writes and ij.io.TiffDecoder reads them: pages run through channels, then slices, then
//! frames; `spacing` is written where it is not 1; resolution counts pixels per `unit`. Of a stack that does not
//! fit 32-bit offsets only the first page has a directory, and the others follow it without gaps.

use super::length::{Spacing, unit};
use crate::format::problem::escape;

/// What the description says.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Hyperstack {
    /// Pages, where it says so.
    pub images: Option<u32>,
    pub channels: u32,
    pub slices: u32,
    pub frames: u32,
    pub spacing: Spacing,
    /// The moment of each frame, where there are several.
    pub time_names: Vec<String>,
    pub notes: Vec<String>,
}

/// True for the description of a file that ImageJ, or one who writes like it, has written.
pub(super) fn is_imagej(description: &str) -> bool {
    description.starts_with("ImageJ=")
}

impl Hyperstack {
    /// `resolution` is in pixels per unit; `pages` is how many directories the file has.
    pub(super) fn read(description: &str, resolution: [Option<f64>; 2], pages: u32) -> Self {
        let value = |name: &str| {
            description
                .lines()
                .filter_map(|line| line.split_once('='))
                .find(|(key, _)| key.trim() == name)
                .map(|(_, value)| value.trim())
        };
        let count = |name: &str| {
            let number = value(name)?.parse::<u32>().ok();
            number.filter(|&n| n > 0)
        };
        let number = |name: &str| {
            let number = value(name)?.parse::<f64>().ok()?;
            Some(number.abs()).filter(|number| number.is_finite() && *number > 0.0)
        };
        let images = count("images");
        let total = images.unwrap_or(1).max(pages);
        let (channels, frames) = (count("channels").unwrap_or(1), count("frames").unwrap_or(1));
        let one_of_each = channels.checked_mul(frames);
        let slices = count("slices").or_else(|| total.checked_div(one_of_each?));
        let product = slices.and_then(|slices| slices.checked_mul(one_of_each?));
        let mut stack = Self {
            images,
            channels,
            slices: slices.unwrap_or(1),
            frames,
            ..Self::default()
        };
        if product != Some(total) {
            stack.notes.push(format!(
                "the description speaks of {channels} channels, {} slices and {frames} frames, but there are {total} pages: all are taken as slices",
                stack.slices
            ));
            (stack.channels, stack.slices, stack.frames) = (1, total, 1);
        }
        stack.read_spacing(value("unit"), number("spacing"), resolution);
        if let Some(interval) = number("finterval").filter(|_| stack.frames > 1) {
            stack.time_names = (0..stack.frames)
                .map(|frame| seconds(f64::from(frame), interval))
                .collect();
        }
        stack
    }

    fn read_spacing(
        &mut self,
        word: Option<&str>,
        spacing: Option<f64>,
        resolution: [Option<f64>; 2],
    ) {
        let word = word.map(unescaped).unwrap_or_default();
        if word.is_empty() || matches!(word.as_str(), "pixel" | "pixels") {
            self.spacing.steps = [Some(1.0), Some(1.0), Some(spacing.unwrap_or(1.0))];
            if spacing.is_none() {
                self.spacing.steps = [None; 3];
            } else {
                self.notes.push("lengths are in pixels".to_owned());
            }
            return;
        }
        match unit(&word) {
            Some((_, word)) => self.spacing.unit = Some(word),
            None => self
                .notes
                .push(format!("lengths are in `{}`", escape(&word))),
        }
        let step = |per_unit: Option<f64>| per_unit.map(f64::recip);
        let [x, y] = resolution.map(step);
        // An absent spacing is how ImageJ writes 1.
        self.spacing.steps = [x.or(Some(1.0)), y.or(Some(1.0)), spacing.or(Some(1.0))];
    }
}

#[allow(clippy::arithmetic_side_effects, reason = "floats")]
fn seconds(frame: f64, interval: f64) -> String {
    format!("{} s", frame * interval)
}

/// Java writes what is not ASCII as `\u00B5`.
fn unescaped(text: &str) -> String {
    let mut rest = text;
    let mut plain = String::new();
    while let Some((before, code)) = rest.split_once("\\u") {
        plain.push_str(before);
        let digits = code.get(..4).unwrap_or("");
        match u32::from_str_radix(digits, 16)
            .ok()
            .and_then(char::from_u32)
        {
            Some(c) => {
                plain.push(c);
                rest = code.get(4..).unwrap_or("");
            }
            None => {
                plain.push_str("\\u");
                rest = code;
            }
        }
    }
    plain + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pages_that_are_not_told_of_are_slices() {
        let stack = Hyperstack::read("ImageJ=1.53f\nimages=41\nchannels=1\n", [None; 2], 41);
        assert_eq!((stack.channels, stack.slices, stack.frames), (1, 41, 1));
        assert!(stack.notes.is_empty(), "{:?}", stack.notes);
        let lie = "ImageJ=1\nimages=12\nchannels=2\nslices=3\nframes=9\n";
        let stack = Hyperstack::read(lie, [None; 2], 12);
        assert_eq!((stack.channels, stack.slices, stack.frames), (1, 12, 1));
        assert_eq!(stack.notes.len(), 1, "{:?}", stack.notes);
    }

    #[test]
    fn micrometres_are_known_in_every_spelling() {
        for word in ["micron", "\\u00B5m", "um", "\u{b5}m", "\u{3bc}m"] {
            let text = format!("ImageJ=1\nslices=2\nunit={word}\nspacing=-0.5\n");
            let stack = Hyperstack::read(&text, [Some(4.0), Some(8.0)], 2);
            assert_eq!(stack.spacing.unit, Some("um"), "{word}");
            let steps = [Some(0.25), Some(0.125), Some(0.5)];
            assert_eq!(stack.spacing.steps, steps, "{word}");
        }
    }
}
