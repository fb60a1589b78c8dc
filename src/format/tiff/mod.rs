//! TIFF: stacks of pages in one file, of OME or ImageJ or plain, and folders of slices.
//!
//! ```text
//! path -> directories (ifd) -> page (what, where) -> all alike? -> which page is which z, channel, time -> PageSource
//! read -> pages of the box -> their strips or tiles (chunk) -> rows of one sample (samples) -> voxels
//! ```
//!
//! World is x right and y down the picture, z from page to page, from the corner of the first pixel, in the unit
//! that the file gives; a header's notes say which.

mod chunk;
mod contiguous;
mod folder;
mod ifd;
mod imagej;
mod jpeg;
mod kind;
mod length;
mod ome;
mod page;
mod palette;
mod samples;
mod single;
mod source;
mod volume;

use super::place::Folder;
use super::problem::{at, escape, invalid, unsupported};
use crate::volume::{ComponentKind, Limits, ReadError, Source, VolumeSelection};
use imagej::Hyperstack;
use page::{Color, Look};
use single::Single;
use source::PageAt;
use std::path::Path;
use volume::Parts;

pub(super) use folder::{open_folder, recognizes_folder};

/// The word of errors.
const TIFF: &str = "tiff";

/// True where a file begins as a TIFF or BigTIFF does.
pub(super) fn recognizes(first: &[u8]) -> bool {
    let heads = [b"II\x2a\0", b"MM\0\x2a", b"II\x2b\0", b"MM\0\x2b"];
    heads.iter().any(|head| first.starts_with(*head))
}

/// Opens a file; of several images of an OME-TIFF `wanted` takes one.
pub(super) fn open(
    path: &Path,
    wanted: &VolumeSelection,
    limits: &Limits,
) -> Result<Box<dyn Source>, ReadError> {
    let mut file = Single::open(path, limits).map_err(at(path))?;
    let description = file.description(limits).map_err(at(path))?;
    if ome::is_ome(&description) {
        open_ome(path, file, &description, wanted, limits)
    } else if imagej::is_imagej(&description) {
        open_imagej(path, file, &description, limits)
    } else if is_truncated(&description) {
        let what = "a stack of which only the first page has a directory (tifffile's `truncated`)";
        Err(at(path)(unsupported(TIFF, what)))
    } else {
        open_plain(path, file, limits)
    }
}

/// tifffile's own description of a stack, whose later pages lie behind the first without directories.
fn is_truncated(description: &str) -> bool {
    description.starts_with("{\"shape\":") && description.contains("\"truncated\": true")
}

/// Pages are layers.
fn open_plain(
    path: &Path,
    mut file: Single,
    limits: &Limits,
) -> Result<Box<dyn Source>, ReadError> {
    let mut notes = Vec::new();
    file.skip_small_copies(&mut notes).map_err(at(path))?;
    let spacing = file.spacing().map_err(at(path))?;
    let depth = u32::try_from(file.pages.len()).unwrap_or(u32::MAX);
    let pages: Vec<PageAt> = file.places(0).collect();
    let parts = Parts {
        depth,
        spacing,
        notes,
        ..Parts::new(vec![path.to_owned()], pages)
    };
    Ok(Box::new(parts.source(path, limits)?))
}

fn open_imagej(
    path: &Path,
    mut file: Single,
    description: &str,
    limits: &Limits,
) -> Result<Box<dyn Source>, ReadError> {
    let count = u32::try_from(file.pages.len()).unwrap_or(u32::MAX);
    let resolution = file.resolution().map_err(at(path))?;
    let stack = Hyperstack::read(description, resolution, count);
    let pages: Vec<PageAt> = file.places(0).collect();
    let has_all = stack.images.is_none_or(|images| images <= count);
    let parts = Parts {
        channels: stack.channels,
        depth: stack.slices,
        times: stack.frames,
        spacing: stack.spacing,
        time_names: stack.time_names,
        notes: stack.notes,
        // ImageJ's color maps are looking glasses: what it measures are the numbers.
        keeps_numbers: true,
        ..Parts::new(vec![path.to_owned()], pages)
    };
    if !has_all {
        return contiguous::open(path, &mut file, parts, limits);
    }
    let pages = in_our_order(&parts);
    Ok(Box::new(Parts { pages, ..parts }.source(path, limits)?))
}

