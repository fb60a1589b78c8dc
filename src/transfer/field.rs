//! Fields of a JSON object, each read by its name or refused by it.

use super::FileProblem;
use serde_json::{Map, Value};

/// A field that says something that cannot be.
pub(super) fn wrong(field: &str, wanted: &'static str, found: &Value) -> FileProblem {
    // A field can be as long as the file; its beginning says enough. JSON escapes what is not text.
    let mut text: String = found.to_string().chars().take(61).collect();
    if text.chars().count() > 60 {
        text.pop();
        text.push_str("...");
    }
    FileProblem::Field {
        field: field.to_owned(),
        wanted,
        found: text,
    }
}

/// What a number may be, and how that is said.
#[derive(Clone, Copy)]
pub(super) struct Expected {
    pub(super) fits: fn(f64) -> bool,
    pub(super) text: &'static str,
}

pub(super) const VALUE: Expected = Expected {
    fits: |x| x.abs() <= f32::MAX as f64,
    text: "a number that a 32-bit float can hold",
};
pub(super) const FRACTION: Expected = Expected {
    fits: |x| (0.0..=1.0).contains(&x),
    text: "a number from 0 to 1",
};
pub(super) const POSITIVE: Expected = Expected {
    fits: |x| x > 0.0 && x <= f32::MAX as f64,
    text: "a positive number",
};

/// The keys of one object, taken out one by one; what is left over is refused.
pub(super) struct Fields<'a> {
    place: String,
    keys: Map<String, Value>,
    wanted: &'a str,
}

impl<'a> Fields<'a> {
    /// The object at `place`; `wanted` is what messages call it.
    pub fn of(place: String, found: &Value, wanted: &'static str) -> Result<Self, FileProblem> {
        match found {
            Value::Object(keys) => Ok(Self {
                place,
                keys: keys.clone(),
                wanted,
            }),
            _ => Err(wrong(&place, wanted, found)),
        }
    }

    /// A field's full name.
    pub fn name(&self, key: &str) -> String {
        format!("{}.{key}", self.place)
    }

    /// What stands at `key`, if that is there.
    pub fn optional(&mut self, key: &str) -> Option<Value> {
        self.keys.remove(key)
    }

    /// What must stand at `key`.
    pub fn take(&mut self, key: &str, wanted: &'static str) -> Result<Value, FileProblem> {
        let found = self.keys.remove(key);
        found.ok_or_else(|| FileProblem::Field {
            field: self.name(key),
            wanted,
            found: "no such key".to_owned(),
        })
    }

    /// A number.
    pub fn number(&mut self, key: &str, wanted: Expected) -> Result<f64, FileProblem> {
        let found = self.take(key, wanted.text)?;
        number(&self.name(key), &found, wanted)
    }

    /// A number, or what it is where nothing is said.
    pub fn number_or(
        &mut self,
        key: &str,
        wanted: Expected,
        other: f64,
    ) -> Result<f64, FileProblem> {
        match self.keys.remove(key) {
            Some(found) => number(&self.name(key), &found, wanted),
            None => Ok(other),
        }
    }

    /// A list of so many numbers.
    pub fn numbers<const N: usize>(
        &mut self,
        key: &str,
        row_wanted: &'static str,
        wanted: Expected,
    ) -> Result<[f64; N], FileProblem> {
        let found = self.take(key, row_wanted)?;
        numbers(&self.name(key), &found, row_wanted, |_| wanted)
    }

    /// Refuses what has not been taken.
    pub fn end(self) -> Result<(), FileProblem> {
        match self.keys.into_iter().next() {
            None => Ok(()),
            Some((key, found)) => Err(FileProblem::Field {
                field: format!("{}.{key}", self.place),
                wanted: "no such key",
                found: format!("{found} ({})", self.wanted),
            }),
        }
    }
}

/// The number `found`, which stands at `field`.
pub(super) fn number(field: &str, found: &Value, wanted: Expected) -> Result<f64, FileProblem> {
    let number = found.as_f64().filter(|&x| (wanted.fits)(x));
    number.ok_or_else(|| wrong(field, wanted.text, found))
}

/// `N` numbers, each of which may be another kind of number.
pub(super) fn numbers<const N: usize>(
    field: &str,
    found: &Value,
    row_wanted: &'static str,
    wanted: impl Fn(usize) -> Expected,
) -> Result<[f64; N], FileProblem> {
    let Some(row) = found.as_array().filter(|row| row.len() == N) else {
        return Err(wrong(field, row_wanted, found));
    };
    let mut numbers = [0.0; N];
    for (i, (into, found)) in numbers.iter_mut().zip(row).enumerate() {
        *into = number(&format!("{field}[{i}]"), found, wanted(i))?;
    }
    Ok(numbers)
}

/// A list with something in it, of at most `limit` things.
pub(super) fn list<'v>(
    field: &str,
    found: &'v Value,
    wanted: &'static str,
    limit: (usize, &'static str),
) -> Result<&'v [Value], FileProblem> {
    let Some(rows) = found.as_array().filter(|rows| !rows.is_empty()) else {
        return Err(wrong(field, wanted, found));
    };
    if rows.len() > limit.0 {
        return Err(FileProblem::Field {
            field: field.to_owned(),
            wanted: limit.1,
            found: rows.len().to_string(),
        });
    }
    Ok(rows)
}

/// Rows of a value and `N - 1` fractions, by ascending value.
pub(super) fn points<const N: usize>(
    field: &str,
    row_wanted: &'static str,
    found: &Value,
) -> Result<Vec<[f64; N]>, FileProblem> {
    let limit = (super::MAX_POINTS, "at most 4096 points");
    let rows = list(field, found, "a list of at least one point", limit)?;
    let mut points: Vec<[f64; N]> = Vec::with_capacity(rows.len());
    for (i, row) in rows.iter().enumerate() {
        let wanted = |c| if c == 0 { VALUE } else { FRACTION };
        let point: [f64; N] = numbers(&format!("{field}[{i}]"), row, row_wanted, wanted)?;
        if points.last().is_some_and(|last| last[0] > point[0]) {
            let found = Value::from(point[0]);
            let field = format!("{field}[{i}][0]");
            return Err(wrong(&field, "a value not below the one before", &found));
        }
        points.push(point);
    }
    Ok(points)
}
