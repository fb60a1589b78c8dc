//! `stratavox compare`: how far two pictures are apart.

use super::{
    Error,
    error::visible,
    flags::finite,
    output::{self, say},
    signals::Gate,
};
use crate::picture::{
    WriteOptions,
    compare::{Comparison, Image},
    read_image, write_picture,
};
use clap::Args;
use serde_json::json;
use std::path::{Path, PathBuf};

/// Measure how far two pictures are apart
#[derive(Args, Debug)]
#[command(after_help = "Example:\n  \
    stratavox render phantom:head -o a.png && stratavox compare a.png a.png --at-most 0")]
pub struct Compare {
    /// What was wanted: a .png, .exr, .hdr or .npy
    #[arg(value_name = "A")]
    wanted: PathBuf,
    /// What was found
    #[arg(value_name = "B")]
    found: PathBuf,
    /// As JSON
    #[arg(long)]
    json: bool,
    /// Write where they differ: black where they agree, white at the largest error
    #[arg(long, value_name = "OUT.png")]
    diff: Option<PathBuf>,
    /// Exit 1 where the largest error is over this
    #[arg(long, value_name = "X", value_parser = finite, allow_negative_numbers = true)]
    at_most: Option<f64>,
    /// Replace files that exist
    #[arg(long)]
    force: bool,
}

impl Compare {
    /// Reads, compares, prints.
    pub fn run(self, gate: &Gate) -> Result<(), Error> {
        let inputs = [self.wanted.clone(), self.found.clone()];
        output::check(self.diff.as_slice(), &inputs, self.force)?;
        let (wanted, found) = (read(&self.wanted)?, read(&self.found)?);
        let comparison = Comparison::of(&wanted, &found).map_err(|error| {
            let pair = format!("{} and {}", self.wanted.display(), self.found.display());
            Error::Differs(format!("cannot compare {pair}: {error}"))
        })?;
        if let Some(path) = &self.diff {
            let options = WriteOptions {
                force: self.force,
                ..WriteOptions::default()
            };
            gate.whole(|| write_picture(&comparison.picture(), path, options))?;
        }
        say(&if self.json {
            json(&comparison)
        } else {
            text(&comparison)
        })?;
        match self.at_most.map(|limit| comparison.at_most(limit)) {
            Some(Err(too_far)) => Err(Error::Differs(format!(
                "{} and {}: {too_far}",
                self.wanted.display(),
                self.found.display()
            ))),
            Some(Ok(())) | None => Ok(()),
        }
    }
}

fn read(path: &Path) -> Result<Image, Error> {
    Ok(read_image(path)?)
}

fn json(comparison: &Comparison) -> String {
    // JSON has no infinity: two equal pictures have no psnr.
    let number = |n: f64| n.is_finite().then_some(n);
    let value = json!({
        "max": number(comparison.max()),
        "rmse": number(comparison.rmse()),
        "psnr": number(comparison.psnr()),
        "ssim": comparison.ssim(),
        "flip": comparison.flip(),
        "worst_pixel": comparison.worst_pixel(),
        "differing": comparison.differing(),
        "pixels": comparison.pixels(),
        "nan_mismatches": comparison.nan_mismatches(),
    });
    format!("{value:#}\n")
}

fn text(comparison: &Comparison) -> String {
    let or_none = |number: Option<f64>| number.map_or("none".to_owned(), |n| n.to_string());
    let [x, y] = comparison.worst_pixel();
    visible_lines(&[
        ("max", format!("{} at ({x}, {y})", comparison.max())),
        ("rmse", comparison.rmse().to_string()),
        ("psnr", format!("{} dB", comparison.psnr())),
        ("ssim", or_none(comparison.ssim())),
        ("flip", or_none(comparison.flip())),
        (
            "differing",
            format!(
                "{} of {} pixels",
                comparison.differing(),
                comparison.pixels()
            ),
        ),
    ])
}

fn visible_lines(lines: &[(&str, String)]) -> String {
    lines
        .iter()
        .map(|(name, value)| format!("{name:<10} {}\n", visible(value)))
        .collect()
}
