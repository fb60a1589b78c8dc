//! `stratavox preset`: the transfer functions that have a name, and those of other programs.

use super::{
    Error,
    error::visible,
    flags::{InputFlags, Numbers, boundaries_of, preset, summary, with_causes},
    output::{self, say, say_aside, write_whole},
    signals::Gate,
};
use crate::{
    figure::short,
    transfer::{
        Classified, Colormap, GradientTransfer, Preset, Scale, Shape, TransferFunction,
        ValueSummary, Window, import_transfer_function, transfer_function_to_json,
    },
    volume::Volume,
};
use clap::{Args, Subcommand};
use std::{fmt::Write, path::PathBuf};

/// List, show and import transfer functions
#[derive(Args, Debug)]
#[command(arg_required_else_help = true)]
#[command(after_help = "Examples:\n  \
    stratavox preset list\n  \
    stratavox preset show ct-bone\n  \
    stratavox preset import colours.json -o tf.json")]
pub struct PresetVerb {
    #[command(subcommand)]
    what: What,
}

#[derive(Debug, Subcommand)]
enum What {
    List(List),
    Show(Show),
    Import(Import),
}

/// Name all presets, and all colour maps
#[derive(Args, Debug)]
#[command(after_help = "Example:\n  stratavox preset list")]
struct List {
    /// As JSON
    #[arg(long)]
    json: bool,
}

/// Print the points of a preset, as they are for a volume if one is given
#[derive(Args, Debug)]
#[command(after_help = "Examples:\n  \
    stratavox preset show ct-bone\n  \
    stratavox preset show mri phantom:head,n=32 --json")]
struct Show {
    /// One of `stratavox preset list`
    #[arg(value_parser = preset)]
    name: String,
    #[command(flatten)]
    input: InputFlags,
    /// The values that the preset is spread over
    #[arg(long, value_name = "LO,HI", allow_hyphen_values = true)]
    window: Option<Numbers<2>>,
    /// As a transfer function file
    #[arg(long)]
    json: bool,
}

/// Turn a transfer function of another program into one of ours: 3D Slicer (.vp, JSON, presets.xml), ParaView
/// (JSON, XML), Inviwo (.itf), Voreen (.tfi), VAPOR (.tf3), or rows `x r g b`, `x a`, `x r g b a`
#[derive(Args, Debug)]
#[command(after_help = "Examples:\n  \
    stratavox preset import colours.json -o tf.json\n  \
    stratavox preset import presets.xml --name CT-Bone --window 100,1500")]
struct Import {
    /// The file; what stands in it tells what it is
    file: PathBuf,
    /// The transfer function file to write [default: the standard output]
    #[arg(short, long, value_name = "OUT.json")]
    output: Option<PathBuf>,
    /// One of several functions in the file
    #[arg(long, value_name = "NAME")]
    name: Option<String>,
    /// The values that the function is spread over
    #[arg(long, value_name = "LO,HI", allow_hyphen_values = true)]
    window: Option<Numbers<2>>,
    /// Replace files that exist
    #[arg(long)]
    force: bool,
}

impl PresetVerb {
    /// Prints or writes.
    pub fn run(self, gate: &Gate) -> Result<(), Error> {
        match self.what {
            What::List(list) => list.run(),
            What::Show(show) => show.run(),
            What::Import(import) => import.run(gate),
        }
    }
}

impl List {
    fn run(self) -> Result<(), Error> {
        if self.json {
            let presets = Preset::ALL.map(|preset| {
                serde_json::json!({
                    "name": preset.name(),
                    "description": preset.description(),
                    "fits_the_volume": preset.fits_the_volume(),
                })
            });
            return say(&format!(
                "{:#}\n",
                serde_json::Value::from(presets.to_vec())
            ));
        }
        let line = |preset: Preset| format!("{:<16} {}\n", preset.name(), preset.description());
        let maps = Colormap::all().map(|map| format!("{:<16} {}\n", map.name(), map.description()));
        let maps: String = maps.collect();
        say(&format!(
            "{}\nColour maps, for --colormap:\n{maps}",
            Preset::ALL.map(line).concat()
        ))
    }
}

impl Show {
    fn run(self) -> Result<(), Error> {
        let preset = Preset::from_name(&self.name).expect("a name that was checked");
        let mut window = window(self.window)?;
        let volume = match self.input.path {
            Some(_) => Some(self.volume()?),
            None => None,
        };
        let summary = volume.as_ref().map_or_else(nothing_known, summary);
        let is_fractions =
            self.input.path.is_none() && window.is_none() && preset.fits_the_volume();
        if is_fractions {
            window = Window::new(0.0, 1.0);
        }
        let of_gradients = volume.as_ref().filter(|_| preset == Preset::Boundaries);
        let of_gradients = of_gradients.and_then(boundaries_of);
        let function = match (of_gradients, window) {
            (Some(function), Some(window)) => function.spread_over(window),
            (Some(function), None) => function,
            (None, _) => preset.function(&summary, Classified::Samples, window),
        };
        if is_fractions {
            say_aside(
                "the preset fits itself to a volume: these are fractions of where it will lie",
            );
        }
        let per = match function.reference_length {
            Some(length) => format!("a length of {}", short(length)),
            None if preset == Preset::Grey => "the smallest voxel spacing".to_owned(),
            None => "1/512 of the diagonal of the grid".to_owned(),
        };
        if self.json {
            if function.reference_length.is_none() && preset != Preset::Grey {
                say_aside(&format!(
                    "opacities are for {per}: name a volume, and the length is written"
                ));
            }
            return say(&transfer_function_to_json(&function));
        }
        say(&format!(
            "{}: {}\nopacity is for {per}\n{}",
            preset.name(),
            preset.description(),
            table(&function)
        ))
    }

