//! What a person reads: lines of a name and what is known, in groups.

use super::{RenderBytes, Report, bars::bars, earth, place, structure};
use crate::{
    cli::{
        error::visible,
        flags::{InputFlags, Subject},
        histogram::length_unit,
        readable::{bytes, grouped},
    },
    figure::short,
    look::face,
    transfer::Choice,
    volume::{Grid, Header, Limits, Statistics},
};
use std::fmt::Write;

/// What there is to say.
pub struct Page<'a> {
    pub report: &'a Report,
    pub header: &'a Header,
    pub input: &'a InputFlags,
    pub statistics: &'a Statistics,
    pub choice: Option<Choice>,
}

/// Where a camera stands.
struct Side {
    /// Azimuth and elevation.
    degrees: [f64; 2],
    /// Small pictures may show that another side has more to tell.
    is_open: bool,
}

/// Of a list that may be long.
pub const MAX_LINES: usize = 40;

/// Lines, groups of them apart.
#[derive(Default)]
pub struct Lines(String);

impl Lines {
    /// What follows stands apart.
    pub fn group(&mut self) {
        if !self.0.is_empty() {
            self.0.push('\n');
        }
    }

    /// A line.
    pub fn say(&mut self, name: &str, value: impl AsRef<str>) {
        let line = format!("{name:<13}{}", visible(value.as_ref()));
        // Writing to a String cannot fail.
        let _ = writeln!(self.0, "{}", line.trim_end());
    }
}

