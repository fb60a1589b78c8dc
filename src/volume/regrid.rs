//! The numbers of a volume on the grid of another: at each of its voxel centres what linear interpolation finds there.

use super::{Grid, Loss, Rescale, Volume, Voxels, sample::linear};
use glam::dvec3;

/// `volume` on `grid`, values as they are after rescale, and the share of the grid's voxels that it has data for.
/// Elsewhere, outside of the volume too, there is no data.
pub fn regridded(volume: &Volume, grid: &Grid) -> (Volume, f64) {
    let from_grid = volume.world_from_voxel.inverse() * grid.world_from_voxel;
    let far = volume.grid().far_corner();
    let [nx, ny, nz] = grid.dims;
    let count = nx as usize * ny as usize * nz as usize;
    let (mut numbers, mut mask) = (Vec::with_capacity(count), Vec::with_capacity(count));
    let mut range = [f64::INFINITY, f64::NEG_INFINITY];
    for z in 0..nz {
        for y in 0..ny {
            for x in 0..nx {
                let center = dvec3(x.into(), y.into(), z.into()) + 0.5;
                let p = from_grid.transform_point3(center);
                let is_inside = p.cmpge(glam::DVec3::ZERO).all() && p.cmple(far).all();
                let found = is_inside
                    .then(|| linear::<f64>(volume, p.to_array()))
                    .flatten();
                if let Some(value) = found {
                    range = [range[0].min(value), range[1].max(value)];
                }
                numbers.push(found.unwrap_or(0.0) as f32);
                mask.push(u8::from(found.is_some()));
            }
        }
    }
    let valid = mask.iter().filter(|&&valid| valid != 0).count();
    let moved = Volume {
        dims: grid.dims,
        world_from_voxel: grid.world_from_voxel,
        voxels: Voxels::F32(numbers),
        rescale: Rescale::default(),
        validity: (valid < count).then_some(mask),
        hounsfield: volume.hounsfield,
        unit: volume.unit.clone(),
        loss: Loss::default(),
        value_range: if valid > 0 { range } else { [0.0; 2] },
    };
    (moved, valid as f64 / count as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DAffine3, DMat3, DVec3};

    #[test]
    fn a_linear_field_is_the_same_on_another_grid_and_ends_where_it_ended() {
        let field = |p: DVec3| 3.0 * p.x - p.y + 0.5 * p.z + 7.0;
        let from = DAffine3::from_mat3_translation(
            DMat3::from_diagonal(dvec3(2.0, 1.0, 0.5)),
            dvec3(-1.0, 2.0, 3.0),
        );
        let [nx, ny, nz] = [6_u32, 7, 8];
        let all = (0..nz).flat_map(|z| (0..ny).flat_map(move |y| (0..nx).map(move |x| [x, y, z])));
        let center = |p: [u32; 3]| DVec3::from_array(p.map(f64::from)) + 0.5;
        let numbers = all.map(|p| field(from.transform_point3(center(p))) as f32);
        let voxels = Voxels::F32(numbers.collect());
        let volume = Volume::from_voxels([nx, ny, nz], from, voxels, Rescale::default(), None)
            .expect("a volume");
        let grid = Grid {
            dims: [5, 5, 5],
            world_from_voxel: DAffine3::from_translation(dvec3(0.3, 3.2, 3.4)),
        };
        let (moved, share) = regridded(&volume, &grid);
        let mask = moved.validity.as_ref().expect("the volume ends at z = 7");
        // Voxel centres at z = 3.9 to 7.9.
        assert_eq!(share, 0.8);
        for (i, &valid) in mask.iter().enumerate() {
            let index = [i % 5, i / 5 % 5, i / 25].map(|n| n as f64 + 0.5);
            let at = grid.world_from_voxel.transform_point3(index.into());
            assert_eq!(valid == 1, at.z < 7.0, "{at}");
            // Between the outermost voxel centres a linear field is itself.
            if valid == 1 && at.z > 3.25 && at.z < 6.75 {
                let found = f64::from(moved.voxels.stored(i));
                assert!((found - field(at)).abs() < 1e-5, "{found} at {at}");
            }
        }
    }
}
