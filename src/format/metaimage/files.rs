//! Which files the voxels of a MetaImage are in: `ElementDataFile`, `HeaderSize`, `CompressedDataSize`.

use super::fields::Fields;
use super::{Array, METAIMAGE};
use crate::format::convert::to_u64;
use crate::format::data::{Part, Start};
use crate::format::decode::Encoding;
use crate::format::place::Folder;
use crate::format::problem::{at, invalid, unsupported};
use crate::format::sequence::{Sequence, template_and_numbers};
use crate::format::text::integers;
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
    let text = fields.data_file().map_err(at(path))?;
    if matches!(text, "LOCAL" | "Local" | "local") {
        let part = part(fields, path.to_owned(), fields.header_bytes, encoding, true);
        return Ok(vec![part.map_err(at(path))?]);
    }
    let folder = Folder::of(path, METAIMAGE, limits).map_err(at(path))?;
    let is_one_file = !text.starts_with("LIST") && !text.contains('%');
    let one = |name: &str| {
        let resolved = folder.resolve(name, METAIMAGE, "ElementDataFile")?;
        part(fields, resolved, 0, encoding, is_one_file).map_err(at(path))
    };
    if is_one_file {
        return Ok(vec![one(text)?]);
    }
    if fields.is_cut {
        // A name or number may have lost its end, and still be that of a file.
        return Err(at(path)(Problem::Invalid {
            format: METAIMAGE,
            field: "ElementDataFile".to_owned(),
            wanted: "a line end behind the last line".to_owned(),
            found: "the end of the file".to_owned(),
        }));
    }
    let check_count = |count: u64, wanted: u64| {
        if count != wanted {
            let wanted = format!("{wanted} files");
            let count = count.to_string();
            return Err(invalid(METAIMAGE, "ElementDataFile", wanted, &count));
        }
        if count > to_u64(limits.max_files) {
            let wanted = format!("at most {} files", limits.max_files);
            let count = count.to_string();
            return Err(invalid(METAIMAGE, "ElementDataFile", wanted, &count));
        }
        Ok(())
    };
    if text.starts_with("LIST") {
        let wanted = files_of_list(text, array).map_err(at(path))?;
        check_count(to_u64(fields.listed_files.len()), wanted).map_err(at(path))?;
        return fields.listed_files.iter().map(|name| one(name)).collect();
    }
    let slices = array.sizes.last().copied().unwrap_or(1);
    let wanted = "a template with perhaps first, last, step: `slice%03d.raw 1 9 1`";
    let fail = || at(path)(invalid(METAIMAGE, "ElementDataFile", wanted, text));
    let sequence = sequence(text, slices.into()).ok_or_else(fail)?;
    check_count(sequence.count(), slices.into()).map_err(at(path))?;
    sequence
        .names()
        .map(|name| one(&name.ok_or_else(fail)?))
        .collect()
}

/// How many files `LIST` or `LIST n` asks for; n is the number of axes of each.
fn files_of_list(text: &str, array: &Array) -> Result<u64, Problem> {
    let fail = || {
        let wanted = "`LIST`, perhaps with the number of axes of a file";
        invalid(METAIMAGE, "ElementDataFile", wanted, text)
    };
    let axes = array.sizes.len();
    let rest = text.strip_prefix("LIST").unwrap_or("");
    let of_a_file = match *integers(rest).ok_or_else(fail)?.as_slice() {
        [] => axes.saturating_sub(1),
        [n] => usize::try_from(n)
            .ok()
            .filter(|n| (1..=axes).contains(n))
            .ok_or_else(fail)?,
        _ => return Err(fail()),
    };
    let others = array.sizes.iter().skip(of_a_file);
    Ok(others.fold(1, |count: u64, &size| count.saturating_mul(size.into())))
}

/// Numbers run from 1, or from the first number on; without a step they are spread evenly.
fn sequence(text: &str, slices: i64) -> Option<Sequence> {
    let (template, numbers) = template_and_numbers(text)?;
    let steps = slices.checked_sub(1)?;
    match *numbers.as_slice() {
        [] => Sequence::new(template, 1, slices, 1),
        [first] => Sequence::new(template, first, first.checked_add(steps)?, 1),
        [first, last] => {
            let step = last.checked_sub(first)?.checked_div(steps.max(1))?.max(1);
            Sequence::new(template, first, last, step)
        }
        [first, last, step] => Sequence::new(template, first, last, step),
        _ => None,
    }
}

/// One file of voxels; `data_begins` is where they do if `HeaderSize` does not say otherwise.
fn part(
    fields: &Fields,
    path: PathBuf,
    data_begins: u64,
    encoding: Encoding,
    is_one_file: bool,
) -> Result<Part, Problem> {
    let encoded_bytes = match fields.integer("CompressedDataSize")? {
        // One number cannot be the size of several files.
        Some(size) if size != 0 && encoding == Encoding::Gzip && is_one_file => {
            let size = u64::try_from(size).map_err(|_| {
                let wanted = "a number that is not negative";
                invalid(METAIMAGE, "CompressedDataSize", wanted, &size.to_string())
            })?;
            Some((size, "CompressedDataSize"))
        }
        _ => None,
    };
    let start = match fields.integer("HeaderSize")? {
        None | Some(0) => Start::Skip {
            file_bytes: data_begins,
            decoded_bytes: 0,
        },
        Some(-1) if encoding == Encoding::Raw || encoded_bytes.is_some() => Start::End {
            after_bytes: 0,
            earliest: data_begins,
        },
        Some(-1) => {
            let what = format!(
                "HeaderSize -1 with {} data of unknown size",
                encoding.name()
            );
            return Err(unsupported(METAIMAGE, what));
        }
        Some(size) => Start::Skip {
            file_bytes: u64::try_from(size)
                .map_err(|_| invalid(METAIMAGE, "HeaderSize", "-1 or more", &size.to_string()))?,
            decoded_bytes: 0,
        },
    };
    Ok(Part {
        path,
        start,
        encoded_bytes,
    })
}