impl Page<'_> {
    /// All of it.
    pub fn text(&self, limits: &Limits) -> String {
        let mut lines = Lines::default();
        self.what(&mut lines);
        lines.group();
        self.space(&mut lines);
        lines.group();
        self.values(&mut lines);
        lines.group();
        self.drawing(&mut lines);
        if self.header.variables.len() > 1 {
            lines.group();
            self.variables(&mut lines, limits);
        }
        if !self.header.derived.is_empty() {
            lines.group();
            earth::derived(&self.header.derived, &mut lines);
        }
        if !self.header.series.is_empty() {
            lines.group();
            self.series(&mut lines);
        }
        if let Some(structure) = &self.report.structure {
            structure::say(structure, &mut lines);
        }
        if !self.header.notes.is_empty() {
            lines.group();
            for note in &self.header.notes {
                lines.say("note", note);
            }
        }
        lines.0
    }

    fn what(&self, lines: &mut Lines) {
        let (report, header) = (self.report, self.header);
        lines.say("format", report.format);
        match header.variables.as_slice() {
            [] => {}
            [only] => lines.say("variable", only),
            [first, others @ ..] => lines.say(
                "variable",
                format!(
                    "{first}: all numbers here are its own; {} more below",
                    others.len()
                ),
            ),
        }
        if let Some(what) = &header.long_name {
            lines.say("", what);
        }
        let [x, y, z] = report.dims;
        let count = grouped(header.voxel_count());
        lines.say(
            "dims",
            format!("{x} x {y} x {z} = {count} voxels of {}", report.r#type),
        );
        if report.levels > 1 {
            let others = "each next with half as many voxels along each axis: --level N";
            lines.say("levels", format!("{}, {others}", report.levels));
        }
        if report.components > 1 {
            lines.say(
                "components",
                format!("{}, {}", report.components, self.meaning()),
            );
        }
        for (i, channel) in report.channels.iter().take(MAX_LINES).enumerate() {
            let window = channel
                .window
                .map(|[low, high]| format!(", {} to {}", short(low), short(high)));
            let name = format!("{i}: {}{}", channel.name, window.unwrap_or_default());
            lines.say("", name);
        }
        if report.times > 1 {
            let names = match (report.time_names.first(), report.time_names.last()) {
                (Some(first), Some(last)) => format!(", {first} to {last}"),
                _ => String::new(),
            };
            lines.say("times", format!("{}{names}", report.times));
        } else if let Some(time) = report.time_names.first() {
            lines.say("time", time);
        }
    }

    fn meaning(&self) -> &'static str {
        match self.report.meaning {
            "rgb" => "red, green and blue",
            "rgba" => "red, green, blue and opacity",
            "vector" => "coordinates of a vector",
            "channels" => "channels of the same place",
            _ => "numbers of which the file says nothing more",
        }
    }

    fn space(&self, lines: &mut Lines) {
        let (report, header) = (self.report, self.header);
        let grid = Grid {
            dims: header.dims,
            world_from_voxel: header.world_from_voxel,
        };
        let unit = length_unit(header.format).map_or(String::new(), |unit| format!(" {unit}"));
        let lengths = |lengths: [f64; 3]| lengths.map(short).join(" x ");
        let extent = std::array::from_fn(|k| report.spacing[k] * f64::from(report.dims[k]));
        lines.say("extent", format!("{}{unit}", lengths(extent)));
        lines.say("spacing", format!("{}{unit}", lengths(report.spacing)));
        lines.say("orientation", place::orientation(&grid, header.format));
        if let Some(shear) = place::shear(&grid) {
            lines.say("sheared", shear);
        }
        let rows = report.world_from_voxel;
        // What rounding left of a turn by right angles is no number to show.
        let largest = rows.iter().flat_map(|row| &row[..3]);
        let largest = largest.fold(0.0, |m: f64, n| m.max(n.abs()));
        let shown = |n: f64| if n.abs() < 1e-12 * largest { 0.0 } else { n };
        let row = |k: usize| {
            rows[k]
                .map(|number| format!("{:>12}", short(shown(number))))
                .concat()
        };
        lines.say("world", format!("{}   from voxel centres", row(0)));
        lines.say("", row(1));
        lines.say("", row(2));
        if let Some(map) = &header.map {
            earth::map(map, lines);
        }
    }

    fn values(&self, lines: &mut Lines) {
        let report = self.report;
        let unit = report
            .unit
            .as_ref()
            .map_or(String::new(), |unit| format!(" {unit}"));
        match (report.min, report.max, report.mean) {
            (Some(min), Some(max), Some(mean)) => {
                let range = format!(
                    "{} to {}{unit}, mean {}",
                    short(min),
                    short(max),
                    short(mean)
                );
                lines.say("values", range);
                lines.say("", bars(&self.statistics.histogram.counts));
            }
            _ => lines.say("values", "none"),
        }
        if report.non_finite > 0 {
            lines.say(
                "not finite",
                format!("{} voxels", grouped(report.non_finite)),
            );
        }
        if report.fill_count > 0 {
            lines.say("no data", format!("{} voxels", grouped(report.fill_count)));
        }
        if self.header.is_labels {
            lines.say("labels", "values are names of things");
        }
    }

    fn drawing(&self, lines: &mut Lines) {
        if let Some(Choice { kind, colormap, .. }) = self.choice {
            let colors = colormap.map(|map| format!(", in the colours of {}", map.name()));
            let sentence = kind.sentence();
            lines.say(
                "drawn as",
                format!("{sentence}{}", colors.unwrap_or_default()),
            );
        }
        let Side { degrees, is_open } = self.side();
        let [azimuth, elevation] = degrees;
        // Only pictures show which of them it is.
        let others = match is_open {
            true => ", or another of six sides that shows more",
            false => "",
        };
        let degrees = format!("azimuth {azimuth}, elevation {elevation} degrees{others}");
        lines.say("seen from", degrees);
        let RenderBytes { host, device } = self.report.render_bytes.volume;
        let on_cpu = match self.report.software_device_bytes {
            same if same == device => String::new(),
            other => format!(", {} by rays on llvmpipe", bytes(other)),
        };
        let (host, device) = (bytes(host), bytes(device));
        lines.say(
            "to draw",
            format!("{host} of memory, {device} of the device's{on_cpu}"),
        );
    }

    /// Where the camera stands without a flag.
    fn side(&self) -> Side {
        let header = self.header;
        let grid = Grid {
            dims: header.dims,
            world_from_voxel: header.world_from_voxel,
        };
        let has_named_axes = header.is_patient || header.is_earth;
        // Pieces of the Earth are thin, and seen from the south.
        let face = face(&grid, has_named_axes).filter(|_| !header.is_earth);
        let side = match face {
            Some(view) => view.orbit(),
            None => Subject::new(&grid, header.is_earth).side(),
        };
        Side {
            degrees: [side.azimuth_degrees, side.elevation_degrees],
            is_open: face.is_none() && !has_named_axes,
        }
    }

    fn series(&self, lines: &mut Lines) {
        for (i, series) in self.header.series.iter().take(MAX_LINES).enumerate() {
            let title = if i == 0 { "series" } else { "" };
            let pictures = format!("{:>5} pictures", series.pictures);
            lines.say(
                title,
                format!("{pictures}  {}  {}", series.uid, series.description),
            );
        }
        self.rest(lines, self.header.series.len());
        if self.header.series.len() > 1 {
            lines.say(
                "",
                "--series UID takes one; all numbers here are those of the first",
            );
        }
    }

    pub fn rest(&self, lines: &mut Lines, count: usize) {
        if count > MAX_LINES {
            lines.say("", format!("and {} more", count - MAX_LINES));
        }
    }
}
