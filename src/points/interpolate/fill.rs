//! Values on a grid. Each voxel is computed by itself, so that the number of threads changes no byte.

use super::{Interpolation, Scratch};
use crate::volume::{Grid, Problem, Rescale, Volume, Voxels};
use glam::DVec3;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

impl Interpolation {
    /// The values at the centres of the voxels, x fastest; NaN where there are no data.
    pub fn values_on(&self, grid: &Grid) -> Vec<f32> {
        self.values_watched(grid, &|_| {})
    }

    /// The same, and tells after each row of voxels how much is done, 0 to 1, from several threads.
    pub fn values_watched(&self, grid: &Grid, watch: &(dyn Fn(f64) + Sync)) -> Vec<f32> {
        self.values_by(grid, super::threads(), watch)
    }

    /// The same as a volume, with a mask where there are no data.
    ///
    /// # Errors
    /// [`Problem`] where the grid is none.
    pub fn volume_on(&self, grid: &Grid) -> Result<Volume, Problem> {
        Volume::from_voxels(
            grid.dims,
            grid.world_from_voxel,
            Voxels::F32(self.values_on(grid)),
            Rescale::default(),
            None,
        )
    }

    pub(super) fn values_by(
        &self,
        grid: &Grid,
        threads: usize,
        watch: &(dyn Fn(f64) + Sync),
    ) -> Vec<f32> {
        let [nx, ny, nz] = grid.dims.map(|n| n as usize);
        let mut values = vec![f32::NAN; nx * ny * nz];
        let frame_from_voxel = self.frame_from_world * grid.world_from_voxel.matrix3;
        let origin = self.frame_from_world * grid.world_from_voxel.translation;
        let step = frame_from_voxel.x_axis.length();
        let (done, all) = (AtomicUsize::new(0), ny * nz);
        let rows = Mutex::new(values.chunks_mut(nx.max(1)).enumerate());
        let work = || {
            let mut scratch = Scratch::new(self);
            loop {
                let next = rows.lock().unwrap_or_else(PoisonError::into_inner).next();
                let Some((row, values)) = next else { return };
                let [y, z] = [row % ny, row / ny].map(|n| n as f64 + 0.5);
                scratch.leave();
                for (x, value) in values.iter_mut().enumerate() {
                    let voxel = DVec3::new(x as f64 + 0.5, y, z);
                    let at = frame_from_voxel * voxel + origin;
                    if let Some(found) = self.in_frame(at, step, &mut scratch) {
                        *value = found as f32;
                    }
                }
                let done = done.fetch_add(1, Ordering::Relaxed) + 1;
                watch(done as f64 / all as f64);
            }
        };
        std::thread::scope(|scope| {
            for _ in 0..threads.max(1) {
                scope.spawn(work);
            }
        });
        values
    }
}
