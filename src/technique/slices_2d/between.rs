//! Between the slices of a stack: CPU reference of `shaders/lib/between.wgsl`, `slices_2d_smooth.wgsl` and
//! `slices_2d_slab.wgsl`, and how many planes there are.
//!
//! ```text
//! S(i + a) = (1 - a) S(i) + a S(i + 1)        plane i at the height 1/2 + i / n, n planes a slice
//! n = ceil(1 / (h s)),  s = |n_k . v| |row k|  so that no sample is farther from the next than h
//! ```
//!
//! Rezk-Salama et al., "Interactive Volume Rendering on Standard PC Graphics Hardware Using Multi-Textures and
//! Multi-Stage Rasterization", Graphics Hardware 2000.

use crate::lattice::Slab;
use crate::ray::{Ray, domain_interval, pixel_ray, visible_interval, voxel_ray};
use crate::real::Real;
use crate::shaders::Frame;
use crate::technique::View;
use crate::technique::blend::Fragment;
use crate::technique::reference::SlabValues;
use crate::technique::stack_axis::facing;

/// More planes than these show nothing new.
const MAX_PLANES_PER_SLICE: u32 = 64;
/// A spacing that is too long by less is right.
const ROUNDING: f64 = 1e-3;

/// How many planes of the stack along `axis` there are for each of its slices: 1 unless the settings say smooth.
pub fn planes_per_slice(view: &View, axis: usize) -> u32 {
    if !view.settings.smooth {
        return 1;
    }
    let slope = facing(view)[axis] * view.grid.voxel_rows()[axis].length();
    let wanted = (1.0 / (view.step_world() * slope) - ROUNDING).ceil();
    // What is not a number counts as 1.
    (wanted.max(1.0) as u32).clamp(1, MAX_PLANES_PER_SLICE)
}

/// So much of the way from one slice to the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Level<R> {
    /// The slice below; -1 before the first.
    pub below: i32,
    /// The part of the slice above, under 1.
    pub part: R,
}

impl<R: Real> Level<R> {
    fn of_plane(frame: &Frame, plane: i32) -> Self {
        let planes = frame.planes_per_slice as i32;
        let part = R::from_f64(f64::from(plane.rem_euclid(planes)));
        Self {
            below: plane.div_euclid(planes),
            part: part / R::from_f32(frame.planes_per_slice),
        }
    }

    /// That of a height in voxels along the stack.
    pub(super) fn at(height: R) -> Self {
        let lattice = height - R::from_f64(0.5);
        let below = lattice.floor();
        Self {
            below: below.to_i32(),
            part: lattice - below,
        }
    }

    /// The value at this level of what `in_slice` says of a slice; `None` where a slice that counts has none.
    pub fn linear(self, slices: u32, in_slice: impl Fn(u32) -> Option<R>) -> Option<R> {
        let [low, high] = self.slices(slices);
        let below = in_slice(low)?;
        if self.part == R::from_f64(0.0) {
            return Some(below);
        }
        Some(below.lerp(in_slice(high)?, self.part))
    }

    /// The nearer slice.
    pub fn nearest(self, slices: u32) -> u32 {
        let [low, high] = self.slices(slices);
        if self.part >= R::from_f64(0.5) {
            high
        } else {
            low
        }
    }

    fn slices(self, count: u32) -> [u32; 2] {
        let clamped = |slice: i32| u32::try_from(slice).unwrap_or(0).min(count - 1);
        [clamped(self.below), clamped(self.below.saturating_add(1))]
    }
}

fn height_of_plane<R: Real>(frame: &Frame, plane: i32) -> R {
    R::from_f64(0.5) + R::from_f64(f64::from(plane)) / R::from_f32(frame.planes_per_slice)
}

/// The ray in voxel space, where it is in the domain, and its slope along the stack, which is not 0.
fn ray_of<R: Real>(frame: &Frame, pixel: [R; 2]) -> Option<(Ray<R>, [R; 2], R)> {
    let world = pixel_ray(frame, pixel);
    let voxel = voxel_ray(frame, &world);
    let slope = voxel.direction[frame.slice_axis as usize];
    let is_crossing = slope.abs() >= R::from_f32(1e-20);
    let interval = visible_interval(frame, domain_interval(frame, &world, &voxel), &world);
    is_crossing.then_some((voxel, interval, slope))
}

/// The sample of a pixel's ray on one plane; `None` outside the domain, `Some(None)` for no data.
pub fn fragment<R: Real, V>(
    frame: &Frame,
    pixel: [R; 2],
    plane: i32,
    value_at: impl Fn(Level<R>, [R; 3]) -> Option<V>,
) -> Option<Option<Fragment<R, V>>> {
    let (voxel, [t0, t1], slope) = ray_of(frame, pixel)?;
    let height: R = height_of_plane(frame, plane);
    let t = (height - voxel.origin[frame.slice_axis as usize]) / slope;
    if !(t0 <= t && t < t1) {
        return None;
    }
    let length = R::from_f64(1.0) / (slope.abs() * R::from_f32(frame.planes_per_slice));
    let mut place = voxel.at(t);
    // No rounding takes it out of its plane.
    place[frame.slice_axis as usize] = height;
    let value = value_at(Level::of_plane(frame, plane), place);
    Some(value.map(|value| Fragment { value, length }))
}

/// The slab of a pixel's ray between one plane and the next.
pub fn slab<R: Real>(
    frame: &Frame,
    pixel: [R; 2],
    plane: i32,
    value_at: impl Fn(Level<R>, [R; 3]) -> Option<R>,
) -> Option<Option<Fragment<R, SlabValues<R>>>> {
    let (voxel, interval, slope) = ray_of(frame, pixel)?;
    let axis = frame.slice_axis as usize;
    let mut planes = [plane, plane + 1];
    if slope < R::from_f64(0.0) {
        planes.reverse();
    }
    let whole = planes.map(|i| (height_of_plane::<R>(frame, i) - voxel.origin[axis]) / slope);
    let length = R::from_f64(1.0) / (slope.abs() * R::from_f32(frame.planes_per_slice));
    let slab = Slab::cut(whole, interval, length);
    if slab.ends[0].partial_cmp(&slab.ends[1]) != Some(std::cmp::Ordering::Less) {
        return None;
    }
    let value = |end: usize| {
        let place = voxel.at(slab.ends[end]);
        let level = match slab.ends[end] == whole[end] {
            true => Level::of_plane(frame, planes[end]),
            false => Level::at(place[axis]),
        };
        value_at(level, place)
    };
    let mut middle = voxel.at(slab.segment().t);
    if slab.ends == whole {
        let planes = planes.map(|i| height_of_plane::<R>(frame, i));
        middle[axis] = R::from_f64(0.5) * (planes[0] + planes[1]);
    }
    let ends = value(0).and_then(|front| Some([front, value(1)?]));
    Some(ends.map(|ends| Fragment {
        value: SlabValues { ends, middle },
        length: slab.length,
    }))
}
