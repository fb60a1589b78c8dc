//! A volume brought to the grid of another one, so that both have a number in each voxel.
//!
//! ```text
//! value of a voxel = trilinear value of the other volume where the voxel's centre lies
//! ```
//!
//! Outside of the box of the other volume, and where its footprint has no data, there is none.

use super::{Grid, Problem, Rescale, Volume, Voxels, sample::linear};
use glam::{DVec3, dvec3};

/// Whether two grids are one but for rounding: their voxels lie within a thousandth of the smallest spacing.
pub fn is_same_grid(a: &Grid, b: &Grid) -> bool {
    let tolerance = 1e-3 * a.smallest_spacing();
    let corners = [DVec3::ZERO, a.far_corner(), DVec3::X, DVec3::Y];
    let is_near = |corner: DVec3| {
        let here = a.world_from_voxel.transform_point3(corner);
        let there = b.world_from_voxel.transform_point3(corner);
        here.distance(there) <= tolerance
    };
    a.dims == b.dims && corners.into_iter().all(is_near)
}

/// The volume on another grid, and the share of the grid's voxels that have data there.
///
/// # Errors
/// [`Problem`] where the numbers make no volume.
pub fn regridded(volume: &Volume, grid: &Grid) -> Result<(Volume, f64), Problem> {
    let there_from_here = volume.world_from_voxel.inverse() * grid.world_from_voxel;
    let far = volume.grid().far_corner();
    let [nx, ny, nz] = grid.dims;
    let mut values = Vec::with_capacity(nx as usize * ny as usize * nz as usize);
    let mut count = 0_u64;
    for z in 0..nz {
        for y in 0..ny {
            for x in 0..nx {
                let center = dvec3(x.into(), y.into(), z.into()) + 0.5;
                let p = there_from_here.transform_point3(center);
                let is_inside = p.cmpge(DVec3::ZERO).all() && p.cmple(far).all();
                let value = if is_inside {
                    linear(volume, p.to_array())
                } else {
                    None
                };
                count += u64::from(value.is_some());
                values.push(value.map_or(f32::NAN, |value: f64| value as f32));
            }
        }
    }
    let share = count as f64 / values.len() as f64;
    let voxels = Voxels::F32(values);
    let moved = Volume::from_voxels(
        grid.dims,
        grid.world_from_voxel,
        voxels,
        Rescale::default(),
        None,
    )?;
    let moved = Volume {
        hounsfield: volume.hounsfield,
        unit: volume.unit.clone(),
        loss: volume.loss,
        ..moved
    };
    Ok((moved, share))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DAffine3, DMat3};

    /// A field that is linear in world space, in voxels of this place.
    fn ramp(dims: [u32; 3], world_from_voxel: DAffine3) -> Volume {
        let field = |p: DVec3| (2.0 * p.x - p.y + 0.5 * p.z) as f32;
        let [nx, ny, nz] = dims;
        let all = (0..nz).flat_map(|z| (0..ny).flat_map(move |y| (0..nx).map(move |x| [x, y, z])));
        let center = |v: [u32; 3]| DVec3::from_array(v.map(f64::from)) + 0.5;
        let values = all.map(|v| field(world_from_voxel.transform_point3(center(v))));
        let voxels = Voxels::F32(values.collect());
        Volume::from_voxels(dims, world_from_voxel, voxels, Rescale::default(), None)
            .expect("a volume")
    }

    #[test]
    fn a_linear_field_stays_what_it_is_and_there_is_nothing_outside() {
        let coarse = ramp([5, 4, 6], DAffine3::from_scale(DVec3::splat(2.0)));
        let turn = DMat3::from_rotation_z(0.3) * 0.7;
        let grid = Grid {
            dims: [8, 7, 9],
            world_from_voxel: DAffine3::from_mat3_translation(turn, dvec3(-0.5, 1.5, 2.0)),
        };
        let wanted = ramp(grid.dims, grid.world_from_voxel);
        let (found, share) = regridded(&coarse, &grid).expect("a volume");
        let valid = found.validity.as_ref().expect("some lie outside");
        let mut inside = 0;
        for (i, &is_valid) in valid.iter().enumerate() {
            let x = (i % 8) as u32;
            let (y, z) = ((i / 8 % 7) as u32, (i / 56) as u32);
            let p = dvec3(x.into(), y.into(), z.into()) + 0.5;
            let world = grid.world_from_voxel.transform_point3(p);
            let size = dvec3(10.0, 8.0, 12.0);
            let is_inside = world.cmpge(DVec3::ZERO).all() && world.cmple(size).all();
            assert_eq!(is_valid == 1, is_inside, "at {world}");
            // Between the outermost centres the ramp goes on, outside of them the edge does.
            let is_between = world.cmpge(DVec3::ONE).all() && world.cmple(size - 1.0).all();
            if is_between {
                inside += 1;
                let off = found.voxels.stored(i) - wanted.voxels.stored(i);
                assert!(off.abs() < 1e-5, "off by {off} at {world}");
            }
        }
        assert!(inside > 100, "only {inside} voxels are compared");
        let count = valid.iter().map(|&v| f64::from(v)).sum::<f64>();
        assert_eq!(share, count / valid.len() as f64);
        assert!(is_same_grid(&grid, &wanted.grid()) && !is_same_grid(&grid, &coarse.grid()));
    }
}
