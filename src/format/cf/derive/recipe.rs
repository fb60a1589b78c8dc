//! What a derived variable is made of, and how.
//!
//! ```text
//! temperature         air_temperature, else air_potential_temperature and pressure
//! pressure            air_pressure; P + PB
//! wind_speed          u, v, and w where it is in m/s
//! relative_humidity   relative_humidity, else temperature (or potential temperature), pressure and vapour
//! ```
//!
//! Where no variable is the pressure, that of the levels is taken.

use super::super::choose::drawable;
use super::super::model::{Arrays, Variable};
use super::formula::Formula;
use super::parts::{Origin, Part, Parts};
use crate::format::problem::invalid;
use crate::volume::{DerivedVariable, Header, Problem, Rescale, VolumeSelection, VoxelType};

/// Names of derived variables.
const NAMES: [&str; 4] = ["temperature", "pressure", "wind_speed", "relative_humidity"];

/// A derived variable of a file.
#[derive(Debug)]
pub(in super::super) struct Recipe<'a> {
    /// As it was asked for, with its group and indices.
    asked: String,
    /// `[DIMENSION=INDEX,...]` of it, or nothing.
    indices: String,
    what: What,
    pub(super) formula: Formula,
    pub(super) arguments: Vec<Part<'a>>,
}

/// One of [`NAMES`], with what a file would say of it.
#[derive(Clone, Copy, Debug)]
struct What {
    name: &'static str,
    unit: &'static str,
    /// CF's; none where its definition is another.
    standard_name: Option<&'static str>,
    long_name: &'static str,
}

/// The recipe of what `wanted` names; `None` where that is no derived variable, or one of the file's own.
///
/// # Errors
/// Where a part is missing, or has a unit that it cannot have.
pub(in super::super) fn recipe<'a>(
    arrays: &'a dyn Arrays,
    wanted: &VolumeSelection,
) -> Result<Option<Recipe<'a>>, Problem> {
    let Some(asked) = &wanted.variable else {
        return Ok(None);
    };
    let (path, indices) = asked
        .find('[')
        .map_or((asked.as_str(), ""), |at| asked.split_at(at));
    let path = path.trim().trim_start_matches('/');
    if arrays
        .variables()
        .iter()
        .any(|variable| variable.name == path)
    {
        return Ok(None);
    }
    let (group, name) = path.split_at(path.rfind('/').map_or(0, |at| at.saturating_add(1)));
    let Some(name) = NAMES.into_iter().find(|known| *known == name) else {
        return Ok(None);
    };
    let parts = Parts::of(arrays, group);
    let lacking = |wanted: &str| {
        let field = format!("variable {name}");
        invalid(arrays.format(), &field, wanted, &parts.names())
    };
    let (what, formula, arguments) = made(name, &parts)?.map_err(lacking)?;
    Ok(Some(Recipe {
        asked: asked.clone(),
        indices: indices.to_owned(),
        what,
        formula,
        arguments,
    }))
}

/// The derived variables that the file has all parts of and not by itself.
pub(in super::super) fn available(arrays: &dyn Arrays) -> Vec<DerivedVariable> {
    let mut groups: Vec<&str> = Vec::new();
    for variable in drawable(arrays) {
        if !groups.contains(&variable.group()) {
            groups.push(variable.group());
        }
    }
    let all = groups
        .iter()
        .flat_map(|group| NAMES.map(|name| format!("{group}{name}")));
    all.filter_map(|name| {
        let wanted = VolumeSelection {
            variable: Some(name.clone()),
            ..VolumeSelection::default()
        };
        let recipe = recipe(arrays, &wanted).ok()??;
        Some(DerivedVariable {
            name,
            unit: recipe.what.unit.to_owned(),
            from: recipe.parts(),
        })
    })
    .collect()
}

type Made<'a> = (What, Formula, Vec<Part<'a>>);
/// How a variable is made, or what is wanted of a file that lacks a part.
type Outcome<'a> = Result<Result<Made<'a>, &'static str>, Problem>;

fn made<'a>(name: &str, parts: &Parts<'a>) -> Outcome<'a> {
    match name {
        "temperature" => temperature(parts),
        "pressure" => pressure(parts),
        "wind_speed" => wind_speed(parts),
        _ => humidity(parts),
    }
}

fn temperature<'a>(parts: &Parts<'a>) -> Outcome<'a> {
    let what = What {
        name: "temperature",
        unit: "K",
        standard_name: Some("air_temperature"),
        long_name: "Temperature",
    };
    if let Some(part) = parts.temperature()? {
        return Ok(Ok((what, Formula::Same, vec![part])));
    }
    let Some(theta) = parts.potential_temperature()? else {
        return Ok(Err(
            "air_temperature, or air_potential_temperature and air_pressure (T, P and PB of WRF)",
        ));
    };
    Ok(match pressure_beside(parts, &theta)? {
        Some(pressure) => Ok((what, Formula::Temperature, vec![theta, pressure])),
        None => Err("air_pressure beside the potential temperature (P and PB of WRF)"),
    })
}