/// Channels fastest, then slices, then frames, to slices fastest.
fn in_our_order(parts: &Parts) -> Vec<PageAt> {
    let (channels, depth) = (to_usize(parts.channels), to_usize(parts.depth));
    let mut pages = Vec::new();
    for frame in parts.pages.chunks(channels.saturating_mul(depth).max(1)) {
        for channel in 0..channels {
            pages.extend(frame.iter().skip(channel).step_by(channels.max(1)));
        }
    }
    pages
}

fn open_ome(
    path: &Path,
    file: Single,
    description: &str,
    wanted: &VolumeSelection,
    limits: &Limits,
) -> Result<Box<dyn Source>, ReadError> {
    let mut image = ome::read(description, wanted.variable.as_deref()).map_err(at(path))?;
    let own_name = path
        .file_name()
        .and_then(|name| name.to_str())
        .unwrap_or("");
    let others = image.other_files(own_name);
    if others.len() >= limits.max_files {
        let wanted = format!("at most {} files", limits.max_files);
        let found = others.len().to_string();
        return Err(at(path)(invalid(TIFF, "TiffData", wanted, &found)));
    }
    let mut files = vec![path.to_owned()];
    let mut opened = vec![file];
    if !others.is_empty() {
        let folder = Folder::of(path, TIFF, limits).map_err(at(path))?;
        for name in &others {
            let other = folder.resolve(name, TIFF, "FileName")?;
            opened.push(Single::open(&other, limits).map_err(at(&other))?);
            files.push(other);
        }
    }
    let index_of = |name: Option<&str>| {
        let other = name.and_then(|name| others.iter().position(|other| other == name));
        other.map_or(0, |index| index.saturating_add(1))
    };
    let (file, number) = image.first_page();
    let look = opened
        .get_mut(index_of(file))
        .ok_or_else(|| invalid(TIFF, "TiffData", "a file", "none"))
        .and_then(|file| file.page(number, limits))
        .map_err(at(path))?
        .look;
    let (channel_pages, components_agree) = match volume::components(look) {
        1 => (image.channel_count, true),
        n => (1, n == image.channel_count || n == look.samples),
    };
    if !components_agree {
        let what = format!(
            "{} channels in pages of {} samples",
            image.channel_count, look.samples
        );
        return Err(at(path)(unsupported(TIFF, what)));
    }
    if image.page_size != [look.width, look.height] {
        let wanted = format!("the pages' {} x {}", look.width, look.height);
        let found = format!("{:?}", image.page_size);
        return Err(at(path)(invalid(TIFF, "SizeX, SizeY", wanted, &found)));
    }
    let counts: Vec<u64> = opened
        .iter()
        .map(|file| super::convert::to_u64(file.pages.len()))
        .collect();
    let pages_of = |name: Option<&str>| counts.get(index_of(name)).copied().unwrap_or(0);
    let names = image
        .pages(channel_pages, limits.max_files, pages_of)
        .map_err(at(path))?;
    let mut pages = Vec::new();
    for name in names {
        let file = index_of(name.file.as_deref());
        let number = usize::try_from(name.number).unwrap_or(usize::MAX);
        let ifd = opened.get(file).and_then(|file| file.pages.get(number));
        let Some(&ifd) = ifd else {
            let found = name.number.to_string();
            return Err(at(path)(invalid(TIFF, "IFD", "a page", &found)));
        };
        pages.push(PageAt { file, ifd, number });
    }
    let meaning = (channel_pages > 1).then_some(ComponentKind::Channels(image.channels));
    let parts = Parts {
        channels: channel_pages,
        depth: image.depth,
        times: image.times,
        spacing: image.spacing,
        time_names: image.time_names,
        variables: image.names,
        notes: image.notes,
        meaning,
        ..Parts::new(files, pages)
    };
    Ok(Box::new(parts.source(path, limits)?))
}

/// Text of a file for a header: no control characters, and not without end.
fn clean(text: &str) -> String {
    let text = text.trim();
    let is_plain = text.len() <= 200 && !text.chars().any(char::is_control);
    match is_plain {
        true => text.to_owned(),
        false => escape(text),
    }
}

/// True for numbers that stand for colors of a map.
fn is_indexed(look: Look) -> bool {
    look.color == Color::Palette
}

/// No machine has a usize below 32 bits.
fn to_usize(n: u32) -> usize {
    samples::side(n)
}
