//! Arrays about whose axes nothing or only a name is known: the last three are z, y, x.

use super::ZARR;
use super::array::Array;
use super::json::{number, optional, wrong};
use super::ngff::Level;
use super::source::Role;
use super::tree::Tree;
use crate::format::problem::{escape, invalid, unsupported};
use crate::volume::{Format, Header, Limits, Problem, Rescale, VolumeSelection};
use glam::DAffine3;
use serde_json::Value;

/// The wanted array of a store, without a word the first.
pub(super) fn choose(
    tree: &Tree,
    wanted: &VolumeSelection,
    limits: &Limits,
) -> Result<Level, Problem> {
    let (array, names) = named(tree, wanted, limits)?;
    let roles = roles(&array);
    let header = header(&array, &roles, names)?;
    Ok(Level {
        array,
        roles,
        header,
    })
}

/// The wanted array, and the names of all that may be wanted, its own first.
fn named(
    tree: &Tree,
    wanted: &VolumeSelection,
    limits: &Limits,
) -> Result<(Array, Vec<String>), Problem> {
    let mut names = Vec::new();
    let mut first = None;
    let mut refused = None;
    for path in tree
        .nodes
        .iter()
        .filter(|(_, node)| node.is_array)
        .map(|(path, _)| path)
    {
        match tree.array(path, limits) {
            Ok(array) if is_volume(&array) => {
                names.push(path.clone());
                first = first.or(Some(array));
            }
            Ok(array) => refused = refused.or_else(|| Some(no_volume(&array))),
            Err(problem) => refused = Some(problem),
        }
    }
    let array = match &wanted.variable {
        Some(name) if tree.nodes.get(name).is_some_and(|node| node.is_array) => {
            tree.array(name, limits)?
        }
        Some(name) => {
            let wanted = format!("one of {}", names.join(", "));
            return Err(invalid(ZARR, "variable", wanted, name));
        }
        None => match first {
            Some(array) => array,
            None => {
                return Err(
                    refused.unwrap_or_else(|| unsupported(ZARR, "a store without an array"))
                );
            }
        },
    };
    names.retain(|name| *name != array.path);
    // An array that is the store itself has no name.
    if !array.path.is_empty() {
        names.insert(0, array.path.clone());
    }
    Ok((array, names))
}

/// Coordinates and single numbers are no volumes.
fn is_volume(array: &Array) -> bool {
    array.rank() >= 2 || array.path.is_empty() && array.rank() == 1
}

fn no_volume(array: &Array) -> Problem {
    let name = escape(&array.path);
    let rank = array.rank();
    unsupported(
        ZARR,
        format!("the array `{name}` of {rank} axes as a volume"),
    )
}

/// By names where they are the usual ones, and the last axes for what is left of x, y, z.
fn roles(array: &Array) -> Vec<Role> {
    let none = Vec::new();
    let names = array.dimension_names.as_ref().unwrap_or(&none);
    let mut roles: Vec<Option<Role>> = vec![None; array.rank()];
    for (role, name) in roles.iter_mut().zip(names) {
        *role = match name.to_ascii_lowercase().as_str() {
            "x" => Some(Role::Space(0)),
            "y" => Some(Role::Space(1)),
            "z" => Some(Role::Space(2)),
            "t" | "time" => Some(Role::Time),
            "c" | "channel" => Some(Role::Component),
            _ => None,
        };
    }
    // A name that stands twice counts for its last axis.
    for k in 0..roles.len() {
        let twice = roles
            .get(k)
            .copied()
            .flatten()
            .filter(|role| *role != Role::Component);
        let later = roles.get(k.saturating_add(1)..).unwrap_or(&[]);
        if twice.is_some()
            && later.contains(&twice)
            && let Some(role) = roles.get_mut(k)
        {
            *role = Some(Role::Component);
        }
    }
    for space in (0..3).map(Role::Space) {
        if !roles.contains(&Some(space)) {
            let free = roles.iter_mut().rev().find(|role| role.is_none());
            if let Some(role) = free {
                *role = Some(space);
            }
        }
    }
    let others = roles
        .into_iter()
        .map(|role| role.unwrap_or(Role::Component));
    others.collect()
}

fn header(array: &Array, roles: &[Role], variables: Vec<String>) -> Result<Header, Problem> {
    let Sizes {
        dims,
        times,
        components,
    } = sizes(array, roles)?;
    let mut notes = Vec::new();
    let names = array.dimension_names.as_ref();
    let unnamed = roles
        .iter()
        .enumerate()
        .filter(|(_, role)| **role == Role::Component);
    for (k, _) in unnamed {
        let name = names
            .and_then(|names| names.get(k))
            .filter(|name| !name.is_empty());
        let name = name.map_or(format!("axis {k}"), |name| {
            format!("axis `{}`", escape(name))
        });
        let size = array.shape.get(k).copied().unwrap_or(1);
        if size > 1 {
            notes.push(format!(
                "the {size} places of {name} are the components of a voxel"
            ));
        }
    }
    Ok(Header {
        times,
        components,
        rescale: rescale(array)?,
        fill: fill(array),
        unit: optional(&array.attributes, "units")
            .and_then(Value::as_str)
            .map(escape),
        variables,
        notes,
        ..Header::new(Format::Zarr, dims, array.stored, DAffine3::IDENTITY)
    })
}

/// Packed numbers, CF Conventions 8.1: value = stored * scale_factor + add_offset.
fn rescale(array: &Array) -> Result<Rescale, Problem> {
    let factor = |field: &str, usual: f64| match optional(&array.attributes, field) {
        None => Ok(usual),
        Some(value) => number(value)
            .filter(|number| number.is_finite() && (number.is_normal() || field == "add_offset"))
            .ok_or_else(|| wrong(field, "a finite number that scales", value)),
    };
    Ok(Rescale {
        slope: factor("scale_factor", 1.0)?,
        intercept: factor("add_offset", 0.0)?,
    })
}

/// The number that means "no data". Where xarray writes version 2, the fill value of the array is it.
fn fill(array: &Array) -> Option<f64> {
    let mut named = ["_FillValue", "missing_value"].iter();
    let named = named.find_map(|field| number(array.attributes.get(*field)?));
    let is_of_xarray = array.attributes.contains_key("_ARRAY_DIMENSIONS");
    named
        .or_else(|| (is_of_xarray && array.fill.is_given).then_some(array.fill.number))
        .filter(|number| number.is_finite())
}

/// What a header says about the sides of an array.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sizes {
    pub dims: [u32; 3],
    pub times: u32,
    pub components: u32,
}

/// The sides along x, y, z, the times and the components.
pub(super) fn sizes(array: &Array, roles: &[Role]) -> Result<Sizes, Problem> {
    let mut sizes = Sizes {
        dims: [1; 3],
        times: 1,
        components: 1,
    };
    let too_many = || {
        let found = format!("{:?}", array.shape);
        invalid(
            ZARR,
            "shape",
            "at most 2^32 - 1 times and components",
            &found,
        )
    };
    for (role, &side) in roles.iter().zip(&array.shape) {
        let side = u32::try_from(side)
            .map_err(|_| invalid(ZARR, "shape", "axes of at most 2^32 - 1", &side.to_string()))?;
        match role {
            Role::Space(k) => {
                if let Some(place) = sizes.dims.get_mut(*k) {
                    *place = side;
                }
            }
            Role::Time => sizes.times = sizes.times.checked_mul(side).ok_or_else(too_many)?,
            Role::Component => {
                sizes.components = sizes.components.checked_mul(side).ok_or_else(too_many)?;
            }
        }
    }
    Ok(sizes)
}
