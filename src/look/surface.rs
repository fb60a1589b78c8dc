//! The values of another quantity w where surfaces of v pass: of both ends of each edge that a surface cuts,
//!
//! ```text
//! { w(i), w(j) : i, j neighbours along an axis, v(i) < level <= v(j) or v(j) < level <= v(i) }
//! ```
//!
//! Between the two ends w is linear, so that no colour of the surface lies outside of their range.

use crate::{
    transfer::{Quantity, ValueSummary},
    volume::Volume,
};

/// What the values of `other` look like where `volume` has one of these levels, in its unit; `None` where no surface has
/// data of both. Both lie on one grid.
pub fn summary_at(volume: &Volume, levels: &[f64], other: &Volume) -> Option<ValueSummary> {
    let [nx, ny, nz] = volume.dims.map(|count| count as usize);
    let strides = [1, nx, nx * ny];
    let mut is_cut = vec![false; volume.voxels.len()];
    for i in 0..is_cut.len() {
        let at = [i % nx, i / nx % ny, i / (nx * ny)];
        let Some(own) = value(volume, i) else {
            continue;
        };
        for ((place, count), stride) in at.into_iter().zip([nx, ny, nz]).zip(strides) {
            if place + 1 == count {
                continue;
            }
            let Some(next) = value(volume, i + stride) else {
                continue;
            };
            if levels.iter().any(|level| (own < *level) != (next < *level)) {
                is_cut[i] = true;
                is_cut[i + stride] = true;
            }
        }
    }
    let cut = is_cut.iter().enumerate().filter(|(_, is_cut)| **is_cut);
    let values: Vec<f64> = cut.filter_map(|(i, _)| value(other, i)).collect();
    if values.is_empty() {
        return None;
    }
    let range = values
        .iter()
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| {
            [low.min(*value), high.max(*value)]
        });
    let far = volume.grid().far_corner();
    let diagonal = volume.world_from_voxel.transform_vector3(far).length();
    let summary = ValueSummary::of(values.len(), range, diagonal, other.hounsfield, |i| {
        Some(values[i])
    });
    let quantity = Quantity::of_unit(other.unit.as_deref());
    Some(summary.measuring(quantity))
}

/// In the unit of the values; `None` where there is no data.
fn value(volume: &Volume, i: usize) -> Option<f64> {
    let is_valid = volume.validity.as_ref().is_none_or(|mask| mask[i] != 0);
    let stored = f64::from(volume.voxels.stored(i));
    is_valid.then_some(stored * volume.rescale.slope + volume.rescale.intercept)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::volume::{Rescale, Voxels};
    use glam::DAffine3;

    fn volume(values: [f32; 8], fill: Option<f64>) -> Volume {
        let voxels = Voxels::F32(values.to_vec());
        let dims = [4, 2, 1];
        Volume::from_voxels(dims, DAffine3::IDENTITY, voxels, Rescale::default(), fill)
            .expect("a volume")
    }

    #[test]
    fn values_of_both_ends_of_cut_edges_count_and_no_others() {
        let height = volume([0.0, 1.0, 2.0, 3.0, 0.0, 1.0, 2.0, -9.0], Some(-9.0));
        let other = volume([10.0, 20.0, 30.0, 90.0, 11.0, 21.0, 31.0, 99.0], None);
        let found = summary_at(&height, &[1.5], &other).expect("a surface");
        assert_eq!(found.range, [20.0, 31.0]);
        // The value itself belongs to the side above, and an edge to a hole is none.
        let found = summary_at(&height, &[2.0, 2.5], &other).expect("two surfaces");
        assert_eq!(found.range, [20.0, 90.0]);
        assert_eq!(summary_at(&height, &[7.0], &other), None);
    }

    #[test]
    fn a_surface_without_numbers_of_the_other_is_none() {
        let height = volume([0.0, 1.0, 2.0, 3.0, 0.0, 1.0, 2.0, 3.0], None);
        let other = volume([-1.0, 5.0, 5.0, -1.0, -1.0, 5.0, 5.0, -1.0], Some(5.0));
        assert_eq!(summary_at(&height, &[1.5], &other), None);
    }
}
