//! OME-NGFF 0.4 and 0.5: images at several levels of detail, with axes, units, channels and labels.
//!
//! ngff.openmicroscopy.org/0.4 and /0.5. The position of the centre of a voxel, along each axis:
//!
//! ```text
//! world = t_all + s_all (t_level + s_level index)          s: scale, t: translation
//! ```

use super::array::Array;
use super::json::Object;
use super::multiscale::Multiscale;
use super::plain::sizes;
use super::source::Role;
use super::tree::Tree;
use super::{ZARR, omero};
use crate::format::convert::{bytes_in_memory, to_u64};
use crate::format::geometry::{with_missing_axes, world_from_voxel};
use crate::format::problem::{escape, invalid};
use crate::volume::{ComponentKind, Format, Header, Limits, Problem, VolumeSelection};
use glam::DVec3;
use serde_json::Value;

/// A group that is an image.
#[derive(Debug)]
pub(super) struct Image {
    group: String,
    /// The group's attributes, in 0.5 those under `ome`.
    facts: Object,
    is_label: bool,
}

/// An array of an image, and what is known about it.
pub(super) struct Level {
    pub array: Array,
    pub roles: Vec<Role>,
    pub header: Header,
}

/// All images of a store, those that are no labels first.
pub(super) fn images(tree: &Tree) -> Vec<Image> {
    let groups = tree.nodes.iter().filter(|(_, node)| !node.is_array);
    let image = |(path, node): (&String, &super::tree::Node)| {
        let inside = node.attributes.get("ome").and_then(Value::as_object);
        let facts = inside.unwrap_or(&node.attributes);
        facts.contains_key("multiscales").then(|| Image {
            group: path.clone(),
            facts: facts.clone(),
            is_label: facts.contains_key("image-label")
                || path.split('/').any(|part| part == "labels"),
        })
    };
    let mut images: Vec<Image> = groups.filter_map(image).collect();
    images.sort_by_key(|image| image.is_label);
    images
}

/// The wanted level of the wanted image, without a word the finest that fits the limits; `None` where
/// something else is wanted.
pub(super) fn choose(
    tree: &Tree,
    images: &[Image],
    wanted: &VolumeSelection,
    limits: &Limits,
) -> Result<Option<Level>, Problem> {
    let name = wanted.variable.as_deref();
    let mut found = None;
    for image in images {
        let is_named = name.is_none_or(|name| name == image.group);
        let multiscale = match Multiscale::of(&image.facts, &image.group) {
            Err(problem) if is_named => return Err(problem),
            Err(_) => continue,
            Ok(multiscale) => multiscale,
        };
        let level = multiscale
            .levels
            .iter()
            .position(|level| name.is_some_and(|name| name == level.path));
        if is_named || level.is_some() {
            found = Some((image, multiscale, level));
            break;
        }
    }
    let Some((image, multiscale, level)) = found else {
        return Ok(None);
    };
    let last = multiscale.levels.len().saturating_sub(1);
    let of_word = wanted.level.map(|level| level as usize);
    if let Some(number) = of_word.filter(|&number| number > last) {
        let wanted = format!("0 to {last}");
        return Err(invalid(ZARR, "level", wanted, &number.to_string()));
    }
    let level = level.or(of_word);
    let (number, array) = match level {
        Some(number) => {
            let path = multiscale
                .levels
                .get(number)
                .map_or("", |level| &level.path);
            (number, tree.array(path, limits)?)
        }
        None => finest(tree, &multiscale, limits)?,
    };
    let roles = multiscale.roles(array.rank())?;
    let mut header = header(image, &multiscale, number, &array, &roles)?;
    header.levels = u32::try_from(multiscale.levels.len()).unwrap_or(u32::MAX);
    if level.is_none() {
        header
            .notes
            .extend(levels_note(tree, &multiscale, number, limits));
    }
    header.variables = variables(images, name.unwrap_or(&array.path), name.is_some());
    if name.is_none() {
        let labels = images.iter().filter(|image| image.is_label);
        let others = labels.map(|image| escape(&image.group)).collect::<Vec<_>>();
        if !others.is_empty() && !image.is_label {
            let note = format!("labels of this image: --variable {}", others.join(", "));
            header.notes.push(note);
        }
    }
    Ok(Some(Level {
        array,
        roles,
        header,
    }))
}

