//! One frame: where it lies, when it was taken and what its numbers mean. By DICOM PS3.3: C.7.6.2 for one picture
//! a file, C.7.6.16.2 for functional groups, C.8.4.8 and C.8.4.9 for nuclear medicine, C.8.8.3 for dose.

#![allow(
    clippy::arithmetic_side_effects,
    reason = "vectors of f64: nothing wraps or panics"
)]

use super::DICOM;
use super::fields::DataSet;
use super::moment::{Kind, moments};
use super::tags::{self, *};
use crate::format::problem::invalid;
use crate::volume::{Problem, Rescale};
use glam::DVec3;

/// One frame of one file.
#[derive(Clone, Debug)]
pub(super) struct Picture {
    /// Index of its file.
    pub file: usize,
    /// Index in its file.
    pub frame: u32,
    /// The centre of its first pixel, LPS.
    pub position: Option<DVec3>,
    /// Unit vectors along a row and along a column, LPS.
    pub directions: Option<[DVec3; 2]>,
    /// Between columns and between rows.
    pub spacing: Option<[f64; 2]>,
    /// From this slice to the next, where the file says so; its thickness where it does not.
    pub slice_step: Option<f64>,
    pub rescale: Rescale,
    pub instance: Option<f64>,
    /// What can tell pictures of one place apart.
    pub moments: [Option<f64>; Kind::COUNT],
}

/// All frames of a file.
pub(super) fn pictures(set: &DataSet, file: usize, frames: u32) -> Result<Vec<Picture>, Problem> {
    let shared = set.item(SHARED_FUNCTIONAL_GROUPS);
    let own = set.items(PER_FRAME_FUNCTIONAL_GROUPS);
    let count = usize::try_from(frames).unwrap_or(usize::MAX);
    if !own.is_empty() && own.len() != count {
        let wanted = format!("an item for each of {frames} frames");
        let found = format!("{} items", own.len());
        let field = tags::name(PER_FRAME_FUNCTIONAL_GROUPS);
        return Err(invalid(DICOM, &field, wanted, &found));
    }
    let plain = plain(set, file)?;
    if shared.is_none() && own.is_empty() {
        return repeated(set, &plain, frames);
    }
    let empty = DataSet::default();
    let mut pictures = Vec::new();
    for (frame, own) in (0..frames).zip(own.iter().chain(std::iter::repeat(&empty))) {
        let groups = [Some(own), shared, Some(set)];
        pictures.push(enhanced(groups, &plain, frame)?);
    }
    Ok(pictures)
}

/// What the attributes at the root of a data set say.
fn plain(set: &DataSet, file: usize) -> Result<Picture, Problem> {
    let detector = set
        .item(DETECTOR_INFORMATION)
        .filter(|_| !set.has(IMAGE_POSITION));
    let place = detector.unwrap_or(set);
    let spacing = match set.vector(PIXEL_SPACING)? {
        Some(spacing) => Some(spacing),
        None => set.vector(IMAGER_PIXEL_SPACING)?,
    };
    let step = set.number(SPACING_BETWEEN_SLICES)?;
    Ok(Picture {
        file,
        frame: 0,
        position: place.vector(IMAGE_POSITION)?.map(DVec3::from_array),
        directions: directions(place)?,
        spacing: ordered(spacing)?,
        slice_step: match step {
            Some(step) => Some(step),
            None => set.number(SLICE_THICKNESS)?,
        },
        rescale: rescale(set)?,
        instance: set.number(INSTANCE_NUMBER)?,
        moments: moments(&[Some(set)])?,
    })
}

/// Frames without functional groups: along the normal, as a dose or an old scan of nuclear medicine has them.
fn repeated(set: &DataSet, first: &Picture, frames: u32) -> Result<Vec<Picture>, Problem> {
    let offsets = set.numbers(GRID_FRAME_OFFSET_VECTOR)?;
    let count = usize::try_from(frames).unwrap_or(usize::MAX);
    if let Some(offsets) = &offsets
        && offsets.len() != count
    {
        let wanted = format!("{frames} numbers");
        let found = format!("{} numbers", offsets.len());
        return Err(invalid(
            DICOM,
            &tags::name(GRID_FRAME_OFFSET_VECTOR),
            wanted,
            &found,
        ));
    }
    let time = match set.tag(FRAME_INCREMENT_POINTER) {
        // Where the times between frames differ, frames are counted.
        Some(FRAME_TIME | FRAME_TIME_VECTOR) => match set.number(FRAME_TIME) {
            Ok(Some(milliseconds)) if milliseconds > 0.0 => Some(milliseconds),
            _ => Some(1.0),
        },
        _ => None,
    };
    let [along_row, along_column] = first.directions.unwrap_or([DVec3::X, DVec3::Y]);
    let normal = along_row.cross(along_column);
    let step = first.slice_step.filter(|step| *step != 0.0);
    let origin = first.position.unwrap_or(DVec3::ZERO);
    let first_offset = offsets
        .as_ref()
        .and_then(|offsets| offsets.first())
        .copied()
        .unwrap_or(0.0);
    let mut pictures = Vec::new();
    for frame in 0..frames {
        let index = usize::try_from(frame).unwrap_or(usize::MAX);
        let distance = match &offsets {
            // Offsets begin with 0, or are coordinates along the normal.
            Some(offsets) => offsets.get(index).map(|offset| offset - first_offset),
            None => Some(f64::from(frame) * step.unwrap_or(1.0)),
        };
        let mut picture = Picture {
            frame,
            ..first.clone()
        };
        if let Some(milliseconds) = time {
            Kind::Frame.put(&mut picture.moments, f64::from(frame) * milliseconds);
        } else if frames > 1 {
            picture.position = distance.map(|distance| origin + normal * distance);
            picture.directions = Some([along_row, along_column]);
        }
        pictures.push(picture);
    }
    Ok(pictures)
}

