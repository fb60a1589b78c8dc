//! Discrete sampling geometries: numbers that were measured at places, and on no grid.
//!
//! CF Conventions 1.11, chapter 9 and appendix H. A file says `featureType`; a variable of data says `coordinates`. Each of
//! these is looked up by the names of its dimensions:
//!
//! ```text
//! orthogonal, incomplete   data(station, time)   lon(station)   z(z) or z(station, z)
//! contiguous ragged        data(obs)             lon(station)   count(station): sample_dimension = "obs"
//! indexed ragged           data(obs)             lon(station)   index(obs): instance_dimension = "station"
//! ```
//!
//! so that samples, series, profiles and trajectories are read alike. A number that is missing is NaN.

use super::axes::in_scope;
use super::model::{Arrays, Attributes, Kind, Variable};
use super::units::{Measure, is_east, is_north, measure};
use super::values::Values;
use crate::format::convert::to_u64;
use crate::format::problem::{escape, invalid, missing};
use crate::volume::Problem;

/// What a file of samples says of itself.
const FEATURES: [&str; 6] = [
    "point",
    "timeSeries",
    "trajectory",
    "profile",
    "timeSeriesProfile",
    "trajectoryProfile",
];

/// What stands upwards or downwards.
const VERTICAL: [&str; 6] = [
    "height",
    "altitude",
    "depth",
    "air_pressure",
    "height_above_mean_sea_level",
    "height_above_reference_ellipsoid",
];

/// Heights, depths or pressures of samples.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Vertical {
    pub name: String,
    pub measure: Measure,
    /// True where larger numbers are higher up.
    pub is_up: bool,
}

/// All samples of a variable.
#[derive(Debug)]
pub(crate) struct Samples {
    /// Degrees east, degrees north, and what `vertical` says, or zeros.
    pub place: [Vec<f64>; 3],
    pub value: Vec<f64>,
    pub vertical: Option<Vertical>,
    /// Of the variable.
    pub name: String,
    /// Of others that could be it.
    pub others: Vec<String>,
    pub attributes: Attributes,
    /// True where samples have times.
    pub has_times: bool,
}

/// True for a file of samples.
pub(crate) fn is_sampled(arrays: &dyn Arrays) -> bool {
    let feature = arrays.attributes().text("featureType").unwrap_or_default();
    FEATURES
        .iter()
        .any(|name| name.eq_ignore_ascii_case(feature))
}

/// The samples of a variable, by default of the first.
pub(crate) fn samples(arrays: &dyn Arrays, wanted: Option<&str>) -> Result<Samples, Problem> {
    let format = arrays.format();
    let is_data = |variable: &&Variable| {
        matches!(variable.kind, Kind::Numbers(_))
            && variable.attributes.text("coordinates").is_some()
    };
    let all: Vec<&Variable> = arrays.variables().iter().filter(is_data).collect();
    let names: Vec<String> = all.iter().map(|variable| variable.name.clone()).collect();
    let data = match wanted {
        None => all.first().copied(),
        Some(name) => all.iter().copied().find(|variable| variable.name == name),
    };
    let data = data.ok_or_else(|| match wanted {
        None => missing(format, "variable with `coordinates`"),
        Some(name) => {
            let known: Vec<String> = names.iter().map(|name| escape(name)).collect();
            invalid(
                format,
                "variable",
                format!("one of {}", known.join(", ")),
                name,
            )
        }
    })?;
    let coordinates = coordinates(arrays, data);
    let find = |is: fn(&Variable) -> bool| coordinates.iter().copied().find(|found| is(found));
    let east = find(is_longitude).ok_or_else(|| missing(format, "longitude of samples"))?;
    let north = find(is_latitude).ok_or_else(|| missing(format, "latitude of samples"))?;
    let up = find(is_vertical);
    let ragged = Ragged::all(arrays, data)?;
    let along = |coordinate: &Variable| {
        let numbers = numbers(arrays, coordinate)?;
        spread(format, data, coordinate, &numbers, &ragged)
    };
    let value = numbers(arrays, data)?;
    let place = [
        along(east)?,
        along(north)?,
        up.map_or_else(|| Ok(vec![0.0; value.len()]), along)?,
    ];
    Ok(Samples {
        place,
        vertical: up.map(vertical),
        others: names
            .into_iter()
            .filter(|name| *name != data.name)
            .collect(),
        name: data.name.clone(),
        attributes: data.attributes.clone(),
        has_times: coordinates.iter().any(|found| is_time(found)),
        value,
    })
}

