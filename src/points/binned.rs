//! The volume that stands for points where a volume is asked for: each voxel has the mean value of the points in it, those
//! without a point have no data.
//!
//! The grid is the box of the points and three standard deviations of the widest around. Splats reach farther, and are drawn
//! outside of it too.

use super::{Points, distances};
use crate::volume::{PrecisionLoss, Rescale, Volume, Voxels};
use glam::{DAffine3, DMat3, DVec3};

/// Standard deviations around the box.
const REACH_STDS: f64 = 3.0;
/// Voxels along the longest edge.
const MOST_VOXELS: f64 = 64.0;

impl Points {
    /// Corners of the box of [`Self::binned`], in the world.
    pub fn bounds(&self) -> [DVec3; 2] {
        let widest = self.stds.iter().copied().fold(0.0, f32::max);
        let [low, high] = distances::bounds(self.places.iter().copied());
        let around = DVec3::splat(REACH_STDS * f64::from(widest));
        [low - around, high + around]
    }

    /// Means of the points in each voxel of a grid of cubes, 64 along the longest edge.
    pub fn binned(&self) -> Volume {
        self.binned_in(self.bounds())
    }

    /// The same of the box of the points and so much around it: the volume of the field of that radius.
    pub fn binned_within(&self, radius: f64) -> Volume {
        let [low, high] = distances::bounds(self.places.iter().copied());
        self.binned_in([low - radius, high + radius])
    }

    fn binned_in(&self, [low, high]: [DVec3; 2]) -> Volume {
        let extent = high - low;
        let edge = extent.max_element() / MOST_VOXELS;
        let count = (extent / edge)
            .ceil()
            .max(DVec3::ONE)
            .min(DVec3::splat(MOST_VOXELS));
        let dims = count.to_array().map(|n| n as u32);
        // Cubes may reach beyond the box, half on each side.
        let corner = 0.5 * (low + high - edge * count);
        let world_from_voxel = DAffine3 {
            matrix3: DMat3::from_diagonal(DVec3::splat(edge)),
            translation: corner,
        };
        let strides = [1, dims[0] as usize, (dims[0] * dims[1]) as usize];
        let mut sums = vec![(0.0_f64, 0_u32); strides[2] * dims[2] as usize];
        for (place, &value) in self.places.iter().zip(&self.values) {
            let at = ((place - corner) / edge)
                .floor()
                .clamp(DVec3::ZERO, count - 1.0);
            let at = at.to_array().map(|n| n as usize);
            let sum = &mut sums[at[0] + strides[1] * at[1] + strides[2] * at[2]];
            *sum = (sum.0 + f64::from(value), sum.1 + 1);
        }
        let value_range = self.value_range();
        let mean = |&(sum, count): &(f64, u32)| match count {
            0 => value_range[0] as f32,
            _ => (sum / f64::from(count)) as f32,
        };
        let holes = sums.iter().any(|&(_, count)| count == 0);
        Volume {
            dims,
            world_from_voxel,
            voxels: Voxels::F32(sums.iter().map(mean).collect()),
            rescale: Rescale::default(),
            validity: holes.then(|| sums.iter().map(|&(_, n)| u8::from(n > 0)).collect()),
            hounsfield: false,
            unit: None,
            loss: PrecisionLoss::default(),
            value_range,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn voxels_have_the_means_of_their_points_and_the_box_holds_all_that_is_seen() {
        let places = vec![DVec3::ZERO, DVec3::X * 1e-3, glam::dvec3(10.0, 4.0, 0.0)];
        let points = Points::new(places, vec![1.0, 2.0, 7.0], Some(vec![0.5; 3]), None);
        let volume = points.expect("three points").binned();
        assert_eq!(volume.dims[0], 64);
        let Voxels::F32(voxels) = &volume.voxels else {
            panic!("floats")
        };
        let valid = volume.validity.as_ref().expect("holes");
        let seen: Vec<_> = voxels.iter().zip(valid).filter(|(_, v)| **v == 1).collect();
        assert_eq!(
            seen.iter().map(|(v, _)| **v).collect::<Vec<_>>(),
            [1.5, 7.0]
        );
        assert_eq!(volume.value_range, [1.0, 7.0]);
        let grid = volume.grid();
        let corner = grid.world_from_voxel.transform_point3(grid.far_corner());
        assert!(corner.cmpge(glam::dvec3(11.5, 5.5, 1.5)).all(), "{corner}");
        assert!(
            grid.world_from_voxel
                .translation
                .cmple(DVec3::splat(-1.5))
                .all()
        );
    }
}
