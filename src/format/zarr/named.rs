//! Arrays with named axes, as xarray writes them: a container for the rules of the CF conventions.
//!
//! Names of axes stand in `_ARRAY_DIMENSIONS` (version 2) or `dimension_names` (version 3). What NetCDF calls
//! `_FillValue` is in version 2 the fill value of the array, and in version 3 an attribute of a float may hold
//! its eight bytes in base64 (docs.xarray.dev/en/stable/internals/zarr-encoding-spec.html).

use super::ZARR;
use super::array::{Array, number_of};
use super::chunk::{Range, Unit, visit};
use super::json::{self, Object, number, optional};
use super::source::{read_box, unit_strides};
use super::store::Store;
use super::tree::Tree;
use crate::format::base64::Base64;
use crate::format::cf::{self, Arrays, Attributes, Contents, Dimension, Kind, Value, Variable};
use crate::format::convert::{Endian, to_u64};
use crate::format::problem::{at, invalid};
use crate::volume::{
    Format, Limits, Piece, Problem, ReadError, Source, VolumeSelection, VoxelType,
};
use std::io::Read;
use std::sync::Arc;

/// The arrays of a store.
struct Named {
    store: Store,
    arrays: Vec<Array>,
    contents: Contents,
    limits: Limits,
}

/// True where an array of the store has names for its axes.
pub(super) fn has_names(tree: &Tree, limits: &Limits) -> bool {
    arrays(tree, limits).any(|array| {
        let names = array.dimension_names;
        names.is_some_and(|names| names.iter().any(|name| !name.is_empty()))
    })
}

fn arrays<'a>(tree: &'a Tree, limits: &'a Limits) -> impl Iterator<Item = Array> + 'a {
    let nodes = tree.nodes.iter().filter(|(_, node)| node.is_array);
    nodes.filter_map(|(path, _)| tree.array(path, limits).ok())
}

/// Opens a variable.
pub(super) fn open(
    store: Store,
    tree: &Tree,
    wanted: &VolumeSelection,
    limits: &Limits,
) -> Result<Box<dyn Source>, ReadError> {
    if let Some(name) = &wanted.variable {
        let plain = name.split('[').next().unwrap_or("").trim();
        // An array that is there and not read says why.
        if tree.nodes.get(plain).is_some_and(|node| node.is_array) {
            tree.array(plain, limits).map_err(at(store.path()))?;
        }
    }
    let arrays: Vec<Array> = arrays(tree, limits).collect();
    let root = tree.nodes.get("").map(|node| attributes(&node.attributes));
    let named = Named {
        contents: Contents {
            path: store.path().to_owned(),
            format: ZARR,
            variables: arrays.iter().map(variable).collect(),
            attributes: root.unwrap_or_default(),
        },
        arrays,
        store,
        limits: *limits,
    };
    // A chunk that is not there takes no bytes: no number of bytes is too few.
    cf::open(Arc::new(named), u64::MAX, Format::Zarr, wanted, limits)
}

fn variable(array: &Array) -> Variable {
    let none = Vec::new();
    let names = array.dimension_names.as_ref().unwrap_or(&none);
    let dimension = |(axis, &size): (usize, &u64)| {
        let name = names.get(axis).filter(|name| !name.is_empty()).cloned();
        Dimension {
            name: name.unwrap_or_else(|| format!("axis_{axis}")),
            size,
        }
    };
    let mut facts = attributes(&array.attributes);
    facts.0.retain(|(name, _)| name != "_FillValue");
    facts
        .0
        .push(("_FillValue".to_owned(), Value::Numbers(vec![fill(array)])));
    Variable {
        name: array.path.clone(),
        dimensions: array.shape.iter().enumerate().map(dimension).collect(),
        kind: Kind::Numbers(array.stored),
        attributes: facts,
    }
}

/// The number that means "no data"; NaN, which always does, where the file has none.
fn fill(array: &Array) -> f64 {
    let named = optional(&array.attributes, "_FillValue");
    let named = named.and_then(|value| number(value).or_else(|| in_base64(value.as_str()?)));
    let is_of_xarray = array.attributes.contains_key("_ARRAY_DIMENSIONS");
    let own = (is_of_xarray && array.fill.is_given).then_some(array.fill.number);
    named.or(own).unwrap_or(f64::NAN)
}

