//! `stratavox histogram`: how often each value occurs, as a figure or as numbers.

mod joint;
mod outlines;
mod single;

use super::{
    Error,
    error::visible,
    flags::{Classification, ClassificationFlags, InputFlags},
    load,
    output::{self, say_aside, write_whole},
    signals::Gate,
};
use crate::{
    annotate::unit,
    figure::{self, Anchor, Color, Figure, INK, Ticks},
    technique::Mode,
    transfer::TransferFunction,
    volume::{Format, Header, TimeComponent, Volume},
};
use clap::Args;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// Draw how often each value occurs, with the transfer function over it
#[derive(Args, Debug)]
#[command(after_help = "Examples:\n  \
    stratavox histogram phantom:head,n=64 -o head.svg\n  \
    stratavox histogram phantom:head,n=64 --joint -o joint.png\n  \
    stratavox histogram phantom:head,n=48 --joint --preset boundaries -o widgets.svg\n  \
    stratavox histogram phantom:storm,n=32 --variable temperature -o counts.json")]
pub struct HistogramVerb {
    #[command(flatten)]
    input: InputFlags,
    /// The figure: its ending says whether .png, .svg or .json
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// Values against gradient magnitudes: boundaries between materials are arches; the widgets of the function lie
    /// over them as lines
    #[arg(long)]
    joint: bool,
    /// As many bins of values at most
    #[arg(long, value_name = "N", default_value_t = 256, value_parser = clap::value_parser!(u32).range(1..=4096))]
    bins: u32,
    #[command(flatten)]
    classification: ClassificationFlags,
    /// Replace files that exist
    #[arg(long)]
    force: bool,
}

/// What is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Png,
    Svg,
    Json,
}

impl HistogramVerb {
    /// Counts and writes.
    pub fn run(mut self, gate: &Gate) -> Result<(), Error> {
        let kind = kind(&self.output)?;
        self.classification.inline_file()?;
        self.classification.check()?;
        let inputs: Vec<PathBuf> = self.input.file().map(Path::to_owned).into_iter().collect();
        output::check(std::slice::from_ref(&self.output), &inputs, self.force)?;
        let counted = Counted::read(&self.input)?;
        let function = match self
            .classification
            .classification(&counted.volume, Mode::Composite)?
        {
            Classification::Function(function) => function,
            Classification::RangeOfPicture => unreachable!("only integrals have no function yet"),
        };
        let bins = self.bins as usize;
        let (figure, json) = if self.joint {
            joint::of(&counted, &function, bins)
        } else {
            single::of(&counted, &function, bins)
        };
        let bytes = match kind {
            Kind::Png => figure::png(&figure),
            Kind::Svg => figure::svg(&figure).into_bytes(),
            Kind::Json => format!("{json}\n").into_bytes(),
        };
        write_whole(&self.output, &bytes, self.force, gate)
    }
}

fn kind(path: &Path) -> Result<Kind, Error> {
    let ending = path.extension().and_then(|ending| ending.to_str());
    match ending.map(str::to_ascii_lowercase).as_deref() {
        Some("png") => Ok(Kind::Png),
        Some("svg") => Ok(Kind::Svg),
        Some("json") => Ok(Kind::Json),
        _ => Err(Error::usage(
            format!("-o {}: the ending says no kind of figure", path.display()),
            "end the name in .png, .svg or .json",
        )),
    }
}

/// A volume and the words that a figure says of it.
struct Counted {
    volume: Volume,
    /// The file's name, and which of the volumes in it.
    name: String,
    /// What the values are.
    quantity: String,
    /// Of values, where it is known.
    unit: Option<String>,
    /// Of lengths, where it is known.
    length_unit: Option<&'static str>,
    header: Header,
    pick: TimeComponent,
}

impl Counted {
    fn read(input: &InputFlags) -> Result<Self, Error> {
        let limits = input.limits();
        let source = load::open(input, &limits)?;
        let header = source.header().clone();
        let (pick, note) = input.pick(&header)?;
        for note in header.notes.iter().chain(&note) {
            say_aside(note);
        }
        let volume = Volume::read(source.as_ref(), pick, header.whole(), &limits)?;
        let variable = header.variables.first().cloned();
        Ok(Self {
            name: name(input, &header, pick),
            quantity: variable.unwrap_or("value".to_owned()),
            unit: unit(&header),
            length_unit: length_unit(header.format),
            volume,
            header,
            pick,
        })
    }

    /// `value (HU)`.
    fn quantity_with_unit(&self) -> String {
        match &self.unit {
            Some(unit) => format!("{} ({unit})", self.quantity),
            None => self.quantity.clone(),
        }
    }

    fn voxel_count(&self) -> u64 {
        self.header.voxel_count()
    }

