//! Which variables of the input are the components of the wind, and whether they lie on one grid.
//!
//! ```text
//! --wind U,V,W  >  standard names  >  names  >  the only volume of three numbers a voxel
//! ```

use super::super::{Error, progress::Progress};
use super::flags::WindWords;
use super::variable::Variables;
use crate::flow::wind::WindNames;
use crate::volume::{ComponentKind, Grid, Header, MapKind, Reduced, Source, is_same_grid};

/// What the three components are read from, with the number of the component.
pub(super) struct Components {
    pub east: (Box<dyn Source>, u32),
    pub north: (Box<dyn Source>, u32),
    pub up: Option<(Box<dyn Source>, u32)>,
    pub names: [String; 3],
}

impl Components {
    /// The same with means of blocks of so many voxels a side.
    pub(super) fn reduced(self, factor: u32) -> Self {
        if factor == 1 {
            return self;
        }
        let reduced = |(source, component): (Box<dyn Source>, u32)| -> (Box<dyn Source>, u32) {
            (
                Box::new(Reduced::new(source, factor, SLAB_BYTES)),
                component,
            )
        };
        Self {
            east: reduced(self.east),
            north: reduced(self.north),
            up: self.up.map(reduced),
            names: self.names,
        }
    }
}

/// Of a source that is reduced, in memory at once.
const SLAB_BYTES: u64 = 16 << 20;

/// Where the voxels of a header lie.
pub(super) fn grid_of(header: &Header) -> Grid {
    Grid {
        dims: header.dims,
        world_from_voxel: header.world_from_voxel,
    }
}

/// The components that the words name, or those that the file calls a wind.
pub(super) fn components(
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
            // What goes up beside another pair is not known to go with this one.
            up: match &words.up {
                Some(up) => up.clone(),
                None => found
                    .filter(|found| [&found.east, &found.north] == [&words.east, &words.north])
                    .and_then(|found| found.up),
            },
        },
        None => match found.filter(|_| variables.input.variable.is_none()) {
            Some(found) => found,
            None => return vectors(variables, first, progress),
        },
    };
    check_along_rows(&names, header)?;
    let up = names.up.as_deref();
    for name in [Some(names.east.as_str()), Some(names.north.as_str()), up] {
        check_there(name.unwrap_or_default(), header)?;
    }
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

/// Refuses components along parallels and meridians of the Earth where those of the grid are others.
fn check_along_rows(names: &WindNames, header: &Header) -> Result<(), Error> {
    let is_turned = header
        .map
        .is_some_and(|map| matches!(map.kind, MapKind::LatitudeLongitude | MapKind::Curvilinear));
    let mut all = header.variables.iter().zip(&header.variable_standard_names);
    let is_of_earth = |name: &str| name.starts_with("eastward_") || name.starts_with("northward_");
    let found = all.find(|(name, standard)| {
        [&names.east, &names.north].contains(name) && is_of_earth(standard)
    });
    match found.filter(|_| is_turned) {
        Some((name, standard)) => Err(Error::usage(
            format!(
                "--flow: {name} is {standard}, along parallels and meridians of the Earth, and rows of the grid are others: \
                 wanted x_wind and y_wind, along its rows and columns"
            ),
            "--wind U,V[,W|none] names other variables",
        )),
        None => Ok(()),
    }
}

/// Refuses the name of a variable that the file has not.
fn check_there(name: &str, header: &Header) -> Result<(), Error> {
    // Words in brackets choose a member.
    let plain = name.split('[').next().unwrap_or_default().trim();
    let plain = plain.trim_start_matches('/');
    if plain.is_empty() || header.variables.iter().any(|other| other == plain) {
        return Ok(());
    }
    Err(Error::usage(
        format!(
            "--wind: no variable {}, there are {}",
            plain.escape_debug(),
            header.variables.join(", ")
        ),
        "--wind U,V[,W|none]",
    ))
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
pub(super) fn check_grids(components: &Components, east: &Header) -> Result<(), Error> {
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
