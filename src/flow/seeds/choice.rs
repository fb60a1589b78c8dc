//! Voxels where a variable is large, or small: seeds in an updraft.
//!
//! ```text
//! m voxels hold;  the i-th seed is one of the m - i that are left,  number floor(u (m - i)),  u = pcg4d(i, seed, 0, 0) / 2^32
//! ```

use super::pcg::unit;
use crate::volume::{Volume, sample::nearest};
use glam::DVec3;

/// Which side of a threshold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Comparison {
    /// Over it.
    Over,
    /// Under it.
    Under,
}

/// The middles of `count` random voxels whose value is over, or under, the threshold; of all of them where there are fewer.
pub fn seeds_where(
    volume: &Volume,
    comparison: Comparison,
    threshold: f64,
    count: u32,
    seed: u32,
) -> Vec<DVec3> {
    let [nx, ny, nz] = volume.dims;
    let voxels = (0..nz).flat_map(|z| (0..ny).flat_map(move |y| (0..nx).map(move |x| [x, y, z])));
    let center = |voxel: [u32; 3]| voxel.map(|i| f64::from(i) + 0.5);
    let holds = |voxel: &[u32; 3]| {
        let value = nearest::<f64>(volume, center(*voxel));
        value.is_some_and(|value| match comparison {
            Comparison::Over => value > threshold,
            Comparison::Under => value < threshold,
        })
    };
    let mut left: Vec<[u32; 3]> = voxels.filter(holds).collect();
    let mut seeds = Vec::new();
    for i in 0..count {
        if left.is_empty() {
            break;
        }
        let [u, ..] = unit(i, seed);
        let at = ((u * left.len() as f64) as usize).min(left.len() - 1);
        let place = DVec3::from_array(center(left.swap_remove(at)));
        seeds.push(volume.world_from_voxel.transform_point3(place));
    }
    seeds
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::volume::{Rescale, Voxels};
    use glam::DAffine3;

    #[test]
    fn seeds_are_other_voxels_each_and_the_value_holds_in_all() {
        let values: Vec<f32> = (0..1000).map(|i| i as f32).collect();
        let affine = DAffine3::from_scale(DVec3::splat(2.0));
        let rescale = Rescale::default();
        let volume = Volume::from_voxels([10; 3], affine, Voxels::F32(values), rescale, None)
            .expect("a volume");
        let value = |p: &DVec3| {
            let [x, y, z] = (*p / 2.0).to_array().map(f64::floor);
            x + 10.0 * y + 100.0 * z
        };
        let seeds = seeds_where(&volume, Comparison::Over, 899.0, 40, 0);
        let mut values: Vec<f64> = seeds.iter().map(value).collect();
        assert!(values.len() == 40 && values.iter().all(|&v| v > 899.0));
        values.sort_by(f64::total_cmp);
        values.dedup();
        assert_eq!(values.len(), 40, "one voxel twice");
        assert_eq!(
            seeds_where(&volume, Comparison::Over, 994.0, 40, 0).len(),
            5
        );
        assert_eq!(seeds_where(&volume, Comparison::Under, 3.0, 40, 0).len(), 3);
    }
}
