//! Which column of a table is which: by what a person says, else by names.
//!
//! | axis | first of |
//! |---|---|
//! | x, y | `x` and `y`; `lon`, `longitude` and `lat`, `latitude` |
//! | z | `z`; `height`, `altitude`, `depth` or `pressure` |
//! | value | the first other column of numbers that is not called `time`, `id` or `index`, nor nothing |
//! | std, weight | `std`, `weight`, where they are there |
//!
//! Large and small letters are the same, and an end `_km`, `_m` or `_hPa` is the unit.

use super::PointColumns;
use super::place::{Axes, Axis};
use super::quantity::{Quantity, quantity, without_unit};
use crate::format::problem::{escape, invalid, missing};
use crate::volume::Problem;

/// Columns that are no value unless they are asked for.
const NEVER_A_VALUE: [&str; 4] = ["", "time", "id", "index"];

/// A column and what it is called.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Column {
    pub index: usize,
    pub name: String,
}

/// The columns that are read.
#[derive(Debug)]
pub(super) struct Roles {
    pub axes: Axes,
    /// Of x, y and z.
    pub places: [usize; 3],
    pub value: Column,
    pub std: Option<Column>,
    pub weight: Option<Column>,
    /// Other columns of numbers.
    pub others: Vec<String>,
}

/// The names of a table, and which columns hold numbers.
pub(super) struct Table<'a> {
    pub format: &'static str,
    pub names: &'a [String],
    pub are_numbers: &'a [bool],
}

impl Roles {
    pub(super) fn of(table: &Table, wanted: &PointColumns) -> Result<Self, Problem> {
        let [x, y] = table.horizontal(wanted)?;
        let z = match &wanted.z {
            Some(name) => table.named("z", name)?,
            None => table.vertical()?,
        };
        let axes = Axes([
            table.axis(&x, "x", &[Quantity::Longitude, Quantity::Length])?,
            table.axis(&y, "y", &[Quantity::Latitude, Quantity::Length])?,
            table.axis(
                &z,
                "z",
                &[
                    Quantity::Height,
                    Quantity::Depth,
                    Quantity::Pressure,
                    Quantity::Length,
                ],
            )?,
        ]);
        let optional = |key: &'static str, name: &Option<String>| match name {
            Some(name) => table.named(key, name).map(Some),
            None => table.one_of(&[key]),
        };
        let std = optional("std", &wanted.std)?;
        let weight = optional("weight", &wanted.weight)?;
        let places = [x.index, y.index, z.index];
        let is_taken = |index: usize| {
            let also = [&std, &weight].into_iter().flatten();
            places.contains(&index) || also.into_iter().any(|column| column.index == index)
        };
        let mut free = table.numbers().filter(|column| !is_taken(column.index));
        let value = match &wanted.value {
            Some(name) => table.named("value", name)?,
            None => free
                .by_ref()
                .find(|column| {
                    let name = column.name.to_ascii_lowercase();
                    !NEVER_A_VALUE.contains(&name.as_str())
                })
                .ok_or_else(|| missing(table.format, "value"))?,
        };
        let others = table
            .numbers()
            .filter(|column| !is_taken(column.index) && column.index != value.index)
            .map(|column| column.name)
            .filter(|name| !name.is_empty())
            .collect();
        Ok(Self {
            axes,
            places,
            value,
            std,
            weight,
            others,
        })
    }
}

impl Table<'_> {
    /// Columns of numbers.
    fn numbers(&self) -> impl Iterator<Item = Column> + '_ {
        let all = self.names.iter().zip(self.are_numbers).enumerate();
        all.filter(|(_, (_, is))| **is)
            .map(|(index, (name, _))| Column {
                index,
                name: name.clone(),
            })
    }

    /// The one column that a test takes.
    fn only(&self, what: &str, is: impl Fn(&str) -> bool) -> Result<Option<Column>, Problem> {
        let mut found = None;
        for (index, name) in self.names.iter().enumerate().filter(|(_, name)| is(name)) {
            let column = Column {
                index,
                name: name.clone(),
            };
            if found.replace(column).is_some() {
                return Err(invalid(self.format, what, "one column of that name", name));
            }
        }
        Ok(found)
    }

    /// The column of a name that a person gave for `key`.
    fn named(&self, key: &str, name: &str) -> Result<Column, Problem> {
        // The name to the letter is meant first.
        let exact = self.only(key, |found| found == name)?;
        let found = match exact {
            Some(column) => Some(column),
            None => self.only(key, |found| found.eq_ignore_ascii_case(name))?,
        };
        found.ok_or_else(|| {
            let names: Vec<String> = self.names.iter().map(|name| escape(name)).collect();
            let wanted = format!("the column {}", escape(name));
            invalid(self.format, key, wanted, &names.join(", "))
        })
    }

    /// The column that has one of these names, with or without a unit.
    fn one_of(&self, names: &[&str]) -> Result<Option<Column>, Problem> {
        let what = names.first().copied().unwrap_or_default();
        self.only(what, |found| {
            let (stem, _) = without_unit(found);
            names.iter().any(|name| name.eq_ignore_ascii_case(stem))
        })
    }

    fn horizontal(&self, wanted: &PointColumns) -> Result<[Column; 2], Problem> {
        let plain = [self.one_of(&["x"])?, self.one_of(&["y"])?];
        let [plain_x, plain_y] = match plain {
            [Some(x), Some(y)] => [Some(x), Some(y)],
            // One of them alone is no place: degrees come first.
            [x, y] => [
                self.one_of(&["lon", "longitude"])?.or(x),
                self.one_of(&["lat", "latitude"])?.or(y),
            ],
        };
        let x = match &wanted.x {
            Some(name) => Some(self.named("x", name)?),
            None => plain_x,
        };
        let y = match &wanted.y {
            Some(name) => Some(self.named("y", name)?),
            None => plain_y,
        };
        let x = x.ok_or_else(|| missing(self.format, "x, lon or longitude"))?;
        let y = y.ok_or_else(|| missing(self.format, "y, lat or latitude"))?;
        Ok([x, y])
    }

    fn vertical(&self) -> Result<Column, Problem> {
        let plain = self.one_of(&["z"])?;
        let others = ["height", "altitude", "alt", "depth", "pressure"];
        let mut named = self.names.iter().enumerate().filter(|(_, name)| {
            let (stem, _) = without_unit(name);
            others.iter().any(|other| other.eq_ignore_ascii_case(stem))
        });
        let first = || {
            named.next().map(|(index, name)| Column {
                index,
                name: name.clone(),
            })
        };
        plain
            .or_else(first)
            .ok_or_else(|| missing(self.format, "z, height, altitude, depth or pressure"))
    }

    fn axis(&self, column: &Column, key: &str, known: &[Quantity]) -> Result<Axis, Problem> {
        let quantity = quantity(&column.name);
        if !known.contains(&quantity) {
            let wanted = format!("a column that measures along {key}");
            return Err(invalid(self.format, key, wanted, &column.name));
        }
        let (_, unit) = without_unit(&column.name);
        let fits = match quantity {
            Quantity::Pressure => unit.is_none_or(|unit| unit.metres().is_none()),
            Quantity::Longitude | Quantity::Latitude => unit.is_none(),
            _ => unit.is_none_or(|unit| unit.metres().is_some()),
        };
        if !fits {
            let wanted = "a unit of what the column measures";
            return Err(invalid(self.format, key, wanted, &column.name));
        }
        Ok(Axis {
            quantity,
            unit,
            name: column.name.clone(),
        })
    }
}
