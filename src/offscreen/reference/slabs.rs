//! The walk of slabs, and of planes between the slices of a stack.

use super::{Classifier, Gathered, Walk, filtered, filtered_in_slice};
use crate::real::Real;
use crate::technique::blend::{Fragment, blend_material};
use crate::technique::slices_2d::between::Level;
use crate::technique::{Filter, Technique, raycast, slices_2d, slices_3d};
use crate::transfer::classify_slab;

impl<R: Real> Walk<'_, R> {
    /// Emission and absorption of slabs of one volume.
    pub(super) fn composite_slabs(&self, pixel: [R; 2]) -> Gathered<R> {
        let settings = self.scene.settings;
        let (volume, frame, filter) = (self.volumes[0], &self.frame, settings.filter);
        let value_at = |p| filtered(volume, filter, p);
        let material = |fragment: Fragment<R, [R; 2]>| Fragment {
            value: self.classify_slab(fragment.value),
            length: fragment.length,
        };
        let blend = |target, fragment: Fragment<R, [R; 4]>| {
            blend_material(settings.order, target, fragment.value, fragment.length)
        };
        match settings.technique {
            Technique::Raycast => {
                let found = raycast::reference::radiance_of_slabs(
                    frame,
                    settings.lattice,
                    pixel,
                    value_at,
                    |ends| self.classify_slab(ends),
                );
                Gathered::of_composite(found)
            }
            Technique::Slices3d => {
                let slab = |i| {
                    let plane = self.plane_of(i);
                    let slab = slices_3d::reference::slab(frame, pixel, plane, value_at);
                    slab.map(|found| found.map(material))
                };
                self.blend_all(slab, blend)
            }
            Technique::Slices2d => {
                let value_at = |level, p| self.value_between(level, p);
                let slab = |i| {
                    let plane = slices_2d::reference::slice_of(frame, i);
                    let slab = slices_2d::between::slab(frame, pixel, plane, value_at);
                    slab.map(|found| found.map(material))
                };
                self.blend_all(slab, blend)
            }
        }
    }

    /// Emission and absorption of one volume on planes between the slices of its stack.
    pub(super) fn composite_between(&self, pixel: [R; 2]) -> Gathered<R> {
        let order = self.scene.settings.order;
        let value_at = |level, p| self.value_between(level, p);
        let sample = |i| {
            let plane = slices_2d::reference::slice_of(&self.frame, i);
            let found = slices_2d::between::fragment(&self.frame, pixel, plane, value_at);
            let material = |fragment: Fragment<R>| Fragment {
                value: self.classify(0, fragment.value),
                length: fragment.length,
            };
            found.map(|found| found.map(material))
        };
        self.blend_all(sample, |target, fragment| {
            blend_material(order, target, fragment.value, fragment.length)
        })
    }

    /// The volume's value between the slices of the stack.
    fn value_between(&self, level: Level<R>, p: [R; 3]) -> Option<R> {
        let (volume, filter) = (self.volumes[0], self.scene.settings.filter);
        let axis = self.frame.slice_axis as usize;
        let slices = volume.dims[axis];
        let in_slice = |slice| filtered_in_slice(volume, filter, axis, slice, p);
        match filter {
            Filter::Nearest => in_slice(level.nearest(slices)),
            // Wide filters refuse planes between slices.
            _ => level.linear(slices, in_slice),
        }
    }

    fn classify_slab(&self, [front, back]: [R; 2]) -> [R; 4] {
        match &self.classifiers[0] {
            Classifier::Slabs(slabs) => classify_slab(slabs, front, back),
            Classifier::Table(_) | Classifier::Points(_) => self.classify(0, front),
        }
    }
}
