//! From the variables of a file to the field that lines are traced in.
//!
//! ```text
//! names -> sources on one grid -> units -> snapshots at their seconds -> metric of the place -> field over the ground
//! ```

use super::super::{Error, progress::Progress};
use super::components::{Components, check_grids, components, grid_of};
use super::flags::{FlowWord, WindWords};
use super::ground;
use super::variable::{Variables, numbers};
use crate::flow::wind::{WindUnit, filled_down, metric_of, seconds_since_first};
use crate::flow::{FieldError, GridField, Snapshot, Vertical};
use crate::volume::{Grid, Header, Heights, Source, is_same_grid, regridded};

/// A wind, and what is known of its grid.
pub struct Wind {
    pub field: GridField,
    pub header: Header,
    pub grid: Grid,
    /// Numbers of the file's times that are in the field, and their seconds.
    pub times: Vec<(u32, f64)>,
}

/// Reads the wind at all times of particles, and at the one of the words for stream lines. `said` is what was said of the file,
/// where something was: that, and which time is taken, is not said again.
pub fn read(
    variables: &Variables<'_>,
    words: Option<&WindWords>,
    word: FlowWord,
    at: Option<f64>,
    said: Option<&[String]>,
    progress: &Progress,
) -> Result<Wind, Error> {
    let components = components(variables, words, progress)?;
    let whole = components.east.0.header().clone();
    check_grids(&components, &whole)?;
    // Before all that is told of the file: a wind that is none is told alone.
    let (units, up) = units(&components, &whole, progress)?;
    let times = match at {
        Some(time) => between(time),
        None => {
            let (times, note) = times(variables, &whole, word)?;
            let note = note.filter(|_| said.is_none());
            note.iter().for_each(|note| progress.note(note));
            times
        }
    };
    let factor = fitting_factor(&whole, times.len() as u64, variables)?;
    let components = components.reduced(factor);
    let header = components.east.0.header().clone();
    let grid = grid_of(&header);
    let is_new = |note: &&String| said.is_none_or(|said| !said.contains(note));
    for note in header.notes.iter().filter(is_new) {
        progress.note(note);
    }
    // Of reduced columns the means.
    let columns = |all: Vec<f64>| match factor {
        1 => all,
        _ => mean_columns(&all, whole.dims, factor),
    };
    let ground = ground::heights(variables, &whole)?.map(columns);
    let mut snapshots = Vec::new();
    for (done, &(time, seconds)) in times.iter().enumerate() {
        progress.stage("read", done, times.len());
        let read = |(source, component): &(Box<dyn Source>, u32), factor: f64| {
            let volume = variables.read(source.as_ref(), time, *component)?;
            let volume = match is_same_grid(&grid, &volume.grid()) {
                true => volume,
                false => {
                    regridded(&volume, &grid)
                        .map_err(|problem| Error::Input {
                            path: source.path().to_owned(),
                            problem: problem.to_string(),
                        })?
                        .0
                }
            };
            let mut values = numbers(&volume, factor);
            if ground.is_some() {
                let is_rising = grid.world_from_voxel.matrix3.z_axis.z > 0.0;
                filled_down(&mut values, grid.dims, is_rising);
            }
            Ok::<_, Error>(values)
        };
        let east = read(&components.east, units[0].factor)?;
        let north = read(&components.north, units[1].factor)?;
        let up = match (&components.up, up) {
            (Some(source), true) => Some(read(source, units[2].factor)?),
            _ => None,
        };
        let [nx, ny, _] = grid.dims.map(|n| n as usize);
        let snapshot = Snapshot::from_fn(&grid, |[x, y, z]| {
            let i = (z as usize * ny + y as usize) * nx + x as usize;
            Some([east[i], north[i], up.as_ref().map_or(0.0, |up| up[i])])
        });
        snapshots.push((seconds, snapshot));
    }
    let map = ground::map_factors(variables, &whole)?.map(|map| map.map(columns));
    let metric = metric_of(&header, units[2].kind, map);
    let failed = |error: FieldError| Error::usage(format!("--flow: {error}"), "--wind U,V,none");
    let mut field = GridField::new(grid, snapshots, metric).map_err(failed)?;
    if let Some(ground) = ground {
        field = field.over_ground(ground).map_err(failed)?;
    }
    Ok(Wind {
        field,
        header,
        grid,
        times,
    })
}

/// Bytes of the wind of a header at so many times.
pub fn bytes(header: &Header, times: u64) -> u64 {
    header.voxel_count().saturating_mul(VECTOR_BYTES * times)
}

/// Of a wind at a voxel and a time.
const VECTOR_BYTES: u64 = 12;

