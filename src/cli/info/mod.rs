//! `stratavox info`: what a volume is, before anything is drawn.

mod bars;
mod beside;
mod earth;
mod place;
mod structure;
mod text;
mod values;
mod variables;
mod watched;

use super::{
    Error,
    flags::{ClassificationFlags, InputFlags},
    memory::{RenderBytes, software_device_bytes},
    output::{say, say_aside},
    progress::{Progress, ProgressWord},
};
use crate::annotate::unit;
use crate::volume::{
    ComponentKind, DerivedVariable, Grid, Header, Limits, MapProjection, Problem, ReadError,
    Source, Statistics, TimeComponent,
};
use beside::DrawnBytes;
use clap::Args;
use glam::DVec3;
use serde::Serialize;
use watched::Watched;

/// Say what a volume holds
#[derive(Args, Debug)]
#[command(after_help = "Examples:\n  \
    stratavox info phantom:head --json\n  \
    stratavox info phantom:head,n=64 --structure --preset ct-bone")]
pub struct Info {
    #[command(flatten)]
    input: InputFlags,
    /// Say too which voxels are full under a transfer function, and what run-length encoding and an octree take for them.
    /// The function is that of `render`, or one by the flags of colour; the volume is read into memory
    #[arg(long)]
    structure: bool,
    #[command(flatten)]
    classification: ClassificationFlags,
    /// As JSON
    #[arg(long)]
    json: bool,
    /// Say on stderr how far the work is
    #[arg(long, value_enum, default_value_t)]
    progress: ProgressWord,
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
    /// What is computed from these on demand.
    derived: Vec<DerivedVariable>,
    /// The map of a weather model; `null` where the file tells none. Angles in degrees.
    map: Option<MapProjection>,
    /// Resolutions that `--level` chooses from.
    levels: u32,
    render_bytes: DrawnBytes,
    /// Of a device that computes on the CPU, which keeps 8-bit numbers in another way too.
    software_device_bytes: u64,
    /// Of values; `null` where the file is silent.
    unit: Option<String>,
    /// What the values are; `null` where nothing says it.
    long_name: Option<String>,
    /// What the numbers of a voxel are to each other: numbers, rgb, rgba, vector or channels.
    meaning: &'static str,
    /// One for each component that is a channel.
    channels: Vec<ChannelReport>,
    /// One for each time, or none.
    time_names: Vec<String>,
    series: Vec<SeriesReport>,
    notes: Vec<String>,
    /// With `--structure`.
    #[serde(skip_serializing_if = "Option::is_none")]
    structure: Option<structure::StructureReport>,
}

/// A thing seen in the same place as others.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct ChannelReport {
    name: String,
    srgb: Option<[f32; 3]>,
    window: Option<[f64; 2]>,
}

/// A series of a DICOM folder.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct SeriesReport {
    uid: String,
    description: String,
    pictures: usize,
}

