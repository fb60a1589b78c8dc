//! A velocity at every place and time, or the reason why there is none.
//!
//! ```text
//! v(t, p) = dp/dt        world length per second, p in the drawn world before heights are exaggerated
//! ```

use glam::{DMat3, DVec3};

/// Why there is no velocity at a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Absence {
    /// It is outside of the grid.
    Domain,
    /// It is under the ground.
    Ground,
    /// A voxel that it lies between has no data.
    NoData,
    /// It is nearer to a pole than the last row of the grid off the pole.
    Pole,
}

/// What lines are traced in. A host may trace fields of its own.
pub trait VectorField: Sync {
    /// The velocity at a time in seconds and a place of the world, in world length per second.
    ///
    /// # Errors
    /// Where there is none.
    fn velocity(&self, time: f64, place: DVec3) -> Result<DVec3, Absence>;

    /// Cells per world length: rows of the inverse of the grid's affine. No step is longer than a cell, and errors are
    /// measured in cells.
    fn cells_from_world(&self) -> DMat3;

    /// The true speed, m/s where that is known; by default that in world length per second.
    ///
    /// # Errors
    /// Where there is none.
    fn speed(&self, time: f64, place: DVec3) -> Result<f64, Absence> {
        self.velocity(time, place).map(DVec3::length)
    }

    /// First and last time with a velocity.
    fn time_span(&self) -> [f64; 2] {
        [f64::NEG_INFINITY, f64::INFINITY]
    }

    /// The next time, in this direction, at which the velocity has a kink: no step goes across one.
    fn next_snapshot(&self, _time: f64, _forward: bool) -> Option<f64> {
        None
    }

    /// World x of both sides of the seam of a field that goes around the globe: places beyond one side are those that lie as
    /// far from the other. `None` where the field ends along x.
    fn seam(&self) -> Option<[f64; 2]> {
        None
    }

    /// A speed that few places exceed, world length per second: a line that is a million times slower stagnates.
    fn fast_speed(&self) -> f64 {
        0.0
    }
}

/// A field at one instant.
#[derive(Clone, Copy, Debug)]
pub struct Frozen<'a, F: ?Sized> {
    field: &'a F,
    time: f64,
}

impl<'a, F: VectorField + ?Sized> Frozen<'a, F> {
    /// The field as it is at a time in seconds.
    pub fn new(field: &'a F, time: f64) -> Self {
        Self { field, time }
    }
}

impl<F: VectorField + ?Sized> VectorField for Frozen<'_, F> {
    fn velocity(&self, _: f64, place: DVec3) -> Result<DVec3, Absence> {
        self.field.velocity(self.time, place)
    }

    fn cells_from_world(&self) -> DMat3 {
        self.field.cells_from_world()
    }

    fn speed(&self, _: f64, place: DVec3) -> Result<f64, Absence> {
        self.field.speed(self.time, place)
    }

    fn seam(&self) -> Option<[f64; 2]> {
        self.field.seam()
    }

    fn fast_speed(&self) -> f64 {
        self.field.fast_speed()
    }
}
