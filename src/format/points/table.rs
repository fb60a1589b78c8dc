//! Tables of text, `.csv` and `.tsv`: a row of names, then a row a point.

use super::PointColumns;
use super::gathered::{Gathered, Row};
use super::quantity::without_unit;
use super::roles::{Roles, Table};
use super::rows::{TextRow, TextRows};
use super::source::{Names, PointFile};
use crate::format::place::open_regular;
use crate::format::problem::{at, invalid, missing};
use crate::format::text::number;
use crate::volume::{Format, Limits, Problem, ReadError};
use glam::DVec3;
use std::fs::File;
use std::io::BufReader;
use std::path::Path;

/// The word of errors.
const CSV: &str = "csv";

/// Rows that are looked at to tell columns of numbers.
const ROWS_LOOKED_AT: usize = 64;

/// Opens a table whose columns a delimiter parts.
pub(super) fn open(
    path: &Path,
    delimiter: u8,
    wanted: &PointColumns,
    limits: &Limits,
) -> Result<PointFile, ReadError> {
    let (gathered, names) = gathered(path, delimiter, wanted, limits).map_err(at(path))?;
    PointFile::new(path, Format::Csv, gathered, names, limits)
}

fn rows_of(
    path: &Path,
    delimiter: u8,
    limits: &Limits,
) -> Result<TextRows<BufReader<File>>, Problem> {
    let (file, _) = open_regular(path)?;
    let most_bytes = limits.max_header_bytes;
    Ok(TextRows::new(
        BufReader::new(file),
        CSV,
        delimiter,
        most_bytes,
    ))
}

fn gathered(
    path: &Path,
    delimiter: u8,
    wanted: &PointColumns,
    limits: &Limits,
) -> Result<(Gathered, Names), Problem> {
    let roles = roles(path, delimiter, wanted, limits)?;
    let mut rows = rows_of(path, delimiter, limits)?;
    let count = names(&mut rows)?.len();
    let std = roles.std.as_ref();
    let std_unit = std.and_then(|column| without_unit(&column.name).1);
    let mut gathered = Gathered::new(CSV, roles.axes, std_unit, limits);
    while let Some(row) = rows.next()? {
        check_count(&row, count)?;
        let number = |index: usize| {
            let field = row.fields.get(index);
            field.and_then(|text| number(text)).unwrap_or(f64::NAN)
        };
        gathered.push(Row {
            place: DVec3::from_array(roles.places.map(number)),
            value: number(roles.value.index),
            std: roles.std.as_ref().map(|column| number(column.index)),
            weight: roles.weight.as_ref().map(|column| number(column.index)),
        })?;
    }
    let mut notes = Vec::new();
    if rows.is_open() {
        notes.push("the last line has no end: the file may have been cut".to_owned());
    }
    let names = Names {
        value: roles.value.name,
        others: roles.others,
        notes,
    };
    Ok((gathered, names))
}

/// The first row.
fn names(rows: &mut TextRows<BufReader<File>>) -> Result<Vec<String>, Problem> {
    let row = rows.next()?.ok_or_else(|| missing(CSV, "row of names"))?;
    let names = row.fields.iter().map(|name| name.trim().to_owned());
    Ok(names.collect())
}

/// Looks at the names and the first rows.
fn roles(
    path: &Path,
    delimiter: u8,
    wanted: &PointColumns,
    limits: &Limits,
) -> Result<Roles, Problem> {
    let mut rows = rows_of(path, delimiter, limits)?;
    let names = names(&mut rows)?;
    // All that is said in a column is a number, and something is.
    let mut columns = vec![(true, false); names.len()];
    let mut has_rows = false;
    for _ in 0..ROWS_LOOKED_AT {
        let Some(row) = rows.next()? else { break };
        check_count(&row, names.len())?;
        has_rows = true;
        for ((are_numbers, is_said), text) in columns.iter_mut().zip(&row.fields) {
            let is_empty = text.trim().is_empty();
            *are_numbers &= is_empty || number(text).is_some();
            *is_said |= !is_empty;
        }
    }
    if !has_rows {
        return Err(invalid(CSV, "rows", "at least one row of numbers", "none"));
    }
    let are_numbers: Vec<bool> = columns
        .iter()
        .map(|(numbers, said)| *numbers && *said)
        .collect();
    let table = Table {
        format: CSV,
        names: &names,
        are_numbers: &are_numbers,
    };
    Roles::of(&table, wanted)
}

fn check_count(row: &TextRow, wanted: usize) -> Result<(), Problem> {
    let found = row.fields.len();
    if found == wanted {
        return Ok(());
    }
    let field = format!("line {}", row.line);
    let wanted = format!("{wanted} fields, one a name");
    Err(invalid(CSV, &field, wanted, &found.to_string()))
}
