//! Half-angle slices on the CPU: the eye's picture and the light's, slice by slice. CPU reference of
//! [`crate::technique::slices_3d::HalfAngleSlicer`], `shaders/lib/lit_scalar.wgsl` and `lit_scalar_gradient.wgsl`.

use super::{ReferenceRays, filtered, moved, steepness};
use crate::ray::pixel_ray;
use crate::real::Real;
use crate::shaders::Frame;
use crate::technique::blend::{Fragment, blend_material};
use crate::technique::reference::Gathered;
use crate::technique::shading::shade;
use crate::technique::slices_3d::half_angle::reference::{
    LightBuffer, dimmed, fragment, plainly_lit,
};
use crate::technique::slices_3d::reference::plane_of;
use crate::technique::{Order, Recording};
use crate::transfer::{classify_by_gradient, opacity_over};

impl<R: Real> ReferenceRays<'_, R> {
    /// All pixels of the picture, in the light of `light`, the recording of the light's pass.
    pub(super) fn gather_in_light(&self, light: &Recording) -> Vec<Gathered<R>> {
        let zero = R::from_f64(0.0);
        let nothing = Gathered::of_blended([zero; 4], 0.0);
        let [width, height] = self.scene.extent_pixels;
        let mut pixels = vec![nothing; width as usize * height as usize];
        let mut buffer = LightBuffer::new(light.frame.extent_pixels);
        for slice in 0..self.slices {
            let plane = plane_of(&self.frame, slice);
            for_each_row(&mut pixels, width, |pixel, found| {
                self.see(pixel, plane, light.order, &buffer, found);
            });
            let texels_across = buffer.extent[0];
            for_each_row(&mut buffer.taken, texels_across, |texel, taken| {
                self.take_light(&light.frame, texel, plane, taken);
            });
        }
        pixels
    }

    /// The eye's fragment.
    fn see(
        &self,
        pixel: [R; 2],
        plane: i32,
        order: Order,
        buffer: &LightBuffer<R>,
        found: &mut Gathered<R>,
    ) {
        let frame = &self.frame;
        let ray_direction = pixel_ray(frame, pixel).direction;
        let material_at = |place, world| {
            let light = buffer.light_at(frame, world);
            self.lit_material(place, light, ray_direction)
        };
        if let Some(sample) = fragment(frame, pixel, plane, material_at) {
            found.samples += 1.0;
            if let Some(Fragment { value, length }) = sample {
                found.accumulation = blend_material(order, found.accumulation, value, length);
            }
        }
    }

    /// The light's fragment.
    fn take_light(&self, frame: &Frame, texel: [R; 2], plane: i32, taken: &mut R) {
        let extinction_at = |place, _| Some(self.unlit_material(place)?[3]);
        if let Some(Some(sample)) = fragment(frame, texel, plane, extinction_at) {
            let opacity = opacity_over(sample.value, sample.length);
            *taken = (R::from_f64(1.0) - *taken) * opacity + *taken;
        }
    }

    /// What the volume is made of at a place, before any light.
    fn unlit_material(&self, place: [R; 3]) -> Option<[R; 4]> {
        let (volume, filter) = (self.volumes[0], self.scene.settings.filter);
        let value = filtered(volume, filter, place)?;
        let material = self.classified(0, value);
        let Some(widgets) = &self.widgets else {
            return Some(material);
        };
        let tap = |step| filtered(volume, filter, moved(place, step));
        let gradient = self.gradient(place, tap);
        let steep = steepness(&self.frame, widgets, gradient, tap);
        Some(classify_by_gradient(widgets, material, value, steep))
    }

    /// The same where this part of the light is left.
    fn lit_material(&self, place: [R; 3], light: R, ray_direction: [R; 3]) -> Option<[R; 4]> {
        let [r, g, b, extinction] = self.unlit_material(place)?;
        let (frame, color) = (&self.frame, [r, g, b]);
        let lit = if frame.light_count == 0 {
            plainly_lit(frame, color)
        } else {
            let (volume, filter) = (self.volumes[0], self.scene.settings.filter);
            let gradient =
                self.gradient(place, |step| filtered(volume, filter, moved(place, step)));
            shade(frame, color, gradient, &self.lamps(place, ray_direction))
        };
        let [r, g, b] = dimmed(frame, color, lit, light);
        Some([r, g, b, extinction])
    }
}

/// Calls `of_pixel` with the centre of each pixel and what it holds, rows shared out among the machine's cores.
fn for_each_row<R: Real, T: Send>(
    pixels: &mut [T],
    width: u32,
    of_pixel: impl Fn([R; 2], &mut T) + Sync,
) {
    let threads = std::thread::available_parallelism().map_or(1, |n| n.get());
    let width = width as usize;
    let rows = (pixels.len() / width).div_ceil(threads).max(1);
    let center = |n: usize| R::from_f64(n as f64 + 0.5);
    std::thread::scope(|scope| {
        for (first, share) in (0..).step_by(rows).zip(pixels.chunks_mut(rows * width)) {
            let of_pixel = &of_pixel;
            scope.spawn(move || {
                for (i, pixel) in share.iter_mut().enumerate() {
                    of_pixel([center(i % width), center(first + i / width)], pixel);
                }
            });
        }
    });
}
