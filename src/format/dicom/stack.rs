//! Pictures to a grid: sorted by where they lie along their normal, whatever their names and numbers say.
//!
//! ```text
//! distance = position . normal,   centre(column, row, slice) = first + column * x + row * y + slice * step
//! ```
//! The step between slices comes from their positions, so that a tilted gantry gives a sheared grid. Where
//! pictures are missing there are slices without data: nothing is invented, and nothing moves.

#![allow(
    clippy::arithmetic_side_effects,
    reason = "vectors of f64: nothing wraps or panics"
)]

use super::DICOM;
use super::file::PictureFile;
use super::line::{Line, line};
use super::picture::Picture;
use super::tags::{self, *};
use super::times::{Places, Same, times};
use crate::format::problem::{at, escape};
use crate::volume::{Problem, ReadError};
use glam::DVec3;

/// Where the pictures of a series lie.
#[derive(Debug)]
pub(super) struct Stack {
    /// The centre of the first voxel, LPS.
    pub first_center: DVec3,
    /// From voxel to voxel along a row, a column and the stack, LPS.
    pub steps: [DVec3; 3],
    pub slices: usize,
    pub times: usize,
    /// For each time each slice: the picture, or none where one is missing.
    pub order: Vec<Option<usize>>,
    pub time_names: Vec<String>,
    pub notes: Vec<String>,
}

/// Pictures nearer than this part of a pixel lie in one place.
const SAME_PLACE: f64 = 0.01;
/// Unit vectors of one direction differ by no more.
const SAME_DIRECTION: f64 = 1e-3;
/// Spacings that are the same differ by no more, relatively.
const SAME_SPACING: f64 = 1e-3;

/// What the sorting works on.
pub(super) struct Sorting<'a> {
    pub pictures: &'a [Picture],
    pub files: &'a [PictureFile],
}

impl Sorting<'_> {
    pub(super) fn picture(&self, index: usize) -> Result<&Picture, ReadError> {
        self.pictures.get(index).ok_or_else(|| self.lost())
    }

    pub(super) fn file(&self, index: usize) -> Result<&PictureFile, ReadError> {
        let picture = self.picture(index)?;
        self.files.get(picture.file).ok_or_else(|| self.lost())
    }

    /// There are no indices beyond the pictures; this keeps a mistake of ours from being a panic.
    fn lost(&self) -> ReadError {
        at("".as_ref())(Problem::UnknownFormat(": no picture".to_owned()))
    }

    /// The name of a picture for a sentence.
    pub(super) fn name(&self, index: usize) -> String {
        let (Ok(picture), Ok(file)) = (self.picture(index), self.file(index)) else {
            return String::new();
        };
        let name = file.path.file_name().unwrap_or(file.path.as_os_str());
        let name = escape(&name.to_string_lossy());
        match file.layout.frames {
            1 => name,
            _ => format!("frame {} of {name}", picture.frame),
        }
    }

    /// An error about one picture, which `wanted` may compare with another.
    pub(super) fn wrong(&self, index: usize, tag: u32, wanted: String, found: String) -> ReadError {
        let path = self
            .file(index)
            .map(|file| file.path.clone())
            .unwrap_or_default();
        let frame = match (self.file(index), self.picture(index)) {
            (Ok(file), Ok(picture)) if file.layout.frames > 1 => {
                format!(" of frame {}", picture.frame)
            }
            _ => String::new(),
        };
        let field = tags::name(tag) + &frame;
        at(&path)(Problem::Invalid {
            format: DICOM,
            field,
            wanted,
            found,
        })
    }
}

/// Sorts the pictures of one series. `same` tells whether two of them have the same pixels.
pub(super) fn stack(sorting: &Sorting, same: Same) -> Result<Stack, ReadError> {
    let mut notes = Vec::new();
    let [along_row, along_column] = common_directions(sorting, &mut notes)?;
    let [x, y] = common_spacing(sorting, &mut notes)?;
    let normal = along_row.cross(along_column).normalize_or(DVec3::Z);
    let are_known = all_or_none(sorting)?;
    let places = if are_known {
        places(sorting, normal, x.min(y) * SAME_PLACE)?
    } else {
        places_by_number(sorting, &mut notes)?
    };
    let times = times(sorting, places, same, &mut notes)?;
    let count = times.places.len();
    let first = times
        .places
        .first()
        .and_then(|place| place.first())
        .copied()
        .unwrap_or(0);
    let thickness = sorting
        .picture(first)?
        .slice_step
        .map(f64::abs)
        .filter(|step| *step > 0.0);
    let origin = sorting.picture(first)?.position.unwrap_or(DVec3::ZERO);
    let line = if are_known && count > 1 {
        line(sorting, &times.places, normal, &mut notes)?
    } else {
        if count > 1 && thickness.is_none() {
            notes.push("the files give no distance between slices: 1 is taken".to_owned());
        }
        let step = normal * thickness.unwrap_or(if count > 1 { 1.0 } else { x.min(y) });
        Line {
            step,
            index: (0..count).collect(),
        }
    };
    let slices = line.index.last().map_or(0, |last| last + 1);
    let mut order = vec![None; slices.saturating_mul(times.count)];
    for (place, index) in times.places.iter().zip(&line.index) {
        for (time, picture) in place.iter().enumerate() {
            if let Some(entry) = order.get_mut(time.saturating_mul(slices).saturating_add(*index)) {
                *entry = Some(*picture);
            }
        }
    }
    Ok(Stack {
        first_center: origin,
        steps: [along_row * x, along_column * y, line.step],
        slices,
        times: times.count,
        order,
        time_names: times.names,
        notes,
    })
}

