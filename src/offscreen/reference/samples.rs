//! What a technique asks of the volumes of a scene.

use super::{Classifier, ReferenceRays};
use crate::ray::before_depth;
use crate::real::Real;
use crate::scene::Beside;
use crate::shaders::Frame;
use crate::technique::gradient::gradient_of;
use crate::technique::reference::{Samples, moved};
use crate::technique::splat::ViewPoints;
use crate::technique::{AlikeCells, Filter, Settings};
use crate::transfer::{classify_slab, emission_by_points, extinctions_by_points};
use crate::volume::Volume;
use crate::volume::kernel::{convolved, convolved_in_slice};
use crate::volume::sample::{linear, linear_in_slice, nearest};

impl<R: Real> Samples<R> for ReferenceRays<'_, R> {
    fn frame(&self) -> &Frame {
        &self.frame
    }

    fn frame_of(&self, pixel: [R; 2]) -> Frame {
        let Some(ends) = &self.ends else {
            return self.frame;
        };
        let [x, y] = pixel.map(|n| n.to_f64() as usize);
        before_depth(
            &self.frame,
            ends[y * self.scene.extent_pixels[0] as usize + x],
        )
    }

    fn settings(&self) -> &Settings {
        self.scene.settings
    }

    fn slice_count(&self) -> u32 {
        self.slices
    }

    fn dim(&self, axis: usize) -> u32 {
        self.volumes[0].dims[axis]
    }

    fn value(&self, p: [R; 3]) -> Option<R> {
        match self.field {
            Some(field) => field.value(in_cells(&self.frame, p)),
            None => filtered(self.volumes[0], self.scene.settings.filter, p),
        }
    }

    fn value_in_slice(&self, axis: usize, slice: u32, p: [R; 3]) -> Option<R> {
        filtered_in_slice(self.volumes[0], self.scene.settings.filter, axis, slice, p)
    }

    fn voxel(&self, index: [i32; 3]) -> Option<R> {
        nearest(
            self.volumes[0],
            index.map(|i| R::from_f64(f64::from(i) + 0.5)),
        )
    }

    fn is_classified(&self) -> bool {
        matches!(self.scene.beside, Beside::Classified(_))
    }

    fn classified_voxel(&self, index: [i32; 3]) -> Option<[R; 4]> {
        let center = index.map(|i| R::from_f64(f64::from(i) + 0.5));
        let mut found = [R::from_f64(0.0); 4];
        for (number, volume) in found.iter_mut().zip(&self.volumes) {
            *number = nearest(volume, center)?;
        }
        Some(found)
    }

    fn points(&self) -> Option<&ViewPoints> {
        self.points.as_ref()
    }

    fn material(&self, p: [R; 3], ray_direction: [R; 3]) -> Option<[R; 4]> {
        if self.field.is_some() {
            return self.value(p).map(|value| self.classify(value));
        }
        let look = |volume: &_, filter, step| filtered(volume, filter, moved(p, step));
        self.mixed(look, p, ray_direction)
    }

    fn gradient_met(&self, p: [R; 3], part: R) -> [R; 3] {
        match self.scene.beside {
            Beside::Channels(_) => self.gradient_of_channels(p, part),
            _ => gradient_of(&self.frame, |step| self.value(moved(p, step))),
        }
    }

    fn material_in_slice(
        &self,
        axis: usize,
        slice: u32,
        p: [R; 3],
        ray_direction: [R; 3],
    ) -> Option<[R; 4]> {
        let look = |volume: &Volume, filter, step: [i32; 3]| {
            let last = volume.dims[axis] - 1;
            let slice = slice.saturating_add_signed(step[axis]).min(last);
            filtered_in_slice(volume, filter, axis, slice, moved(p, step))
        };
        let mut on_slice = p;
        on_slice[axis] = R::from_f64(f64::from(slice) + 0.5);
        self.mixed(look, on_slice, ray_direction)
    }

    fn classify(&self, value: R) -> [R; 4] {
        self.classified(0, value)
    }

    fn extinctions(&self, value: R) -> [R; 3] {
        match &self.medium {
            Some(points) => extinctions_by_points(points, value),
            None => [self.classify(value)[3]; 3],
        }
    }

    fn emission(&self, value: R) -> [R; 3] {
        let points = self.medium.as_ref();
        points.map_or([R::from_f64(0.0); 3], |p| emission_by_points(p, value))
    }

    fn classify_slab(&self, [front, back]: [R; 2]) -> [R; 4] {
        match &self.classifiers[0] {
            Classifier::Slabs(slabs) => classify_slab(slabs, front, back),
            Classifier::Table(_) | Classifier::Points(_) => self.classified(0, front),
        }
    }

    fn lit(
        &self,
        material: [R; 4],
        p: [R; 3],
        ray_direction: [R; 3],
        tap: impl Fn([i32; 3]) -> Option<R>,
    ) -> [R; 4] {
        self.lit_by(material, p, ray_direction, || self.gradient(p, tap))
    }

    fn alike(&self) -> Option<&AlikeCells> {
        self.alike.as_ref()
    }
}

/// From voxel space to the cells of the field of points.
fn in_cells<R: Real>(frame: &Frame, p: [R; 3]) -> [R; 3] {
    frame.field_from_voxel.map(|row| {
        let [x, y, z, w] = row.map(R::from_f32);
        x * p[0] + y * p[1] + z * p[2] + w
    })
}

pub(super) fn filtered<R: Real>(volume: &Volume, filter: Filter, p: [R; 3]) -> Option<R> {
    match filter {
        Filter::Nearest => nearest(volume, p),
        Filter::Linear => linear(volume, p),
        filter => convolved(volume, filter.kernel()?, p),
    }
}

pub(super) fn filtered_in_slice<R: Real>(
    volume: &Volume,
    filter: Filter,
    axis: usize,
    slice: u32,
    mut p: [R; 3],
) -> Option<R> {
    match filter {
        Filter::Nearest => {
            p[axis] = R::from_f64(f64::from(slice) + 0.5);
            nearest(volume, p)
        }
        Filter::Linear => linear_in_slice(volume, axis, slice, p),
        filter => convolved_in_slice(volume, filter.kernel()?, axis, slice, p),
    }
}