/// The eight bytes of an f64, little-endian.
fn in_base64(text: &str) -> Option<f64> {
    let mut bytes = [0; 8];
    let mut decoded = Base64::new(text.as_bytes());
    decoded.read_exact(&mut bytes).ok()?;
    Some(f64::from_le_bytes(bytes))
}

fn attributes(object: &Object) -> Attributes {
    let value = |value: &serde_json::Value| match value {
        serde_json::Value::String(text) => Some(Value::Text(text.clone())),
        serde_json::Value::Array(all) => {
            let numbers: Option<Vec<f64>> = all.iter().map(json::number).collect();
            numbers
                .map(Value::Numbers)
                .or_else(|| Some(Value::Text(json::words(value)?.join(" "))))
        }
        other => Some(Value::Numbers(vec![other.as_f64()?])),
    };
    let pairs = object
        .iter()
        .filter_map(|(name, found)| Some((name.clone(), value(found)?)));
    Attributes(pairs.collect())
}

impl Named {
    fn array(&self, variable: &Variable) -> Result<&Array, Problem> {
        let found = self.arrays.iter().find(|array| array.path == variable.name);
        found.ok_or_else(|| invalid(ZARR, "variable", "an array of the store", &variable.name))
    }
}

impl Arrays for Named {
    fn contents(&self) -> &Contents {
        &self.contents
    }

    fn read(
        &self,
        variable: &Variable,
        start: &[u64],
        count: &[u64],
        stored: VoxelType,
    ) -> Result<Piece, Problem> {
        let array = Array {
            stored,
            ..self.array(variable)?.clone()
        };
        let ends = start.iter().zip(count);
        let range = Range {
            low: start.to_vec(),
            high: ends
                .map(|(start, count)| start.saturating_add(*count))
                .collect(),
        };
        let mut strides = vec![0; count.len()];
        let mut stride = 1_usize;
        for (place, &side) in strides.iter_mut().zip(count).rev() {
            *place = stride;
            stride = stride.saturating_mul(usize::try_from(side).unwrap_or(usize::MAX));
        }
        read_box(&self.store, &array, &range, &strides, &self.limits).map_err(|error| error.problem)
    }

    fn numbers(&self, variable: &Variable) -> Result<Vec<f64>, Problem> {
        let array = self.array(variable)?;
        numbers(&self.store, array, &self.limits).map_err(|error| error.problem)
    }
}

/// All numbers of a small array, the last axis fastest, as near as an f64 comes.
fn numbers(store: &Store, array: &Array, limits: &Limits) -> Result<Vec<f64>, ReadError> {
    let range = Range::whole(array);
    let bytes = to_u64(array.stored.bytes());
    let wanted_bytes = range.count().saturating_mul(bytes.max(8));
    let limit_bytes = to_u64(limits.max_header_bytes);
    if wanted_bytes > limit_bytes {
        return Err(at(&store.shown(&array.path))(Problem::Limit {
            what: "the numbers of a coordinate".to_owned(),
            wanted_bytes,
            limit_bytes,
        }));
    }
    let count = usize::try_from(range.count()).unwrap_or(0);
    let mut all = vec![array.fill.number; count];
    let from_strides = unit_strides(array);
    let size = array.stored.bytes();
    visit(store, array, &range, limits, &mut |unit: &Unit| {
        let Some(meet) = range.meet(unit.origin, array.unit()) else {
            return Ok(());
        };
        for index in meet.indices() {
            let mut from = 0_usize;
            let mut to = 0_u64;
            let sides = unit.origin.iter().zip(&array.shape);
            for ((here, (origin, side)), stride) in index.iter().zip(sides).zip(&from_strides) {
                let inside = usize::try_from(here.saturating_sub(*origin)).unwrap_or(usize::MAX);
                from = from.saturating_add(inside.saturating_mul(*stride));
                to = to.saturating_mul(*side).saturating_add(*here);
            }
            let mut bytes = unit
                .bytes
                .get(from.saturating_mul(size)..)
                .and_then(|rest| rest.get(..size))
                .unwrap_or(&[])
                .to_vec();
            if array.codecs.endian == Endian::Big {
                bytes.reverse();
            }
            let place = usize::try_from(to).ok().and_then(|to| all.get_mut(to));
            if let (Some(place), Some(number)) = (place, number_of(&bytes, array.stored)) {
                *place = number;
            }
        }
        Ok(())
    })?;
    Ok(all)
}
