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
/// How far off the line a slice may lie, in steps: positions are often rounded to a tenth of a millimetre.
const OFF_LINE: f64 = 0.1;
/// Unit vectors of one direction differ by no more.
const SAME_DIRECTION: f64 = 1e-3;
/// Spacings that are the same differ by no more, relatively.
const SAME_SPACING: f64 = 1e-3;
/// One in so many slices may be missing.
const MISSING: usize = 10;

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

/// The slices of a stack on a line.
struct Line {
    step: DVec3,
    /// For each place its slice.
    index: Vec<usize>,
}

fn line(
    sorting: &Sorting,
    places: &Places,
    normal: DVec3,
    notes: &mut Vec<String>,
) -> Result<Line, ReadError> {
    let firsts: Vec<usize> = places
        .iter()
        .filter_map(|place| place.first().copied())
        .collect();
    let mut positions = Vec::new();
    for first in &firsts {
        positions.push(sorting.picture(*first)?.position.unwrap_or(DVec3::ZERO));
    }
    let distances: Vec<f64> = positions
        .windows(2)
        .map(|pair| match pair {
            [a, b] => (*b - *a).dot(normal),
            _ => 0.0,
        })
        .collect();
    let mut sorted = distances.clone();
    sorted.sort_by(f64::total_cmp);
    let usual = sorted.get(sorted.len() / 2).copied().unwrap_or(1.0);
    let even: Vec<usize> = (0..positions.len()).collect();
    let (index, missing) = match on_line(&positions, &even) {
        Some(_) => (even, 0),
        None => with_gaps(&distances, usual),
    };
    let allowed = (positions.len() / MISSING).max(1);
    let fit = on_line(&positions, &index).filter(|_| missing <= allowed);
    // The largest distance is where a picture is missing, or where the stack changes its step.
    let widest = distances
        .iter()
        .enumerate()
        .max_by(|a, b| a.1.total_cmp(b.1))
        .map_or(0, |(k, _)| k);
    let (before, after) = (
        firsts.get(widest).copied().unwrap_or(0),
        firsts.get(widest + 1).copied().unwrap_or(0),
    );
    let width = distances.get(widest).copied().unwrap_or(0.0);
    let Some((step, off)) = fit else {
        let wanted = format!("slices on a line, each {usual} mm after the last");
        let found = format!(
            "{width} mm between {} and {}",
            sorting.name(before),
            sorting.name(after)
        );
        return Err(sorting.wrong(after, IMAGE_POSITION, wanted, found));
    };
    if missing > 0 {
        let slices = if missing == 1 {
            "slice is"
        } else {
            "slices are"
        };
        notes.push(format!(
            "{missing} {slices} missing, the first of the widest gap between {} and {} ({width} mm instead of {usual}): they hold no data",
            sorting.name(before), sorting.name(after)
        ));
    }
    if off > 0.01 {
        notes.push(format!(
            "slices lie up to {:.1} % of their distance beside even steps",
            off * 100.0
        ));
    }
    let tilt = step.angle_between(normal).to_degrees();
    if tilt > 0.05 {
        notes.push(format!("the slices are shifted against each other, by a gantry tilted {tilt:.2} degrees: they are drawn as they lie"));
    }
    Ok(Line { step, index })
}

/// The step that leads from the first to the last, if all others lie on the way, and how far off in steps.
fn on_line(positions: &[DVec3], index: &[usize]) -> Option<(DVec3, f64)> {
    let (first, last) = (positions.first()?, positions.last()?);
    #[allow(
        clippy::cast_precision_loss,
        reason = "there are less than 2^52 slices"
    )]
    let number = |index: usize| index as f64;
    let step = (*last - *first) / number(*index.last()?);
    let off = positions
        .iter()
        .zip(index)
        .map(|(position, index)| position.distance(*first + step * number(*index)) / step.length());
    let worst = off.fold(0.0, f64::max);
    (worst <= OFF_LINE).then_some((step, worst))
}

/// Slices where each distance is a number of usual ones, and how many are missing between them.
fn with_gaps(distances: &[f64], usual: f64) -> (Vec<usize>, usize) {
    let mut index = vec![0_usize];
    let mut missing = 0_usize;
    for distance in distances {
        let steps = (distance / usual).round().clamp(1.0, 1e6);
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "1 to 10^6"
        )]
        let steps = steps as usize;
        missing = missing.saturating_add(steps - 1);
        index.push(index.last().copied().unwrap_or(0).saturating_add(steps));
    }
    (index, missing)
}
