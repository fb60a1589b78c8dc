//! What the CPU reference of a technique is given, and what it leaves.
//!
//! ```text
//! technique.pixel(samples, pixel)     one pixel of what the technique gathers, in f32 or f64
//! ```

use super::blend::{Fragment, clear_color, merge};
use super::composite::Composite;
use super::gradient::gradient_of;
use super::isosurface::Surfaces;
use super::merge::MAX_BATCH_SLICES;
use super::pathtrace::{PathMeans, numbers_of};
use super::splat::ViewPoints;
use super::{AlikeCells, Settings};
use crate::picture::LayerKind;
use crate::real::Real;
use crate::shaders::Frame;

/// What a technique asks of what it shows. Positions are in voxel space; `None` stands for no data.
pub trait Samples<R: Real> {
    /// The parameters of the picture.
    fn frame(&self) -> &Frame;
    /// Those of the ray of a pixel, which ends at what is drawn there.
    fn frame_of(&self, _pixel: [R; 2]) -> Frame {
        *self.frame()
    }
    /// What to compute.
    fn settings(&self) -> &Settings;
    /// Slices to draw.
    fn slice_count(&self) -> u32;
    /// Voxels along an axis.
    fn dim(&self, axis: usize) -> u32;
    /// The filtered value.
    fn value(&self, p: [R; 3]) -> Option<R>;
    /// The same of the voxels of one slice across an axis.
    fn value_in_slice(&self, axis: usize, slice: u32, p: [R; 3]) -> Option<R>;
    /// A voxel, by its index.
    fn voxel(&self, index: [i32; 3]) -> Option<R>;
    /// Whether voxels are classified already.
    fn is_classified(&self) -> bool {
        false
    }
    /// The four numbers of such a voxel: light, and optical depth over the reference length.
    fn classified_voxel(&self, _index: [i32; 3]) -> Option<[R; 4]> {
        None
    }
    /// The scattered points that are splatted in place of voxels.
    fn points(&self) -> Option<&ViewPoints> {
        None
    }
    /// Colour and extinction of what is there, lit.
    fn material(&self, p: [R; 3], ray_direction: [R; 3]) -> Option<[R; 4]>;
    /// The gradient of the matter that a collision at `p` is with, in units of the first volume: of several volumes that which `part`,
    /// 0 to 1, finds by the shares that they have of the extinction. 0 for no data.
    fn gradient_met(&self, p: [R; 3], _part: R) -> [R; 3] {
        gradient_of(self.frame(), |step| self.value(moved(p, step)))
    }
    /// The same of the voxels of one slice across an axis.
    fn material_in_slice(
        &self,
        axis: usize,
        slice: u32,
        p: [R; 3],
        ray_direction: [R; 3],
    ) -> Option<[R; 4]>;
    /// Colour and extinction of a value.
    fn classify(&self, value: R) -> [R; 4];
    /// Extinctions per world length of red, green and blue.
    fn extinctions(&self, value: R) -> [R; 3] {
        [self.classify(value)[3]; 3]
    }
    /// Radiance per world length that matter sends out.
    fn emission(&self, _value: R) -> [R; 3] {
        [R::from_f64(0.0); 3]
    }
    /// The same of a slab with these values at its ends.
    fn classify_slab(&self, ends: [R; 2]) -> [R; 4];
    /// A slab's material, lit in its middle; `tap` finds values so many voxels away from there.
    fn material_of_slab(
        &self,
        slab: SlabValues<R>,
        ray_direction: [R; 3],
        tap: impl Fn([i32; 3]) -> Option<R>,
    ) -> [R; 4] {
        let own = self.classify_slab(slab.ends);
        self.lit(own, slab.middle, ray_direction, tap)
    }
    /// A material at `p` with the light that falls on it; `tap` finds values so many voxels away.
    fn lit(
        &self,
        material: [R; 4],
        p: [R; 3],
        ray_direction: [R; 3],
        tap: impl Fn([i32; 3]) -> Option<R>,
    ) -> [R; 4];
    /// Where one sample stands for others, where steps adapt.
    fn alike(&self) -> Option<&AlikeCells>;
}

/// What a slab is classified and lit by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlabValues<R> {
    /// The values at its two ends.
    pub ends: [R; 2],
    /// Its middle, in voxel space.
    pub middle: [R; 3],
}

