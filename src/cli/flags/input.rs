//! Which volume: the words, and the source they name.

use super::{
    super::{memory, untrusted},
    Component, Error, PointGrid, time,
};
use crate::cli::stdin::{self, STANDARD};
use crate::look::first_variable;
use crate::{
    format,
    volume::{Header, Limits, Magnitude, Series, Source, TimeComponent, VolumeSelection, phantom},
};
use clap::Args;
use serde::{Deserialize, Serialize};
use std::{
    ops::Range,
    path::{Path, PathBuf},
};

/// The words, none of them filled in.
#[derive(Args, Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct InputFlags {
    /// A volume file, a file of scattered points, a folder of slices, - for a file on the standard input, or phantom:NAME[,n=256][,type=u8|u16|f32] with NAME of sphere, gauss,
    /// marschner-lobb, head, fog, shells, storm, flow, cells
    #[arg(value_name = "INPUT")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub path: Option<String>,
    /// The layout of a file without a header: 256x256x109,i16[,0.9x0.9x1.5][,le|be]
    #[arg(long, value_name = "LAYOUT", help_heading = "Input")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub raw: Option<String>,
    /// One of several variables: a name, an HDF5 path, or NAME[AXIS=N] where it has axes beside time and space
    #[arg(long, value_name = "NAME", help_heading = "Input")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub variable: Option<String>,
    /// One of several times: its number, counted from 0, or its date [default: the first]
    #[arg(long, value_name = "N|ISO", help_heading = "Input")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time: Option<String>,
    /// One of several numbers of a voxel, counted from 0; the length of the vector that they are; or all, each in a
    /// colour of its own
    #[arg(long, value_name = "N|magnitude|all", help_heading = "Input")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub component: Option<Component>,
    /// One of several DICOM series in a folder
    #[arg(long, value_name = "UID", help_heading = "Input")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub series: Option<String>,
    /// The input is scattered points, as .csv, .tsv, .ply and .vtp files are: rows x, y, z, value[, std[, weight]] of .npy
    #[arg(long, help_heading = "Input")]
    #[serde(skip_serializing_if = "is_false")]
    pub points: bool,
    /// Scattered points: which columns are what, by their names [default: by names such as x, longitude, depth_km; the
    /// value is the first other one of numbers]
    #[arg(
        long,
        value_name = "x=..,y=..,z=..,value=..[,std=..][,weight=..]",
        help_heading = "Input"
    )]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub point_columns: Option<String>,
    /// One of several resolutions of a file that has them: 0 the finest, each next with half as many voxels along each
    /// axis
    #[arg(long, value_name = "N", help_heading = "Input")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub level: Option<u32>,
    /// Draw a volume that is too large for the memory with fewer voxels, and say so
    #[arg(long, help_heading = "Input")]
    #[serde(skip_serializing_if = "is_false")]
    pub fit: bool,
    /// Draw thin components of CT that touch faces of the box, such as a table, which composites leave out under
    /// `--look auto`; false leaves them out under plain too
    #[arg(
        long,
        value_name = "true|false",
        num_args = 0..=1,
        require_equals = true,
        default_missing_value = "true",
        help_heading = "Input"
    )]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub keep_all: Option<bool>,
    /// Memory that the volume may take, such as 512M or 16G [default: 90 % of what is free]
    #[arg(long, value_name = "SIZE", value_parser = memory::bytes_of_word, help_heading = "Input")]
    #[serde(skip)]
    pub max_memory: Option<u64>,
    /// Draw brick by brick from the file, as volumes are drawn that are too large for the memory
    #[arg(long, conflicts_with = "fit", help_heading = "Input")]
    #[serde(skip_serializing_if = "is_false")]
    pub stream: bool,
    /// Device memory that the bricks of such a volume may take, such as 2G [default: half of what there is where that
    /// is the memory of the processor, else 80 %]
    #[arg(long, value_name = "SIZE", value_parser = memory::bytes_of_word, help_heading = "Input")]
    #[serde(skip)]
    pub device_memory: Option<u64>,
    /// For files of strangers: read in a process of its own with limits of memory and time; 1 GiB, small headers, no
    /// second file that a header names
    #[arg(long, help_heading = "Input")]
    #[serde(skip)]
    pub untrusted: bool,
    /// Scattered points are interpolated.
    #[arg(skip)]
    #[serde(skip)]
    pub on_grid: Option<Box<PointGrid>>,
}

#[allow(
    clippy::trivially_copy_pass_by_ref,
    reason = "serde hands over references"
)]
fn is_false(flag: &bool) -> bool {
    !flag
}

/// How a built-in volume begins.
pub const PHANTOM: &str = "phantom:";

