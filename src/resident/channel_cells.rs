//! Ranges of macro cells of a volume, of a channel that lies on a grid of its own.
//!
//! ```text
//! a cell's samples    p' = A p,  p in the cell         A from voxels of the volume to the channel's
//! its range           over voxels from  min p' - 1/2  to  max p' + 1/2,  half a voxel more for rounding
//! ```
//!
//! The image of a cell is a parallelepiped, and voxels are those of the box around it: more than samples touch, never less.

use super::cell_ranges::range_of;
use crate::shaders::{CELL_VOXELS, CellGrid};
use crate::volume::{Grid, Volume, VoxelBox, VoxelPart, Voxels};
use glam::{DAffine3, DVec3};
use half::f16;

/// As far as the voxels lie from a sample that a linear filter mixes, and half a voxel.
const REACH_VOXELS: f64 = 1.0;
/// No value: no function shows one from `most` to `least`.
const NOTHING: [f32; 2] = [f32::MAX, f32::MIN];

/// Smallest and largest value that samples of the cells of `cells` find in `channel`, x fastest. `coding` has the coding of
/// its texels and what a sampler loses; `grid` is that of the cells.
pub(super) fn ranges_of_channel(
    channel: &Volume,
    coding: &CellGrid,
    grid: &Grid,
    cells: &CellGrid,
) -> Vec<[f32; 2]> {
    let channel_from_voxel = channel.world_from_voxel.inverse() * grid.world_from_voxel;
    let [nx, ny, nz] = cells.cells;
    let places = (0..nz).flat_map(|z| (0..ny).flat_map(move |y| (0..nx).map(move |x| [x, y, z])));
    let boxes = places.map(|cell| box_of(&channel_from_voxel, cells, cell, channel.dims));
    let part = VoxelPart::from(channel);
    let ends_of = |region: Option<VoxelBox>| -> [f32; 2] {
        let Some(region) = region else { return NOTHING };
        let ends = match part.voxels {
            Voxels::U8(v) => ends(v, &part, region, |c| c.into()),
            Voxels::I8(v) => ends(v, &part, region, |c| c.into()),
            Voxels::U16(v) => ends(v, &part, region, |c| c.into()),
            Voxels::I16(v) => ends(v, &part, region, |c| c.into()),
            Voxels::F16(v) => ends(v, &part, region, f16::to_f32),
            Voxels::F32(v) => ends(v, &part, region, |c| c),
        };
        range_of(ends, coding)
    };
    boxes.map(ends_of).collect()
}

/// The voxels of a channel of `dims` that samples of a cell touch; `None` where the cell lies outside of it.
fn box_of(
    channel_from_voxel: &DAffine3,
    cells: &CellGrid,
    cell: [u32; 3],
    dims: [u32; 3],
) -> Option<VoxelBox> {
    let side = f64::from(CELL_VOXELS);
    let low: [f64; 3] =
        std::array::from_fn(|k| f64::from(cells.origin[k]) + side * f64::from(cell[k]));
    let corner = |n: u32| {
        let at = |k: usize| low[k] + if n >> k & 1 == 1 { side } else { 0.0 };
        channel_from_voxel.transform_point3(DVec3::new(at(0), at(1), at(2)))
    };
    let (min, max) = (0..8)
        .map(corner)
        .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(min, max), p| {
            (min.min(p), max.max(p))
        });
    let whole = VoxelBox {
        min: [0; 3],
        max: dims,
    };
    // The ends saturate: what lies far outside has no voxel in common.
    let touched = VoxelBox {
        min: std::array::from_fn(|k| (min[k] - REACH_VOXELS).floor() as u32),
        max: std::array::from_fn(|k| ((max[k] + REACH_VOXELS).floor() as u32).saturating_add(1)),
    };
    let is_beside = (0..3).any(|k| max[k] + REACH_VOXELS < 0.0);
    touched.and(&whole).filter(|_| !is_beside)
}

/// Smallest and largest code of a box of voxels.
fn ends<T: Copy + PartialOrd>(
    voxels: &[T],
    part: &VoxelPart,
    region: VoxelBox,
    to_f32: impl Fn(T) -> f32,
) -> [f32; 2] {
    let length = region.dims()[0] as usize;
    let mut rows = part.rows(region);
    let first = voxels[rows.next().expect("a box has voxels")];
    let rows = part
        .rows(region)
        .map(|first| &voxels[first..first + length]);
    let [least, most] = rows.flatten().fold([first; 2], |[least, most], &code| {
        [
            if code < least { code } else { least },
            if code > most { code } else { most },
        ]
    });
    [to_f32(least), to_f32(most)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shaders::CellGridFields;

    fn cells_of(dims: [u32; 3]) -> CellGrid {
        CellGridFields {
            cells: dims.map(|n| n.div_ceil(CELL_VOXELS)),
            slope: 1.0,
            ..bytemuck::Zeroable::zeroed()
        }
        .into()
    }

    /// Voxels of half the size, the box turned and moved: each sample of a cell finds a value of its range.
    #[test]
    fn a_sample_finds_values_of_the_range_of_its_cell() {
        let dims = [24, 16, 17];
        let grid = Grid {
            dims,
            world_from_voxel: DAffine3::IDENTITY,
        };
        let turned = DAffine3::from_rotation_z(0.4) * DAffine3::from_scale(DVec3::splat(0.5));
        let world_from_voxel = DAffine3::from_translation(DVec3::new(3.0, 2.0, -1.5)) * turned;
        let voxels: Vec<u8> = (0..30_u32 * 20 * 25)
            .map(|i| (i * 7919 % 251) as u8)
            .collect();
        let channel = Volume::from_voxels(
            [30, 20, 25],
            world_from_voxel,
            Voxels::U8(voxels),
            crate::volume::Rescale::default(),
            None,
        );
        let channel = channel.expect("a volume");
        let cells = cells_of(dims);
        let found = ranges_of_channel(&channel, &cells, &grid, &cells);
        let channel_from_world = world_from_voxel.inverse();
        let (mut inside, mut outside) = (0, 0);
        for i in 0..24 * 16 * 17 * 8_u32 {
            let p = [i % 48, i / 48 % 32, i / 48 / 32].map(|n| f64::from(n) * 0.5 + 0.25);
            let cell = p.map(|x| x as u32 / CELL_VOXELS);
            let [nx, ny, _] = cells.cells;
            let [low, high] = found[(cell[0] + nx * (cell[1] + ny * cell[2])) as usize];
            let own = channel_from_world.transform_point3(p.into());
            let is_in = own.cmpge(DVec3::ZERO).all() && own.cmple(grid_corner(&channel)).all();
            if !is_in {
                outside += 1;
                continue;
            }
            inside += 1;
            let value = crate::volume::sample::linear::<f64>(&channel, own.to_array());
            let value = value.expect("data");
            assert!(
                value >= f64::from(low) && value <= f64::from(high),
                "{p:?}: {value} of {low}..{high}"
            );
        }
        assert!(inside > 1000 && outside > 1000, "{inside} {outside}");
        let nothing = found.iter().filter(|range| **range == NOTHING).count();
        assert!(
            nothing > 0 && nothing < found.len(),
            "{nothing} of {}",
            found.len()
        );
    }

    fn grid_corner(volume: &Volume) -> DVec3 {
        volume.grid().far_corner()
    }
}
