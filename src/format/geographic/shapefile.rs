//! ESRI shapefiles of lines and polygons, `.shp`; attributes and indices beside them are not read.
//!
//! ESRI, "Shapefile Technical Description", July 1998; lengths are in 16-bit words, `>` is big-endian, `<` little-endian:
//!
//! ```text
//! header    >9994 (20 bytes) >length of the file  <1000  <type  (64 bytes of boxes)
//! record    >number  >length  <type  box (32 bytes)  <parts  <points  <first point of each part  <x, y of each point
//!           of Z types  range (16 bytes), z of each point;  of Z and M types, where it is there, the same of measures
//! ```
//!
//! Each length must be what the others make it: a record that is longer or shorter than its counts say is refused, as is a
//! file whose records do not fill it.

use super::{GeographicLine, checked};
use crate::format::convert::to_u64;
use crate::format::problem::{invalid, unsupported};
use crate::volume::Problem;

/// The word of errors.
const SHAPEFILE: &str = "shapefile";

const MAGIC: [u8; 4] = 9994_i32.to_be_bytes();
const VERSION: i32 = 1000;
const HEADER_BYTES: usize = 100;
/// Of a record's own header, of its type and box, and of the counts behind these.
const RECORD_HEADER_BYTES: usize = 8;
const BOX_BYTES: usize = 36;
const COUNT_BYTES: usize = 8;

/// True where a file begins as every shapefile does.
pub(super) fn recognizes(first: &[u8]) -> bool {
    first.starts_with(&MAGIC)
}

/// The lines, and the rings of polygons.
pub(super) fn lines(bytes: &[u8]) -> Result<Vec<GeographicLine>, Problem> {
    let header = bytes.get(..HEADER_BYTES).ok_or_else(|| {
        let wanted = format!("{HEADER_BYTES} bytes");
        invalid(SHAPEFILE, "header", wanted, &bytes.len().to_string())
    })?;
    let words = number(header, 24, i32::from_be_bytes)?;
    let promised = u64::try_from(words).unwrap_or(0).saturating_mul(2);
    if promised != to_u64(bytes.len()) {
        let wanted = format!("{} bytes, which the file has", bytes.len());
        return Err(invalid(
            SHAPEFILE,
            "file length",
            wanted,
            &promised.to_string(),
        ));
    }
    let version = number(header, 28, i32::from_le_bytes)?;
    if version != VERSION {
        let wanted = VERSION.to_string();
        return Err(invalid(SHAPEFILE, "version", wanted, &version.to_string()));
    }
    let kind = Kind::of(number(header, 32, i32::from_le_bytes)?)?;
    let mut lines = Vec::new();
    let mut rest = bytes.get(HEADER_BYTES..).unwrap_or_default();
    let mut count = 0_u64;
    while !rest.is_empty() {
        count = count.saturating_add(1);
        let (record, behind) = record_of(rest).map_err(|problem| problem.in_record(count))?;
        add(&mut lines, record, kind).map_err(|problem| problem.in_record(count))?;
        rest = behind;
    }
    if lines.is_empty() {
        return Err(invalid(SHAPEFILE, "records", "a line", "none"));
    }
    Ok(lines)
}

/// What a record has behind its points.
#[derive(Clone, Copy, PartialEq)]
struct Kind {
    number: i32,
    has_heights: bool,
    may_have_measures: bool,
}

impl Kind {
    fn of(number: i32) -> Result<Self, Problem> {
        let (has_heights, may_have_measures) = match number {
            3 | 5 => (false, false),
            13 | 15 => (true, true),
            23 | 25 => (false, true),
            0 | 1 | 8 | 11 | 18 | 21 | 28 | 31 => {
                let what = format!("type {number} (lines are 3, 13 and 23, polygons 5, 15 and 25)");
                return Err(unsupported(SHAPEFILE, what));
            }
            _ => {
                let wanted = "3, 13 or 23 of lines, 5, 15 or 25 of polygons";
                return Err(invalid(SHAPEFILE, "type", wanted, &number.to_string()));
            }
        };
        Ok(Self {
            number,
            has_heights,
            may_have_measures,
        })
    }

    /// Bytes that a record may have: with measures and without.
    fn lengths(self, parts: u64, points: u64) -> [u64; 2] {
        let counts = to_u64(BOX_BYTES).saturating_add(to_u64(COUNT_BYTES));
        let places = parts
            .saturating_mul(4)
            .saturating_add(points.saturating_mul(16));
        let more = points.saturating_mul(8).saturating_add(16);
        let least = counts
            .saturating_add(places)
            .saturating_add(if self.has_heights { more } else { 0 });
        let most = least.saturating_add(if self.may_have_measures { more } else { 0 });
        [least, most]
    }
}

