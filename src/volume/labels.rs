//! Label maps: which labels there are, a map brought to the grid of another volume, and labels taken out or dimmed.
//!
//! A label is never interpolated: each voxel of the grid takes that of the voxel of the map that its centre lies
//! in; outside of the map it is 0.

use super::{Grid, PrecisionLoss, Rescale, Volume, Voxels};
use glam::{DVec3, dvec3};
use std::collections::BTreeMap;

/// More labels than this are none: a shader looks through the points of their transfer function.
pub const MAX_LABELS: usize = 2048;

/// How many voxels each label has, ascending. `None` where values are no whole numbers that an f32 tells apart, or
/// too many.
pub fn labels_of(map: &Volume) -> Option<BTreeMap<i64, u64>> {
    const EXACT: f64 = 16_777_216.0;
    let mut counts = BTreeMap::new();
    // Neighbours are mostly alike: one look into the tree for each run.
    let mut run: Option<(i64, u64)> = None;
    for i in 0..map.voxels.len() {
        if map.validity.as_ref().is_some_and(|mask| mask[i] == 0) {
            continue;
        }
        let value = value_at(map, i);
        if value.fract() != 0.0 || value.abs() > EXACT {
            return None;
        }
        let label = value as i64;
        run = match run {
            Some((same, count)) if same == label => Some((same, count + 1)),
            other => {
                if let Some((done, count)) = other {
                    *counts.entry(done).or_default() += count;
                    if counts.len() > MAX_LABELS {
                        return None;
                    }
                }
                Some((label, 1))
            }
        };
    }
    if let Some((done, count)) = run {
        *counts.entry(done).or_default() += count;
    }
    (counts.len() <= MAX_LABELS).then_some(counts)
}

/// The map on another grid, and the share of the grid's voxels that lie in it.
pub fn on_grid(map: &Volume, grid: &Grid) -> (Volume, f64) {
    let map_from_voxel = map.world_from_voxel.inverse() * grid.world_from_voxel;
    let [nx, ny, nz] = grid.dims;
    let mut labels = Vec::with_capacity(nx as usize * ny as usize * nz as usize);
    let mut inside = 0_u64;
    for z in 0..nz {
        for y in 0..ny {
            for x in 0..nx {
                let center = dvec3(x.into(), y.into(), z.into()) + 0.5;
                let found = index_of(map, map_from_voxel.transform_point3(center));
                inside += u64::from(found.is_some());
                let valid = found.filter(|&i| map.validity.as_ref().is_none_or(|m| m[i] != 0));
                labels.push(valid.map_or(0.0, |i| value_at(map, i) as f32));
            }
        }
    }
    let share = inside as f64 / labels.len() as f64;
    let range = labels
        .iter()
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], &label| {
            [low.min(label.into()), high.max(label.into())]
        });
    let fits = |largest: f64| range[0] >= 0.0 && range[1] <= largest;
    let voxels = if fits(255.0) {
        Voxels::U8(labels.iter().map(|&label| label as u8).collect())
    } else if fits(65535.0) {
        Voxels::U16(labels.iter().map(|&label| label as u16).collect())
    } else {
        Voxels::F32(labels)
    };
    let moved = Volume {
        dims: grid.dims,
        world_from_voxel: grid.world_from_voxel,
        voxels,
        rescale: Rescale::default(),
        validity: None,
        hounsfield: false,
        unit: None,
        loss: PrecisionLoss::default(),
        value_range: range,
    };
    (moved, share)
}

/// Makes no data of every voxel whose label is not shown: in a mixture, no data in labels hides what lies there.
pub fn hide(map: &mut Volume, is_shown: impl Fn(i64) -> bool) {
    let mask = (0..map.voxels.len()).map(|i| u8::from(is_shown(value_at(map, i) as i64)));
    let mask: Vec<u8> = mask.collect();
    map.validity = mask.contains(&0).then_some(mask);
}

/// The mark of a voxel that is there, and faint: in a mixture, all that lies where a label is dimmed.
pub const DIMMED: u8 = 2;

/// Dims every voxel that is there and whose label is to be dimmed, as much as [`crate::technique::Settings::dim`] says.
pub fn dim(map: &mut Volume, is_dimmed: impl Fn(i64) -> bool) {
    let count = map.voxels.len();
    let mut mask = map.validity.take().unwrap_or_else(|| vec![1; count]);
    for (i, mark) in mask.iter_mut().enumerate() {
        if *mark != 0 && is_dimmed(value_at(map, i) as i64) {
            *mark = DIMMED;
        }
    }
    map.validity = mask.iter().any(|&mark| mark != 1).then_some(mask);
}

/// The marks of a map that has dimmed voxels, as numbers of a volume of their own.
pub(crate) fn marks_of(map: &Volume) -> Option<Volume> {
    let mask = map
        .validity
        .as_ref()
        .filter(|mask| mask.contains(&DIMMED))?;
    Some(Volume {
        voxels: Voxels::U8(mask.clone()),
        rescale: Rescale::default(),
        validity: None,
        unit: None,
        ..*map
    })
}

fn value_at(map: &Volume, index: usize) -> f64 {
    f64::from(map.voxels.stored(index)) * map.rescale.slope + map.rescale.intercept
}

/// The voxel that a point of voxel space lies in.
fn index_of(map: &Volume, p: DVec3) -> Option<usize> {
    let dims = DVec3::from_array(map.dims.map(f64::from));
    let inside = p.cmpge(DVec3::ZERO).all() && p.cmplt(dims).all();
    let [nx, ny, _] = map.dims.map(|n| n as usize);
    let [x, y, z] = p.to_array().map(|c| c as usize);
    inside.then_some((z * ny + y) * nx + x)
}