/// The variables that `coordinates` names, and those that are called as dimensions are.
fn coordinates<'a>(arrays: &'a dyn Arrays, data: &Variable) -> Vec<&'a Variable> {
    let named = data.attributes.text("coordinates").unwrap_or_default();
    let named = named.split_whitespace().map(str::to_owned);
    let dimensions = data
        .dimensions
        .iter()
        .map(|dimension| dimension.name.clone());
    let found = named
        .chain(dimensions)
        .filter_map(|name| in_scope(arrays, data, &name).next());
    found
        .filter(|variable| matches!(variable.kind, Kind::Numbers(_)))
        .collect()
}

fn text<'a>(variable: &'a Variable, name: &str) -> &'a str {
    variable.attributes.text(name).unwrap_or_default()
}

fn is_longitude(variable: &Variable) -> bool {
    text(variable, "standard_name") == "longitude" || is_east(text(variable, "units"))
}

fn is_latitude(variable: &Variable) -> bool {
    text(variable, "standard_name") == "latitude" || is_north(text(variable, "units"))
}

fn is_vertical(variable: &Variable) -> bool {
    text(variable, "axis").eq_ignore_ascii_case("Z")
        || variable.attributes.text("positive").is_some()
        || VERTICAL.contains(&text(variable, "standard_name"))
        || matches!(measure(text(variable, "units")), Measure::Pressure(_))
}

fn is_time(variable: &Variable) -> bool {
    text(variable, "standard_name") == "time" || text(variable, "units").contains(" since ")
}

fn vertical(variable: &Variable) -> Vertical {
    let standard_name = text(variable, "standard_name");
    Vertical {
        name: variable.name.clone(),
        measure: measure(text(variable, "units")),
        is_up: match variable.attributes.text("positive") {
            Some(word) => !word.eq_ignore_ascii_case("down"),
            None => standard_name != "depth",
        },
    }
}

/// All numbers of a variable; NaN where one is missing.
fn numbers(arrays: &dyn Arrays, variable: &Variable) -> Result<Vec<f64>, Problem> {
    let values = Values::of(variable, arrays.format())?;
    let mut numbers = arrays.numbers(variable)?;
    let wanted = variable.count();
    if to_u64(numbers.len()) != wanted {
        let found = numbers.len().to_string();
        let wanted = format!("{wanted} numbers");
        return Err(invalid(arrays.format(), &variable.name, wanted, &found));
    }
    for number in &mut numbers {
        *number = match values.missing.known(*number, values.stored) {
            Some(known) => known * values.rescale.slope + values.rescale.intercept,
            None => f64::NAN,
        };
    }
    Ok(numbers)
}

/// Which of its instances each sample of a dimension is of.
struct Ragged {
    /// The dimension of samples.
    samples: String,
    /// Of stations, profiles or trajectories.
    instances: String,
    of_sample: Vec<usize>,
}

impl Ragged {
    /// All that a file says of dimensions of `data`.
    fn all(arrays: &dyn Arrays, data: &Variable) -> Result<Vec<Self>, Problem> {
        let mut found = Vec::new();
        for variable in arrays.variables() {
            let [dimension] = variable.dimensions.as_slice() else {
                continue;
            };
            let of = |name: &str| data.dimensions.iter().find(|other| other.name == name);
            if let Some(samples) = of(text(variable, "sample_dimension")) {
                found.push(Self {
                    samples: samples.name.clone(),
                    instances: dimension.name.clone(),
                    of_sample: counted(arrays, variable, samples.size)?,
                });
            }
            let instances = text(variable, "instance_dimension");
            if !instances.is_empty() && of(&dimension.name).is_some() {
                found.push(Self {
                    samples: dimension.name.clone(),
                    instances: instances.to_owned(),
                    of_sample: indexed(arrays, variable)?,
                });
            }
        }
        Ok(found)
    }
}