/// By how much each axis has to shrink for the wind to fit, and one time while it is read: 1 but for `--fit`.
fn fitting_factor(header: &Header, times: u64, variables: &Variables<'_>) -> Result<u32, Error> {
    let (wanted, there) = (bytes(header, times + 1), variables.limits.max_bytes);
    let fits = |factor: &u32| {
        let dims = header.dims.map(|n| n.div_ceil(*factor));
        let reduced = Header {
            dims,
            ..header.clone()
        };
        bytes(&reduced, times + 1) <= there
    };
    let largest = header.dims.into_iter().max().unwrap_or(1);
    let factor = (1..=largest).find(fits).unwrap_or(largest);
    match factor == 1 || variables.input.fit {
        true => Ok(factor),
        false => Err(Error::Memory(format!(
            "the wind of {} takes {wanted} bytes, and there are {there}; --fit takes means of blocks of it",
            match times {
                1 => "one time".to_owned(),
                count => format!("{count} times"),
            },
        ))),
    }
}

/// Means of numbers of one a column over blocks of so many columns a side.
fn mean_columns(all: &[f64], dims: [u32; 3], factor: u32) -> Vec<f64> {
    let [nx, ny, _] = dims.map(|n| n as usize);
    let factor = factor as usize;
    let blocks = (0..ny).step_by(factor);
    let blocks = blocks.flat_map(|y| (0..nx).step_by(factor).map(move |x| [x, y]));
    let mean = |[x, y]: [usize; 2]| {
        let [to_x, to_y] = [(x + factor).min(nx), (y + factor).min(ny)];
        let rows = (y..to_y).map(|y| all[y * nx + x..y * nx + to_x].iter().sum::<f64>());
        rows.sum::<f64>() / ((to_x - x) * (to_y - y)) as f64
    };
    blocks.map(mean).collect()
}

/// The units, and whether the upward component is one that moves what is drawn.
fn units(
    components: &Components,
    header: &Header,
    progress: &Progress,
) -> Result<([WindUnit; 3], bool), Error> {
    let sources = [
        Some(&components.east),
        Some(&components.north),
        components.up.as_ref(),
    ];
    let mut units = [WindUnit {
        factor: 1.0,
        kind: Vertical::Metres,
    }; 3];
    let mut silent = Vec::new();
    for ((k, source), name) in sources.into_iter().enumerate().zip(&components.names) {
        let Some((source, _)) = source else { continue };
        let unit = source.header().unit.as_deref();
        let failed = |error: crate::flow::wind::UnitError| {
            Error::usage(
                format!("--flow: {error}"),
                "--wind U,V[,W|none] names other variables",
            )
        };
        units[k] = WindUnit::of(name, unit, k == 2).map_err(failed)?;
        if unit.is_none() && !silent.contains(name) {
            silent.push(name.clone());
        }
    }
    if !silent.is_empty() && (header.is_earth || header.length_metres.is_some()) {
        progress.note(&format!(
            "without a unit, and taken as m s-1: {}",
            silent.join(", ")
        ));
    }
    if components.up.is_some() && header.heights == Heights::Levels {
        progress.note(
            "levels are only numbers: without heights the upward wind is left out, and lines stay in their level",
        );
        units[2].kind = Vertical::Metres;
        return Ok((units, false));
    }
    let is_in_pressures = units[2].kind == Vertical::Pascals;
    if components.up.is_some() && is_in_pressures && header.heights != Heights::Pressures {
        progress.note("levels are no pressures: without an upward wind lines stay in their level");
        units[2].kind = Vertical::Metres;
        return Ok((units, false));
    }
    Ok((units, components.up.is_some()))
}

/// The times around one of a film, in place of seconds counted from the first of them.
fn between(time: f64) -> Vec<(u32, f64)> {
    let [before, after] = [time.floor(), time.ceil()];
    let mut times = vec![(before as u32, 0.0)];
    if after > before {
        times.push((after as u32, 1.0));
    }
    times
}

/// Numbers of times, and their seconds since the first of the file.
type Times = Vec<(u32, f64)>;

/// The times that are read, and what a person should know about the choice.
fn times(
    variables: &Variables<'_>,
    header: &Header,
    word: FlowWord,
) -> Result<(Times, Option<String>), Error> {
    let seconds = seconds_since_first(&header.time_names);
    if word == FlowWord::Stream {
        let (time, note) = variables.input.time(header)?;
        return Ok((vec![(time, 0.0)], note));
    }
    if header.times < 2 {
        return Err(Error::usage(
            format!("--flow {}: the input has one time", word.name()),
            "--flow stream",
        ));
    }
    let seconds = seconds.filter(|seconds| {
        seconds.len() == header.times as usize && seconds.is_sorted_by(|a, b| a < b)
    });
    let seconds = seconds.ok_or_else(|| {
        Error::usage(
            format!(
                "--flow {}: the times of the input have no dates or hours that grow",
                word.name()
            ),
            "--flow stream",
        )
    })?;
    Ok(((0..header.times).zip(seconds).collect(), None))
}