impl Info {
    /// Reads all of the input and prints what it is like.
    pub fn run(mut self) -> Result<(), Error> {
        self.check_function()?;
        let limits = self.input.limits();
        let progress = Progress::new(self.progress);
        let source = self.input.open_as_stored(&limits)?;
        if self.input.untrusted {
            check_size(source.as_ref(), &limits)?;
        }
        // Statistics read everything twice, and what the values look like the first time once more.
        let times = 2 * u64::from(source.header().times) + 1;
        let all = source.header().voxel_count().saturating_mul(times);
        let source = Watched::new(source, &progress, all);
        let header = source.header().clone();
        let header = &header;
        self.input.time(header)?;
        if self.input.time.is_some() {
            say_aside(match self.structure {
                true => {
                    "--time is for --structure, the other numbers of info are those of all times"
                }
                false => "--time has no effect on info, its numbers are those of all times",
            });
        }
        let components = self.input.components(header)?;
        let statistics = Statistics::of(&source, components.clone(), &limits)?;
        // Where one number a voxel is drawn; JSON says nothing of it.
        let choice = match components.len() == 1 && statistics.valid_count > 0 && !self.json {
            true => {
                let component = components.start;
                values::choice(&source, TimeComponent { time: 0, component }, &limits)?
            }
            false => None,
        };
        drop(source);
        let structure = match self.structure {
            true => {
                progress.stage("structure", 0, 1);
                let read = structure::read(&self.input, &self.classification, &limits)?;
                Some(read)
            }
            false => None,
        };
        // What follows is said without a line of progress beside it.
        drop(progress);
        // A stranger's file is not opened again and again.
        let wind_of = Some(&self.input).filter(|input| self.json && !input.untrusted);
        let mut report = report(header, &statistics, wind_of);
        report.structure = structure;
        if header.is_earth {
            // Uneven levels are drawn from even ones, of which there are more.
            let drawn = self.input.open(&limits)?;
            let is_other = drawn.header().dims != header.dims;
            let has_holes = is_other || has_holes(&statistics);
            report.render_bytes.volume = RenderBytes::of(drawn.header(), has_holes);
            report.software_device_bytes = software_device_bytes(drawn.header(), has_holes);
        }
        if self.json {
            for note in &header.notes {
                say_aside(note);
            }
            let json = serde_json::to_string_pretty(&report).expect("numbers as JSON");
            say(&format!("{json}\n"))
        } else {
            let page = text::Page {
                report: &report,
                header,
                input: &self.input,
                statistics: &statistics,
                choice,
            };
            say(&page.text(&limits))
        }
    }
}

impl Info {
    /// Reads the files of the function, which is for `--structure` alone.
    fn check_function(&mut self) -> Result<(), Error> {
        if !self.structure && self.classification != ClassificationFlags::default() {
            return Err(Error::usage(
                "--preset, --tf, --window and the other flags of colour say what --structure takes for full",
                "add --structure, or leave them out",
            ));
        }
        self.classification.inline_file()?;
        self.classification.check()
    }
}

/// The values of a volume of more bytes are not read where a stranger's file says so.
fn check_size(source: &dyn Source, limits: &Limits) -> Result<(), ReadError> {
    let header = source.header();
    let wanted_bytes = RenderBytes::of(header, false).host;
    if wanted_bytes <= limits.max_bytes {
        return Ok(());
    }
    Err(ReadError {
        path: source.path().to_owned(),
        problem: Problem::Limit {
            what: "the volume".to_owned(),
            wanted_bytes,
            limit_bytes: limits.max_bytes,
        },
    })
}

fn meaning(header: &Header) -> (&'static str, Vec<ChannelReport>) {
    let channels = match &header.meaning {
        ComponentKind::Channels(channels) => channels.as_slice(),
        _ => &[],
    };
    let channels = channels.iter().map(|channel| ChannelReport {
        name: channel.name.clone(),
        srgb: channel.srgb,
        window: channel.window,
    });
    let word = match header.meaning {
        ComponentKind::Numbers => "numbers",
        ComponentKind::Rgb => "rgb",
        ComponentKind::Rgba => "rgba",
        ComponentKind::Vector => "vector",
        ComponentKind::Channels(_) => "channels",
    };
    (word, channels.collect())
}

fn report(header: &Header, statistics: &Statistics, wind_of: Option<&InputFlags>) -> Report {
    let grid = Grid {
        dims: header.dims,
        world_from_voxel: header.world_from_voxel,
    };
    let known = |number: f64| number.is_finite().then_some(number);
    let (meaning, channels) = meaning(header);
    let series = header.series.iter().map(|series| SeriesReport {
        uid: series.uid.clone(),
        description: series.description.clone(),
        pictures: series.pictures,
    });
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
        derived: header.derived.clone(),
        map: header.map,
        levels: header.levels,
        render_bytes: DrawnBytes::of(
            RenderBytes::of(header, has_holes(statistics)),
            header,
            wind_of,
        ),
        software_device_bytes: software_device_bytes(header, has_holes(statistics)),
        unit: unit(header),
        long_name: header.long_name.clone(),
        meaning,
        channels,
        time_names: header.time_names.clone(),
        series: series.collect(),
        notes: header.notes.clone(),
        structure: None,
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
