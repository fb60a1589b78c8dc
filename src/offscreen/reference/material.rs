//! What the volumes of a scene are made of in one place: classified, by gradients where they count, and lit.

use super::mixture::SeenPlace;
use super::{ReferenceRays, filtered};
use crate::real::{Real, dot, scale};
use crate::scene::Beside;
use crate::shaders::Frame;
use crate::technique::gradient::gradient_of;
use crate::technique::gradient_taps::weighted_gradient;
use crate::technique::reference::Samples;
use crate::technique::second_derivative::second_derivative_of;
use crate::technique::shading::{Lamps, shade};
use crate::technique::{Filter, Operator, scattered, shining};
use crate::transfer::{GradientMagnitude, PackedWidgets, classify_by_gradient};
use crate::volume::Volume;

impl<R: Real> ReferenceRays<'_, R> {
    /// The gradient at `p`; `tap` filters values so many voxels away.
    pub(super) fn gradient(&self, p: [R; 3], tap: impl Fn([i32; 3]) -> Option<R>) -> [R; 3] {
        let operator = self.scene.settings.gradient_operator();
        gradient_at(
            &self.frame,
            self.gradients.map(|source| (source, operator)),
            p,
            tap,
        )
    }

    /// What comes through to a position in voxel space, seen along a ray.
    pub(super) fn lamps(&self, voxel: [R; 3], ray_direction: [R; 3]) -> Lamps<'_, R> {
        Lamps {
            field: self.light,
            voxel,
            ray_direction,
        }
    }

    /// What the volumes are made of at `p`, where `look_from` looks from, so many voxels away; `None` for no data.
    pub(super) fn mixed(
        &self,
        look_from: impl Fn(&Volume, Filter, [i32; 3]) -> Option<R>,
        p: [R; 3],
        ray_direction: [R; 3],
    ) -> Option<[R; 4]> {
        let settings = self.scene.settings;
        let place = SeenPlace { p, ray_direction };
        if let Beside::Colors(_) | Beside::Classified(_) = self.scene.beside {
            return self.mixed_colors(look_from, place);
        }
        if let [volume] = self.volumes[..] {
            let value = look_from(volume, settings.filter, [0; 3])?;
            let material = self.classified(0, value);
            if settings.single_scattering.is_some() {
                return Some(self.scattered(material, value, p, ray_direction));
            }
            let tap = |step| look_from(volume, settings.filter, step);
            let Some(widgets) = &self.widgets else {
                let gradient = || self.gradient(p, tap);
                return Some(self.lit_by(material, p, ray_direction, gradient));
            };
            let gradient = self.gradient(p, tap);
            let steep = steepness(&self.frame, widgets, gradient, tap);
            let material = classify_by_gradient(widgets, material, value, steep);
            return Some(self.lit_by(material, p, ray_direction, || gradient));
        }
        self.mixed_channels(look_from, place)
    }

    /// The material of a value at `p` with the light that it scatters and sends to the eye: none along no direction.
    fn scattered(&self, material: [R; 4], value: R, p: [R; 3], ray_direction: [R; 3]) -> [R; 4] {
        let [r, g, b, extinction] = material;
        if ray_direction == [R::from_f64(0.0); 3] {
            return material;
        }
        let extinction_at = |p| {
            let value = filtered(self.volumes[0], self.scene.settings.filter, p);
            value.map_or(R::from_f64(0.0), |value| self.classified(0, value)[3])
        };
        let lamps = self.lamps(p, ray_direction);
        let [r, g, b] = scattered(&self.frame, [r, g, b], &lamps, extinction_at);
        shining(&self.frame, [r, g, b, extinction], || self.emission(value))
    }

    /// A material at `p` with the light that falls on it: none along no direction, and without lamps all of it ambient.
    pub(super) fn lit_by(
        &self,
        [r, g, b, extinction]: [R; 4],
        p: [R; 3],
        ray_direction: [R; 3],
        gradient: impl FnOnce() -> [R; 3],
    ) -> [R; 4] {
        if ray_direction == [R::from_f64(0.0); 3] {
            return [r, g, b, extinction];
        }
        let lamps = self.lamps(p, ray_direction);
        let [r, g, b] = match self.frame.light_count {
            0 => scale([r, g, b], lamps.ambient(&self.frame)),
            _ => shade(&self.frame, [r, g, b], gradient(), &lamps),
        };
        [r, g, b, extinction]
    }
}

/// The gradient at `p`: by the weights of an operator over a volume, or else by differences of what `tap` finds so
/// many voxels away.
pub(super) fn gradient_at<R: Real>(
    frame: &Frame,
    weighted: Option<(&Volume, Operator)>,
    p: [R; 3],
    tap: impl Fn([i32; 3]) -> Option<R>,
) -> [R; 3] {
    match weighted {
        Some((source, operator)) => weighted_gradient(frame, source, operator, p),
        None => gradient_of(frame, tap),
    }
}

/// What widgets want to know where the field has this gradient.
pub(super) fn steepness<R: Real>(
    frame: &Frame,
    widgets: &PackedWidgets,
    gradient: [R; 3],
    tap: impl Fn([i32; 3]) -> Option<R>,
) -> GradientMagnitude<R> {
    let second = match widgets.needs_second() {
        true => second_derivative_of(frame, gradient, tap),
        false => R::from_f64(0.0),
    };
    GradientMagnitude {
        magnitude: dot(gradient, gradient).sqrt(),
        second,
        smallest_spacing: R::from_f32(frame.smallest_spacing),
    }
}
