//! From an open container to a [`Source`]: the variable chosen, its axes placed, its numbers understood.

use super::axes::{coordinate, in_scope};
use super::choose::{Choice, choose};
use super::coordinates::Coordinate;
use super::curved::{flattened, latitude_longitude};
use super::derive::{available, recipe};
use super::grid::{Grid, Role};
use super::model::{Arrays, Kind, Variable};
use super::moved_pole;
use super::place::{Place, place};
use super::regular::Regular;
use super::time::Clock;
use super::values::Values;
use super::wrf;
use crate::format::problem::{at, invalid};
use crate::volume::{
    Format, Header, Limits, MapKind, MapProjection, Problem, ReadError, Source, VolumeSelection,
    VoxelType,
};
use std::sync::Arc;

/// The volume that `wanted` names. Uneven grids become even ones, unless `wanted` asks for the stored one.
pub(crate) fn open(
    arrays: Arc<dyn Arrays>,
    file_bytes: u64,
    format: Format,
    wanted: &VolumeSelection,
    limits: &Limits,
) -> Result<Box<dyn Source>, ReadError> {
    let path = arrays.path().to_owned();
    open_checked(arrays, file_bytes, format, wanted, limits).map_err(at(&path))
}

fn open_checked(
    arrays: Arc<dyn Arrays>,
    file_bytes: u64,
    format: Format,
    wanted: &VolumeSelection,
    limits: &Limits,
) -> Result<Box<dyn Source>, Problem> {
    let holder = Arc::clone(&arrays);
    let recipe = recipe(holder.as_ref(), wanted)?;
    let first = recipe.as_ref().and_then(|recipe| {
        let first = recipe.reference()?;
        Some(recipe.selection(first))
    });
    let choice = choose(arrays.as_ref(), first.as_ref().unwrap_or(wanted))?;
    if wrf::is_on_grid(arrays.as_ref(), &choice.variable) {
        let recipe = recipe.as_ref();
        return wrf::open(arrays, file_bytes, format, choice, recipe, wanted, limits);
    }
    let mut notes = Vec::new();
    let dims = dims(arrays.as_ref(), &choice)?;
    let Placed {
        place,
        map,
        earth_arrays,
    } = placed(arrays.as_ref(), &choice, dims, &mut notes)?;
    let mut header = Header::new(format, dims, VoxelType::F32, place.world_from_voxel);
    header.is_earth = place.is_earth;
    header.degree_lengths = place.degrees;
    header.map = map;
    header.earth_arrays = earth_arrays;
    header.derived = available(arrays.as_ref());
    header.heights = place.heights;
    header.notes = notes;
    header.notes.extend(place.notes);
    let even = place.uneven.iter().all(Option::is_none);
    if !even && wanted.as_stored {
        header.notes.push(
            "the points are unevenly spaced: the affine has their mean step, and a picture is drawn from even points between them".to_owned(),
        );
    }
    let voxels = grid(Arc::clone(&arrays), file_bytes, &choice, header, limits)?;
    let stored: Box<dyn Source> = match &recipe {
        None => Box::new(voxels),
        Some(recipe) => {
            let part = |choice: Choice| -> Result<Box<dyn Source>, Problem> {
                let size = self::dims(arrays.as_ref(), &choice)?;
                let header = Header::new(format, size, VoxelType::F32, place.world_from_voxel);
                let voxels = grid(Arc::clone(&arrays), file_bytes, &choice, header, limits)?;
                Ok(Box::new(voxels))
            };
            recipe.open(arrays.as_ref(), &voxels.header, limits, &part)?
        }
    };
    if even || wanted.as_stored {
        return Ok(stored);
    }
    Ok(Box::new(Regular::new(stored, place.uneven, limits)))
}

/// The stored voxels of a choice; `header` has their dims, their place and what was noted of it.
pub(super) fn grid(
    arrays: Arc<dyn Arrays>,
    file_bytes: u64,
    choice: &Choice,
    header: Header,
    limits: &Limits,
) -> Result<Grid, Problem> {
    let values = Values::of(&choice.variable, arrays.format())?;
    let mut notes = choice.notes.clone();
    if !values.stored.is_kept_exactly() {
        notes.push(format!(
            "voxels are stored as {} and kept as f32",
            values.stored.name()
        ));
    }
    let times = size_of(choice, Role::Time);
    let header = Header {
        times: u32::try_from(times).map_err(|_| too_long(arrays.as_ref(), times))?,
        stored: values.stored,
        rescale: values.rescale,
        fill: values.missing.fill,
        unit: values.unit,
        standard_name: text_of(choice, "standard_name").or(header.standard_name),
        // WRF words it `description`.
        long_name: header
            .long_name
            .or_else(|| text_of(choice, "long_name"))
            .or_else(|| text_of(choice, "description")),
        // Kilometres.
        length_metres: header.is_earth.then_some(1e3),
        is_labels: values.is_labels,
        time_names: time_names(arrays.as_ref(), choice),
        variables: choice.names.clone(),
        variable_standard_names: choice.standard_names.clone(),
        notes: [header.notes, notes].concat(),
        ..header
    };
    let grid = Grid {
        arrays,
        variable: choice.variable.clone(),
        roles: choice.roles.clone(),
        header,
        read_as: values.stored,
        missing: values.missing,
        max_bytes: limits.max_bytes,
    };
    grid.new_checked(file_bytes)
}

/// An attribute of the variable.
fn text_of(choice: &Choice, name: &str) -> Option<String> {
    choice.variable.attributes.text(name).map(str::to_owned)
}