/// True where every picture says where it lies, false where none does.
fn all_or_none(sorting: &Sorting) -> Result<bool, ReadError> {
    let has = |picture: &Picture| picture.position.is_some();
    let with = sorting.pictures.iter().position(has);
    let without = sorting.pictures.iter().position(|picture| !has(picture));
    match (with, without) {
        (Some(with), Some(without)) => {
            let wanted = format!("a position, as {} has one", sorting.name(with));
            Err(sorting.wrong(without, IMAGE_POSITION, wanted, "none".to_owned()))
        }
        (with, _) => Ok(with.is_some()),
    }
}

fn common_directions(sorting: &Sorting, notes: &mut Vec<String>) -> Result<[DVec3; 2], ReadError> {
    let of = |index: usize| sorting.picture(index).map(|picture| picture.directions);
    let first = of(0)?;
    for index in 1..sorting.pictures.len() {
        let same = match (first, of(index)?) {
            (None, None) => true,
            (Some(a), Some(b)) => a
                .iter()
                .zip(b)
                .all(|(a, b)| a.distance(b) <= SAME_DIRECTION),
            _ => false,
        };
        if !same {
            let shown = |directions: Option<[DVec3; 2]>| {
                directions.map_or("none".to_owned(), |[row, column]| format!("{row} {column}"))
            };
            let wanted = format!("{} as in {}", shown(first), sorting.name(0));
            return Err(sorting.wrong(index, IMAGE_ORIENTATION, wanted, shown(of(index)?)));
        }
    }
    if first.is_none() {
        notes.push("the files do not say how the patient lay: rows are taken from right to left, columns from front to back".to_owned());
    }
    Ok(first.unwrap_or([DVec3::X, DVec3::Y]))
}

fn common_spacing(sorting: &Sorting, notes: &mut Vec<String>) -> Result<[f64; 2], ReadError> {
    let of = |index: usize| sorting.picture(index).map(|picture| picture.spacing);
    let first = of(0)?;
    for index in 1..sorting.pictures.len() {
        let same = match (first, of(index)?) {
            (None, None) => true,
            (Some(a), Some(b)) => a
                .iter()
                .zip(b)
                .all(|(a, b)| (a - b).abs() <= SAME_SPACING * a),
            _ => false,
        };
        if !same {
            let shown = |spacing: Option<[f64; 2]>| {
                spacing.map_or("none".to_owned(), |[x, y]| format!("{y} {x}"))
            };
            let wanted = format!("{} as in {}", shown(first), sorting.name(0));
            return Err(sorting.wrong(index, PIXEL_SPACING, wanted, shown(of(index)?)));
        }
    }
    if first.is_none() {
        notes.push("the files give no distance between pixels: 1 is taken".to_owned());
    }
    Ok(first.unwrap_or([1.0; 2]))
}

/// Pictures at the same distance along the normal, nearest first.
fn places(sorting: &Sorting, normal: DVec3, apart: f64) -> Result<Places, ReadError> {
    let position = |index: usize| {
        let picture = sorting.picture(index)?;
        Ok(picture.position.unwrap_or(DVec3::ZERO))
    };
    let mut sorted = Vec::new();
    for index in 0..sorting.pictures.len() {
        sorted.push((position(index)?.dot(normal), index));
    }
    // Pictures of one place keep the order of their files.
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let mut places: Places = Vec::new();
    let mut start = f64::NEG_INFINITY;
    for (distance, index) in sorted {
        match places.last_mut() {
            Some(place) if distance - start <= apart => {
                let first = place.first().copied().unwrap_or(index);
                let shift = position(index)?.distance(position(first)?);
                if shift > 2.0 * apart {
                    let wanted = format!(
                        "the place of {}, which lies in the same plane",
                        sorting.name(first)
                    );
                    let found = format!("{shift} mm beside it");
                    return Err(sorting.wrong(index, IMAGE_POSITION, wanted, found));
                }
                place.push(index);
            }
            _ => {
                start = distance;
                places.push(vec![index]);
            }
        }
    }
    Ok(places)
}

/// Without positions: frames of a film lie in one place, all else follows its number.
fn places_by_number(sorting: &Sorting, notes: &mut Vec<String>) -> Result<Places, ReadError> {
    use super::moment::Kind;
    let is_film = |picture: &Picture| Kind::Frame.of(&picture.moments).is_some();
    if sorting.pictures.iter().all(is_film) {
        return Ok(vec![(0..sorting.pictures.len()).collect()]);
    }
    if sorting.pictures.len() > 1 {
        notes.push(
            "the files do not say where their pictures lie: they are stacked by their numbers"
                .to_owned(),
        );
    }
    let mut sorted: Vec<usize> = (0..sorting.pictures.len()).collect();
    let number = |index: &usize| {
        sorting
            .picture(*index)
            .ok()
            .and_then(|picture| picture.instance)
    };
    sorted.sort_by(|a, b| {
        let (a, b) = (
            number(a).unwrap_or(f64::INFINITY),
            number(b).unwrap_or(f64::INFINITY),
        );
        a.total_cmp(&b)
    });
    Ok(sorted.into_iter().map(|index| vec![index]).collect())
}
