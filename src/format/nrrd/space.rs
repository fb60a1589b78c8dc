//! Where a NRRD lies: `space`, `space directions`, `space origin`, or `spacings` and `axis mins` alone.
//!
//! `space origin` is the centre of the first sample, `space directions` are the steps between centres
//! (definition, section 4). `axis mins` is the edge of the first cell of a cell-centred axis, and the first
//! sample of a node-centred one (section 6); an axis without `centerings` is cell-centred, as in Teem.

use super::NRRD;
use super::array::Array;
use super::fields::Fields;
use crate::format::geometry::{RAS_FROM_LPS, with_missing_axes, world_from_voxel};
use crate::format::problem::{escape, invalid, unsupported};
use crate::format::select::Role;
use crate::format::text::{integers, number, numbers};
use crate::volume::Problem;
use glam::{DAffine3, DVec3};

/// Voxel space to world, RAS+, and what should be said about it.
#[allow(
    clippy::arithmetic_side_effects,
    reason = "vectors of f64: nothing wraps or panics"
)]
pub(super) fn affine(
    fields: &Fields,
    array: &Array,
    notes: &mut Vec<String>,
) -> Result<DAffine3, Problem> {
    let ras_from_space = ras_from_space(fields, notes)?;
    let (field, columns, origin) = match vectors(fields, "space directions")? {
        Some(directions) if directions.iter().any(Option::is_some) => {
            let steps = directions
                .iter()
                .zip(&array.axes)
                .filter(|(_, axis)| matches!(axis.role, Role::Space(_)))
                .filter_map(|(vector, _)| vector.as_deref().map(in_space))
                .collect();
            ("space directions", steps, origin(fields)?)
        }
        _ => {
            let (steps, first) = along_axes(fields, array, notes)?;
            let origin = match fields.get("space origin") {
                Some(_) => origin(fields)?,
                None => first,
            };
            ("spacings", steps, origin)
        }
    };
    note_units(fields, notes);
    let columns: Vec<DVec3> = columns.iter().map(|c| *c * ras_from_space).collect();
    world_from_voxel(with_missing_axes(&columns), origin * ras_from_space).ok_or_else(|| {
        let text = fields.get(field).unwrap_or("");
        let wanted = "finite steps and origin that span a volume";
        invalid(NRRD, field, wanted, text)
    })
}

/// A space without what may be written in several ways.
fn words_of(space: &str) -> String {
    space.replace(['-', ' '], "").to_ascii_lowercase()
}

/// What multiplies coordinates of the file's space to make RAS+ ones.
fn ras_from_space(fields: &Fields, notes: &mut Vec<String>) -> Result<DVec3, Problem> {
    let Some(space) = fields.get("space") else {
        notes.push("the file names no space: its axes are taken as RAS+ as they stand".to_owned());
        return Ok(DVec3::ONE);
    };
    if fields.get("space dimension").is_some() {
        let wanted = "`space` or `space dimension`, not both";
        return Err(invalid(NRRD, "space", wanted, space));
    }
    let words = words_of(space);
    let words = words.strip_suffix("time").unwrap_or(&words);
    let handed = |turned: &str| {
        format!(
            "space `{}` names no anatomical directions: its axes are taken as RAS+{turned}",
            escape(space)
        )
    };
    Ok(match words {
        "rightanteriorsuperior" | "ras" | "rast" => DVec3::ONE,
        "leftanteriorsuperior" | "las" | "last" => DVec3::new(-1.0, 1.0, 1.0),
        "leftposteriorsuperior" | "lps" | "lpst" => RAS_FROM_LPS,
        "scannerxyz" | "scannerxyzt" | "3drighthanded" => {
            notes.push(handed(" as they stand"));
            DVec3::ONE
        }
        "3dlefthanded" => {
            // As it stands it would be drawn as its mirror image.
            notes.push(handed(
                " with the third one turned round, because the world is right-handed",
            ));
            DVec3::new(1.0, 1.0, -1.0)
        }
        "rightup" | "rightdown" => return Err(unsupported(NRRD, "a space of two dimensions")),
        _ => {
            let wanted = "a space of the format, such as `left-posterior-superior`";
            return Err(invalid(NRRD, "space", wanted, space));
        }
    })
}

/// The number of coordinates of a vector in space.
fn space_dimension(fields: &Fields) -> Result<Option<usize>, Problem> {
    if let Some(space) = fields.get("space") {
        let with_time = space.to_ascii_lowercase().ends_with("time")
            || space.eq_ignore_ascii_case("scanner-xyzt")
            || ["RAST", "LAST", "LPST"]
                .iter()
                .any(|name| space.eq_ignore_ascii_case(name));
        return Ok(Some(if with_time { 4 } else { 3 }));
    }
    let Some(text) = fields.get("space dimension") else {
        return Ok(None);
    };
    integers(text)
        .and_then(|all| <[i64; 1]>::try_from(all).ok())
        .and_then(|[dimension]| usize::try_from(dimension).ok())
        .filter(|dimension| (1..=4).contains(dimension))
        .map(Some)
        .ok_or_else(|| invalid(NRRD, "space dimension", "a number from 1 to 4", text))
}

