//! Where the points and cells of an image lie: extents, origin, spacing, direction.
//!
//! ```text
//! point (i, j, k):   world = origin + direction * (spacing * (i, j, k)),   first <= i <= last of the extent
//! cell  (i, j, k):   its centre, half a spacing on; a flat axis has one cell, in the plane of its points
//! ```

#![allow(
    clippy::arithmetic_side_effects,
    reason = "vectors of f64: nothing wraps or panics; integers are checked"
)]

use super::VTI;
use super::xml::Element;
use crate::format::geometry::world_from_voxel;
use crate::format::problem::invalid;
use crate::format::text::{integers, numbers};
use crate::volume::{Problem, VoxelBox};
use glam::{DAffine3, DMat3, DVec3};

/// First and last index of points along each axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Extent([[i64; 2]; 3]);

impl Extent {
    /// Of an attribute; `None` where it holds no points.
    pub(super) fn of(element: &Element, name: &str) -> Result<Option<Self>, Problem> {
        let text = element.required(name)?;
        let all = integers(text)
            .and_then(|all| <[i64; 6]>::try_from(all).ok())
            .filter(|all| all.iter().all(|n| i32::try_from(*n).is_ok()))
            .ok_or_else(|| invalid(VTI, name, "six whole numbers of 32 bits", text))?;
        let [a, b, c, d, e, f] = all;
        let axes = [[a, b], [c, d], [e, f]];
        let is_empty = axes.iter().any(|[first, last]| last < first);
        Ok((!is_empty).then_some(Self(axes)))
    }

    /// Points or cells along each axis.
    pub(super) fn dims(self, of_cells: bool) -> [u32; 3] {
        self.0.map(|[first, last]| {
            let steps = u32::try_from(last - first).unwrap_or(0);
            match of_cells {
                true => steps.max(1),
                false => steps.saturating_add(1),
            }
        })
    }

    /// The points or cells of `piece` in this extent; `None` where it reaches out of it.
    pub(super) fn place(self, piece: Self, of_cells: bool) -> Option<VoxelBox> {
        let mut place = VoxelBox {
            min: [0; 3],
            max: [0; 3],
        };
        let ends = place.min.iter_mut().zip(&mut place.max);
        let axes = self.0.iter().zip(&piece.0);
        let sizes = self.dims(of_cells).into_iter().zip(piece.dims(of_cells));
        for (((min, max), ([first, last], [from, to])), (size, count)) in ends.zip(axes).zip(sizes)
        {
            *min = u32::try_from(from - first).ok()?;
            *max = min.checked_add(count).filter(|&max| max <= size)?;
            // A piece of one plane of points has no cells of a volume.
            if to > last || (of_cells && from == to && first != last) {
                return None;
            }
        }
        Some(place)
    }
}

/// Voxel space to world. VTK knows no patient: coordinates are taken as they stand.
pub(super) fn affine(
    image: &Element,
    whole: Extent,
    of_cells: bool,
    notes: &mut Vec<String>,
) -> Result<DAffine3, Problem> {
    let origin = vector(image, "Origin", DVec3::ZERO)?;
    let mut spacing = vector(image, "Spacing", DVec3::ONE)?;
    let directions = match image.get("Direction") {
        None => DMat3::IDENTITY,
        // Row by row: column k is the direction of axis k.
        Some(text) => finite(text)
            .and_then(|all| <[f64; 9]>::try_from(all).ok())
            .map(|rows| DMat3::from_cols_array(&rows).transpose())
            .ok_or_else(|| invalid(VTI, "Direction", "nine finite numbers", text))?,
    };
    let mut first = DVec3::ZERO;
    for (k, [low, high]) in whole.0.into_iter().enumerate() {
        if low == high && spacing[k] == 0.0 {
            spacing[k] = 1.0;
            notes.push("a flat axis has no spacing: 1 is taken".to_owned());
        }
        let half = if of_cells && low < high { 0.5 } else { 0.0 };
        #[allow(clippy::cast_precision_loss, reason = "an index has 32 bits")]
        let index = low as f64 + half;
        first[k] = index * spacing[k];
    }
    let steps = directions * DMat3::from_diagonal(spacing);
    let columns = [steps.x_axis, steps.y_axis, steps.z_axis];
    world_from_voxel(columns, origin + directions * first).ok_or_else(|| {
        let wanted = "steps that span a volume";
        invalid(
            VTI,
            "Spacing",
            wanted,
            image.get("Spacing").unwrap_or("1 1 1"),
        )
    })
}

fn vector(image: &Element, name: &str, default: DVec3) -> Result<DVec3, Problem> {
    let Some(text) = image.get(name) else {
        return Ok(default);
    };
    finite(text)
        .and_then(|all| <[f64; 3]>::try_from(all).ok())
        .map(DVec3::from_array)
        .ok_or_else(|| invalid(VTI, name, "three finite numbers", text))
}

fn finite(text: &str) -> Option<Vec<f64>> {
    numbers(text).filter(|all| all.iter().all(|x| x.is_finite()))
}
