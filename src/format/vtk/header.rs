//! The lines before the arrays: version, title, ASCII or BINARY, the data set and its lattice.

use super::VTK;
use super::scan::Scan;
use super::sections::{Field, field};
use crate::format::problem::{escape, invalid, missing, unsupported};
use crate::volume::Problem;

/// Where the points lie.
#[derive(Clone, Debug)]
pub(super) struct Lattice {
    /// Points along x, y, z.
    pub points: [u32; 3],
    pub origin: [f64; 3],
    pub spacing: [f64; 3],
    /// The time of field data, if it is there.
    pub time: Option<f64>,
    /// The word that ended the lattice: `POINT_DATA` or `CELL_DATA`.
    pub next: String,
}

impl Lattice {
    /// Points, or the cells between them.
    pub(super) fn dims(&self, of_cells: bool) -> [u32; 3] {
        self.points.map(|n| match of_cells {
            true => n.saturating_sub(1).max(1),
            false => n,
        })
    }

    pub(super) fn read(scan: &mut Scan) -> Result<Self, Problem> {
        first_lines(scan)?;
        let mut points = None;
        let mut origin = [0.0; 3];
        let mut spacing = [1.0; 3];
        let mut time = None;
        let mut first_index = [0.0; 3];
        loop {
            let Some(word) = scan.keyword()? else {
                return Err(missing(VTK, "POINT_DATA"));
            };
            match word.as_str() {
                "DIMENSIONS" => points = Some(dimensions(scan)?),
                // Before version 2 the distances were called so.
                "SPACING" | "ASPECT_RATIO" => spacing = three(scan, &word)?,
                "ORIGIN" => origin = three(scan, &word)?,
                "EXTENT" => {
                    let (size, first) = extent(scan)?;
                    points = Some(size);
                    first_index = first;
                }
                "FIELD" => {
                    for Field { name, number, .. } in field(scan)? {
                        if name.eq_ignore_ascii_case("time") || name == "TimeValue" {
                            time = number;
                        }
                    }
                }
                "METADATA" => scan.skip_to_empty_line()?,
                "POINT_DATA" | "CELL_DATA" => {
                    let points = points.ok_or_else(|| missing(VTK, "DIMENSIONS"))?;
                    for ((origin, spacing), index) in
                        origin.iter_mut().zip(&spacing).zip(first_index)
                    {
                        *origin += spacing * index;
                    }
                    // A flat axis may have no distance.
                    for (step, size) in spacing.iter_mut().zip(points) {
                        if *step == 0.0 && size == 1 {
                            *step = 1.0;
                        }
                    }
                    return Ok(Self {
                        points,
                        origin,
                        spacing,
                        time,
                        next: word,
                    });
                }
                _ => {
                    let wanted = "DIMENSIONS, SPACING, ORIGIN, POINT_DATA or CELL_DATA";
                    return Err(invalid(VTK, "header", wanted, &word));
                }
            }
        }
    }
}

fn first_lines(scan: &mut Scan) -> Result<(), Problem> {
    let line = scan.line()?.unwrap_or_default();
    let version = line
        .trim()
        .strip_prefix("# vtk DataFile Version")
        .map(str::trim);
    let major = version.and_then(|text| text.split('.').next()?.parse::<u32>().ok());
    match major {
        Some(1..=5) => {}
        Some(_) => {
            let version = escape(version.unwrap_or(""));
            return Err(unsupported(VTK, format!("version {version} of the format")));
        }
        None => {
            let wanted = "`# vtk DataFile Version` and a number as the first line";
            return Err(invalid(VTK, "version", wanted, &line));
        }
    }
    let ended = || invalid(VTK, "header", "a title", "the end of the file");
    scan.line()?.ok_or_else(ended)?;
    let kind = scan.after("title")?;
    scan.is_binary = match kind.to_ascii_uppercase().as_str() {
        "ASCII" => false,
        "BINARY" => true,
        _ => return Err(invalid(VTK, "third line", "ASCII or BINARY", &kind)),
    };
    let mut word = scan.keyword()?.unwrap_or_default();
    // A file may be a field and nothing else.
    if word == "FIELD" {
        return Err(unsupported(VTK, "a file of field data alone"));
    }
    if word != "DATASET" {
        return Err(invalid(VTK, "fourth line", "DATASET", &word));
    }
    word = scan.after("DATASET")?.to_ascii_uppercase();
    match word.as_str() {
        "STRUCTURED_POINTS" => Ok(()),
        "UNSTRUCTURED_GRID" => Err(Problem::Unstructured),
        "RECTILINEAR_GRID" | "STRUCTURED_GRID" | "POLYDATA" => Err(unsupported(
            VTK,
            format!("the data set {word}, not STRUCTURED_POINTS,"),
        )),
        _ => Err(invalid(VTK, "DATASET", "STRUCTURED_POINTS", &word)),
    }
}

fn dimensions(scan: &mut Scan) -> Result<[u32; 3], Problem> {
    let wanted = "three whole numbers from 1 to 2^31 - 1";
    let mut size = || -> Result<u32, Problem> {
        let n: i32 = scan.number("DIMENSIONS", wanted)?;
        let size = u32::try_from(n).ok().filter(|&n| n > 0);
        size.ok_or_else(|| invalid(VTK, "DIMENSIONS", wanted, &n.to_string()))
    };
    Ok([size()?, size()?, size()?])
}

/// Sizes and first indices.
fn extent(scan: &mut Scan) -> Result<([u32; 3], [f64; 3]), Problem> {
    let wanted = "first and last index along three axes";
    let mut axis = || -> Result<(u32, f64), Problem> {
        let first: i32 = scan.number("EXTENT", wanted)?;
        let last: i32 = scan.number("EXTENT", wanted)?;
        let size = i64::from(last)
            .checked_sub(first.into())
            .and_then(|n| n.checked_add(1))
            .and_then(|n| u32::try_from(n).ok())
            .filter(|&n| n > 0)
            .ok_or_else(|| invalid(VTK, "EXTENT", wanted, &format!("{first} {last}")))?;
        Ok((size, first.into()))
    };
    let (x, y, z) = (axis()?, axis()?, axis()?);
    Ok(([x.0, y.0, z.0], [x.1, y.1, z.1]))
}

fn three(scan: &mut Scan, field: &str) -> Result<[f64; 3], Problem> {
    let mut number = || -> Result<f64, Problem> {
        let x: f64 = scan.number(field, "three finite numbers")?;
        match x.is_finite() {
            true => Ok(x),
            false => Err(invalid(VTK, field, "three finite numbers", &x.to_string())),
        }
    };
    Ok([number()?, number()?, number()?])
}
