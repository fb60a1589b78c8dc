//! Samples of a NetCDF file by CF's discrete sampling geometries, as points.
//!
//! ```text
//! vertical   metres upwards: a height;  downwards: a depth;  pressures: at the heights of the standard atmosphere
//! ```

use super::PointColumns;
use super::gathered::{Columns, Gathered};
use super::place::{Axes, Axis};
use super::quantity::{Quantity, Unit};
use super::source::{Names, PointFile};
use crate::format::cf::{Arrays, Measure, Samples, Vertical, samples};
use crate::format::problem::{at, escape, invalid};
use crate::volume::{Format, Limits, Problem, ReadError};

/// The samples of the variable that is named as the value, by default of the first.
pub(in crate::format) fn open(
    arrays: &dyn Arrays,
    wanted: &PointColumns,
    limits: &Limits,
) -> Result<PointFile, ReadError> {
    let path = arrays.path();
    let others = PointColumns {
        value: None,
        ..wanted.clone()
    };
    if let Some(key) = others.first_named() {
        let wanted = "no name but `value`: coordinates are those of CF";
        return Err(at(path)(invalid(arrays.format(), key, wanted, "one")));
    }
    let samples = samples(arrays, wanted.value.as_deref()).map_err(at(path))?;
    let attributes = samples.attributes.clone();
    let name = samples.name.clone();
    let (gathered, names) = gathered(arrays.format(), samples, limits).map_err(at(path))?;
    let mut file = PointFile::new(path, Format::NetCdf, gathered, names, limits)?;
    let text = |key: &str| attributes.text(key).map(str::to_owned);
    file.header.unit = text("units");
    file.header.standard_name = text("standard_name");
    file.header.long_name = text("long_name").or(Some(name));
    Ok(file)
}

fn gathered(
    format: &'static str,
    samples: Samples,
    limits: &Limits,
) -> Result<(Gathered, Names), Problem> {
    let [east, north, mut up] = samples.place;
    let (vertical, factor) = axis(format, samples.vertical.as_ref())?;
    for number in &mut up {
        *number *= factor;
    }
    let horizontal = |quantity, name: &str| Axis {
        quantity,
        unit: None,
        name: name.to_owned(),
    };
    let axes = Axes([
        horizontal(Quantity::Longitude, "longitude"),
        horizontal(Quantity::Latitude, "latitude"),
        vertical,
    ]);
    let mut notes = Vec::new();
    if samples.vertical.is_none() {
        notes.push("the samples have no heights: all lie at 0".to_owned());
    }
    if samples.has_times {
        notes.push("the samples of all times are shown together".to_owned());
    }
    let mut gathered = Gathered::new(format, axes, None, limits);
    gathered.push_columns(&Columns {
        place: [east, north, up],
        value: samples.value,
        std: None,
        weight: None,
    })?;
    let names = Names {
        value: samples.name,
        others: samples.others,
        notes,
    };
    Ok((gathered, names))
}

/// What stands upwards, and what its numbers are multiplied by: kilometres and hectopascals.
fn axis(format: &'static str, vertical: Option<&Vertical>) -> Result<(Axis, f64), Problem> {
    let Some(vertical) = vertical else {
        let axis = Axis {
            quantity: Quantity::Height,
            unit: Some(Unit::Kilometres),
            name: "height".to_owned(),
        };
        return Ok((axis, 1.0));
    };
    let (quantity, unit, factor) = match vertical.measure {
        Measure::Length(metres) if vertical.is_up => {
            (Quantity::Height, Unit::Kilometres, metres / 1000.0)
        }
        Measure::Length(metres) => (Quantity::Depth, Unit::Kilometres, metres / 1000.0),
        Measure::Pressure(pascals) => (Quantity::Pressure, Unit::Hectopascals, pascals / 100.0),
        _ => {
            let field = format!("units of {}", escape(&vertical.name));
            let wanted = "a length or a pressure of the air, such as m or hPa";
            return Err(invalid(format, &field, wanted, "another unit"));
        }
    };
    let axis = Axis {
        quantity,
        unit: Some(unit),
        name: vertical.name.clone(),
    };
    Ok((axis, factor))
}