/// What is wrong in a record.
struct Wrong {
    field: &'static str,
    wanted: String,
    found: String,
}

impl Wrong {
    fn new(field: &'static str, wanted: impl Into<String>, found: impl ToString) -> Self {
        Self {
            field,
            wanted: wanted.into(),
            found: found.to_string(),
        }
    }

    fn in_record(self, number: u64) -> Problem {
        let field = format!("record {number}: {}", self.field);
        invalid(SHAPEFILE, &field, self.wanted, &self.found)
    }
}

/// The first record without its header, and what is behind it.
fn record_of(bytes: &[u8]) -> Result<(&[u8], &[u8]), Wrong> {
    let cut = || Wrong::new("header", "8 bytes", bytes.len());
    let (header, rest) = bytes
        .split_at_checked(RECORD_HEADER_BYTES)
        .ok_or_else(cut)?;
    let words = number(header, 4, i32::from_be_bytes).map_err(|_| cut())?;
    let length = usize::try_from(words).ok().and_then(|n| n.checked_mul(2));
    length
        .and_then(|length| rest.split_at_checked(length))
        .ok_or_else(|| {
            let wanted = format!("at most {} words, which follow", rest.len() / 2);
            Wrong::new("length", wanted, words)
        })
}

/// Adds the lines of a record.
fn add(lines: &mut Vec<GeographicLine>, record: &[u8], kind: Kind) -> Result<(), Wrong> {
    let cut = |_| Wrong::new("length", "44 bytes at least", record.len());
    let found = number(record, 0, i32::from_le_bytes).map_err(cut)?;
    // A place that is kept for a shape without a form.
    if found == 0 && record.len() == 4 {
        return Ok(());
    }
    if found != kind.number {
        let wanted = format!("{}, which the header names, or 0", kind.number);
        return Err(Wrong::new("type", wanted, found));
    }
    let counts = [BOX_BYTES, BOX_BYTES + 4].map(|place| number(record, place, i32::from_le_bytes));
    let [parts, points] = counts;
    let [parts, points] = [parts.map_err(cut)?, points.map_err(cut)?];
    let numbers = (u64::try_from(parts), u64::try_from(points));
    let fits = matches!(numbers, (Ok(parts), Ok(points))
        if kind.lengths(parts, points).contains(&to_u64(record.len())));
    if !fits {
        let wanted = format!("what {parts} parts of {points} points take");
        let found = format!("{} bytes", record.len());
        return Err(Wrong::new("length", wanted, found));
    }
    // So many bytes are there.
    let words = record.get(BOX_BYTES + COUNT_BYTES..).unwrap_or_default();
    let part_bytes = usize::try_from(parts).unwrap_or(0).saturating_mul(4);
    let (starts, rest) = words.split_at_checked(part_bytes).unwrap_or_default();
    let (starts, _) = starts.as_chunks::<4>();
    let (pairs, _) = rest.as_chunks::<16>();
    let pairs = pairs
        .get(..usize::try_from(points).unwrap_or(0))
        .unwrap_or_default();
    let firsts = starts.iter().map(|start| i32::from_le_bytes(*start));
    let ends = firsts.clone().skip(1).chain([points]);
    for (index, (first, end)) in firsts.zip(ends).enumerate() {
        let range = usize::try_from(first)
            .ok()
            .zip(usize::try_from(end).ok())
            .filter(|(first, end)| first < end && (index > 0 || *first == 0));
        let part = range.and_then(|(first, end)| pairs.get(first..end));
        let part = part.ok_or_else(|| {
            let wanted = "first points of parts that begin with 0 and grow";
            Wrong::new("parts", wanted, format!("{first}, then {end}"))
        })?;
        let line: Result<GeographicLine, Wrong> = part.iter().map(place).collect();
        let line = line?;
        if line.len() > 1 {
            lines.push(line);
        }
    }
    Ok(())
}

fn place(pair: &[u8; 16]) -> Result<[f64; 2], Wrong> {
    let (numbers, _) = pair.as_chunks::<8>();
    let mut numbers = numbers.iter().map(|bytes| f64::from_le_bytes(*bytes));
    let mut next = || numbers.next().unwrap_or(f64::NAN);
    checked([next(), next()]).map_err(|(found, wanted)| Wrong::new("points", wanted, found))
}

fn number(bytes: &[u8], place: usize, read: fn([u8; 4]) -> i32) -> Result<i32, Problem> {
    let found = bytes.get(place..).and_then(|rest| rest.first_chunk::<4>());
    let cut = || {
        invalid(
            SHAPEFILE,
            "length",
            "four bytes more",
            &bytes.len().to_string(),
        )
    };
    found.map(|bytes| read(*bytes)).ok_or_else(cut)
}
