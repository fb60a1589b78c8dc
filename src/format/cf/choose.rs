//! Which variable of a file is drawn: `NAME`, or `NAME[DIMENSION=INDEX,...]` where it has axes beside time and
//! space, such as the members of an ensemble; without an index the first is taken.

use super::axes::{Axis, axes_of, says_place};
use super::grid::Role;
use super::model::{Arrays, Kind, Variable};
use crate::format::problem::{escape, invalid};
use crate::volume::{Problem, VolumeSelection};

/// A variable and the role of each of its dimensions.
pub(super) struct Choice {
    pub variable: Variable,
    pub roles: Vec<Role>,
    /// Names of all that can be drawn, this one first, as it was asked for.
    pub names: Vec<String>,
    /// Their standard names, empty where there are none.
    pub standard_names: Vec<String>,
    pub notes: Vec<String>,
}

/// More names help nobody.
const MAX_NAMES: usize = 1000;

pub(super) fn choose(arrays: &dyn Arrays, wanted: &VolumeSelection) -> Result<Choice, Problem> {
    let format = arrays.format();
    let mut drawable = drawable(arrays);
    let (variable, indices, asked) = match &wanted.variable {
        None => {
            let first = drawable.first().copied().ok_or_else(|| {
                let wanted = "numbers along at least two axes of space";
                invalid(format, "variables", wanted, "none that have them")
            })?;
            (first, Vec::new(), first.name.clone())
        }
        Some(asked) => {
            let (name, indices) = parse(asked).ok_or_else(|| {
                let wanted = "NAME or NAME[DIMENSION=INDEX]";
                invalid(format, "variable", wanted, asked)
            })?;
            let plain = name.trim_start_matches('/');
            let found = arrays.variables().iter().find(|other| other.name == plain);
            let found = found.ok_or_else(|| {
                let there: Vec<&str> = drawable.iter().map(|other| other.name.as_str()).collect();
                let wanted = format!("one of {}", escape(&there.join(", ")));
                invalid(format, "variable", wanted, name)
            })?;
            (found, indices, asked.clone())
        }
    };
    let mut notes = Vec::new();
    let roles = roles(arrays, variable, &indices, &mut notes)?;
    drawable.retain(|other| other.name != variable.name);
    let others = || drawable.iter().copied().take(MAX_NAMES);
    let names = std::iter::once(asked)
        .chain(others().map(|other| other.name.clone()))
        .collect();
    let standard = |other: &Variable| {
        let name = other.attributes.text("standard_name");
        name.unwrap_or_default().to_owned()
    };
    let standard_names = std::iter::once(variable)
        .chain(others())
        .map(standard)
        .collect();
    Ok(Choice {
        variable: variable.clone(),
        roles,
        names,
        standard_names,
        notes,
    })
}

/// Variables that a picture can show, those with height first, and last what only says where others lie.
pub(super) fn drawable(arrays: &dyn Arrays) -> Vec<&Variable> {
    let helpers = helpers(arrays);
    let mut ranked: Vec<(usize, &Variable)> = arrays
        .variables()
        .iter()
        .filter(|variable| {
            matches!(variable.kind, Kind::Numbers(_)) && !helpers.contains(&variable.name.as_str())
        })
        .map(|variable| (space_axes(arrays, variable), variable))
        .filter(|&(axes, _)| axes >= 2)
        .collect();
    // A stable sort keeps the file's order.
    ranked.sort_by_key(|&(axes, variable)| (says_place(variable), std::cmp::Reverse(axes)));
    ranked.into_iter().map(|(_, variable)| variable).collect()
}

/// How many axes of space have more than one point.
fn space_axes(arrays: &dyn Arrays, variable: &Variable) -> usize {
    if variable
        .dimensions
        .iter()
        .any(|dimension| dimension.size == 0)
    {
        return 0;
    }
    let axes = axes_of(arrays, variable);
    let sizes = variable.dimensions.iter().map(|dimension| dimension.size);
    axes.into_iter()
        .zip(sizes)
        .filter(|&(axis, size)| matches!(axis, Axis::X | Axis::Y | Axis::Z) && size > 1)
        .count()
}

/// Names of variables that only say where others lie: bounds of cells, coordinates in two dimensions.
fn helpers(arrays: &dyn Arrays) -> Vec<&str> {
    let named = |variable| {
        let lists = ["bounds", "climatology", "coordinates"];
        lists
            .into_iter()
            .flat_map(move |list| words(variable, list))
    };
    arrays.variables().iter().flat_map(named).collect()
}

/// The words of an attribute that lists names.
fn words<'a>(variable: &'a Variable, name: &str) -> Vec<&'a str> {
    let text = variable.attributes.text(name).unwrap_or("");
    text.split_whitespace().collect()
}

/// `NAME[a=1,b=2]`, taken apart.
fn parse(text: &str) -> Option<(&str, Vec<(&str, u64)>)> {
    let Some((name, rest)) = text.split_once('[') else {
        return Some((text, Vec::new()));
    };
    let pairs = rest.strip_suffix(']')?.split(',');
    let pairs = pairs.map(|pair| {
        let (dimension, index) = pair.split_once('=')?;
        Some((dimension.trim(), index.trim().parse().ok()?))
    });
    Some((name.trim_end(), pairs.collect::<Option<_>>()?))
}

fn roles(
    arrays: &dyn Arrays,
    variable: &Variable,
    indices: &[(&str, u64)],
    notes: &mut Vec<String>,
) -> Result<Vec<Role>, Problem> {
    let format = arrays.format();
    if let Some(empty) = variable
        .dimensions
        .iter()
        .find(|dimension| dimension.size == 0)
    {
        let field = format!("dimension {}", empty.name);
        return Err(invalid(format, &field, "at least one point", "0"));
    }
    if space_axes(arrays, variable) < 2 {
        let wanted = "a variable with at least two axes of space";
        return Err(invalid(format, "variable", wanted, &variable.name));
    }
    let axes = axes_of(arrays, variable);
    let is_there = |name: &str| {
        let pairs = variable.dimensions.iter().zip(&axes);
        pairs
            .into_iter()
            .any(|(d, axis)| d.name == name && *axis == Axis::Other)
    };
    if let Some((name, _)) = indices.iter().find(|(name, _)| !is_there(name)) {
        let wanted = "a dimension of the variable beside time and space";
        return Err(invalid(format, "variable", wanted, name));
    }
    let mut roles = Vec::new();
    for (dimension, axis) in variable.dimensions.iter().zip(&axes) {
        roles.push(match axis {
            Axis::X => Role::Space(0),
            Axis::Y => Role::Space(1),
            Axis::Z => Role::Space(2),
            Axis::Time => Role::Time,
            Axis::Other => {
                let chosen = indices.iter().find(|(name, _)| *name == dimension.name);
                let index = chosen.map_or(0, |&(_, index)| index);
                if index >= dimension.size {
                    let field = format!("dimension {}", dimension.name);
                    let wanted = format!("an index below {}", dimension.size);
                    return Err(invalid(format, &field, wanted, &index.to_string()));
                }
                if chosen.is_none() && dimension.size > 1 {
                    let (name, dimension_name) = (escape(&variable.name), escape(&dimension.name));
                    notes.push(format!(
                        "of {} along `{dimension_name}` the first is taken; --variable \"{name}[{dimension_name}=1]\" takes another",
                        dimension.size
                    ));
                }
                Role::Fixed(index)
            }
        });
    }
    Ok(roles)
}