/// The vectors of a field, `None` for `none`: `(1,0,0) none (0,2,0)`.
pub(super) fn vectors(
    fields: &Fields,
    name: &str,
) -> Result<Option<Vec<Option<Vec<f64>>>>, Problem> {
    let Some(text) = fields.get(name) else {
        return Ok(None);
    };
    let dimension = space_dimension(fields)?
        .ok_or_else(|| crate::format::problem::missing(NRRD, "space` or `space dimension"))?;
    let wanted = || format!("vectors such as (1,0,0) of {dimension} finite numbers, or `none`");
    let fail = || invalid(NRRD, name, wanted(), text);
    let mut all = Vec::new();
    let mut rest = text.trim_start();
    while !rest.is_empty() {
        let vector = if let Some(tail) = rest.strip_prefix('(') {
            let (inside, tail) = tail.split_once(')').ok_or_else(fail)?;
            rest = tail;
            let numbers: Option<Vec<f64>> = inside.split(',').map(number).collect();
            let numbers = numbers.filter(|n| n.len() == dimension).ok_or_else(fail)?;
            // Some writers put NaN where `none` is meant.
            if numbers.iter().all(|x| x.is_nan()) {
                None
            } else if numbers.iter().all(|x| x.is_finite()) {
                Some(numbers)
            } else {
                return Err(fail());
            }
        } else {
            rest = rest.strip_prefix("none").ok_or_else(fail)?;
            None
        };
        all.push(vector);
        rest = rest.trim_start();
    }
    Ok(Some(all))
}

/// The first three coordinates; a fourth is time.
fn in_space(vector: &[f64]) -> DVec3 {
    let coordinate = |k| vector.get(k).copied().unwrap_or(0.0);
    DVec3::new(coordinate(0), coordinate(1), coordinate(2))
}

fn origin(fields: &Fields) -> Result<DVec3, Problem> {
    match vectors(fields, "space origin")?.as_deref() {
        None => Ok(DVec3::ZERO),
        Some([Some(origin)]) => Ok(in_space(origin)),
        Some(_) => {
            let text = fields.get("space origin").unwrap_or("");
            Err(invalid(NRRD, "space origin", "one vector", text))
        }
    }
}

/// Steps along the world's own axes, and the centre of the first voxel.
#[allow(
    clippy::arithmetic_side_effects,
    reason = "vectors of f64: nothing wraps or panics"
)]
fn along_axes(
    fields: &Fields,
    array: &Array,
    notes: &mut Vec<String>,
) -> Result<(Vec<DVec3>, DVec3), Problem> {
    let per_axis = |name: &'static str| -> Result<Option<Vec<f64>>, Problem> {
        let Some(text) = fields.get(name) else {
            return Ok(None);
        };
        let wanted = || format!("{} numbers", array.axes.len());
        numbers(text)
            .filter(|all| all.len() == array.axes.len())
            .map(Some)
            .ok_or_else(|| invalid(NRRD, name, wanted(), text))
    };
    let spacings = per_axis("spacings")?;
    let mins = per_axis("axis mins")?;
    let maxs = per_axis("axis maxs")?;
    let nodes: Vec<bool> = fields
        .get("centerings")
        .unwrap_or("")
        .split_ascii_whitespace()
        .map(|centering| centering.eq_ignore_ascii_case("node"))
        .collect();
    let given = |all: &Option<Vec<f64>>, index: usize| {
        let value = all.as_ref()?.get(index).copied()?;
        (!value.is_nan()).then_some(value)
    };
    let mut steps = Vec::new();
    let mut first = DVec3::ZERO;
    let mut assumed = false;
    for (index, axis) in array.axes.iter().enumerate() {
        let Role::Space(k) = axis.role else { continue };
        let is_node = nodes.get(index).copied().unwrap_or(false);
        let (min, max) = (given(&mins, index), given(&maxs, index));
        let intervals = if is_node {
            axis.size.saturating_sub(1)
        } else {
            axis.size
        };
        #[allow(
            clippy::cast_precision_loss,
            reason = "an axis has less than 2^32 voxels"
        )]
        let from_range = min
            .zip(max)
            .map(|(min, max)| (max - min) / intervals as f64);
        let step = given(&spacings, index)
            .or(from_range.filter(|step| step.is_finite()))
            .unwrap_or_else(|| {
                assumed = true;
                1.0
            });
        let first_center = min.map_or(0.0, |min| if is_node { min } else { min + 0.5 * step });
        let direction = DVec3::AXES.get(k).copied().unwrap_or(DVec3::ZERO);
        steps.push(direction * step);
        first += direction * first_center;
    }
    if assumed {
        notes.push("the file gives no spacing: 1 is taken".to_owned());
    }
    Ok((steps, first))
}

/// True where the space has anatomical directions.
pub(super) fn is_patient(fields: &Fields) -> bool {
    let space = fields.get("space").unwrap_or("").to_ascii_lowercase();
    ["right", "left", "ras", "las", "lps"]
        .iter()
        .any(|side| space.starts_with(side))
}

/// Metres of a unit of the world: an anatomical space without units is in millimetres.
pub(super) fn length_metres(fields: &Fields) -> Option<f64> {
    let Some(units) = fields.get("space units") else {
        return is_patient(fields).then_some(1e-3);
    };
    let mut units = units.split_ascii_whitespace();
    let first = units.next()?;
    let metres = match first.trim_matches('"') {
        "km" => 1e3,
        "m" => 1.0,
        "mm" => 1e-3,
        "um" | "\u{b5}m" | "\u{3bc}m" | "microns" => 1e-6,
        "nm" => 1e-9,
        _ => return None,
    };
    units.all(|unit| unit == first).then_some(metres)
}

fn note_units(fields: &Fields, notes: &mut Vec<String>) {
    if let Some(units) = fields.get("space units")
        && !units.split_ascii_whitespace().all(|unit| unit == "\"mm\"")
    {
        let units = escape(units);
        notes.push(format!("world lengths are in the file's units, {units}"));
    }
}