/// A variable, or that of the levels of another part.
fn pressure_beside<'a>(parts: &Parts<'a>, beside: &Part<'a>) -> Result<Option<Part<'a>>, Problem> {
    let levels = || parts.pressure_of_levels(beside);
    Ok(parts.pressure()?.or_else(levels))
}

fn pressure<'a>(parts: &Parts<'a>) -> Outcome<'a> {
    let what = What {
        name: "pressure",
        unit: "Pa",
        standard_name: Some("air_pressure"),
        long_name: "Pressure",
    };
    Ok(match parts.pressure()? {
        Some(part) => Ok((what, Formula::Same, vec![part])),
        None => Err("air_pressure (P and PB of WRF)"),
    })
}

fn wind_speed<'a>(parts: &Parts<'a>) -> Outcome<'a> {
    let Some([east, north]) = parts.horizontal_wind()? else {
        return Ok(Err("eastward_wind and northward_wind (or u, v)"));
    };
    let up = parts.upward_wind(&east);
    let what = What {
        name: "wind_speed",
        unit: "m s-1",
        // CF's wind_speed has no vertical part.
        standard_name: up.is_none().then_some("wind_speed"),
        long_name: match up {
            Some(_) => "Wind speed",
            None => "Horizontal wind speed",
        },
    };
    let components = [east, north].into_iter().chain(up).collect();
    Ok(Ok((what, Formula::Speed, components)))
}

fn humidity<'a>(parts: &Parts<'a>) -> Outcome<'a> {
    let what = What {
        name: "relative_humidity",
        unit: "%",
        standard_name: Some("relative_humidity"),
        long_name: "Relative humidity",
    };
    if let Some(part) = parts.relative_humidity()? {
        return Ok(Ok((what, Formula::Same, vec![part])));
    }
    let (vapour, is_specific) = match parts.mixing_ratio()? {
        Some(part) => (part, false),
        None => match parts.specific_humidity()? {
            Some(part) => (part, true),
            None => {
                return Ok(Err(
                    "relative_humidity, or specific_humidity or humidity_mixing_ratio (QVAPOR of WRF)",
                ));
            }
        },
    };
    let (warmth, is_potential) = match parts.temperature()? {
        Some(part) => (part, false),
        None => match parts.potential_temperature()? {
            Some(part) => (part, true),
            None => {
                return Ok(Err(
                    "air_temperature or air_potential_temperature beside the vapour (T of WRF)",
                ));
            }
        },
    };
    let formula = Formula::Humidity {
        is_potential,
        is_specific,
    };
    Ok(match pressure_beside(parts, &warmth)? {
        Some(pressure) => Ok((what, formula, vec![warmth, pressure, vapour])),
        None => Err("air_pressure beside temperature and vapour (P and PB of WRF)"),
    })
}

impl<'a> Recipe<'a> {
    /// The variable that says where voxels lie.
    pub(in super::super) fn reference(&self) -> Option<&'a Variable> {
        self.arguments.iter().find_map(Part::variable)
    }

    /// What opens a variable of the file as this one was asked for.
    pub(in super::super) fn selection(&self, variable: &Variable) -> VolumeSelection {
        VolumeSelection {
            variable: Some(format!("{}{}", variable.name, self.indices)),
            ..VolumeSelection::default()
        }
    }

    /// Names of its parts.
    fn parts(&self) -> Vec<String> {
        let terms = self.arguments.iter().flat_map(|part| &part.terms);
        terms.map(|(from, _)| Origin::name(from)).collect()
    }

    /// What the header of its reference becomes.
    pub(in super::super) fn header(&self, reference: &Header) -> Header {
        let What {
            name,
            unit,
            standard_name,
            long_name,
        } = self.what;
        let mut variables = reference.variables.clone();
        if let (Some(first), Some(variable)) = (variables.first_mut(), self.reference()) {
            first.clone_from(&variable.name);
        }
        variables.insert(0, self.asked.clone());
        let mut notes = reference.notes.clone();
        let arguments: Vec<String> = self.arguments.iter().map(Part::words).collect();
        let words = self.formula.words(&arguments);
        notes.push(format!("{name} is derived: {words}"));
        Header {
            stored: VoxelType::F32,
            rescale: Rescale::default(),
            fill: None,
            is_labels: false,
            unit: Some(unit.to_owned()),
            standard_name: standard_name.map(str::to_owned),
            long_name: Some(long_name.to_owned()),
            variables,
            notes,
            ..reference.clone()
        }
    }
}