    /// What figures of all kinds say below their title.
    fn sentence(&self) -> String {
        let [x, y, z] = self.volume.dims;
        let no_data = match self.volume.no_data_count() {
            0 => String::new(),
            count => format!(", {count} without data"),
        };
        format!("{x} × {y} × {z} = {} voxels{no_data}", self.voxel_count())
    }

    /// What JSON of all kinds begins with.
    fn json(&self, key: &str) -> Value {
        json!({
            key: 1,
            "input": self.name,
            "quantity": self.quantity,
            "unit": self.unit,
            "time": self.pick.time,
            "component": self.pick.component,
            "dims": self.volume.dims,
            "voxels": self.voxel_count(),
            "no_data": self.volume.no_data_count(),
        })
    }
}

/// The unit of lengths in the world, where the format has one.
pub fn length_unit(format: Format) -> Option<&'static str> {
    match format {
        Format::Nifti1 | Format::Nifti2 | Format::Dicom | Format::MetaImage => Some("mm"),
        _ => None,
    }
}

fn name(input: &InputFlags, header: &Header, pick: TimeComponent) -> String {
    let file = input.file().and_then(Path::file_name);
    let file = file.map(|name| name.to_string_lossy().into_owned());
    let mut name = file.or(input.path.clone()).unwrap_or_default();
    if let (Some(variable), true) = (header.variables.first(), header.variables.len() > 1) {
        name = format!("{name}, {variable}");
    }
    if header.components > 1 {
        name = format!("{name}, component {}", pick.component);
    }
    if header.times > 1 {
        let time = header.time_names.get(pick.time as usize);
        let time = time.map_or(pick.time.to_string(), String::clone);
        name = format!("{name}, time {time}");
    }
    visible(&name)
}

/// Where the axes of a figure lie.
#[derive(Clone, Copy, Debug)]
struct Plot {
    left: f64,
    right: f64,
    top: f64,
    bottom: f64,
    /// Values at the left and right ends.
    range: [f64; 2],
}

/// Of names of axes.
const NAME_SIZE: f64 = 15.0;
/// Of numbers at ticks.
const TICK_SIZE: f64 = 13.0;

impl Plot {
    const SIZE: [f64; 2] = [960.0, 600.0];

    fn x(&self, value: f64) -> f64 {
        let [low, high] = self.range;
        self.left + (value - low) / (high - low) * (self.right - self.left)
    }

    /// The place of a fraction of the height, 0 at the foot.
    fn y(&self, fraction: f64) -> f64 {
        self.bottom + fraction * (self.top - self.bottom)
    }

    /// An empty figure with its title, and what is said below it.
    fn figure(counted: &Counted, kind: &str, sentences: &[String]) -> Figure {
        let mut figure = Figure::new(Self::SIZE, format!("{kind} of {}", counted.name));
        let title = figure.title.clone();
        figure.text([84.0, 32.0], shortened(&title, 80), 20.0, Anchor::Start);
        for (line, sentence) in sentences.iter().enumerate() {
            let y = 54.0 + 18.0 * line as f64;
            figure.faint([84.0, y], shortened(sentence, 120), 13.0, Anchor::Start);
        }
        figure
    }

    /// The axis of values: lines of the grid, numbers below `foot`, and what they are.
    fn value_axis(&self, figure: &mut Figure, counted: &Counted, foot: f64) {
        let ticks = Ticks::linear(self.range, 8);
        for (value, text) in &ticks.at {
            let x = self.x(*value);
            figure.line([x, foot], [x, foot + 5.0], INK, 1.0);
            figure.text([x, foot + 20.0], text, TICK_SIZE, Anchor::Middle);
        }
        let name = format!("{}{}", counted.quantity_with_unit(), ticks.suffix());
        let middle = 0.5 * (self.left + self.right);
        let place = [middle, foot + 44.0];
        figure.text(place, shortened(&name, 80), NAME_SIZE, Anchor::Middle);
    }

    fn value_grid(&self, figure: &mut Figure) {
        for (value, _) in Ticks::linear(self.range, 8).at {
            let x = self.x(value);
            figure.line([x, self.top], [x, self.bottom], figure::GRID, 1.0);
        }
    }

    fn frame(&self, figure: &mut Figure) {
        figure.frame([self.left, self.top], [self.right, self.bottom], INK);
    }
}

/// At most so many letters.
fn shortened(text: &str, most: usize) -> String {
    if text.chars().count() <= most {
        return text.to_owned();
    }
    let start: String = text.chars().take(most - 1).collect();
    format!("{start}…")
}

fn color([r, g, b]: [f64; 3]) -> Color {
    let [r, g, b] = [r, g, b].map(|c| (c.clamp(0.0, 1.0) * 255.0).round() as u8);
    [r, g, b, 255]
}

/// The function as JSON of its own kind.
fn function_json(function: &TransferFunction) -> Value {
    let text = crate::transfer::transfer_function_to_json(function);
    serde_json::from_str(&text).expect("what we have just written as JSON")
}
