//! Which dimension of a variable runs east, north, up or through time.
//!
//! CF Conventions 4: by the coordinate variable's `axis`, its `standard_name`, its units (`degrees_east`, a
//! pressure, `... since ...`) or `positive`; where there is none of these by the names that models use.

use super::model::{Arrays, Kind, Variable};
use super::units::{Measure, is_east, is_north, measure};

/// What a dimension is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Axis {
    X,
    Y,
    Z,
    Time,
    /// Members of an ensemble, wave lengths and the like.
    Other,
}

/// The coordinate variable of a dimension: of its name, along it alone, in the variable's group or above.
pub(super) fn coordinate<'a>(
    arrays: &'a dyn Arrays,
    variable: &Variable,
    dimension: &str,
) -> Option<&'a Variable> {
    in_scope(arrays, variable, dimension).find(|other| {
        matches!(other.dimensions.as_slice(), [only] if only.name == dimension)
            && matches!(other.kind, Kind::Numbers(_))
    })
}

/// Variables of a name in the group of `variable`, then in those above it.
pub(super) fn in_scope<'a>(
    arrays: &'a dyn Arrays,
    variable: &Variable,
    name: &str,
) -> impl Iterator<Item = &'a Variable> {
    let mut group = variable.group().to_owned();
    let mut names = vec![format!("{group}{name}")];
    while !group.is_empty() {
        let parent = group.trim_end_matches('/').rfind('/');
        group.truncate(parent.map_or(0, |at| at.saturating_add(1)));
        names.push(format!("{group}{name}"));
    }
    names.into_iter().filter_map(|name| {
        let all = arrays.variables().iter();
        all.into_iter().find(|other| other.name == name)
    })
}

/// The axis of each dimension of `variable`.
pub(super) fn axes_of(arrays: &dyn Arrays, variable: &Variable) -> Vec<Axis> {
    let mut told: Vec<Option<Axis>> = variable
        .dimensions
        .iter()
        .map(|dimension| {
            coordinate(arrays, variable, &dimension.name)
                .and_then(by_attributes)
                .or_else(|| by_name(&dimension.name))
        })
        .collect();
    // When a forecast began is its time only where no other dimension is the time.
    let is_start: Vec<bool> = variable
        .dimensions
        .iter()
        .map(|dimension| {
            coordinate(arrays, variable, &dimension.name).is_some_and(is_start_of_forecast)
        })
        .collect();
    let mut pairs = told.iter().zip(&is_start);
    if pairs.any(|(axis, is_start)| *axis == Some(Axis::Time) && !is_start) {
        for (axis, _) in told.iter_mut().zip(&is_start).filter(|(_, start)| **start) {
            *axis = Some(Axis::Other);
        }
    }
    let mut axes: Vec<Option<Axis>> = Vec::new();
    for axis in &told {
        // Two dimensions cannot both run east: the first of them does.
        let is_new = axis.is_some_and(|axis| axis == Axis::Other || !axes.contains(&Some(axis)));
        axes.push(axis.filter(|_| is_new).or(axis.map(|_| Axis::Other)));
    }
    let is_known = |axes: &[Option<Axis>], axis| axes.contains(&Some(axis));
    let nothing_is_known = ![Axis::X, Axis::Y, Axis::Z]
        .into_iter()
        .any(|axis| is_known(&axes, axis));
    // Dimensions without a word run x, y, z from the fastest, as CF recommends. Behind known ones z must be told:
    // it could as well be a member of an ensemble.
    let mut free = vec![Axis::X, Axis::Y];
    if nothing_is_known {
        free.push(Axis::Z);
    }
    let mut free = free
        .into_iter()
        .filter(|&axis| !is_known(&axes, axis))
        .collect::<Vec<_>>()
        .into_iter();
    for axis in axes.iter_mut().rev().filter(|axis| axis.is_none()) {
        *axis = Some(free.next().unwrap_or(Axis::Other));
    }
    axes.into_iter()
        .map(|axis| axis.unwrap_or(Axis::Other))
        .collect()
}

fn is_start_of_forecast(coordinate: &Variable) -> bool {
    coordinate.attributes.text("standard_name") == Some("forecast_reference_time")
}

fn by_attributes(coordinate: &Variable) -> Option<Axis> {
    let attributes = &coordinate.attributes;
    match attributes
        .text("axis")
        .map(str::to_ascii_uppercase)
        .as_deref()
    {
        Some("X") => return Some(Axis::X),
        Some("Y") => return Some(Axis::Y),
        Some("Z") => return Some(Axis::Z),
        Some("T") => return Some(Axis::Time),
        _ => {}
    }
    match attributes.text("standard_name").unwrap_or("") {
        "longitude" | "grid_longitude" | "projection_x_coordinate" => return Some(Axis::X),
        "latitude" | "grid_latitude" | "projection_y_coordinate" => return Some(Axis::Y),
        "time" => return Some(Axis::Time),
        "realization" | "forecast_period" => return Some(Axis::Other),
        name if is_vertical(name) => return Some(Axis::Z),
        _ => {}
    }
    let units = attributes.text("units").unwrap_or("");
    if is_east(units) {
        Some(Axis::X)
    } else if is_north(units) {
        Some(Axis::Y)
    } else if units.contains(" since ") {
        Some(Axis::Time)
    } else if attributes.text("positive").is_some()
        || matches!(measure(units), Measure::Pressure(_) | Measure::Geopotential)
    {
        Some(Axis::Z)
    } else {
        None
    }
}

/// True for a variable that says where others lie, whatever its shape: longitudes of a curved grid, heights of levels.
pub(super) fn says_place(variable: &Variable) -> bool {
    let standard_name = variable.attributes.text("standard_name").unwrap_or("");
    let axis = by_attributes(variable);
    is_vertical(standard_name) || matches!(axis, Some(Axis::X | Axis::Y | Axis::Time))
}

/// Standard names of vertical coordinates, CF Conventions 4.3 and appendix D.
fn is_vertical(standard_name: &str) -> bool {
    matches!(
        standard_name,
        "air_pressure"
            | "height"
            | "altitude"
            | "depth"
            | "geopotential_height"
            | "geopotential"
            | "model_level_number"
            | "height_above_mean_sea_level"
            | "height_above_reference_ellipsoid"
    ) || standard_name.starts_with("atmosphere_") && standard_name.ends_with("_coordinate")
        || standard_name.starts_with("ocean_")
}

fn by_name(dimension: &str) -> Option<Axis> {
    let name = dimension.to_ascii_lowercase();
    let name = name.strip_suffix("_stag").unwrap_or(&name);
    Some(match name {
        "x" | "lon" | "lons" | "longitude" | "west_east" | "xc" | "nx" | "ni" | "rlon"
        | "xt_ocean" | "i" => Axis::X,
        "y" | "lat" | "lats" | "latitude" | "south_north" | "yc" | "ny" | "nj" | "rlat"
        | "yt_ocean" | "j" => Axis::Y,
        "z" | "lev" | "level" | "levels" | "plev" | "height" | "altitude" | "alt" | "depth"
        | "deptht" | "bottom_top" | "hybrid" | "isobaric" | "isobaricinhpa" | "pressure"
        | "pressure_level" | "model_level" | "nz" | "zt_ocean" | "k" | "sigma" | "eta" | "nlev"
        | "st_ocean" => Axis::Z,
        "time" | "t" | "times" | "valid_time" | "nt" => Axis::Time,
        "number" | "member" | "members" | "ens" | "ensemble" | "realization" | "step" | "band"
        | "bands" | "wavelength" | "channel" | "component" => Axis::Other,
        _ => return None,
    })
}
