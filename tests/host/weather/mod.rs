//! Laws of lines, of the wind and of scattered points, and for each the faults that its check must see.
//!
//! A check says what is off. Without a fault nothing is, and with each of them something must be: else it proves nothing.
//! `docs/weather.md` lists them.

#[cfg(feature = "netcdf")]
mod columns;
#[cfg(feature = "phantoms")]
mod flows;
mod globe;
mod holes;
#[cfg(feature = "files")]
mod points;
mod steps;
#[cfg(feature = "netcdf")]
mod temperature;
mod time;
mod world;

use glam::{DMat3, DVec3};
use std::fmt::Debug;
use stratavox::flow::{Absence, VectorField};

/// What is off, in words.
type Found = Result<(), String>;

/// Fails where the check finds something off without a fault, or nothing with one of them.
fn sees<F: Copy + Debug>(faults: &[F], check: impl Fn(Option<F>) -> Found) {
    if let Err(off) = check(None) {
        panic!("without a fault: {off}");
    }
    let mut unseen = Vec::new();
    for fault in faults {
        match check(Some(*fault)) {
            Ok(()) => unseen.push(fault),
            Err(off) => println!("{fault:?}: {off}"),
        }
    }
    assert!(unseen.is_empty(), "the check does not see {unseen:?}");
}

/// Nothing is off where `off` is at most `most`; what is no number is.
fn within(what: &str, off: f64, most: f64) -> Found {
    match off <= most {
        true => Ok(()),
        false => Err(format!("{what} is off by {off:.3e}, not by {most:.0e}")),
    }
}

/// A field with other velocities, and with cells of another size.
struct Changed<'a, F, C> {
    field: &'a F,
    /// Of the time, the place and the velocity there.
    velocity: C,
    /// Times the cells per world length.
    cells: DMat3,
}

impl<F, C> VectorField for Changed<'_, F, C>
where
    F: VectorField,
    C: Fn(f64, DVec3, DVec3) -> DVec3 + Sync,
{
    fn velocity(&self, time: f64, place: DVec3) -> Result<DVec3, Absence> {
        let own = self.field.velocity(time, place)?;
        Ok((self.velocity)(time, place, own))
    }

    fn cells_from_world(&self) -> DMat3 {
        self.cells * self.field.cells_from_world()
    }

    fn time_span(&self) -> [f64; 2] {
        self.field.time_span()
    }

    fn next_snapshot(&self, time: f64, forward: bool) -> Option<f64> {
        self.field.next_snapshot(time, forward)
    }

    fn seam(&self) -> Option<[f64; 2]> {
        self.field.seam()
    }
}
