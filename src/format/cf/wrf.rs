//! The Weather Research and Forecasting model: a C grid on levels that follow the ground.
//!
//! Winds lie on the faces of cells (dimensions `*_stag`), everything else in their middles. Voxels are
//! `DX` by `DY` metres; the grid stands around the world's origin, as map factors and projection do not bend it.
//! WRF-ARW Users' Guide, appendix on the output; Skamarock et al., NCAR/TN-556+STR, 2019, chapter 3.

use super::centered::Centered;
use super::choose::Choice;
use super::columns::{Columns, Heights};
use super::derive::{Recipe, available};
use super::grid::Role;
use super::knots::even_count;
use super::model::{Arrays, Variable};
use super::open::{dims, grid};
use super::place::from_points;
use super::regular::with_axis;
use super::wrf_map::{latitude_longitude, map};
use super::wrf_names::describe;
use crate::format::problem::invalid;
use crate::volume::{
    Format, Header, Limits, Problem, ReadError, Source, VolumeSelection, VoxelType,
};
use std::sync::Arc;

/// The names of WRF's dimensions along x, y, z.
const NAMES: [&str; 3] = ["west_east", "south_north", "bottom_top"];

/// True for a variable on WRF's grid.
pub(super) fn is_on_grid(arrays: &dyn Arrays, variable: &Variable) -> bool {
    let attributes = arrays.attributes();
    let mut names = variable.dimensions.iter().map(|d| base(&d.name)).rev();
    attributes.number("DX").is_some()
        && attributes.number("DY").is_some()
        && names.next() == Some(Some(NAMES[0]))
        && names.next() == Some(Some(NAMES[1]))
}

/// The name of the dimension along an axis of space.
fn dimension(choice: &Choice, k: usize) -> Option<&str> {
    let at = choice
        .roles
        .iter()
        .position(|role| *role == Role::Space(k))?;
    let found = choice.variable.dimensions.get(at)?;
    Some(found.name.as_str())
}

/// One of [`NAMES`], without the mark of staggering.
fn base(name: &str) -> Option<&str> {
    let name = name.strip_suffix("_stag").unwrap_or(name);
    NAMES.contains(&name).then_some(name)
}

fn is_staggered(choice: &Choice, k: usize) -> bool {
    dimension(choice, k).is_some_and(|name| name.ends_with("_stag"))
}

/// The variable of `choice`; with a `recipe` the one that is computed, `choice` being its first part.
pub(super) fn open(
    arrays: Arc<dyn Arrays>,
    file_bytes: u64,
    format: Format,
    choice: Choice,
    recipe: Option<&Recipe<'_>>,
    wanted: &VolumeSelection,
    limits: &Limits,
) -> Result<Box<dyn Source>, Problem> {
    let size = dims(arrays.as_ref(), &choice)?;
    let has_levels = dimension(&choice, 2).and_then(base).is_some();
    let is_middle = !is_staggered(&choice, 2);
    let heights = if has_levels && size[2] > 1 {
        heights(&arrays, file_bytes, format, is_middle, limits)
    } else {
        None
    };
    let middle = |k: usize, size: u32| size.saturating_sub(u32::from(is_staggered(&choice, k)));
    let mass = [middle(0, size[0]), middle(1, size[1])];
    // Heights must stand over the same columns at the same times.
    let heights = heights.filter(|heights| {
        let header = heights.parts[0].header();
        let [x, y, faces] = header.dims;
        [x, y] == mass && faces == size[2].saturating_add(u32::from(is_middle))
    });
    let levels = match &heights {
        Some(heights) => mean_heights(heights, mass, size[2])?,
        None => Vec::new(),
    };
    let mut header = stored_header(arrays.as_ref(), format, size, &levels)?;
    header.derived = available(arrays.as_ref());
    header.map = map(arrays.as_ref(), &mut header.notes);
    header.earth_arrays = latitude_longitude(arrays.as_ref());
    if recipe.is_none() {
        describe(&choice.variable, &mut header);
    }
    let voxels = grid(Arc::clone(&arrays), file_bytes, &choice, header, limits)?;
    let mut stored: Box<dyn Source> = Box::new(voxels);
    if let Some(recipe) = recipe {
        let first = centered(stored, &choice, &[0, 1]);
        let part = |choice: Choice| {
            let size = dims(arrays.as_ref(), &choice)?;
            let header = stored_header(arrays.as_ref(), format, size, &[])?;
            let voxels = grid(Arc::clone(&arrays), file_bytes, &choice, header, limits)?;
            let axes: &[usize] = if is_middle { &[0, 1, 2] } else { &[0, 1] };
            Ok(centered(Box::new(voxels), &choice, axes))
        };
        stored = recipe.open(arrays.as_ref(), first.header(), limits, &part)?;
    }
    let same_times = |heights: &Heights| {
        let times = stored.header().times;
        heights
            .parts
            .iter()
            .all(|part| part.header().times == times)
    };
    let heights = heights.filter(same_times);
    if wanted.as_stored {
        return Ok(stored);
    }
    if recipe.is_none() {
        stored = centered(stored, &choice, &[0, 1]);
    }
    let Some(heights) = heights else {
        return Ok(stored);
    };
    on_heights(stored, heights, &levels, mass, limits).map_err(|error| error.problem)
}

/// Values that are on the faces of cells along some of `axes`, in their middles.
fn centered(mut source: Box<dyn Source>, choice: &Choice, axes: &[usize]) -> Box<dyn Source> {
    for &k in axes {
        if is_staggered(choice, k) && source.header().dims.get(k).is_some_and(|&n| n > 1) {
            source = Box::new(Centered::new(source, k));
        }
    }
    source
}