/// The position so many voxels away.
pub(crate) fn moved<R: Real>(p: [R; 3], step: [i32; 3]) -> [R; 3] {
    std::array::from_fn(|k| p[k] + R::from_f64(step[k].into()))
}

/// What a technique leaves for one pixel, before it is resolved.
#[derive(Clone, Copy, Debug)]
pub struct Gathered<R> {
    /// Composite: premultiplied colour and alpha. Else (value, weight, unused, unused).
    pub accumulation: [R; 4],
    /// World length along the ray, as the layer of depths has it; `None`: no depth.
    pub depth: Option<R>,
    /// The value of a surface that was hit first.
    pub level: Option<R>,
    /// What a depth cue leaves of the colour.
    pub light: R,
    /// How many it took; of several rays the mean.
    pub samples: f32,
    /// What paths leave beside their picture.
    pub paths: Option<PathMeans>,
}

impl<R: Real> Gathered<R> {
    /// Of a ray that has composited so many samples.
    pub fn of_composite((found, samples): (Composite<R>, u32)) -> Self {
        let ([r, g, b], one) = (found.color, R::from_f64(1.0));
        Self {
            accumulation: [r, g, b, one - found.transmittance],
            depth: found.depth,
            level: None,
            light: R::from_f64(1.0),
            samples: samples as f32,
            paths: None,
        }
    }

    /// Of a ray that has met surfaces.
    pub fn of_surfaces(found: Surfaces<R>) -> Self {
        let ([r, g, b], one) = (found.color, R::from_f64(1.0));
        Self {
            accumulation: [r, g, b, one - found.transmittance],
            depth: found.first.map(|(_, t)| t),
            level: found.first.map(|(level, _)| level),
            light: one,
            samples: found.samples as f32,
            paths: None,
        }
    }

    /// Of paths, the mean of them and what they leave beside it.
    pub fn of_paths(accumulation: [R; 4], means: PathMeans) -> Self {
        let [samples, ..] = numbers_of(LayerKind::Samples, &means);
        Self {
            paths: Some(means),
            ..Self::of_blended(accumulation, samples)
        }
    }

    /// Of what a blending unit has made of so many fragments.
    pub fn of_blended(accumulation: [R; 4], samples: f32) -> Self {
        Self {
            accumulation,
            depth: None,
            level: None,
            light: R::from_f64(1.0),
            samples,
            paths: None,
        }
    }
}

/// All slices of one pixel through the blending unit.
pub(super) fn blended<R: Real, V>(
    of: &impl Samples<R>,
    fragment: impl Fn(u32) -> Option<Option<Fragment<R, V>>>,
    blend: impl Fn([R; 4], Fragment<R, V>) -> [R; 4],
) -> Gathered<R> {
    let (settings, slices) = (of.settings(), of.slice_count());
    let clear = clear_color(settings.mode).map(R::from_f32);
    let mut samples = 0;
    let mut of_batch = |slices: std::ops::Range<u32>| {
        let mut target = clear;
        for fragment in slices.filter_map(&fragment) {
            samples += 1;
            if let Some(fragment) = fragment {
                target = blend(target, fragment);
            }
        }
        target
    };
    let at_once = if R::IS_MERGED {
        MAX_BATCH_SLICES
    } else {
        slices.max(1)
    };
    let batches = (0..slices).step_by(at_once as usize);
    let batches = batches.map(|first| of_batch(first..(first + at_once).min(slices)));
    let merged = batches.reduce(|before, batch| merge(settings.order, before, batch));
    Gathered::of_blended(merged.unwrap_or(clear), samples as f32)
}

/// The fragments of slices of one volume's values, blended as the mode says. It classifies when it is resolved.
pub(super) fn projected<R: Real>(
    of: &impl Samples<R>,
    fragment: impl Fn(u32) -> Option<Option<Fragment<R>>>,
) -> Gathered<R> {
    let (mode, order) = (of.settings().mode, of.settings().order);
    let unclassified = |_| [R::from_f64(0.0); 4];
    blended(of, fragment, |target, fragment| {
        super::blend::blend(mode, order, target, fragment, unclassified)
    })
}

/// The fragments of slices of matter, composited.
pub(super) fn composited<R: Real>(
    of: &impl Samples<R>,
    fragment: impl Fn(u32) -> Option<Option<Fragment<R, [R; 4]>>>,
) -> Gathered<R> {
    let order = of.settings().order;
    blended(of, fragment, |target, fragment| {
        super::blend::blend_material(order, target, fragment.value, fragment.length)
    })
}
