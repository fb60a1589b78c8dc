//! Numbers at voxel centres and what a filter makes of them between, by the formulas of the kernels over the distance
//! d to each centre, a sum over all voxels that are near enough:
//!
//! ```text
//! nearest          1 in the voxel                      linear    1 - d
//! quadratic        3/4 - d^2, d < 1/2;                 (3/2 - d)^2 / 2, d < 3/2
//! cubic            2/3 - d^2 + d^3/2, d < 1;           (2 - d)^3 / 6, d < 2
//! Catmull and Rom  1 - 5/2 d^2 + 3/2 d^3, d < 1;       2 - 4 d + 5/2 d^2 - d^3/2, d < 2
//! ```

use super::PictureCase;
use crate::technique::Filter;
use crate::technique::slices_2d::stack_axis;
use crate::volume::{Rescale, Volume, Voxels};
use glam::{DAffine3, DVec3, dvec3};

/// A volume of f32 and the same numbers in f64.
#[derive(Clone, Debug)]
pub struct Numbers {
    /// As the library has it.
    pub volume: Volume,
    dims: [i64; 3],
}

impl Numbers {
    /// A field over voxel space, at voxel centres.
    pub fn of(shot: &PictureCase, field: impl Fn(DVec3) -> f64) -> Self {
        let dims = shot.grid.dims;
        let [nx, ny, nz] = dims;
        let all = (0..nz).flat_map(|z| (0..ny).flat_map(move |y| (0..nx).map(move |x| [x, y, z])));
        let values = all.map(|at| field(dvec3(at[0].into(), at[1].into(), at[2].into()) + 0.5));
        let voxels = Voxels::F32(values.map(|value| value as f32).collect());
        let affine = shot.grid.world_from_voxel;
        let volume = Volume::from_voxels(dims, affine, voxels, Rescale::default(), None);
        Self {
            volume: volume.expect("as many voxels as the grid has"),
            dims: dims.map(i64::from),
        }
    }

    /// The same field in the box, on a grid of its own: with two voxels more on each side, which repeat the outermost.
    pub fn bordered(&self) -> Volume {
        let dims = self.volume.dims.map(|n| n + 4);
        let [nx, ny, nz] = dims.map(i64::from);
        let all = (0..nz).flat_map(|z| (0..ny).flat_map(move |y| (0..nx).map(move |x| [x, y, z])));
        let voxels = all.map(|at| self.voxel(at.map(|n| n - 2)) as f32);
        let border = DAffine3::from_translation(DVec3::splat(-2.0));
        let affine = self.volume.world_from_voxel * border;
        let voxels = Voxels::F32(voxels.collect());
        let made = Volume::from_voxels(dims, affine, voxels, Rescale::default(), None);
        made.expect("as many voxels as the grid has")
    }

    fn voxel(&self, at: [i64; 3]) -> f64 {
        let [x, y, z] = std::array::from_fn(|k| at[k].clamp(0, self.dims[k] - 1));
        let index = (z * self.dims[1] + y) * self.dims[0] + x;
        match &self.volume.voxels {
            Voxels::F32(values) => values[index as usize].into(),
            _ => unreachable!("made of f32"),
        }
    }

    /// The value at a place; outside of the outermost centres it is that at them. Along the axis of a stack it is that
    /// of the slice that the place lies in.
    pub fn at(&self, filter: Filter, place: DVec3, stack: Option<usize>) -> f64 {
        let taps: [Vec<(i64, f64)>; 3] = std::array::from_fn(|k| {
            let inside = place[k].clamp(0.5, self.dims[k] as f64 - 0.5);
            match filter == Filter::Nearest || stack == Some(k) {
                true => taps(Filter::Nearest, place[k]),
                false => taps(filter, inside),
            }
        });
        let mut sum = 0.0;
        for &(z, of_z) in &taps[2] {
            for &(y, of_y) in &taps[1] {
                for &(x, of_x) in &taps[0] {
                    sum += of_x * of_y * of_z * self.voxel([x, y, z]);
                }
            }
        }
        sum
    }
}

/// Voxels of an axis, and their weights.
fn taps(filter: Filter, place: f64) -> Vec<(i64, f64)> {
    let home = place.floor() as i64;
    if filter == Filter::Nearest {
        return vec![(home, 1.0)];
    }
    let weight = |voxel: i64| weight(filter, (place - voxel as f64 - 0.5).abs());
    (home - 2..=home + 2)
        .map(|i| (i, weight(i)))
        .filter(|tap| tap.1 != 0.0)
        .collect()
}

fn weight(filter: Filter, d: f64) -> f64 {
    match filter {
        Filter::QuadraticSmooth if d < 0.5 => 0.75 - d * d,
        Filter::QuadraticSmooth if d < 1.5 => 0.5 * (1.5 - d).powi(2),
        Filter::CubicSmooth if d < 1.0 => 2.0 / 3.0 - d * d + 0.5 * d.powi(3),
        Filter::CubicSmooth if d < 2.0 => (2.0 - d).powi(3) / 6.0,
        Filter::CatmullRom if d < 1.0 => 1.0 - 2.5 * d * d + 1.5 * d.powi(3),
        Filter::CatmullRom if d < 2.0 => 2.0 - 4.0 * d + 2.5 * d * d - 0.5 * d.powi(3),
        Filter::Linear if d < 1.0 => 1.0 - d,
        _ => 0.0,
    }
}

/// The axis of the stack that a shot draws, where it draws one.
pub fn stack_of(shot: &PictureCase) -> Option<usize> {
    shot.settings
        .technique
        .draws_stacks()
        .then(|| stack_axis(&shot.view()))
}
