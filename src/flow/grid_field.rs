//! The wind of a grid of voxels as a field: trilinear in space, linear in time.
//!
//! ```text
//! v(t, p) = M(p) lerp(wind_a(A p), wind_b(A p), (t - t_a) / (t_b - t_a)),  t_a <= t <= t_b two snapshots
//! ```
//!
//! Columns of degrees that close around the globe are neighbours across the seam.
//! A takes the world to voxels, M is the metric. Before the first snapshot and behind the last the wind is that of it.

use super::error::FieldError;
use super::field::{Absence, VectorField};
use super::metric::{GridMetric, Metric, check_axes, columns};
use super::snapshot::{Columns, Snapshot};
use crate::volume::Grid;
use glam::{DAffine3, DMat3, DVec3};

/// A velocity in the box of a grid.
#[derive(Clone, Debug)]
pub struct GridField {
    grid: Grid,
    voxel_from_world: DAffine3,
    times: Vec<f64>,
    snapshots: Vec<Snapshot>,
    metric: GridMetric,
    /// Heights of the ground, world.
    ground: Option<Columns>,
    off_poles: [f64; 2],
    /// Its first column is the neighbour of its last one.
    seam: Option<[f64; 2]>,
    fast_speed: f64,
}

/// The part of places that are slower than [`VectorField::fast_speed`].
const FAST: f64 = 0.999;
/// More speeds say no more of that.
const MOST_SPEEDS: usize = 1 << 20;

impl GridField {
    /// Of snapshots with their times in seconds, all on `grid`.
    ///
    /// # Errors
    /// [`FieldError`]: no snapshot, times that do not grow, other grids, a metric that is none on this grid.
    pub fn new(
        grid: Grid,
        snapshots: Vec<(f64, Snapshot)>,
        metric: Metric,
    ) -> Result<Self, FieldError> {
        let (times, snapshots): (Vec<_>, Vec<_>) = snapshots.into_iter().unzip();
        let grow = times.is_sorted_by(|a, b| a < b) && times.iter().all(|t| t.is_finite());
        if times.is_empty() || !grow {
            return Err(FieldError::Times { found: times });
        }
        let dims = grid.dims.map(|n| n as usize);
        let other = snapshots.iter().position(|one| one.dims() != dims);
        if let Some(index) = other {
            return Err(FieldError::Snapshot {
                index,
                wanted: grid.dims,
                found: snapshots[index].dims(),
            });
        }
        let metric = GridMetric::new(metric, &grid)?;
        let mut field = Self {
            grid,
            voxel_from_world: grid.world_from_voxel.inverse(),
            times,
            snapshots,
            off_poles: metric.off_poles(&grid),
            seam: metric.seam(&grid),
            metric,
            ground: None,
            fast_speed: 0.0,
        };
        field.fast_speed = field.fast_speed_of_nodes();
        Ok(field)
    }

    /// The same over ground of these heights, world length, one a column of voxels, x fastest: lines end there.
    ///
    /// # Errors
    /// [`FieldError::Columns`], and [`FieldError::Turned`] where up is not along z of the grid.
    pub fn over_ground(mut self, heights: Vec<f64>) -> Result<Self, FieldError> {
        check_axes(&self.grid, "the ground")?;
        self.ground = Some(columns(heights, &self.grid, "the height of the ground")?);
        Ok(self)
    }

    /// The wind as the snapshots have it: east, north and up, or along the axes of the grid, m/s (the third also Pa/s).
    ///
    /// # Errors
    /// Where there is none.
    pub fn components(&self, time: f64, place: DVec3) -> Result<[f64; 3], Absence> {
        self.wind(time, place).map(|(wind, _)| wind)
    }

    /// The height of the ground below or above a place, world; `None` where it is not known.
    pub fn ground_height(&self, place: DVec3) -> Option<f64> {
        let ground = self.ground.as_ref()?;
        let voxel = self.voxel_from_world.transform_point3(place).to_array();
        Some(ground.at(voxel, self.seam.is_some()))
    }

