//! Which files the voxels of a NRRD are in: `data file`, `line skip`, `byte skip`.

use super::NRRD;
use super::array::Array;
use super::fields::{Fields, is_list};
use crate::format::convert::to_u64;
use crate::format::data::{Part, Start};
use crate::format::decode::Encoding;
use crate::format::place::{Folder, offset_after_lines};
use crate::format::problem::{at, invalid, unsupported};
use crate::format::sequence::{Sequence, asks_for_a_number, template_and_numbers};
use crate::format::text::{integers, number, whole};
use crate::volume::{Limits, Problem, ReadError};
use std::path::{Path, PathBuf};

/// The files that the voxels are in.
pub(super) fn parts(
    path: &Path,
    fields: &Fields,
    array: &Array,
    encoding: Encoding,
    limits: &Limits,
) -> Result<Vec<Part>, ReadError> {
    let skip = Skip::of(fields, encoding).map_err(at(path))?;
    let Some(text) = fields.get("data file") else {
        return Ok(vec![skip.part(path.to_owned(), fields.header_bytes)?]);
    };
    let folder = Folder::of(path, NRRD, limits).map_err(at(path))?;
    let part = |name: &str| skip.part(folder.resolve(name, NRRD, "data file")?, 0);
    let too_many = |count: u64| {
        let wanted = format!("at most {} files", limits.max_files);
        at(path)(invalid(NRRD, "data file", wanted, &count.to_string()))
    };
    let most = to_u64(limits.max_files);
    if is_list(text) {
        let dimension = list_dimension(text).map_err(at(path))?;
        let count = to_u64(fields.listed_files.len());
        check_count(array, dimension, count).map_err(at(path))?;
        if count > most {
            return Err(too_many(count));
        }
        return fields.listed_files.iter().map(|name| part(name)).collect();
    }
    let template = text.split([' ', '\t']).next().unwrap_or("");
    if !asks_for_a_number(template) {
        return Ok(vec![part(text)?]);
    }
    let wanted = "a template with first, last, step and perhaps dimension: `slice%d.raw 1 9 1`";
    let fail = || at(path)(invalid(NRRD, "data file", wanted, text));
    let (template, numbers) = template_and_numbers(text).ok_or_else(fail)?;
    let (first, last, step, dimension) = match *numbers.as_slice() {
        [first, last, step] => (first, last, step, None),
        [first, last, step, dimension] => (first, last, step, Some(dimension)),
        _ => return Err(fail()),
    };
    let sequence = Sequence::new(template, first, last, step).ok_or_else(fail)?;
    check_count(array, dimension, sequence.count()).map_err(at(path))?;
    if sequence.count() > most {
        return Err(too_many(sequence.count()));
    }
    sequence
        .names()
        .map(|name| part(&name.ok_or_else(fail)?))
        .collect()
}

/// The number behind `LIST`.
fn list_dimension(text: &str) -> Result<Option<i64>, Problem> {
    let wanted = "`LIST`, perhaps with a dimension";
    let fail = || invalid(NRRD, "data file", wanted, text);
    match text.split_once([' ', '\t']).unwrap_or((text, "")) {
        ("SKIPLIST", _) => Err(unsupported(NRRD, "data file `SKIPLIST`")),
        (_, rest) => match *integers(rest).ok_or_else(fail)?.as_slice() {
            [] => Ok(None),
            [dimension] => Ok(Some(dimension)),
            _ => Err(fail()),
        },
    }
}

/// `count` files of `dimension` axes each make up the array; without a dimension, each is a slice along the slowest
/// axis.
fn check_count(array: &Array, dimension: Option<i64>, count: u64) -> Result<(), Problem> {
    let axes = array.axes.len();
    let dimension = match dimension {
        None => axes.saturating_sub(1),
        Some(dimension) => usize::try_from(dimension)
            .ok()
            .filter(|dimension| (1..=axes).contains(dimension))
            .ok_or_else(|| {
                let wanted = format!("pieces of 1 to {axes} axes");
                invalid(NRRD, "data file", wanted, &dimension.to_string())
            })?,
    };
    let slowest = array.axes.last().map_or(1, |axis| axis.size);
    let slower = array.axes.iter().skip(dimension).map(|axis| axis.size);
    let (matches, wanted) = if dimension == axes {
        let divides = count > 0 && slowest.checked_rem(count) == Some(0);
        (divides, format!("a number of files that divides {slowest}"))
    } else {
        let wanted = slower.fold(1_u64, u64::saturating_mul);
        (count == wanted, format!("{wanted} files"))
    };
    if matches {
        Ok(())
    } else {
        Err(invalid(NRRD, "data file", wanted, &count.to_string()))
    }
}

/// `line skip` and `byte skip`, which hold for every file.
struct Skip {
    lines: u64,
    bytes: i64,
    is_compression: bool,
}

impl Skip {
    fn of(fields: &Fields, encoding: Encoding) -> Result<Self, Problem> {
        let one = |name: &'static str| {
            let Some(text) = fields.get(name) else {
                return Ok(0);
            };
            let number = number(text).and_then(whole);
            number.ok_or_else(|| invalid(NRRD, name, "a whole number", text))
        };
        let lines = one("line skip")?;
        let bytes = one("byte skip")?;
        let wanted = "a number that is not negative";
        let lines = u64::try_from(lines)
            .map_err(|_| invalid(NRRD, "line skip", wanted, &lines.to_string()))?;
        if bytes < 0 && encoding != Encoding::Raw {
            let what = format!("a negative byte skip with encoding {}", encoding.name());
            return Err(unsupported(NRRD, what));
        }
        Ok(Self {
            lines,
            bytes,
            is_compression: matches!(encoding, Encoding::Gzip | Encoding::Bzip2),
        })
    }

    /// Lines are skipped in the file, bytes after decompression. -1 means that the voxels stand last in the
    /// file, -1 - n that n bytes follow them.
    fn part(&self, path: PathBuf, header_bytes: u64) -> Result<Part, ReadError> {
        let start = match u64::try_from(self.bytes) {
            Err(_) => Start::End {
                after_bytes: self.bytes.unsigned_abs().saturating_sub(1),
                earliest: header_bytes,
            },
            Ok(bytes) => {
                let after_lines = match self.lines {
                    0 => header_bytes,
                    lines => offset_after_lines(&path, header_bytes, lines).map_err(at(&path))?,
                };
                match self.is_compression {
                    true => Start::Skip {
                        file_bytes: after_lines,
                        decoded_bytes: bytes,
                    },
                    false => Start::Skip {
                        file_bytes: after_lines.saturating_add(bytes),
                        decoded_bytes: 0,
                    },
                }
            }
        };
        Ok(Part {
            path,
            start,
            encoded_bytes: None,
        })
    }
}
