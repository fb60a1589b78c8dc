//! ImageJ's stacks beyond 4 GiB: one directory, and the pages one after the other behind the first.

use super::TIFF;
use super::chunk::Compression;
use super::page::{Look, Page};
use super::single::Single;
use super::volume::Parts;
use crate::format::data::{Data, Part, Promise, Start};
use crate::format::decode::Encoding;
use crate::format::file_source::FileSource;
use crate::format::problem::{at, unsupported};
use crate::format::select::{Axis, Role};
use crate::volume::{Limits, Problem, ReadError, Source};
use std::path::Path;

pub(super) fn open(
    path: &Path,
    file: &mut Single,
    parts: Parts,
    limits: &Limits,
) -> Result<Box<dyn Source>, ReadError> {
    let page = file.page(0, limits).map_err(at(path))?;
    check(&page, file.pages.len()).map_err(at(path))?;
    let mut header = parts
        .header(page.look, page.look.stored)
        .map_err(at(path))?;
    header
        .notes
        .push("only the first page has a directory: the others lie behind it".to_owned());
    let promise = Promise {
        format: TIFF,
        stored: page.look.stored,
        endian: file.reader.endian,
        encoding: Encoding::Raw,
        axes: axes(&parts, page.look),
        parts: vec![Part {
            path: path.to_owned(),
            start: Start::Skip {
                file_bytes: page.first_offset(),
                decoded_bytes: 0,
            },
            encoded_bytes: None,
        }],
    };
    let mut data = Data::find(promise, path)?;
    // Directories may lie behind the pages.
    data.notes.clear();
    // The header says already what the source would add about types that are rounded.
    let rounded = header
        .notes
        .iter()
        .position(|note| note.starts_with("voxels are stored as"));
    rounded.map(|index| header.notes.remove(index));
    Ok(Box::new(FileSource::new(path, header, data, limits)))
}

/// The first page is one piece, as it is in memory.
fn check(page: &Page, directories: usize) -> Result<(), Problem> {
    let is_plain = page.compression == Compression::None
        && !page.is_tiled
        && !page.is_planar
        && page.look.bits >= 8
        && page.is_one_piece();
    if directories == 1 && is_plain {
        return Ok(());
    }
    let what = format!(
        "a stack of which only {directories} pages have a directory, and these are not plain"
    );
    Err(unsupported(TIFF, what))
}

fn axes(parts: &Parts, look: Look) -> Vec<Axis> {
    let axis = |role, size: u32| Axis {
        role,
        size: size.into(),
    };
    let [samples, channels] = match look.samples {
        1 => [None, Some(axis(Role::Component, parts.channels))],
        n => [Some(axis(Role::Component, n)), None],
    };
    let space = [
        axis(Role::Space(0), look.width),
        axis(Role::Space(1), look.height),
    ];
    let slow = [
        axis(Role::Space(2), parts.depth),
        axis(Role::Time, parts.times),
    ];
    samples
        .into_iter()
        .chain(space)
        .chain(channels)
        .chain(slow)
        .collect()
}
