//! From the variables of a file to the field that lines are traced in.
//!
//! ```text
//! names -> sources on one grid -> units -> snapshots at their seconds -> metric of the place -> field over the ground
//! ```

use super::super::{Error, progress::Progress};
use super::flags::WindWords;
use super::ground;
use super::variable::{Variables, numbers};
use crate::flow::wind::{WindNames, WindUnit, filled_down, metric_of, seconds_since_first};
use crate::flow::{FieldError, GridField, Snapshot, Vertical};
use crate::volume::{ComponentKind, Grid, Header, Source, is_same_grid, regridded};

/// A wind, and what is known of its grid.
pub struct Wind {
    pub field: GridField,
    pub header: Header,
    pub grid: Grid,
    /// Numbers of the file's times that are in the field, and their seconds.
    pub times: Vec<(u32, f64)>,
}

/// What the three components are read from, with the number of the component.
struct Components {
    east: (Box<dyn Source>, u32),
    north: (Box<dyn Source>, u32),
    up: Option<(Box<dyn Source>, u32)>,
    names: [String; 3],
}

/// Reads the wind at all times, or at the one of the words.
pub fn read(
    variables: &Variables<'_>,
    words: Option<&WindWords>,
    all_times: bool,
    progress: &Progress,
) -> Result<Wind, Error> {
    let components = components(variables, words, progress)?;
    let header = components.east.0.header().clone();
    let grid = grid_of(&header);
    check_grids(&components, &header)?;
    for note in &header.notes {
        progress.note(note);
    }
    let (units, up) = units(&components, &header, progress)?;
    let times = times(variables, &header, all_times, progress)?;
    let voxels = header.voxel_count();
    let wanted = voxels.saturating_mul(12 * times.len() as u64 + 12);
    if wanted > variables.limits.max_bytes {
        return Err(Error::Memory(format!(
            "the wind of {} times takes {wanted} bytes, and there are {}",
            times.len(),
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

fn grid_of(header: &Header) -> Grid {
    Grid {
        dims: header.dims,
        world_from_voxel: header.world_from_voxel,
    }
}

fn components(
    variables: &Variables<'_>,
    words: Option<&WindWords>,
    progress: &Progress,
) -> Result<Components, Error> {
    let first = variables.input.open(&variables.limits)?;
    let header = first.header();
    let found = WindNames::of(&header.variables, &header.variable_standard_names);
    let names = match words {
        Some(words) => WindNames {
            east: words.east.clone(),
            north: words.north.clone(),
            up: match &words.up {
                Some(up) => up.clone(),
                None => found.and_then(|found| found.up),
            },
        },
        None => match found.filter(|_| variables.input.variable.is_none()) {
            Some(found) => found,
            None => return vectors(variables, first, progress),
        },
    };
    let up = names.up.as_deref();
    progress.note(&format!(
        "the wind is {}, {}{}",
        names.east,
        names.north,
        up.map_or_else(
            || ", without an upward variable: lines stay in their level".to_owned(),
            |up| format!(", {up}")
        )
    ));
    let open = |name: &str| variables.open(name).map(|source| (source, 0));
    Ok(Components {
        east: open(&names.east)?,
        north: open(&names.north)?,
        up: up.map(open).transpose()?,
        names: [names.east, names.north, names.up.unwrap_or_default()],
    })
}

/// The only variable whose voxels hold three numbers.
fn vectors(
    variables: &Variables<'_>,
    first: Box<dyn Source>,
    progress: &Progress,
) -> Result<Components, Error> {
    let holds_vectors = |header: &Header| {
        let are_colors = matches!(
            header.meaning,
            ComponentKind::Rgb | ComponentKind::Channels(_)
        );
        header.components == 3 && !are_colors
    };
    let names = first.header().variables.clone();
    let mut found = Vec::new();
    if variables.input.variable.is_some() || names.len() < 2 {
        if holds_vectors(first.header()) {
            found.push(names.first().cloned().unwrap_or_default());
        }
    } else {
        for name in names.iter().take(64) {
            if holds_vectors(variables.open(name)?.header()) {
                found.push(name.clone());
            }
        }
    }
    let path = variables.input.path.clone().unwrap_or_default();
    let wanted =
        "wanted U and V, u and v, their standard names, or one volume of three numbers a voxel";
    let [name] = found.as_slice() else {
        let there = match (found.as_slice(), names.as_slice()) {
            ([], []) => format!("found {} numbers a voxel", first.header().components),
            ([], names) => format!("found {}", names.join(", ")),
            (several, _) => format!("found {} of three numbers", several.join(", ")),
        };
        return Err(Error::usage(
            format!("--flow: no wind in {path}: {wanted}, {there}"),
            "--wind U,V,W names its variables, --variable a volume of three numbers",
        ));
    };
    let open = |component: u32| {
        let source = match name.is_empty() {
            true => variables.input.open(&variables.limits)?,
            false => variables.open(name)?,
        };
        Ok::<_, Error>((source, component))
    };
    let shown = if name.is_empty() { "the volume" } else { name };
    progress.note(&format!("the wind is the three numbers of {shown}"));
    Ok(Components {
        east: open(0)?,
        north: open(1)?,
        up: Some(open(2)?),
        names: [name.clone(), name.clone(), name.clone()],
    })
}

/// North lies on the grid of east; up on the same columns.
fn check_grids(components: &Components, east: &Header) -> Result<(), Error> {
    let size = |header: &Header| {
        let [x, y, z] = header.dims;
        format!("{x}x{y}x{z}")
    };
    let wanted = grid_of(east);
    let others = [Some(&components.north), components.up.as_ref()];
    for (k, other) in others.into_iter().enumerate() {
        let Some((source, _)) = other else { continue };
        let header = source.header();
        let mut found = grid_of(header);
        let is_up = k == 1;
        if is_up {
            // Winds between levels have levels of their own, and are brought to those of the others.
            let [here, there] = [&mut found.world_from_voxel, &mut {
                wanted.world_from_voxel
            }];
            here.matrix3.z_axis = there.matrix3.z_axis;
            here.translation.z = there.translation.z;
            found.dims[2] = wanted.dims[2];
        }
        if !is_same_grid(&wanted, &found) || header.times != east.times {
            let [east_name, ..] = &components.names;
            return Err(Error::usage(
                format!(
                    "--flow: {east_name} is {}, {} {} on another grid",
                    size(east),
                    components.names[k + 1],
                    size(header)
                ),
                "--wind U,V[,W|none] names variables of one grid",
            ));
        }
    }
    Ok(())
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
    let is_in_pressures = units[2].kind == Vertical::Pascals;
    if components.up.is_some() && is_in_pressures && !header.heights_are_pressures {
        progress.note("levels are no pressures: without an upward wind lines stay in their level");
        units[2].kind = Vertical::Metres;
        return Ok((units, false));
    }
    Ok((units, components.up.is_some()))
}

/// The times that are read, and their seconds since the first of the file.
fn times(
    variables: &Variables<'_>,
    header: &Header,
    all: bool,
    progress: &Progress,
) -> Result<Vec<(u32, f64)>, Error> {
    let seconds = seconds_since_first(&header.time_names);
    if !all {
        let (time, note) = variables.input.time(header)?;
        note.iter().for_each(|note| progress.note(note));
        return Ok(vec![(time, 0.0)]);
    }
    if header.times < 2 {
        return Err(Error::usage(
            "--flow path: the input has one time",
            "--flow stream",
        ));
    }
    let seconds = seconds.filter(|seconds| {
        seconds.len() == header.times as usize && seconds.is_sorted_by(|a, b| a < b)
    });
    let seconds = seconds.ok_or_else(|| {
        Error::usage(
            "--flow path: the times of the input have no dates that grow",
            "--flow stream",
        )
    })?;
    Ok((0..header.times).zip(seconds).collect())
}
