//! DICOM: a folder of slices, or one file of many frames, to a volume.
//!
//! By DICOM PS3 (dicom.nema.org/medical/dicom/current): PS3.3 for what attributes mean, PS3.5 for how they and the
//! pixels are written, PS3.6 for their names, PS3.10 for files.
//!
//! ```text
//! folder -> every header (dataset, file) -> series (series) -> pictures (picture, moment)
//!        -> sorted by place and time (stack, times) -> Header;  a box -> frames (pixels) -> voxels (source)
//! ```
//!
//! | a series that | becomes |
//! |---|---|
//! | lies on a line, in even steps | a grid; sheared and with a note where the gantry was tilted |
//! | lacks a few slices | a grid with slices without data, with a note |
//! | has uneven steps, turned or shifted slices | an error that names two files |
//! | has slices of other rows, columns, bits or spacing | an error that names two files |
//! | has the same picture twice | a grid of one of each, with a note |
//! | has several pictures in each place | times, by the attribute that tells them apart, with a note |
//! | gives positions to some pictures only | an error that names two files |
//! | gives no positions at all | a stack by instance number, with a note |
//! | has a rescale of its own in each slice | values as f32, with a note |

mod dataset;
mod fence;
mod fields;
mod file;
mod fragments;
mod inflated;
mod jpeg;
mod jpeg2000;
mod layout;
mod line;
mod moment;
mod picture;
mod pixels;
mod quantity;
mod rle;
mod samples;
mod series;
mod source;
mod stack;
mod syntax;
mod tags;
mod times;

use super::convert::to_u64;
use super::geometry::{RAS_FROM_LPS, world_from_voxel};
use super::problem::{at, escape, invalid, unsupported};
use crate::volume::{
    ComponentKind, Format, Header, Limits, Problem, ReadError, Rescale, Series, Source,
    VolumeSelection, VoxelType,
};
use glam::DAffine3;
use layout::{Color, Layout};
use pixels::Frames;
use series::{Contents, Group};
use source::{DicomSource, Kept};
use stack::{Sorting, Stack, stack};
use std::path::Path;

pub(super) use file::{recognizes, recognizes_bare};
pub(super) use series::is_folder_of_pictures;

/// The word of errors.
const DICOM: &str = "dicom";

/// Opens a folder or a file.
pub(super) fn open(
    path: &Path,
    wanted: &VolumeSelection,
    limits: &Limits,
) -> Result<Box<dyn Source>, ReadError> {
    let Contents {
        mut groups,
        without_pictures,
        not_dicom,
    } = series::contents(path, limits)?;
    let mut listed: Vec<Series> = groups.iter().map(Group::series).collect();
    let mut notes = Vec::new();
    let mut passed_over = |count: usize, what: &str| {
        if count > 0 {
            notes.push(format!("{count} files {what} were passed over"));
        }
    };
    passed_over(without_pictures, "with DICOM but no picture");
    passed_over(not_dicom, "that are not DICOM");
    let chosen = match &wanted.series {
        None => 0,
        Some(uid) => groups
            .iter()
            .position(|group| group.uid == *uid)
            .ok_or_else(|| {
                let uids: Vec<&str> = listed.iter().map(|series| series.uid.as_str()).collect();
                at(path)(invalid(
                    DICOM,
                    "series",
                    format!("one of {}", uids.join(", ")),
                    uid,
                ))
            })?,
    };
    if groups.is_empty() {
        let found = format!("{without_pictures} DICOM files without one");
        return Err(at(path)(Problem::Missing {
            format: DICOM,
            field: format!("picture ({found})"),
        }));
    }
    let group = groups.swap_remove(chosen);
    drop(groups);
    listed.get_mut(..=chosen).unwrap_or(&mut []).rotate_right(1);
    let source = open_group(path, group, listed, notes, limits)?;
    Ok(Box::new(source))
}