/// The first level whose volume fits, the finest standing first.
fn finest(
    tree: &Tree,
    multiscale: &Multiscale,
    limits: &Limits,
) -> Result<(usize, Array), Problem> {
    let mut too_large = None;
    for (number, level) in multiscale.levels.iter().enumerate() {
        match tree.array(&level.path, limits) {
            Ok(array) => {
                let wanted_bytes = volume_bytes(&array, &multiscale.roles(array.rank())?);
                if wanted_bytes <= limits.max_bytes {
                    return Ok((number, array));
                }
                too_large = Some(Problem::Limit {
                    what: format!("the smallest level `{}`", escape(&level.path)),
                    wanted_bytes,
                    limit_bytes: limits.max_bytes,
                });
            }
            Err(problem @ Problem::Limit { .. }) => too_large = Some(problem),
            Err(problem) => return Err(problem),
        }
    }
    Err(too_large.unwrap_or_else(|| invalid(ZARR, "datasets", "a list of levels", "nothing")))
}

/// Bytes in memory of one time and component.
fn volume_bytes(array: &Array, roles: &[Role]) -> u64 {
    let sides = roles.iter().zip(&array.shape);
    let space = sides.filter(|(role, _)| matches!(role, Role::Space(_)));
    space.fold(to_u64(bytes_in_memory(array.stored)), |bytes, (_, side)| {
        bytes.saturating_mul(*side)
    })
}

/// Which level was taken, and why.
fn levels_note(
    tree: &Tree,
    multiscale: &Multiscale,
    number: usize,
    limits: &Limits,
) -> Option<String> {
    let count = multiscale.levels.len();
    let taken = escape(&multiscale.levels.get(number)?.path);
    let first = multiscale.levels.first()?;
    let other = match number {
        0 => multiscale.levels.get(1)?,
        _ => first,
    };
    let other = escape(&other.path);
    Some(match number {
        0 => format!(
            "level `{taken}`, the finest of {count}, is read; --variable {other} takes the next"
        ),
        _ => {
            let needs = tree
                .array(
                    &first.path,
                    &Limits {
                        max_bytes: u64::MAX,
                        ..*limits
                    },
                )
                .ok();
            let needs = needs.and_then(|array| {
                let roles = multiscale.roles(array.rank()).ok()?;
                Some(format!(" needs {} bytes", volume_bytes(&array, &roles)))
            });
            let needs = needs.unwrap_or_default();
            format!(
                "level `{taken}` of {count} is read, the finest that fits the limit of {} bytes: `{other}`{needs}",
                limits.max_bytes
            )
        }
    })
}

/// What may be wanted, `taken` first. Levels of one image are no rivals: without a word only the one that is
/// taken is listed, and the groups of other images.
fn variables(images: &[Image], taken: &str, is_wanted: bool) -> Vec<String> {
    let mut names = vec![taken.to_owned()];
    let mut add = |name: &str| {
        if !name.is_empty() && !names.iter().any(|other| other == name) {
            names.push(name.to_owned());
        }
    };
    for (place, image) in images.iter().enumerate() {
        let levels = Multiscale::of(&image.facts, &image.group).map(|all| all.levels);
        match is_wanted {
            true => levels
                .unwrap_or_default()
                .iter()
                .for_each(|level| add(&level.path)),
            false if place > 0 && !image.is_label => add(&image.group),
            false => {}
        }
    }
    names
}

