//! What is looked at: an open source, one volume of it in memory, and what its values look like as a whole.

use crate::error::Error;
use crate::words::{Arguments, LookWord};
use glam::{DAffine3, DVec3};
use std::path::Path;
use std::sync::Arc;
use stratavox::camera::{Orbit, View};
use stratavox::format;
use stratavox::look::{context, face, first_variable, leave_out, summary};
use stratavox::transfer::{Context, LabelTable, ValueSummary};
use stratavox::volume::{
    ComponentKind, Grid, Header, Histogram, Limits, Magnitude, Rescale, Source, TimeComponent,
    Volume, VolumeSelection, Voxels, luma, phantom, read_colors,
};

/// Bins of the histogram under the transfer function: one for each of its pixels.
const BINS: usize = 256;

pub struct Subject {
    pub source: Arc<dyn Source>,
    /// The name in the title of the window.
    pub name: String,
    /// The name of the file, or the phantom.
    pub file: String,
    pub voxels: Arc<Volume>,
    pub time: u32,
    pub summary: ValueSummary,
    /// What the file says of the values, under `--look auto`.
    pub context: Option<Context>,
    pub histogram: Histogram,
    /// How a voxel is made one number, and how much higher than it is the volume is drawn.
    pub way: Way,
    names: LabelTable,
}

/// From the numbers of a source to a volume that is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Way {
    pub component: u32,
    /// Colours are drawn by their luma: a host's frame has one number a voxel.
    pub is_luma: bool,
    pub height_factor: f64,
    /// Thin components of CT are air.
    pub leaves_out: bool,
}

impl Subject {
    /// What the words name. Of several variables the first is taken where none is named, under `--look auto` the first
    /// that is no coordinate: the panel has the others.
    pub fn open(words: &Arguments) -> Result<Self, Error> {
        let is_auto = words.look == LookWord::Auto;
        let limits = Limits::default();
        let wanted = VolumeSelection {
            variable: words.variable.clone(),
            series: words.series.clone(),
            level: words.level,
            as_stored: false,
        };
        let source = match words.input.starts_with("phantom:") {
            true => {
                let variable = words
                    .variable
                    .iter()
                    .map(|name| format!(",variable={name}"));
                let spec = words.input.clone() + &variable.collect::<String>();
                phantom::open(&spec, &limits)?
            }
            false => format::open(Path::new(&words.input), &wanted, &limits)?,
        };
        let header = source.header();
        let variables = &header.variables;
        if let Some(first) = first_variable(variables)
            && is_auto
            && words.variable.is_none()
            && !words.input.contains(",variable=")
            && Some(first) != variables.first()
        {
            let variable = Some(first.clone());
            return Self::open(&Arguments {
                variable,
                ..words.clone()
            });
        }
        check(words, header)?;
        let is_color = matches!(header.meaning, ComponentKind::Rgb | ComponentKind::Rgba);
        let is_vector = header.meaning == ComponentKind::Vector && header.components > 1;
        let source: Arc<dyn Source> = match words.component {
            None if is_vector => Arc::new(Magnitude::new(source)),
            _ => Arc::from(source),
        };
        let header = source.header();
        for note in &header.notes {
            println!("{note}");
        }
        let grid = Grid {
            dims: header.dims,
            world_from_voxel: header.world_from_voxel,
        };
        let way = Way {
            component: words.component.unwrap_or(0),
            is_luma: words.component.is_none() && is_color,
            height_factor: match header.is_earth {
                true => height_factor(&grid),
                false => 1.0,
            },
            leaves_out: is_auto && !words.keep_all,
        };
        let (voxels, note) = way.read(source.as_ref(), words.time)?;
        if let Some(note) = note {
            println!("{note}; --keep-all draws them");
        }
        Ok(Self {
            name: name(words, header),
            file: file(words),
            summary: summary(&voxels),
            histogram: Histogram::of(&voxels, BINS),
            voxels: Arc::new(voxels),
            time: words.time,
            way,
            context: is_auto.then(|| context(source.header())),
            names: names(words)?,
            source,
        })
    }

    /// What a label is called.
    pub fn name_of(&self, value: Option<f64>) -> Option<String> {
        let label = self.names.labels.get(&(value? as i64))?;
        Some(label.name.clone()).filter(|name| !name.is_empty())
    }

    pub fn header(&self) -> &Header {
        self.source.header()
    }

    /// The face of a slab under `--look auto`. Pieces of the Earth are thin, and seen from the south.
    fn face(&self) -> Option<View> {
        let may_choose = self.context.is_some() && !self.header().is_earth;
        may_choose.then(|| face(&self.voxels.grid(), self.header().is_patient))?
    }

