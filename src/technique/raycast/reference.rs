//! Ray casting on the CPU: CPU reference of `shaders/raycast.wgsl`.

use crate::lattice::Segment;
use crate::ray::{pixel_ray, voxel_ray};
use crate::real::Real;
use crate::shaders::Frame;
use crate::technique::composite::Composite;
use crate::technique::march::{march, march_in_runs, march_slabs};
use crate::technique::mida::Mida;
use crate::technique::reference::{Gathered, Samples, SlabValues, moved};
use crate::technique::{Lattice, Mode};
use std::ops::ControlFlow;

/// What the ray of a pixel gathers, in the modes that composite.
pub(crate) fn pixel<R: Real>(of: &impl Samples<R>, pixel: [R; 2]) -> Gathered<R> {
    let (frame, settings) = (&of.frame_of(pixel), of.settings());
    let (mode, lattice) = (settings.mode, settings.ray_lattice());
    let value_at = |p| of.value(p);
    let ray_direction = pixel_ray(frame, pixel).direction;
    let material_at = |p| of.material(p, ray_direction);
    let same = |material| material;
    Gathered::of_composite(if settings.preintegrated {
        radiance_of_slabs(frame, lattice, pixel, value_at, |slab| {
            let tap = |step| of.value(moved(slab.middle, step));
            of.material_of_slab(slab, ray_direction, tap)
        })
    } else if mode == Mode::Mida {
        let sample_at = |p| value_at(p).zip(material_at(p));
        accumulated(frame, lattice, pixel, sample_at, |value| of.classify(value))
    } else if let Some(alike) = of.alike() {
        radiance_in_runs(frame, pixel, |p| alike.at(p), material_at, same)
    } else {
        radiance(frame, lattice, pixel, material_at, same)
    })
}

/// What one ray gathers, and how many samples it took. `value_at` filters the volume at a position in voxel
/// space; `classify` gives (red, green, blue, extinction).
pub fn radiance<R: Real, V>(
    frame: &Frame,
    lattice: Lattice,
    pixel: [R; 2],
    value_at: impl Fn([R; 3]) -> Option<V>,
    classify: impl Fn(V) -> [R; 4],
) -> (Composite<R>, u32) {
    let mut so_far = Composite::default();
    let samples = march(frame, lattice, pixel, value_at, |value, segment| {
        gather(frame, &mut so_far, classify(value), segment)
    });
    (so_far, samples)
}

/// The same with steps that adapt: `cell_at` names the macro cell of a position where one sample may stand for others.
pub fn radiance_in_runs<R: Real, V>(
    frame: &Frame,
    pixel: [R; 2],
    cell_at: impl Fn([R; 3]) -> Option<usize>,
    value_at: impl Fn([R; 3]) -> Option<V>,
    classify: impl Fn(V) -> [R; 4],
) -> (Composite<R>, u32) {
    let mut so_far = Composite::default();
    let samples = march_in_runs(frame, pixel, cell_at, value_at, |value, segment| {
        gather(frame, &mut so_far, classify(value), segment)
    });
    (so_far, samples)
}

/// The same of slabs: CPU reference of `shaders/raycast_slab.wgsl`.
pub fn radiance_of_slabs<R: Real>(
    frame: &Frame,
    lattice: Lattice,
    pixel: [R; 2],
    value_at: impl Fn([R; 3]) -> Option<R>,
    classify: impl Fn(SlabValues<R>) -> [R; 4],
) -> (Composite<R>, u32) {
    let mut so_far = Composite::default();
    let voxel = voxel_ray(frame, &pixel_ray(frame, pixel));
    let samples = march_slabs(frame, lattice, pixel, value_at, |ends, segment| {
        let middle = voxel.at(segment.t);
        gather(
            frame,
            &mut so_far,
            classify(SlabValues { ends, middle }),
            segment,
        )
    });
    (so_far, samples)
}

fn gather<R: Real>(
    frame: &Frame,
    so_far: &mut Composite<R>,
    material: [R; 4],
    segment: Segment<R>,
) -> ControlFlow<()> {
    so_far.add(material, segment.length, segment.t);
    if so_far.transmittance < R::from_f32(frame.termination) {
        return ControlFlow::Break(());
    }
    ControlFlow::Continue(())
}

/// The same in [`crate::technique::Mode::Mida`]; `sample_at` gives the value and what it is made of, (red, green,
/// blue, extinction), `classify` that of the largest value.
pub fn accumulated<R: Real>(
    frame: &Frame,
    lattice: Lattice,
    pixel: [R; 2],
    sample_at: impl Fn([R; 3]) -> Option<(R, [R; 4])>,
    classify: impl Fn(R) -> [R; 4],
) -> (Composite<R>, u32) {
    let mut so_far = Mida::default();
    let samples = march(frame, lattice, pixel, sample_at, |sample, segment| {
        let (value, material) = sample;
        so_far.add(frame, value, material, segment.length, segment.t);
        if so_far.is_finished(frame) {
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(())
    });
    (so_far.picture(frame, classify), samples)
}
