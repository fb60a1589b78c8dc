//! MIP and its relatives on the CPU: CPU reference of `shaders/projection.wgsl` and of its modes.
//! What a ray keeps: `technique/projected.rs`.

use super::exact::project_exactly;
use crate::real::Real;
use crate::shaders::Frame;
use crate::technique::march::march;
pub use crate::technique::projected::Projected;
use crate::technique::reference::{Gathered, Samples};
use crate::technique::{Lattice, Mode};

/// What the ray of a pixel projects.
pub(crate) fn pixel<R: Real>(of: &impl Samples<R>, pixel: [R; 2]) -> Gathered<R> {
    let (frame, settings) = (&of.frame_of(pixel), of.settings());
    let mode = settings.mode;
    let (found, samples) = if settings.per_mode.exact_maximum {
        project_exactly(frame, mode, pixel, |index| of.voxel(index))
    } else {
        project(frame, settings.ray_lattice(), mode, pixel, |p| of.value(p))
    };
    let zero = R::from_f64(0.0);
    Gathered {
        depth: found.depth,
        ..Gathered::of_blended([found.value, found.weight, zero, zero], samples as f32)
    }
}

/// What one ray projects, and how many samples it took.
pub fn project<R: Real>(
    frame: &Frame,
    lattice: Lattice,
    mode: Mode,
    pixel: [R; 2],
    value_at: impl Fn([R; 3]) -> Option<R>,
) -> (Projected<R>, u32) {
    let mut so_far = Projected::default();
    let samples = march(frame, lattice, pixel, value_at, |value, segment| {
        so_far.add(frame, mode, value, segment)
    });
    (so_far, samples)
}
