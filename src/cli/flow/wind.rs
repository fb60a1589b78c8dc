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
    let header = components.east.0.header().clone();
    let grid = grid_of(&header);
    check_grids(&components, &header)?;
    let is_new = |note: &&String| said.is_none_or(|said| !said.contains(note));
    for note in header.notes.iter().filter(is_new) {
        progress.note(note);
    }
    let (units, up) = units(&components, &header, progress)?;
    let times = match at {
        Some(time) => between(time),
        None => {
            let (times, note) = times(variables, &header, word)?;
            let note = note.filter(|_| said.is_none());
            note.iter().for_each(|note| progress.note(note));
            times
        }
    };
    let voxels = header.voxel_count();
    let wanted = voxels.saturating_mul(12 * times.len() as u64 + 12);
    if wanted > variables.limits.max_bytes {
        return Err(Error::Memory(format!(
            "the wind of {} takes {wanted} bytes, and there are {}",
            match times.len() {
                1 => "one time".to_owned(),
                count => format!("{count} times"),
            },
            variables.limits.max_bytes
        )));
    }
    let ground = ground::heights(variables, &header)?;
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
    let map = ground::map_factors(variables, &header)?;
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