/// Points along the axis of a role; 1 where there is none.
fn size_of(choice: &Choice, role: Role) -> u64 {
    let roles = choice.roles.iter().zip(&choice.variable.dimensions);
    let found = roles.into_iter().find(|(other, _)| **other == role);
    found.map_or(1, |(_, dimension)| dimension.size)
}

fn too_long(arrays: &dyn Arrays, size: u64) -> Problem {
    let wanted = "at most 2^32 - 1 points along an axis";
    invalid(arrays.format(), "dimensions", wanted, &size.to_string())
}

pub(super) fn dims(arrays: &dyn Arrays, choice: &Choice) -> Result<[u32; 3], Problem> {
    let mut dims = [1; 3];
    for (k, size) in dims.iter_mut().enumerate() {
        let found = size_of(choice, Role::Space(k));
        *size = u32::try_from(found).map_err(|_| too_long(arrays, found))?;
    }
    Ok(dims)
}

/// Where the points lie, the map they are drawn on, and the names of the latitudes and longitudes of all columns.
struct Placed {
    place: Place,
    map: Option<MapProjection>,
    earth_arrays: Option<[String; 2]>,
}

fn placed(
    arrays: &dyn Arrays,
    choice: &Choice,
    dims: [u32; 3],
    notes: &mut Vec<String>,
) -> Result<Placed, Problem> {
    let mut coordinates = [None, None, None];
    for (role, dimension) in choice.roles.iter().zip(&choice.variable.dimensions) {
        if let Role::Space(k) = *role
            && let Some(place) = coordinates.get_mut(k)
            && let Some(variable) = coordinate(arrays, &choice.variable, &dimension.name)
        {
            *place = Coordinate::read(arrays, variable, notes);
        }
    }
    let name_of = |k: usize| {
        let at = choice
            .roles
            .iter()
            .position(|role| *role == Role::Space(k))?;
        let found = choice.variable.dimensions.get(at)?;
        Some(found.name.as_str())
    };
    let names = name_of(0).zip(name_of(1));
    let [x, y, _] = &coordinates;
    let mut map = None;
    if x.is_none()
        && y.is_none()
        && let Some((x, y)) = names
        && let Some([east, north]) = flattened(arrays, &choice.variable, x, y)
    {
        notes.push(
            "latitudes and longitudes bend: the grid is drawn flat, with the mean steps of its middle row and column".to_owned(),
        );
        [coordinates[0], coordinates[1]] = [Some(east), Some(north)];
        map = Some(MapProjection::of_kind(MapKind::Curvilinear));
    }
    let spanned = place(dims, &coordinates);
    let spanned = spanned.ok_or_else(|| {
        let wanted = "coordinates that span a volume";
        invalid(
            arrays.format(),
            "coordinates",
            wanted,
            &choice.variable.name,
        )
    })?;
    if let Some((x, y)) = names.filter(|_| spanned.degrees != [None; 2]) {
        map = moved_pole::map(arrays, &choice.variable, [x, y], &spanned, notes);
    }
    let earth_arrays = names.and_then(|(x, y)| {
        let found = latitude_longitude(arrays, &choice.variable, x, y)?;
        Some(found.map(|variable| variable.name.clone()))
    });
    Ok(Placed {
        place: spanned,
        map,
        earth_arrays,
    })
}

/// Longer lists of moments are not read.
const MAX_TIMES: u64 = 1 << 20;

/// A name for each time; of a volume without a time axis that of its scalar time, if it has one.
fn time_names(arrays: &dyn Arrays, choice: &Choice) -> Vec<String> {
    let variable = &choice.variable;
    let axis = choice.roles.iter().position(|role| *role == Role::Time);
    let axis = axis.and_then(|at| variable.dimensions.get(at));
    if let Some(dimension) = axis {
        if dimension.size > MAX_TIMES {
            return Vec::new();
        }
        let names = coordinate(arrays, variable, &dimension.name)
            .and_then(|time| moments(arrays, time))
            .or_else(|| spelled_out(arrays, variable, &dimension.name));
        let is_whole = |names: &Vec<String>| u64::try_from(names.len()) == Ok(dimension.size);
        return names.filter(is_whole).unwrap_or_default();
    }
    let words = variable.attributes.text("coordinates").unwrap_or("");
    words
        .split_whitespace()
        .chain(["valid_time", "time"])
        .filter_map(|name| in_scope(arrays, variable, name).next())
        .filter(|time| time.count() == 1)
        .find_map(|time| moments(arrays, time))
        .unwrap_or_default()
}

/// Of a coordinate `... since ...`; where the calendar has no such moment, the number with its unit.
fn moments(arrays: &dyn Arrays, time: &Variable) -> Option<Vec<String>> {
    let units = time.attributes.text("units")?;
    if !units.contains(" since ") || !matches!(time.kind, Kind::Numbers(_)) {
        return None;
    }
    let clock = Clock::of(units, time.attributes.text("calendar"));
    let numbers = arrays.numbers(time).ok()?;
    let name = |number: &f64| {
        let moment = clock.and_then(|clock| clock.iso(*number));
        moment.unwrap_or_else(|| format!("{number} {units}"))
    };
    Some(numbers.iter().map(name).collect())
}

/// Moments as text, `2005-08-28_12:00:00`, as WRF writes them.
fn spelled_out(arrays: &dyn Arrays, variable: &Variable, dimension: &str) -> Option<Vec<String>> {
    let times = in_scope(arrays, variable, "Times").find(|times| {
        times.kind == Kind::Text
            && times
                .dimensions
                .first()
                .is_some_and(|first| first.name == dimension)
    })?;
    let texts = arrays.texts(times).ok()?;
    let iso = |text: &String| text.trim_matches(['\0', ' ']).replacen('_', "T", 1);
    Some(texts.iter().map(iso).collect())
}