impl InputFlags {
    /// The file, where the input is one.
    pub fn file(&self) -> Option<&Path> {
        self.path
            .as_deref()
            .filter(|path| !path.starts_with(PHANTOM) && *path != STANDARD)
            .map(Path::new)
    }

    /// What a reader may use.
    pub fn limits(&self) -> Limits {
        let limits = if self.untrusted {
            Limits::UNTRUSTED
        } else {
            Limits::default()
        };
        Limits {
            max_bytes: match self.max_memory.or_else(memory::available_bytes) {
                Some(bytes) if self.untrusted => bytes.min(limits.max_bytes),
                Some(bytes) => bytes,
                None => limits.max_bytes,
            },
            ..limits
        }
    }

    /// Takes the first variable of `source` that can be drawn, where the words name none of several: the readers put it
    /// first. Gives the note that names the others.
    pub fn take_first_variable(&mut self, header: &Header) -> Option<String> {
        self.check_one_variable(header).err()?;
        let names = &header.variables;
        let first = first_variable(names)?;
        let others: Vec<_> = names.iter().filter(|&name| name != first).collect();
        let others: Vec<_> = others.into_iter().map(String::as_str).collect();
        let note = format!(
            "drawn is {first}; --variable takes another: {}",
            others.join(", ")
        );
        self.variable = Some(first.clone());
        Some(note)
    }

    /// Opens what the words name, as it is drawn; reads its header alone.
    pub fn open(&self, limits: &Limits) -> Result<Box<dyn Source>, Error> {
        self.open_picked(false, limits)
    }

    /// The same with the voxels as they stand in the file.
    pub fn open_as_stored(&self, limits: &Limits) -> Result<Box<dyn Source>, Error> {
        self.open_picked(true, limits)
    }

    fn open_picked(&self, as_stored: bool, limits: &Limits) -> Result<Box<dyn Source>, Error> {
        let source = self.open_with(as_stored, limits)?;
        if self.component == Some(Component::Magnitude) {
            return Ok(Box::new(Magnitude::new(source)));
        }
        Ok(source)
    }

    fn open_with(&self, as_stored: bool, limits: &Limits) -> Result<Box<dyn Source>, Error> {
        let Some(path) = self.path.as_deref() else {
            return Err(Error::usage(
                "no INPUT is given",
                "name a volume file, or phantom:head",
            ));
        };
        if path.starts_with(PHANTOM) {
            if self.raw.is_some() {
                return Err(Error::usage(
                    "--raw is the layout of a file, and the input is a built-in volume",
                    "leave out --raw",
                ));
            }
            if self.points_are_named() {
                return Err(Error::usage(
                    "--points and --point-columns are for files of points, and the input is a built-in volume",
                    "leave them out",
                ));
            }
            let source = phantom::open(&self.phantom_spec(path), limits)?;
            self.check_series(source.header())?;
            return Ok(source);
        }
        if self.holds_points() {
            let file = self.open_points(limits)?;
            return Ok(Box::new(match &self.on_grid {
                Some(grid) => grid.volume_of(file, self)?,
                None => file,
            }));
        }
        let spooled = match path {
            STANDARD => Some(stdin::file(limits.max_bytes)?),
            _ => None,
        };
        let path = spooled.as_deref().unwrap_or(Path::new(path));
        let source = match &self.raw {
            Some(layout) => {
                let layout = format::raw::RawSpec::parse(layout).map_err(|problem| {
                    Error::usage(
                        format!("--raw {layout}: {problem}"),
                        "--raw 256x256x109,i16,0.9x0.9x1.5,le",
                    )
                })?;
                match self.untrusted {
                    true => untrusted::open(
                        path,
                        self.raw.as_deref(),
                        &VolumeSelection::default(),
                        limits,
                    )?,
                    false => format::raw::open(path, &layout, limits)?,
                }
            }
            None => {
                let wanted = VolumeSelection {
                    variable: self.variable.clone(),
                    series: self.series.clone(),
                    level: self.level,
                    as_stored,
                };
                match self.untrusted {
                    true => untrusted::open(path, None, &wanted, limits)?,
                    false => format::open(path, &wanted, limits)?,
                }
            }
        };
        self.check_series(source.header())?;
        if let Some(name) = &self.variable {
            check_variable(name, source.header())?;
        }
        Ok(source)
    }

    fn phantom_spec(&self, path: &str) -> String {
        match &self.variable {
            Some(variable) => format!("{path},variable={variable}"),
            None => path.to_owned(),
        }
    }

