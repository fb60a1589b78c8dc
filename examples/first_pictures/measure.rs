//! Draws one volume by the program and measures the pictures.

use serde_json::Value;
use std::{
    error::Error,
    path::{Path, PathBuf},
    process::Command,
};
use stratavox::picture::{
    compare::{Comparison, Image},
    read_image,
};

/// A pixel is visible where its alpha, of 0 to 1, is over this.
const VISIBLE_ALPHA: f32 = 8.0 / 255.0;

/// Size of the pictures that are compared with those of more samples.
const SMALL: &str = "512x384";

/// Samples per voxel that a picture is compared with; fewer where the driver ends its loops before.
const REFERENCE_SAMPLES: f64 = 16.0;

/// The built program, and where pictures go.
#[derive(Debug)]
pub struct Program {
    program: PathBuf,
    pictures: PathBuf,
}

/// What was measured of the picture of one volume.
#[derive(Debug)]
pub struct Measured {
    /// The volume as its page names it.
    pub input: String,
    /// Shares of the frame's width and height that the box of visible pixels takes.
    pub box_share: [f64; 2],
    /// Distance of that box's centre from the frame's, in shares of width and height.
    pub off_centre: [f64; 2],
    /// Share of pixels that are visible.
    pub covered: f64,
    /// Mean luminance of visible pixels: sRGB numbers from 0 to 1, weighted .2126 .7152 .0722.
    pub luminance: f64,
    /// Whether light is on.
    pub is_lit: bool,
    /// Samples per voxel.
    pub samples: f64,
    /// SSIM with a picture of `reference_samples` samples per voxel.
    pub ssim: f64,
    /// Samples per voxel of that picture.
    pub reference_samples: f64,
    /// Wall time of the frame.
    pub frame_ms: f64,
    /// Wall time of the frame without light, at one sample per voxel, from the same camera.
    pub plain_frame_ms: f64,
    /// From the start of the program to the written picture.
    pub total_ms: f64,
    /// Name and driver of the device.
    pub driver: String,
}

impl Program {
    pub fn new(program: &Path, pictures: &Path) -> Self {
        Self {
            program: program.to_owned(),
            pictures: pictures.to_owned(),
        }
    }

    /// Draws `input`, a path with `,variable=NAME` after it where it has several, or a phantom.
    pub fn measure(&self, input: &str) -> Result<Measured, Box<dyn Error>> {
        let path = input
            .split_once(",variable=")
            .map_or(input, |(path, _)| path);
        let input_of_page = page_name(input);
        let stem = input_of_page.replace(|c: char| !c.is_ascii_alphanumeric(), "-");
        let file = |what: &str| self.pictures.join(format!("{stem}-{what}"));
        let [scene, times] = [file("scene.json"), file("times.json")];
        let mut command = self.render(&file("dark.png"));
        command.arg(path).arg("--save-scene").arg(&scene);
        if let Some((_, variable)) = input.split_once(",variable=") {
            command.args(["--variable", variable]);
        }
        run(command.arg("--timings").arg(&times))?;
        let drawn = json(&times)?;
        let chosen = json(&scene)?;
        let of_scene = |picture: &Path, flags: &[&str]| {
            let mut command = self.render(picture);
            run(command
                .arg("--scene")
                .arg(&scene)
                .arg("--timings")
                .arg(&times)
                .args(flags))
        };

        let plain = file("plain.png");
        of_scene(
            &plain,
            &[
                "--shading=none",
                "--samples-per-voxel=1",
                "--background=none",
            ],
        )?;
        let plain_frame_ms = number(&json(&times)?["first_frame_ms"])?;
        let [small, reference] = [file("512.png"), file("reference.png")];
        let small_size = format!("--size={SMALL}");
        of_scene(&small, &[&small_size])?;
        let of_reference = |samples: f64| {
            of_scene(
                &reference,
                &[&small_size, &format!("--samples-per-voxel={samples}")],
            )
        };
        let reference_samples = match of_reference(REFERENCE_SAMPLES) {
            Ok(()) => REFERENCE_SAMPLES,
            Err(refused) => {
                let fewer = fewer_samples(&refused.to_string()).ok_or(refused)?;
                of_reference(fewer)?;
                fewer
            }
        };
        let ssim = Comparison::of(&read_image(&reference)?, &read_image(&small)?)?
            .ssim()
            .ok_or("no SSIM of these pictures")?;

        let (dark, mask) = (read_image(&file("dark.png"))?, read_image(&plain)?);
        let visible = Visible::of(&mask).ok_or("nothing is visible")?;
        let samples = &chosen["sampling"]["samples_per_voxel"];
        Ok(Measured {
            input: input_of_page,
            box_share: visible.box_share,
            off_centre: visible.off_centre,
            covered: visible.covered,
            luminance: luminance(&dark, &mask),
            is_lit: chosen["light"]["shading"] == "phong",
            samples: samples.as_f64().unwrap_or(1.0),
            ssim,
            reference_samples,
            frame_ms: number(&drawn["first_frame_ms"])?,
            plain_frame_ms,
            total_ms: number(&drawn["total_ms"])?,
            driver: drawn["driver"].as_str().unwrap_or_default().to_owned(),
        })
    }