#[allow(
    clippy::arithmetic_side_effects,
    reason = "vectors of f64: nothing wraps or panics"
)]
fn header(
    image: &Image,
    multiscale: &Multiscale,
    number: usize,
    array: &Array,
    roles: &[Role],
) -> Result<Header, Problem> {
    let sizes = sizes(array, roles)?;
    let mut notes = Vec::new();
    let place = multiscale
        .levels
        .get(number)
        .and_then(|level| level.place.as_deref());
    if place.is_some_and(|place| place.len() != roles.len()) {
        let wanted = format!("{} numbers, one an axis", roles.len());
        let found = place.map_or(0, <[_]>::len).to_string();
        return Err(invalid(ZARR, "coordinateTransformations", wanted, &found));
    }
    if place.is_none() {
        notes.push("the file gives no size of a voxel: 1 is taken".to_owned());
    }
    // Scale, offset and unit of x, y, z and time.
    let along = |wanted: Role| {
        let axis = roles.iter().position(|role| *role == wanted)?;
        let place = place.and_then(|place| place.get(axis));
        let unit = multiscale
            .axes
            .as_ref()
            .and_then(|axes| axes.get(axis)?.unit.clone());
        Some((
            place.map_or((1.0, 0.0), |place| (place.scale, place.offset)),
            unit,
        ))
    };
    let unit = along(Role::Space(0)).and_then(|(_, unit)| unit);
    let mut columns = Vec::new();
    let mut first_center = DVec3::ZERO;
    for (k, direction) in [DVec3::X, DVec3::Y, DVec3::Z].into_iter().enumerate() {
        let Some(((scale, offset), own_unit)) = along(Role::Space(k)) else {
            break;
        };
        let factor = factor(own_unit.as_deref(), unit.as_deref()).unwrap_or_else(|| {
            notes.push(
                "the axes have units that are not the same kind: lengths are taken as they stand"
                    .to_owned(),
            );
            1.0
        });
        columns.push(direction * (scale * factor));
        first_center += direction * (offset * factor);
    }
    let affine = world_from_voxel(with_missing_axes(&columns), first_center);
    let affine = affine.ok_or_else(|| {
        let found = format!("{columns:?}");
        invalid(
            ZARR,
            "coordinateTransformations",
            "lengths that span a volume",
            &found,
        )
    })?;
    let length_metres = unit.as_deref().and_then(metres);
    if let Some(unit) = unit {
        notes.push(format!("lengths are in {}", escape(&unit)));
    }
    let mut time_names = Vec::new();
    if let Some(((scale, offset), Some(unit))) =
        along(Role::Time).filter(|_| (2..=MOST_TIMES).contains(&sizes.times))
    {
        let unit = escape(&unit);
        time_names = (0..sizes.times)
            .map(|time| format!("{} {unit}", offset + scale * f64::from(time)))
            .collect();
    }
    let channels = omero::channels(&image.facts, sizes.components);
    let meaning = match channels {
        Some(channels) if !image.is_label => ComponentKind::Channels(channels),
        _ => ComponentKind::Numbers,
    };
    Ok(Header {
        times: sizes.times,
        components: sizes.components,
        meaning,
        length_metres,
        is_labels: image.is_label,
        modality: Some("GM".to_owned()),
        time_names,
        notes,
        ..Header::new(Format::Zarr, sizes.dims, array.stored, affine)
    })
}

/// More moments get no names: a header may promise any number of them.
const MOST_TIMES: u32 = 1 << 16;

/// What makes a length in `own` one in `unit`; `None` where they are no units of length.
fn factor(own: Option<&str>, unit: Option<&str>) -> Option<f64> {
    if own == unit {
        return Some(1.0);
    }
    Some(metres(own?)? / metres(unit?)?)
}

/// The units of length that the specification names.
fn metres(unit: &str) -> Option<f64> {
    Some(match unit {
        "angstrom" => 1e-10,
        "picometer" => 1e-12,
        "nanometer" => 1e-9,
        "micrometer" => 1e-6,
        "millimeter" => 1e-3,
        "centimeter" => 1e-2,
        "decimeter" => 1e-1,
        "meter" => 1.0,
        "kilometer" => 1e3,
        "inch" => 0.0254,
        "foot" => 0.3048,
        "yard" => 0.9144,
        "mile" => 1609.344,
        _ => return None,
    })
}