    fn volume(&self) -> Result<Volume, Error> {
        let limits = self.input.limits();
        let source = self.input.open(&limits)?;
        let (pick, note) = self.input.pick(source.header())?;
        for note in source.header().notes.iter().chain(&note) {
            say_aside(note);
        }
        let whole = source.header().whole();
        Ok(Volume::read(source.as_ref(), pick, whole, &limits)?)
    }
}

impl Import {
    fn run(self, gate: &Gate) -> Result<(), Error> {
        let window = window(self.window)?;
        let inputs = std::slice::from_ref(&self.file);
        output::check(self.output.as_slice(), inputs, self.force)?;
        let found = import_transfer_function(&self.file, self.name.as_deref());
        let found = found.map_err(|error| Error::Input {
            path: self.file.clone(),
            problem: with_causes(&error.problem),
        })?;
        let name = found
            .name
            .map_or(String::new(), |name| format!(", {name:?}"));
        say_aside(&format!(
            "{} is {}{name}",
            self.file.display(),
            found.origin
        ));
        for piece in &found.left_out {
            say_aside(&format!("not taken over: {piece}"));
        }
        let function = match (window, found.scale) {
            (Some(window), Scale::Fractions) => found.function.of_fractions(window),
            (Some(window), Scale::Values) => found.function.spread_over(window),
            (None, Scale::Values) => found.function,
            (None, Scale::Fractions) => {
                say_aside(
                    "its points stand at fractions, 0 to 1; --window LO,HI brings them to values",
                );
                found.function
            }
        };
        let text = transfer_function_to_json(&function);
        match &self.output {
            Some(path) => write_whole(path, text.as_bytes(), self.force, gate),
            None => say(&text),
        }
    }
}

fn window(words: Option<Numbers<2>>) -> Result<Option<Window>, Error> {
    let Some(Numbers([low, high])) = words else {
        return Ok(None);
    };
    let window = Window::new(low, high).ok_or_else(|| {
        Error::usage(
            format!("--window {low},{high}: wanted a low value and a higher one"),
            "--window -200,300",
        )
    })?;
    Ok(Some(window))
}

/// Values of no volume in particular: the lengths of one are not known either.
fn nothing_known() -> ValueSummary {
    ValueSummary::of(2, [0.0, 1.0], 0.0, false, |i| Some(i as f64))
}

/// The points as lines, colours and opacities at the same values side by side.
fn table(function: &TransferFunction) -> String {
    let mut text = String::from("       value  colour   opacity\n");
    let mut values: Vec<f64> = function.color.iter().map(|p| p.value).collect();
    values.extend(function.opacity.iter().map(|p| p.value));
    values.sort_by(f64::total_cmp);
    values.dedup();
    for value in values {
        let color = function.color.iter().find(|p| p.value == value);
        let color = color.map_or(String::new(), |p| {
            let [r, g, b] = p.srgb.map(|c| (c * 255.0).round() as u8);
            format!("#{r:02x}{g:02x}{b:02x}")
        });
        let opacity = function.opacity.iter().find(|p| p.value == value);
        let opacity = opacity.map_or(String::new(), |p| short(p.opacity));
        let line = format!("{:>12}  {color:<7}  {opacity}", short(value));
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{}", visible(line.trim_end()));
    }
    if let Some(gradient_transfer) = &function.gradient_transfer {
        text += &gradients(gradient_transfer);
    }
    text
}

/// What the gradient makes of the points, a line each.
fn gradients(gradient_transfer: &GradientTransfer) -> String {
    let mut text = String::new();
    let share = gradient_transfer.share.iter();
    let share = share.map(|p| format!("{} of it at gradient {}", short(p.opacity), short(p.value)));
    let widgets = gradient_transfer.widgets.iter().map(|widget| {
        let shape = match &widget.shape {
            Shape::Contour { value, half_width } => {
                format!(
                    "contour of {}, {} voxels to both sides",
                    short(*value),
                    short(*half_width)
                )
            }
            Shape::Region { points } => format!("region of {} values", points.len()),
            Shape::Triangle { value, .. } => format!("triangle at {}", short(*value)),
            Shape::Rectangle { values: [a, b], .. } => {
                format!("rectangle from {} to {}", short(*a), short(*b))
            }
            Shape::Gaussian { value, .. } => format!("gaussian at {}", short(*value)),
            Shape::Image { columns, cells, .. } => {
                format!("image of {columns} x {}", cells.count() / (*columns).max(1))
            }
        };
        format!("{shape}: opacity {}", short(widget.opacity))
    });
    for line in share.chain(widgets) {
        let _ = writeln!(text, "{}", visible(&line));
    }
    text
}
