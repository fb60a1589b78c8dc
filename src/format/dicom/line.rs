//! Slices on a line: the step between them, where some are missing, and how far the stack leans.

#![allow(
    clippy::arithmetic_side_effects,
    reason = "vectors of f64: nothing wraps or panics; places are at most as many as files"
)]

use super::stack::Sorting;
use super::tags::IMAGE_POSITION;
use super::times::Places;
use crate::volume::ReadError;
use glam::DVec3;

/// How far off the line a slice may lie, in steps: positions are often rounded to a tenth of a millimetre.
const OFF_LINE: f64 = 0.1;
/// One in so many slices may be missing.
const MISSING: usize = 10;

/// The slices of a stack on a line.
pub(super) struct Line {
    pub step: DVec3,
    /// For each place its slice.
    pub index: Vec<usize>,
}

/// The line through the first pictures of all places, of which there are two at least.
pub(super) fn line(
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
    let usual = sorted
        .get(sorted.len().saturating_sub(1) / 2)
        .copied()
        .unwrap_or(1.0);
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