    fn render(&self, picture: &Path) -> Command {
        let mut command = Command::new(&self.program);
        command.args(["render", "--force", "--progress=none", "-o"]);
        command.arg(picture);
        command
    }
}

/// The last two parts of the path, and the variable.
fn page_name(input: &str) -> String {
    let (path, variable) = input.split_once(",variable=").unwrap_or((input, ""));
    let parts: Vec<&str> = path.trim_end_matches('/').rsplitn(3, '/').take(2).collect();
    let path = parts.into_iter().rev().collect::<Vec<_>>().join("/");
    format!("{path} {variable}").trim_end().to_owned()
}

/// Where a picture is visible, in shares of the frame.
struct Visible {
    box_share: [f64; 2],
    off_centre: [f64; 2],
    covered: f64,
}

impl Visible {
    fn of(mask: &Image) -> Option<Self> {
        let size = [mask.width as usize, mask.height as usize];
        let mut low = size;
        let mut high = [0; 2];
        let mut count = 0;
        for (index, pixel) in mask.pixels.iter().enumerate() {
            if pixel[3] > VISIBLE_ALPHA {
                let at = [index % size[0], index / size[0]];
                for axis in 0..2 {
                    low[axis] = low[axis].min(at[axis]);
                    high[axis] = high[axis].max(at[axis] + 1);
                }
                count += 1;
            }
        }
        let side = |axis: usize| size[axis] as f64;
        (count > 0).then(|| Self {
            box_share: [0, 1].map(|a| (high[a] - low[a]) as f64 / side(a)),
            off_centre: [0, 1].map(|a| ((high[a] + low[a]) as f64 / 2.0 / side(a) - 0.5).abs()),
            covered: f64::from(count) / mask.pixels.len() as f64,
        })
    }
}

/// Mean luminance of the pixels of `picture` that are visible in `mask`.
fn luminance(picture: &Image, mask: &Image) -> f64 {
    let visible: Vec<f64> = picture
        .pixels
        .iter()
        .zip(&mask.pixels)
        .filter(|(_, mask)| mask[3] > VISIBLE_ALPHA)
        .map(|(p, _)| {
            let [r, g, b, _] = p.map(f64::from);
            0.2126 * r + 0.7152 * g + 0.0722 * b
        })
        .collect();
    visible.iter().sum::<f64>() / visible.len() as f64
}

/// The most whole samples per voxel after a refusal of [`REFERENCE_SAMPLES`], which names the samples of a ray that were
/// wanted and those that the driver takes.
fn fewer_samples(refusal: &str) -> Option<f64> {
    let count_after = |words: &str| {
        let (_, rest) = refusal.split_once(words)?;
        rest.split_whitespace().next()?.parse::<f64>().ok()
    };
    let (wanted, allowed) = (
        count_after("would take ")?,
        count_after("ends its loops after ")?,
    );
    let fewer = (REFERENCE_SAMPLES * allowed / wanted).floor();
    (fewer >= 1.0).then_some(fewer)
}

fn run(command: &mut Command) -> Result<(), Box<dyn Error>> {
    let output = command.output()?;
    if output.status.success() {
        return Ok(());
    }
    Err(String::from_utf8_lossy(&output.stderr).into())
}

fn json(path: &Path) -> Result<Value, Box<dyn Error>> {
    Ok(serde_json::from_slice(&std::fs::read(path)?)?)
}

fn number(value: &Value) -> Result<f64, Box<dyn Error>> {
    value.as_f64().ok_or_else(|| "a time is missing".into())
}