/// A frame with functional groups: its own before those that all share before the root.
fn enhanced(
    groups: [Option<&DataSet>; 3],
    plain: &Picture,
    frame: u32,
) -> Result<Picture, Problem> {
    let item = |tag| groups.iter().flatten().find_map(|group| group.item(tag));
    let measures = item(PIXEL_MEASURES);
    let from_measures = |tag| measures.map_or(Ok(None), |item| item.number(tag));
    let spacing = measures.map_or(Ok(None), |item| item.vector(PIXEL_SPACING))?;
    let position = item(PLANE_POSITION).map_or(Ok(None), |item| item.vector(IMAGE_POSITION))?;
    let turned = item(PLANE_ORIENTATION).map_or(Ok(None), directions)?;
    let transformed = item(PIXEL_VALUE_TRANSFORMATION).map(rescale).transpose()?;
    let of_moment = [
        item(FRAME_CONTENT),
        item(MR_DIFFUSION),
        item(MR_ECHO),
        item(CARDIAC_SYNCHRONIZATION),
        item(SEGMENT_IDENTIFICATION),
    ];
    Ok(Picture {
        frame,
        position: position.map(DVec3::from_array).or(plain.position),
        directions: turned.or(plain.directions),
        spacing: ordered(spacing)?.or(plain.spacing),
        slice_step: match from_measures(SPACING_BETWEEN_SLICES)? {
            Some(step) => Some(step),
            None => from_measures(SLICE_THICKNESS)?.or(plain.slice_step),
        },
        rescale: transformed.unwrap_or(plain.rescale),
        moments: moments(&of_moment)?,
        ..plain.clone()
    })
}

/// DICOM gives the distance of rows first: along y.
fn ordered(spacing: Option<[f64; 2]>) -> Result<Option<[f64; 2]>, Problem> {
    match spacing {
        Some([y, x]) if y > 0.0 && x > 0.0 => Ok(Some([x, y])),
        Some(other) => {
            let found = format!("{other:?}");
            Err(invalid(
                DICOM,
                &tags::name(PIXEL_SPACING),
                "two numbers above 0",
                &found,
            ))
        }
        None => Ok(None),
    }
}

fn directions(set: &DataSet) -> Result<Option<[DVec3; 2]>, Problem> {
    let Some([a, b, c, d, e, f]) = set.vector(IMAGE_ORIENTATION)? else {
        return Ok(None);
    };
    let (row, column) = (DVec3::new(a, b, c), DVec3::new(d, e, f));
    // What digits in words leave open is far less.
    let are_unit = [row, column]
        .iter()
        .all(|v| (v.length() - 1.0).abs() < 0.01);
    if are_unit && row.dot(column).abs() < 0.01 {
        return Ok(Some([row.normalize(), column.normalize()]));
    }
    let wanted = "two vectors of length 1 at right angles";
    let found = format!("{row} and {column}");
    Err(invalid(
        DICOM,
        &tags::name(IMAGE_ORIENTATION),
        wanted,
        &found,
    ))
}

fn rescale(set: &DataSet) -> Result<Rescale, Problem> {
    let dose = set.number(DOSE_GRID_SCALING)?;
    let slope = set.number(RESCALE_SLOPE)?.or(dose).unwrap_or(1.0);
    if slope == 0.0 {
        return Err(invalid(
            DICOM,
            &tags::name(RESCALE_SLOPE),
            "a number other than 0",
            "0",
        ));
    }
    let intercept = set.number(RESCALE_INTERCEPT)?.unwrap_or(0.0);
    Ok(Rescale { slope, intercept })
}
