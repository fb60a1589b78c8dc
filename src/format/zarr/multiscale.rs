//! The `multiscales` of an image: its axes, its levels and where their voxels lie.

use super::ZARR;
use super::array::not_read;
use super::json::{Object, number, optional, required, text, wrong};
use super::source::Role;
use crate::format::problem::invalid;
use crate::volume::Problem;
use serde_json::Value;

/// One image at several levels of detail, the finest first.
#[derive(Clone, Debug)]
pub(super) struct Multiscale {
    /// `None` before version 0.3: then they are t, c, z, y, x.
    pub axes: Option<Vec<Axis>>,
    pub levels: Vec<Level>,
}

#[derive(Clone, Debug)]
pub(super) struct Axis {
    pub name: String,
    /// `space`, `time`, `channel`; empty where the file does not say.
    pub kind: String,
    pub unit: Option<String>,
}

#[derive(Clone, Debug)]
pub(super) struct Level {
    /// Of its array in the store.
    pub path: String,
    /// World along each axis; `None` where the file gives no transformation.
    pub place: Option<Vec<Place>>,
}

/// `world = index * scale + offset`, of voxel centres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Place {
    pub scale: f64,
    pub offset: f64,
}

impl Multiscale {
    /// From the attributes of the group at `path`. Of several images in one group the first is taken.
    pub(super) fn of(facts: &Object, path: &str) -> Result<Self, Problem> {
        let list = required(facts, "multiscales")?;
        let first = list.as_array().and_then(|all| all.first());
        let image = first
            .and_then(Value::as_object)
            .ok_or_else(|| wrong("multiscales", "a list of JSON objects", list))?;
        let axes = optional(image, "axes").map(axes).transpose()?;
        let all = required(image, "datasets")?;
        let datasets = all.as_array().filter(|all| !all.is_empty());
        let datasets = datasets.ok_or_else(|| wrong("datasets", "a list of levels", all))?;
        let mut levels = Vec::new();
        for dataset in datasets {
            let Some(dataset) = dataset.as_object() else {
                return Err(wrong("datasets", "a list of JSON objects", all));
            };
            let name = text(dataset, "path")?;
            let mut place = None;
            for level in [dataset, image] {
                if let Some(steps) = optional(level, "coordinateTransformations") {
                    place = Some(transformed(place.as_deref(), steps)?);
                }
            }
            levels.push(Level {
                path: match path {
                    "" => name.to_owned(),
                    _ => format!("{path}/{name}"),
                },
                place,
            });
        }
        Ok(Self { axes, levels })
    }

    /// What each axis of an array of `rank` axes is.
    pub(super) fn roles(&self, rank: usize) -> Result<Vec<Role>, Problem> {
        let usual = ["t", "c", "z", "y", "x"];
        let names: Vec<(&str, &str)> = match &self.axes {
            Some(axes) => axes
                .iter()
                .map(|axis| (axis.name.as_str(), axis.kind.as_str()))
                .collect(),
            None => usual.iter().map(|name| (*name, "")).collect(),
        };
        let listed: Vec<&str> = names.iter().map(|(name, _)| *name).collect();
        let listed = listed.join(", ");
        if names.len() != rank {
            return Err(invalid(
                ZARR,
                "axes",
                format!("{rank}, one an axis of the array"),
                &listed,
            ));
        }
        let role = |(name, kind): &(&str, &str)| match (*kind, *name) {
            ("time", _) | ("", "t") => Role::Time,
            ("space" | "", "x") => Role::Space(0),
            ("space" | "", "y") => Role::Space(1),
            ("space" | "", "z") => Role::Space(2),
            _ => Role::Component,
        };
        let roles: Vec<Role> = names.iter().map(role).collect();
        let count = |role: Role| roles.iter().filter(|other| **other == role).count();
        let once = (0..3)
            .map(Role::Space)
            .chain([Role::Time])
            .all(|role| count(role) < 2);
        if !once || count(Role::Space(0)) == 0 {
            let wanted = "x, y and z at most once each, and x";
            return Err(invalid(ZARR, "axes", wanted, &listed));
        }
        Ok(roles)
    }
}

/// Objects since 0.4, names in 0.3.
fn axes(list: &Value) -> Result<Vec<Axis>, Problem> {
    let fail = || wrong("axes", "a list of axes with names", list);
    let axis = |value: &Value| {
        let (name, object) = match value {
            Value::String(name) => (name.as_str(), None),
            Value::Object(object) => (text(object, "name")?, Some(object)),
            _ => return Err(fail()),
        };
        let word = |field| object?.get(field)?.as_str().map(str::to_owned);
        Ok(Axis {
            name: name.to_ascii_lowercase(),
            kind: word("type").unwrap_or_default(),
            unit: word("unit"),
        })
    };
    list.as_array().ok_or_else(fail)?.iter().map(axis).collect()
}

/// One transformation after the other, behind those that `before` stands for.
fn transformed(before: Option<&[Place]>, steps: &Value) -> Result<Vec<Place>, Problem> {
    let field = "coordinateTransformations";
    let fail = || {
        wrong(
            field,
            "scales above 0 and translations, as many numbers as axes",
            steps,
        )
    };
    let mut places: Option<Vec<Place>> = before.map(<[Place]>::to_vec);
    for step in steps.as_array().ok_or_else(fail)? {
        let object = step.as_object().ok_or_else(fail)?;
        let kind = text(object, "type")?;
        if kind == "identity" {
            continue;
        }
        if !matches!(kind, "scale" | "translation") || !object.contains_key(kind) {
            return Err(not_read("the transformation", kind));
        }
        let numbers = required(object, kind)?.as_array().ok_or_else(fail)?;
        let numbers: Option<Vec<f64>> = numbers.iter().map(number).collect();
        let numbers = numbers
            .filter(|all| all.iter().all(|x| x.is_finite()))
            .ok_or_else(fail)?;
        let start = vec![
            Place {
                scale: 1.0,
                offset: 0.0
            };
            numbers.len()
        ];
        let current = places.take().unwrap_or(start);
        if current.len() != numbers.len() {
            return Err(fail());
        }
        let moved = current
            .iter()
            .zip(&numbers)
            .map(|(place, &number)| match kind {
                "scale" => Place {
                    scale: place.scale * number,
                    offset: place.offset * number,
                },
                _ => Place {
                    scale: place.scale,
                    offset: place.offset + number,
                },
            });
        places = Some(moved.collect());
    }
    let places = places.ok_or_else(fail)?;
    match places.iter().all(|place| place.scale > 0.0) {
        true => Ok(places),
        false => Err(fail()),
    }
}

#[cfg(test)]
mod tests {
    use super::super::json::object;
    use super::*;

    #[test]
    fn a_level_is_scaled_and_moved_before_the_whole_image_is() {
        let facts = object(
            br#"{"multiscales": [{
                "axes": ["x"],
                "datasets": [{"path": "0", "coordinateTransformations": [
                    {"type": "scale", "scale": [2]}, {"type": "translation", "translation": [5]}]}],
                "coordinateTransformations": [
                    {"type": "scale", "scale": [10]}, {"type": "translation", "translation": [-1]}]}]}"#,
        );
        let multiscale = Multiscale::of(&facts.unwrap(), "a/b").unwrap();
        assert_eq!(multiscale.levels[0].path, "a/b/0");
        // index 3: 2 * 3 + 5 = 11, then 10 * 11 - 1 = 109.
        let place = multiscale.levels[0].place.as_ref().unwrap()[0];
        assert_eq!(place.scale * 3.0 + place.offset, 109.0);
    }
}
