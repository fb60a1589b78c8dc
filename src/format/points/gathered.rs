//! Points one after the other, as a file gives them: what is no point is dropped and counted.

use super::place::{Axes, World};
use super::quantity::Unit;
use crate::format::convert::to_u64;
use crate::format::problem::invalid;
use crate::points::Points;
use crate::volume::{Limits, Problem};
use glam::DVec3;

/// Memory of a point: its place, value, standard deviation and weight, and its place once more where duplicates are
/// looked for.
const POINT_BYTES: u64 = 24 + 3 * 4 + 24;

/// Shorter or longer than this is no box of points.
const EXTENTS: std::ops::Range<f64> = 1e-30..1e31;

/// Of coordinates so much smaller than their distance from 0 too few digits are left.
const LEAST_RELATIVE_EXTENT: f64 = 1e-9;

/// The numbers of a row; NaN where one cannot be read.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row {
    pub place: DVec3,
    pub value: f64,
    /// `None` where the file has none.
    pub std: Option<f64>,
    pub weight: Option<f64>,
}

/// The numbers of many rows, each column by itself.
#[derive(Debug)]
pub(super) struct Columns {
    pub place: [Vec<f64>; 3],
    pub value: Vec<f64>,
    /// `None` where the file has none.
    pub std: Option<Vec<f64>>,
    pub weight: Option<Vec<f64>>,
}

/// Points so far.
#[derive(Debug)]
pub(super) struct Gathered {
    format: &'static str,
    axes: Axes,
    std_factor: f64,
    max_bytes: u64,
    places: Vec<DVec3>,
    values: Vec<f32>,
    stds: Vec<f32>,
    weights: Vec<f32>,
    dropped: u64,
}

/// All points of a file.
#[derive(Debug)]
pub(super) struct Finished {
    pub points: Points,
    pub world: World,
    pub notes: Vec<String>,
}

impl Gathered {
    /// None yet; standard deviations are in a unit.
    pub(super) fn new(
        format: &'static str,
        axes: Axes,
        std_unit: Option<Unit>,
        limits: &Limits,
    ) -> Self {
        Self {
            format,
            std_factor: axes.factor(std_unit),
            axes,
            max_bytes: limits.max_bytes,
            places: Vec::new(),
            values: Vec::new(),
            stds: Vec::new(),
            weights: Vec::new(),
            dropped: 0,
        }
    }

    /// One more row. All rows have a standard deviation and a weight, or none has.
    pub(super) fn push(&mut self, row: Row) -> Result<(), Problem> {
        let narrow = |number: f64| -> Option<f32> {
            #[allow(
                clippy::cast_possible_truncation,
                reason = "points are f32, as voxels are"
            )]
            let narrow = number as f32;
            narrow.is_finite().then_some(narrow)
        };
        let value = narrow(row.value);
        let std = match row.std {
            Some(std) => narrow(std * self.std_factor).filter(|std| *std > 0.0),
            None => Some(1.0),
        };
        let weight = match row.weight {
            Some(weight) => narrow(weight).filter(|weight| *weight >= 0.0),
            None => Some(1.0),
        };
        let (true, Some(value), Some(std), Some(weight)) =
            (self.axes.accepts(row.place), value, std, weight)
        else {
            self.dropped = self.dropped.saturating_add(1);
            return Ok(());
        };
        let count = to_u64(self.places.len()).saturating_add(1);
        let wanted_bytes = count.saturating_mul(POINT_BYTES);
        if wanted_bytes > self.max_bytes {
            return Err(Problem::Limit {
                what: "the points".to_owned(),
                wanted_bytes,
                limit_bytes: self.max_bytes,
            });
        }
        self.places.push(row.place);
        self.values.push(value);
        if row.std.is_some() {
            self.stds.push(std);
        }
        if row.weight.is_some() {
            self.weights.push(weight);
        }
        Ok(())
    }

    /// Rows whose numbers stand in columns, as far as the shortest of place and value goes.
    pub(super) fn push_columns(&mut self, columns: &Columns) -> Result<(), Problem> {
        let Columns {
            place: [x, y, z],
            value,
            std,
            weight,
        } = columns;
        let optional = |column: &Option<Vec<f64>>, row: usize| {
            let column = column.as_ref()?;
            Some(column.get(row).copied().unwrap_or(f64::NAN))
        };
        let rows = x.iter().zip(y).zip(z).zip(value).enumerate();
        for (row, (((x, y), z), value)) in rows {
            self.push(Row {
                place: DVec3::new(*x, *y, *z),
                value: *value,
                std: optional(std, row),
                weight: optional(weight, row),
            })?;
        }
        Ok(())
    }

    /// The points, in the world.
    pub(super) fn finish(mut self) -> Result<Finished, Problem> {
        if self.places.is_empty() {
            let found = format!("{} rows without", self.dropped);
            let wanted = "at least one row of finite numbers, with a standard deviation over 0 and a weight of 0 or more where \
                          it has these";
            return Err(invalid(self.format, "points", wanted, &found));
        }
        let world = self.axes.place(&mut self.places);
        let duplicates = duplicates(&self.places);
        let count = self.places.len();
        let some = |list: Vec<f32>| (!list.is_empty()).then_some(list);
        let (stds, weights) = (some(self.stds), some(self.weights));
        let points = Points::new(self.places, self.values, stds, weights).map_err(|cause| {
            let wanted = "points of finite numbers";
            invalid(self.format, "points", wanted, &cause.to_string())
        })?;
        check_extent(self.format, &points)?;
        let mut notes = vec![match count {
            1 => "1 point was read".to_owned(),
            _ => format!("{count} points were read"),
        }];
        if self.dropped > 0 {
            let rows = rows(self.dropped);
            notes.push(format!(
                "{rows} dropped: a number in them is missing, not finite or out of its range"
            ));
        }
        if duplicates > 0 {
            notes.push(format!(
                "points at the place of one before them: {duplicates}; all are kept"
            ));
        }
        Ok(Finished {
            points,
            world,
            notes,
        })
    }
}

fn rows(count: u64) -> String {
    match count {
        1 => "1 row was".to_owned(),
        _ => format!("{count} rows were"),
    }
}

/// How many places were there before.
fn duplicates(places: &[DVec3]) -> usize {
    // The two zeros are one place.
    let bits = |place: &DVec3| place.to_array().map(|x| (x + 0.0).to_bits());
    let mut all: Vec<[u64; 3]> = places.iter().map(bits).collect();
    all.sort_unstable();
    all.dedup();
    places.len().saturating_sub(all.len())
}

/// A volume is made of the box of the points: it must have a length that numbers can tell.
#[allow(
    clippy::arithmetic_side_effects,
    reason = "vectors of f64: nothing wraps or panics"
)]
fn check_extent(format: &'static str, points: &Points) -> Result<(), Problem> {
    let stds_are_lengths = points
        .stds()
        .iter()
        .all(|std| *std > 0.0 && std.is_finite());
    let [low, high] = points.bounds();
    let longest = (high - low).max_element();
    let farthest = low.abs().max(high.abs()).max_element();
    if stds_are_lengths && EXTENTS.contains(&longest) && longest > LEAST_RELATIVE_EXTENT * farthest
    {
        return Ok(());
    }
    let found = format!("{low} to {high}");
    let wanted = "a box of a length that its coordinates can tell";
    Err(invalid(format, "points", wanted, &found))
}