    fn fast_speed_of_nodes(&self) -> f64 {
        let [nx, ny, nz] = self.grid.dims.map(|n| n as usize);
        let count = nx * ny * nz;
        let stride = (count * self.snapshots.len()).div_ceil(MOST_SPEEDS).max(1);
        let mut speeds = Vec::new();
        for snapshot in &self.snapshots {
            for index in (0..count).step_by(stride) {
                let Some(wind) = snapshot.node(index) else {
                    continue;
                };
                let voxel = [index % nx, index / nx % ny, index / nx / ny].map(|i| i as f64 + 0.5);
                let place = self.grid.world_from_voxel.transform_point3(voxel.into());
                let velocity = self.metric.velocity(wind.map(f64::from), place, voxel);
                if velocity.is_finite() {
                    speeds.push(velocity.length());
                }
            }
        }
        let nth = (FAST * speeds.len() as f64) as usize;
        if nth >= speeds.len() {
            return 0.0;
        }
        *speeds.select_nth_unstable_by(nth, f64::total_cmp).1
    }

    /// The wind at a place, and the place in voxels.
    #[inline]
    fn wind(&self, time: f64, place: DVec3) -> Result<([f64; 3], [f64; 3]), Absence> {
        let mut voxel = self.voxel_from_world.transform_point3(place);
        let is_around = self.seam.is_some();
        if is_around {
            voxel.x = voxel.x.rem_euclid(f64::from(self.grid.dims[0]));
        }
        let end = DVec3::from(self.grid.dims.map(f64::from));
        if !(voxel.cmpge(DVec3::ZERO).all() && voxel.cmple(end).all()) {
            return Err(Absence::Domain);
        }
        let [south, north] = self.off_poles;
        if !(south <= place.y && place.y <= north) {
            return Err(Absence::Pole);
        }
        let voxel = voxel.to_array();
        if self
            .ground
            .as_ref()
            .is_some_and(|ground| place.z < ground.at(voxel, is_around))
        {
            return Err(Absence::Ground);
        }
        let above = self.times.partition_point(|&t| t <= time);
        let [a, b] = [above.saturating_sub(1), above.min(self.times.len() - 1)];
        let first = self.snapshots[a]
            .at(voxel, is_around)
            .ok_or(Absence::NoData)?;
        if a == b || time <= self.times[a] {
            return Ok((first, voxel));
        }
        let second = self.snapshots[b]
            .at(voxel, is_around)
            .ok_or(Absence::NoData)?;
        let part = (time - self.times[a]) / (self.times[b] - self.times[a]);
        Ok((
            [0, 1, 2].map(|k| first[k] + part * (second[k] - first[k])),
            voxel,
        ))
    }
}

impl VectorField for GridField {
    #[inline]
    fn velocity(&self, time: f64, place: DVec3) -> Result<DVec3, Absence> {
        let (wind, voxel) = self.wind(time, place)?;
        Ok(self.metric.velocity(wind, place, voxel))
    }

    fn cells_from_world(&self) -> DMat3 {
        self.voxel_from_world.matrix3
    }

    fn speed(&self, time: f64, place: DVec3) -> Result<f64, Absence> {
        let (wind, _) = self.wind(time, place)?;
        Ok(self.metric.speed(wind, place))
    }

    fn time_span(&self) -> [f64; 2] {
        match self.times[..] {
            [_] => [f64::NEG_INFINITY, f64::INFINITY],
            _ => [self.times[0], self.times[self.times.len() - 1]],
        }
    }

    fn next_snapshot(&self, time: f64, forward: bool) -> Option<f64> {
        match forward {
            true => self.times.iter().find(|&&t| t > time).copied(),
            false => self.times.iter().rev().find(|&&t| t < time).copied(),
        }
    }

    fn seam(&self) -> Option<[f64; 2]> {
        self.seam
    }

    fn fast_speed(&self) -> f64 {
        self.fast_speed
    }
}