    /// Whether small pictures choose the side: nothing says how the axes lie, and it is no slab.
    pub fn has_open_side(&self) -> bool {
        let header = self.header();
        let has_named_axes = header.is_patient || header.is_earth;
        self.context.is_some() && !has_named_axes && self.face().is_none()
    }

    /// From where it is seen at first, as `stratavox render` has it: three sides of a box are seen, and of a piece of
    /// the Earth the south, with east on the right.
    pub fn side(&self) -> Orbit {
        if let Some(face) = self.face() {
            return face.orbit();
        }
        let [azimuth_degrees, elevation_degrees] = match self.header().is_earth {
            true => [-60.0, 25.0],
            false => [60.0, 15.0],
        };
        Orbit {
            azimuth_degrees,
            elevation_degrees,
            roll_degrees: 0.0,
        }
    }
}

impl Way {
    /// One time of the source, and the note that says what of it was left out.
    pub fn read(&self, source: &dyn Source, time: u32) -> Result<(Volume, Option<String>), Error> {
        let limits = Limits::default();
        let pick = TimeComponent {
            time,
            component: self.component,
        };
        let mut volume = match self.is_luma {
            true => luma_of(&read_colors(source, time, &limits)?)?,
            false => Volume::read(source, pick, source.header().whole(), &limits)?,
        };
        let stretch = DAffine3::from_scale(DVec3::new(1.0, 1.0, self.height_factor));
        volume.world_from_voxel = stretch * volume.world_from_voxel;
        let note = match self.leaves_out && !self.is_luma {
            true => leave_out(&mut volume, source.header()),
            false => None,
        };
        Ok((volume, note))
    }
}

/// The names that the words bring.
fn names(words: &Arguments) -> Result<LabelTable, Error> {
    let Some(path) = &words.label_tf else {
        return Ok(LabelTable::default());
    };
    let wrong =
        |problem: String| Error::Arguments(format!("--label-tf {}: {problem}", path.display()));
    let text = std::fs::read(path).map_err(|cause| wrong(cause.to_string()))?;
    LabelTable::parse(&text).map_err(|problem| wrong(problem.to_string()))
}

/// Refuses words that name what is not there.
fn check(words: &Arguments, header: &Header) -> Result<(), Error> {
    let wrong = |text: String| Err(Error::Arguments(text));
    if let Some(name) = &words.variable
        && !header.variables.contains(name)
    {
        let there = match header.variables.is_empty() {
            true => "the variable of such a file has no name".to_owned(),
            false => format!("there are {}", header.variables.join(", ")),
        };
        return wrong(format!("--variable {name}: {there}"));
    }
    if words.time >= header.times {
        let (time, times) = (words.time, header.times);
        return wrong(format!("--time {time}: there are {times}, counted from 0"));
    }
    match words.component {
        Some(component) if component >= header.components => wrong(format!(
            "--component {component}: a voxel has {}, counted from 0",
            header.components
        )),
        _ => Ok(()),
    }
}

/// The last name of a path, or a phantom's word.
fn file(words: &Arguments) -> String {
    let input = words.input.trim_end_matches('/');
    match Path::new(input).file_name() {
        Some(name) if !input.starts_with("phantom:") => name.to_string_lossy().into_owned(),
        _ => input.to_owned(),
    }
}

fn name(words: &Arguments, header: &Header) -> String {
    let file = file(words);
    let file = file.strip_prefix("phantom:").unwrap_or(&file).to_owned();
    match header.variables.first() {
        Some(variable) if header.variables.len() > 1 => format!("{file}: {variable}"),
        _ => file,
    }
}

/// The weather lies in a sheet ten kilometres high and thousands wide: it is drawn so high that it is four times as
/// wide as high, to two digits.
fn height_factor(grid: &Grid) -> f64 {
    let m = grid.world_from_voxel.matrix3;
    let far = grid.far_corner();
    let [x, y, z] = [m.x_axis * far.x, m.y_axis * far.y, m.z_axis * far.z];
    let sides = x.abs() + y.abs() + z.abs();
    let factor = sides.x.max(sides.y) / (4.0 * sides.z);
    if !(factor > 1.0 && factor.is_finite()) || grid.dims.contains(&1) {
        return 1.0;
    }
    let unit = 10_f64.powf(factor.log10().floor() - 1.0);
    (factor / unit).round() * unit
}

fn luma_of(colors: &[Volume]) -> Result<Volume, Error> {
    let first = &colors[0];
    let count = first.voxels.len();
    let values = (0..count).map(|i| luma(colors, i).unwrap_or(0.0) as f32);
    let voxels = Voxels::F32(values.collect());
    let place = first.world_from_voxel;
    Volume::from_voxels(first.dims, place, voxels, Rescale::default(), None)
        .map_err(|problem| Error::Arguments(problem.to_string()))
}