/// The header of the voxels as stored; `levels` are the mean heights of levels, where they are known.
fn stored_header(
    arrays: &dyn Arrays,
    format: Format,
    size: [u32; 3],
    levels: &[f64],
) -> Result<Header, Problem> {
    let step = |name: &str| {
        let found = arrays.attributes().number(name).unwrap_or(0.0);
        let is_length = found > 0.0 && found.is_finite();
        is_length.then_some(found / 1000.0).ok_or_else(|| {
            let wanted = "a number of metres above 0";
            invalid(arrays.format(), name, wanted, &found.to_string())
        })
    };
    let around = |count: u32, step: f64| -> Vec<f64> {
        let half = 0.5 * f64::from(count.saturating_sub(1));
        (0..count).map(|i| (f64::from(i) - half) * step).collect()
    };
    let [dx, dy] = [step("DX")?, step("DY")?];
    let [nx, ny, nz] = size;
    let mut notes =
        vec!["the world is in kilometres around the middle of the WRF domain".to_owned()];
    let z = if levels.is_empty() {
        if nz > 1 {
            notes.push(
                "the file has no PH and PHB: levels are spread evenly over a quarter of the width"
                    .to_owned(),
            );
        }
        let width = (f64::from(nx) * dx).max(f64::from(ny) * dy);
        let step = 0.25 * width / f64::from(nz.saturating_sub(1).max(1));
        (0..nz).map(|i| f64::from(i) * step).collect()
    } else {
        notes.push("levels follow the ground: as stored they have their mean step".to_owned());
        levels.to_vec()
    };
    let points = [around(nx, dx), around(ny, dy), z];
    let place = from_points(size, points, true, Vec::new()).ok_or_else(|| {
        let wanted = "levels that span a volume";
        invalid(arrays.format(), "PH", wanted, "levels of one height")
    })?;
    let mut header = Header::new(format, size, VoxelType::F32, place.world_from_voxel);
    header.is_earth = true;
    header.notes = notes;
    Ok(header)
}

/// Sources of the geopotential's two parts, if the file has them.
fn heights(
    arrays: &Arc<dyn Arrays>,
    file_bytes: u64,
    format: Format,
    is_middle: bool,
    limits: &Limits,
) -> Option<Heights> {
    let part = |name: &str| -> Option<Box<dyn Source>> {
        let variable: &Variable = arrays.variables().iter().find(|other| other.name == name)?;
        let wanted = VolumeSelection {
            variable: Some(variable.name.clone()),
            ..VolumeSelection::default()
        };
        let choice = super::choose::choose(arrays.as_ref(), &wanted).ok()?;
        let size = dims(arrays.as_ref(), &choice).ok()?;
        let header = stored_header(arrays.as_ref(), format, size, &[]).ok()?;
        let grid = grid(Arc::clone(arrays), file_bytes, &choice, header, limits).ok()?;
        Some(Box::new(grid))
    };
    let parts = [part("PH")?, part("PHB")?];
    let is_same = parts[0].header().dims == parts[1].header().dims;
    is_same.then_some(Heights { parts, is_middle })
}

/// The mean height of each level at the first time; empty where they do not rise.
fn mean_heights(heights: &Heights, mass: [u32; 2], levels: u32) -> Result<Vec<f64>, Problem> {
    let all = heights
        .read(0, [0, 0], mass)
        .map_err(|error| error.problem)?;
    let count = usize::try_from(levels).unwrap_or(usize::MAX).max(1);
    let columns = all.len().checked_div(count).unwrap_or(1).max(1);
    let means: Vec<f64> = all
        .chunks(columns)
        .map(|level| level.iter().map(|&h| f64::from(h)).sum::<f64>() / columns as f64)
        .collect();
    let rises = means.iter().zip(means.iter().skip(1)).all(|(a, b)| a < b);
    Ok(if rises && means.len() == count {
        means
    } else {
        Vec::new()
    })
}

/// Even heights from the lowest to the highest level of all columns at the first time.
fn on_heights(
    inner: Box<dyn Source>,
    heights: Heights,
    levels: &[f64],
    mass: [u32; 2],
    limits: &Limits,
) -> Result<Box<dyn Source>, ReadError> {
    if levels.len() < 2 {
        return Ok(inner);
    }
    let all = heights.read(0, [0, 0], mass)?;
    let ends = all
        .iter()
        .filter(|height| height.is_finite())
        .map(|&height| f64::from(height))
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], height| {
            [low.min(height), high.max(height)]
        });
    let count = even_count(levels);
    let step = (ends[1] - ends[0]) / (count.max(2).saturating_sub(1)) as f64;
    if !(step.is_normal() && step > 0.0) {
        return Ok(inner);
    }
    let mut header = inner.header().clone();
    header.dims[2] = u32::try_from(count).unwrap_or(u32::MAX);
    header.world_from_voxel = with_axis(header.world_from_voxel, 2, ends[0], step);
    header.stored = VoxelType::F32;
    header.fill = None;
    header
        .notes
        .retain(|note| !note.starts_with("levels follow the ground"));
    header.notes.push(format!(
        "{} levels that follow the ground are drawn on {count} even heights above the sea, linear between levels; below the lowest there is no data",
        levels.len()
    ));
    Ok(Box::new(Columns {
        inner,
        heights,
        header,
        first: ends[0],
        step,
        max_bytes: limits.max_bytes,
    }))
}