fn open_group(
    path: &Path,
    group: Group,
    series: Vec<Series>,
    mut notes: Vec<String>,
    limits: &Limits,
) -> Result<DicomSource, ReadError> {
    if let Some(error) = group.refused {
        return Err(error);
    }
    let Group {
        files,
        pictures,
        quantity,
        ..
    } = group;
    let (Some(first), Some(quantity)) = (files.first(), quantity) else {
        return Err(at(path)(Problem::Missing {
            format: DICOM,
            field: "picture".to_owned(),
        }));
    };
    let layout = first.layout;
    let mut frames = Vec::new();
    let mut file_notes = Vec::new();
    for file in &files {
        if !layout.fits(&file.layout) {
            return Err(differ(first, file));
        }
        let (found, note) = Frames::find(file, limits).map_err(at(&file.path))?;
        frames.push(found);
        file_notes.extend([note, file.note.clone()].into_iter().flatten());
    }
    // Hundreds of files may all be odd in the same way.
    if let [first, rest @ ..] = file_notes.as_slice() {
        let others = if rest.is_empty() {
            String::new()
        } else {
            format!(" (and {} more)", rest.len())
        };
        notes.push(format!("{first}{others}"));
    }
    let sorting = Sorting {
        pictures: &pictures,
        files: &files,
    };
    let mut same = |a: usize, b: usize| same_pixels(&sorting, &frames, [a, b], limits);
    let stack = stack(&sorting, &mut same)?;
    notes.extend(stack.notes.iter().cloned());
    if layout.color.samples() > 1 && stack.order.contains(&None) {
        let what = "a series of colour pictures of which some are missing";
        return Err(at(path)(unsupported(DICOM, what)));
    }
    let kept = kept(&pictures, &stack, first, &mut notes);
    let stored = match kept {
        Kept::Stored => layout.stored(),
        _ => VoxelType::F32,
    };
    let world = world(&stack).map_err(at(path))?;
    let dims = dims(&layout, &stack).map_err(at(path))?;
    if quantity.is_turned(&layout) {
        notes.push(
            "the smallest numbers are the brightest (MONOCHROME1): values are turned round"
                .to_owned(),
        );
    }
    if !layout.stored().is_kept_exactly() {
        notes.push(format!(
            "voxels are stored as {} and kept as f32",
            layout.stored().name()
        ));
    }
    let is_color = layout.color.samples() > 1;
    let rescale = pictures
        .first()
        .map(|picture| picture.rescale)
        .unwrap_or_default();
    let header = Header {
        components: layout.color.samples(),
        times: u32::try_from(stack.times).unwrap_or(u32::MAX),
        rescale: if kept == Kept::Values || is_color {
            Rescale::default()
        } else {
            rescale
        },
        fill: match kept {
            Kept::Stored => first.padding.map(|[low, _]| low),
            _ => None,
        },
        hounsfield: quantity.hounsfield,
        modality: quantity.modality,
        unit: quantity.unit,
        meaning: if is_color {
            ComponentKind::Rgb
        } else {
            ComponentKind::Numbers
        },
        is_labels: quantity.is_labels,
        is_patient: pictures
            .first()
            .is_some_and(|picture| picture.directions.is_some()),
        length_metres: Some(1e-3),
        time_names: stack.time_names,
        series,
        notes,
        ..Header::new(Format::Dicom, dims, stored, world)
    };
    Ok(DicomSource {
        path: path.to_owned(),
        header,
        frames,
        order: stack.order,
        kept,
        limits: *limits,
        files,
        pictures,
    })
}

/// From LPS to RAS+.
#[allow(
    clippy::arithmetic_side_effects,
    reason = "vectors of f64: nothing wraps or panics"
)]
fn world(stack: &Stack) -> Result<DAffine3, Problem> {
    let steps = stack.steps.map(|step| step * RAS_FROM_LPS);
    world_from_voxel(steps, stack.first_center * RAS_FROM_LPS).ok_or_else(|| {
        let found = format!("{:?}", stack.steps);
        let field = tags::name(tags::IMAGE_POSITION);
        invalid(DICOM, &field, "steps that span a volume", &found)
    })
}

fn dims(layout: &Layout, stack: &Stack) -> Result<[u32; 3], Problem> {
    match u32::try_from(stack.slices) {
        Ok(slices) if slices > 0 => Ok([layout.columns, layout.rows, slices]),
        _ => Err(invalid(
            DICOM,
            "slices",
            "1 to 2^32 - 1",
            &stack.slices.to_string(),
        )),
    }
}

/// Numbers stay as they are stored wherever one rescale is right for all of them and no slice is missing.
fn kept(
    pictures: &[picture::Picture],
    stack: &Stack,
    first: &file::PictureFile,
    notes: &mut Vec<String>,
) -> Kept {
    let is_color = first.layout.color.samples() > 1;
    let differ = pictures
        .windows(2)
        .any(|pair| matches!(pair, [a, b] if a.rescale != b.rescale));
    let lacks = stack.order.iter().any(Option::is_none);
    if differ && !is_color {
        notes.push("each slice has a rescale of its own: values are kept as f32".to_owned());
        return Kept::Values;
    }
    let has_nothing =
        first.padding.is_some() && !first.layout.is_float && first.layout.bits_allocated <= 16;
    if lacks && !has_nothing && !is_color {
        return Kept::Floats;
    }
    Kept::Stored
}

/// Two pictures that do not make one volume.
fn differ(first: &file::PictureFile, other: &file::PictureFile) -> ReadError {
    let shown = |layout: &Layout| {
        let sign = if layout.is_signed {
            "signed"
        } else {
            "unsigned"
        };
        let color = match layout.color {
            Color::Monochrome => "MONOCHROME2",
            Color::Inverted => "MONOCHROME1",
            _ => "colour",
        };
        format!(
            "{} x {} {color} pixels, {} of {} bits, high bit {}, {sign}",
            layout.columns, layout.rows, layout.bits_stored, layout.bits_allocated, layout.high_bit
        )
    };
    let name = first.path.file_name().unwrap_or(first.path.as_os_str());
    at(&other.path)(Problem::Invalid {
        format: DICOM,
        field: "pixels".to_owned(),
        wanted: format!(
            "{} as in {}",
            shown(&first.layout),
            escape(&name.to_string_lossy())
        ),
        found: shown(&other.layout),
    })
}

fn same_pixels(
    sorting: &Sorting,
    frames: &[Frames],
    pair: [usize; 2],
    limits: &Limits,
) -> Result<bool, ReadError> {
    let mut pixels = Vec::new();
    for index in pair {
        let (picture, file) = (sorting.picture(index)?, sorting.file(index)?);
        let Some(frames) = frames.get(picture.file) else {
            return Ok(false);
        };
        let mut stream = file.open(limits)?;
        let samples = frames.read(file, stream.as_mut(), picture.frame, limits);
        pixels.push((samples.map_err(at(&file.path))?, picture.rescale));
    }
    debug_assert!(to_u64(pixels.len()) == 2, "a pair");
    Ok(matches!(pixels.as_slice(), [a, b] if a == b))
}
