//! Tables, head holders and container walls, which are left out of composites of CT.
//!
//! ```text
//! matter     over -300 HU; components of it share faces, and the largest of them stays
//! left out   touches a face of the grid box, reaches out of the box of the largest component, and is thin:
//!            2 volume / surface < 0.1 of the second extent of its box
//! faint      -700 to -300 HU: goes with the component that is nearest through faint voxels; ties stay
//! ```

use super::values::{context, summary};
use crate::transfer::Kind;
use crate::volume::{Component, Components, Header, Volume, VoxelBox, Voxels};
use half::f16;

/// Hounsfield units above which a voxel is matter.
const MATTER: f64 = -300.0;
/// Hounsfield units under which nothing is seen.
const FAINT: f64 = -700.0;
/// Hounsfield units of air.
const AIR: f64 = -1000.0;
/// The mean thickness of a thin component, as a share of its second extent.
const THIN: f64 = 0.1;

/// What a voxel is.
#[derive(Clone, Copy, PartialEq)]
enum Part {
    Air,
    Faint,
    Kept,
    LeftOut,
}

/// Makes air of thin components of CT at faces of the box: tables, head holders and container walls. Gives the note that
/// says which; `None` of values of another kind, or where nothing is left out.
pub fn leave_out(volume: &mut Volume, header: &Header) -> Option<String> {
    let choice = context(header).choice(&summary(volume));
    if choice.kind != Kind::Ct {
        return None;
    }
    let (mut parts, components) = parts_of(volume, choice.offset);
    let of_grid = VoxelBox {
        min: [0; 3],
        max: volume.dims,
    };
    let thin = thin_at_faces(&components.all, &of_grid, volume.grid().spacing());
    if thin.is_empty() {
        return None;
    }
    for (voxels, component) in components.runs() {
        if thin.contains(&component) {
            parts[voxels].fill(Part::LeftOut);
        }
    }
    share_faint(&mut parts, volume.dims);
    let [low, high] = volume.value_range;
    let air = (AIR + choice.offset).clamp(low, high);
    fill(volume, &parts, air);
    let all = &components.all;
    let said: Vec<_> = thin
        .iter()
        .map(|&component| {
            let Component { voxels, bounds, .. } = all[component];
            let larger = all.iter().filter(|other| other.voxels > voxels).count();
            format!(
                "number {} of {} by size, {voxels} voxels, {:?} to {:?}",
                larger + 1,
                all.len(),
                bounds.min,
                bounds.max
            )
        })
        .collect();
    Some(format!(
        "left out are thin components at faces of the box: {}",
        said.join("; ")
    ))
}

/// What each voxel is, all matter kept, and the components of matter.
fn parts_of(volume: &Volume, offset: f64) -> (Vec<Part>, Components) {
    let stored = |value: f64| (value + offset - volume.rescale.intercept) / volume.rescale.slope;
    let is_valid = |i: usize| volume.validity.as_ref().is_none_or(|mask| mask[i] != 0);
    let (matter, faint) = (stored(MATTER), stored(FAINT));
    let is_over = |number: f64, limit: f64| match volume.rescale.slope > 0.0 {
        true => number > limit,
        false => number < limit,
    };
    let part = |i: usize| {
        let number = f64::from(volume.voxels.stored(i));
        match is_valid(i) {
            true if is_over(number, matter) => Part::Kept,
            true if is_over(number, faint) => Part::Faint,
            _ => Part::Air,
        }
    };
    let parts: Vec<_> = (0..volume.voxels.len()).map(part).collect();
    let mask: Vec<_> = parts.iter().map(|&part| part == Part::Kept).collect();
    let components = Components::of(&mask, volume.dims, volume.grid().spacing());
    (parts, components)
}

/// The components that are left out, the largest first; none where they are more than half of all matter.
fn thin_at_faces(all: &[Component], of_grid: &VoxelBox, spacing: [f64; 3]) -> Vec<usize> {
    let Some(largest) = all.iter().max_by_key(|component| component.voxels) else {
        return Vec::new();
    };
    let is_left_out = |component: &Component| {
        let (bounds, dims) = (component.bounds, component.bounds.dims());
        let touches = (0..3).any(|k| bounds.min[k] == 0 || bounds.max[k] == of_grid.max[k]);
        let mut extent: [f64; 3] = std::array::from_fn(|k| f64::from(dims[k]) * spacing[k]);
        extent.sort_by(f64::total_cmp);
        let volume = component.voxels as f64 * spacing.iter().product::<f64>();
        let is_thin = 2.0 * volume < THIN * extent[1] * component.surface;
        touches && is_thin && !bounds.is_in(&largest.bounds)
    };
    let mut thin: Vec<_> = (0..all.len()).filter(|&i| is_left_out(&all[i])).collect();
    thin.sort_by_key(|&i| std::cmp::Reverse(all[i].voxels));
    let voxels = |i: usize| all[i].voxels;
    let in_all: u64 = (0..all.len()).map(voxels).sum();
    if 2 * thin.iter().copied().map(voxels).sum::<u64>() > in_all {
        thin.clear();
    }
    thin
}

/// Gives faint voxels to the matter that is nearest through faint voxels, a layer of both at a time.
fn share_faint(parts: &mut [Part], dims: [u32; 3]) {
    let [nx, ny, nz] = dims.map(|n| n as usize);
    let around = |i: usize| {
        let (x, y, z) = (i % nx, i / nx % ny, i / nx / ny);
        [
            (x > 0).then(|| i - 1),
            (x + 1 < nx).then(|| i + 1),
            (y > 0).then(|| i - nx),
            (y + 1 < ny).then(|| i + nx),
            (z > 0).then(|| i - nx * ny),
            (z + 1 < nz).then(|| i + nx * ny),
        ]
    };
    let of = |parts: &[Part], part: Part| {
        let is_edge = |&i: &usize| {
            let is_faint = |&at: &usize| parts[at] == Part::Faint;
            parts[i] == part && around(i).iter().flatten().any(is_faint)
        };
        (0..parts.len()).filter(is_edge).collect::<Vec<_>>()
    };
    let mut fronts = [Part::Kept, Part::LeftOut].map(|part| (part, of(parts, part)));
    // What is kept alone needs no more layers.
    while !fronts[1].1.is_empty() {
        for (part, front) in &mut fronts {
            let mut next = Vec::new();
            for at in front.iter().flat_map(|&i| around(i)).flatten() {
                if parts[at] == Part::Faint {
                    parts[at] = *part;
                    next.push(at);
                }
            }
            *front = next;
        }
    }
}

/// Gives voxels that are left out the number of `value`.
fn fill(volume: &mut Volume, parts: &[Part], value: f64) {
    let number = (value - volume.rescale.intercept) / volume.rescale.slope;
    fn set<T: Copy>(numbers: &mut [T], parts: &[Part], number: T) {
        for (voxel, part) in numbers.iter_mut().zip(parts) {
            if *part == Part::LeftOut {
                *voxel = number;
            }
        }
    }
    match &mut volume.voxels {
        Voxels::U8(v) => set(v, parts, number.round() as u8),
        Voxels::I8(v) => set(v, parts, number.round() as i8),
        Voxels::U16(v) => set(v, parts, number.round() as u16),
        Voxels::I16(v) => set(v, parts, number.round() as i16),
        Voxels::F16(v) => set(v, parts, f16::from_f64(number)),
        Voxels::F32(v) => set(v, parts, number as f32),
    }
}