    /// Which of the volumes in the source to draw, and what a person should know about the choice.
    pub fn pick(&self, header: &Header) -> Result<(TimeComponent, Option<String>), Error> {
        self.check_one(header)?;
        let (time, note) = self.time(header)?;
        let components = self.components(header)?;
        if components.len() != 1 {
            return Err(Error::usage(
                format!(
                    "a voxel holds {} numbers, components 0 to {}",
                    header.components,
                    header.components - 1
                ),
                "choose one: --component 0, or draw all together: --component all",
            ));
        }
        let component = components.start;
        Ok((TimeComponent { time, component }, note))
    }

    /// The components that the words leave: the one they name, else all.
    pub fn components(&self, header: &Header) -> Result<Range<u32>, Error> {
        match self.component {
            None | Some(Component::Word(_)) => Ok(0..header.components),
            Some(Component::Number(component)) if component < header.components => {
                Ok(component..component + 1)
            }
            Some(Component::Number(component)) => Err(Error::usage(
                format!(
                    "--component {component}: a voxel has {} of them, counted from 0",
                    header.components
                ),
                "--component 0",
            )),
        }
    }

    /// Refuses a source of several variables or series of which the words choose none.
    pub fn check_one(&self, header: &Header) -> Result<(), Error> {
        self.check_one_variable(header)?;
        self.check_one_series(header)
    }

    fn check_one_variable(&self, header: &Header) -> Result<(), Error> {
        let in_path = |path: &str| path.starts_with(PHANTOM) && path.contains(",variable=");
        let is_chosen = self.variable.is_some() || self.path.as_deref().is_some_and(in_path);
        if is_chosen || header.variables.len() < 2 {
            return Ok(());
        }
        Err(Error::usage(
            format!(
                "the input holds several variables: {}",
                header.variables.join(", ")
            ),
            "choose one with --variable NAME",
        ))
    }

    fn check_one_series(&self, header: &Header) -> Result<(), Error> {
        if self.series.is_some() || header.series.len() < 2 {
            return Ok(());
        }
        Err(Error::usage(
            format!("the folder holds several series: {}", listed(header)),
            "choose one with --series UID",
        ))
    }

    fn check_series(&self, header: &Header) -> Result<(), Error> {
        let Some(uid) = &self.series else {
            return Ok(());
        };
        if header.series.iter().any(|series| series.uid == *uid) {
            return Ok(());
        }
        let there = match header.series.as_slice() {
            [] => format!("{} files have no series", header.format.name()),
            _ => format!("there are {}", listed(header)),
        };
        Err(Error::usage(
            format!("--series {uid}: {there}"),
            "leave out --series",
        ))
    }

    /// The time to take, and what a person should know about the choice.
    pub fn time(&self, header: &Header) -> Result<(u32, Option<String>), Error> {
        let times = header.times;
        let Some(word) = &self.time else {
            let first = header.time_names.first();
            let first = first.map_or(String::new(), |name| format!(", {name},"));
            let note = (times > 1).then(|| {
                format!("the first of {times} times{first} is taken; --time N takes another")
            });
            return Ok((0, note));
        };
        Ok((time::chosen(word, header)?, None))
    }

    /// The same words with a file's path from the folder of a scene file, as text.
    pub fn relative_to(&self, folder: &Path) -> Self {
        let Some(path) = self.file() else {
            return self.clone();
        };
        let shown = relative(path, folder);
        Self {
            path: Some(shown.to_string_lossy().into_owned()),
            ..self.clone()
        }
    }

    /// The words of a scene file in `folder`, as they are from here.
    pub fn found_in(&self, folder: &Path) -> Self {
        let found: Option<PathBuf> = self.file().map(|path| folder.join(path));
        match found {
            Some(path) => Self {
                path: Some(path.to_string_lossy().into_owned()),
                ..self.clone()
            },
            None => self.clone(),
        }
    }
}

/// The path of a file as it is said in `folder`.
pub fn relative(path: &Path, folder: &Path) -> PathBuf {
    let absolute = |path: &Path| path.canonicalize().unwrap_or_else(|_| path.to_owned());
    let (path, folder) = (absolute(path), absolute(folder));
    path.strip_prefix(&folder).unwrap_or(&path).to_owned()
}

/// The series, each with what is known of it.
fn listed(header: &Header) -> String {
    let line = |series: &Series| {
        format!(
            "{} ({:?}, {} pictures)",
            series.uid, series.description, series.pictures
        )
    };
    header
        .series
        .iter()
        .map(line)
        .collect::<Vec<_>>()
        .join("; ")
}

fn check_variable(name: &str, header: &Header) -> Result<(), Error> {
    if header.variables.iter().any(|variable| variable == name) {
        return Ok(());
    }
    let there = match header.variables.as_slice() {
        [] => format!(
            "{} files have one variable without a name",
            header.format.name()
        ),
        names => format!("there are {}", names.join(", ")),
    };
    Err(Error::usage(
        format!("--variable {name}: {there}"),
        "leave out --variable",
    ))
}