/// Whole numbers from 0 on.
fn whole(arrays: &dyn Arrays, variable: &Variable) -> Result<Vec<usize>, Problem> {
    let all = numbers(arrays, variable)?.into_iter();
    let whole = all.map(|number| {
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "whole, and in range"
        )]
        let is_whole = (number >= 0.0 && number <= f64::from(u32::MAX) && number.fract() == 0.0)
            .then_some(number as usize);
        is_whole.ok_or_else(|| {
            let wanted = "whole numbers from 0 on";
            invalid(arrays.format(), &variable.name, wanted, &number.to_string())
        })
    });
    whole.collect()
}

/// Samples that stand together, so many of each instance.
fn counted(arrays: &dyn Arrays, counts: &Variable, samples: u64) -> Result<Vec<usize>, Problem> {
    let counts_of = whole(arrays, counts)?;
    let sum = counts_of.iter().map(|count| to_u64(*count));
    let sum = sum.fold(0, u64::saturating_add);
    // Before anything is made of them: a lie may be long.
    if sum != samples {
        let wanted = format!("counts of {samples} samples");
        return Err(invalid(
            arrays.format(),
            &counts.name,
            wanted,
            &sum.to_string(),
        ));
    }
    let all = counts_of.into_iter().enumerate();
    Ok(all
        .flat_map(|(instance, count)| std::iter::repeat_n(instance, count))
        .collect())
}

/// Samples that each name their instance.
fn indexed(arrays: &dyn Arrays, index: &Variable) -> Result<Vec<usize>, Problem> {
    whole(arrays, index)
}

/// The number of a coordinate at each sample of `data`.
fn spread(
    format: &'static str,
    data: &Variable,
    coordinate: &Variable,
    numbers: &[f64],
    ragged: &[Ragged],
) -> Result<Vec<f64>, Problem> {
    let size = |n: u64| usize::try_from(n).unwrap_or(usize::MAX);
    let dims: Vec<usize> = data.dimensions.iter().map(|d| size(d.size)).collect();
    // Of each dimension of the coordinate: which of the data's it is, over which instances, and how far its numbers lie apart.
    let mut axes = Vec::new();
    let mut stride = 1_usize;
    for dimension in coordinate.dimensions.iter().rev() {
        let position = |name: &str| data.dimensions.iter().position(|other| other.name == name);
        let own = position(&dimension.name).map(|at| (at, None));
        let through = || {
            let ragged = ragged.iter().find(|one| one.instances == dimension.name)?;
            Some((position(&ragged.samples)?, Some(ragged)))
        };
        let (at, ragged) = own.or_else(through).ok_or_else(|| {
            let wanted = format!("dimensions of {}", escape(&data.name));
            invalid(format, &coordinate.name, wanted, &dimension.name)
        })?;
        axes.push((at, ragged, stride, size(dimension.size)));
        stride = stride.saturating_mul(size(dimension.size));
    }
    let count = dims.iter().fold(1_usize, |n, dim| n.saturating_mul(*dim));
    let mut index = vec![0_usize; dims.len()];
    let mut all = Vec::with_capacity(count);
    for _ in 0..count {
        let mut place = 0_usize;
        for &(at, ragged, stride, length) in &axes {
            let sample = index.get(at).copied().unwrap_or(0);
            let along = match ragged {
                None => sample,
                Some(ragged) => ragged.of_sample.get(sample).copied().unwrap_or(usize::MAX),
            };
            if along >= length {
                let wanted = format!("an index under {length}, of {}", escape(&coordinate.name));
                let found = along.to_string();
                return Err(invalid(format, "instance_dimension", wanted, &found));
            }
            place = place.saturating_add(along.saturating_mul(stride));
        }
        all.push(numbers.get(place).copied().unwrap_or(f64::NAN));
        for (at, dim) in index.iter_mut().zip(&dims).rev() {
            *at = at.saturating_add(1);
            if *at < *dim {
                break;
            }
            *at = 0;
        }
    }
    Ok(all)
}
