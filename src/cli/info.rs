//! `stratavox info`: what a volume is, before anything is drawn.

use super::{
    Error,
    error::visible,
    flags::InputFlags,
    memory::RenderBytes,
    output::{say, say_aside},
};
use crate::volume::{Grid, Header, Statistics};
use clap::Args;
use glam::DVec3;
use serde::Serialize;
use std::fmt::Write;

/// Say what a volume holds
#[derive(Args, Debug)]
#[command(after_help = "Example:\n  stratavox info phantom:head --json")]
pub struct Info {
    #[command(flatten)]
    input: InputFlags,
    /// As JSON
    #[arg(long)]
    json: bool,
}

/// The JSON, key by key; lengths in world units, values after rescale.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct Report {
    format: &'static str,
    dims: [u32; 3],
    components: u32,
    times: u32,
    r#type: &'static str,
    spacing: [f64; 3],
    /// Row-major, of voxel centres as index space.
    world_from_voxel: [[f64; 4]; 4],
    /// Over finite voxels that are not the fill, of all times; `null` where there are none.
    min: Option<f64>,
    max: Option<f64>,
    mean: Option<f64>,
    non_finite: u64,
    fill_count: u64,
    variables: Vec<String>,
    render_bytes: RenderBytes,
}

impl Info {
    /// Reads all of the input and prints what it is like.
    pub fn run(self) -> Result<(), Error> {
        let limits = self.input.limits();
        let source = self.input.open_as_stored(&limits)?;
        let header = source.header();
        self.input.time(header)?;
        if self.input.time.is_some() {
            say_aside("--time has no effect on info, its numbers are those of all times");
        }
        let components = self.input.components(header)?;
        let statistics = Statistics::of(source.as_ref(), components, &limits)?;
        let mut report = report(header, &statistics);
        if header.is_earth {
            // Uneven levels are drawn from even ones, of which there are more.
            let drawn = self.input.open(&limits)?;
            let is_other = drawn.header().dims != header.dims;
            report.render_bytes =
                RenderBytes::of(drawn.header(), is_other || has_holes(&statistics));
        }
        if self.json {
            for note in &header.notes {
                say_aside(note);
            }
            let json = serde_json::to_string_pretty(&report).expect("numbers as JSON");
            say(&format!("{json}\n"))
        } else {
            say(&text(&report, &header.notes))
        }
    }
}

fn report(header: &Header, statistics: &Statistics) -> Report {
    let grid = Grid {
        dims: header.dims,
        world_from_voxel: header.world_from_voxel,
    };
    let known = |number: f64| number.is_finite().then_some(number);
    Report {
        format: header.format.name(),
        dims: header.dims,
        components: header.components,
        times: header.times,
        r#type: header.stored.name(),
        spacing: grid.spacing(),
        world_from_voxel: world_from_centers(header),
        min: known(statistics.min),
        max: known(statistics.max),
        mean: known(statistics.mean),
        non_finite: statistics.non_finite_count,
        fill_count: statistics.fill_count,
        variables: header.variables.clone(),
        render_bytes: RenderBytes::of(header, has_holes(statistics)),
    }
}

/// The affine of index space: index (0, 0, 0) is the centre of the first voxel.
fn world_from_centers(header: &Header) -> [[f64; 4]; 4] {
    let m = header.world_from_voxel.matrix3;
    let origin = header.world_from_voxel.transform_point3(DVec3::splat(0.5));
    // A sum with zero has no negative zero.
    let row = |k: usize| [m.x_axis[k], m.y_axis[k], m.z_axis[k], origin[k]].map(|n| n + 0.0);
    [row(0), row(1), row(2), [0.0, 0.0, 0.0, 1.0]]
}

fn has_holes(statistics: &Statistics) -> bool {
    statistics.non_finite_count + statistics.fill_count > 0
}

fn text(report: &Report, notes: &[String]) -> String {
    let join = |numbers: &[f64]| {
        let words: Vec<_> = numbers.iter().map(f64::to_string).collect();
        words.join(" ")
    };
    let or_none = |number: Option<f64>| number.map_or("none".to_owned(), |n| n.to_string());
    let [x, y, z] = report.dims;
    let mut text = String::new();
    let mut line = |name: &str, value: String| {
        let _ = writeln!(text, "{name:<12} {}", visible(&value));
    };
    line("format", report.format.to_owned());
    line("dims", format!("{x} x {y} x {z}"));
    line("type", report.r#type.to_owned());
    if report.components > 1 {
        line("components", report.components.to_string());
    }
    if report.times > 1 {
        line("times", report.times.to_string());
    }
    line("spacing", join(&report.spacing));
    line(
        "world",
        format!(
            "{}    (from voxel centres, RAS+)",
            join(&report.world_from_voxel[0])
        ),
    );
    line("", join(&report.world_from_voxel[1]));
    line("", join(&report.world_from_voxel[2]));
    line(
        "values",
        format!(
            "{} to {}, mean {}",
            or_none(report.min),
            or_none(report.max),
            or_none(report.mean)
        ),
    );
    if report.non_finite > 0 {
        line("not finite", format!("{} voxels", report.non_finite));
    }
    if report.fill_count > 0 {
        line("no data", format!("{} voxels", report.fill_count));
    }
    if !report.variables.is_empty() {
        line("variables", report.variables.join(" "));
    }
    let RenderBytes { host, device } = report.render_bytes;
    line(
        "to draw",
        format!("{host} bytes of memory, {device} of the device's"),
    );
    for note in notes {
        line("note", note.clone());
    }
    text
}
