//! What the volumes of a scene are made of in one place: classified, by gradients where they count, and lit.

use super::ReferenceRays;
use super::mixture::SeenPlace;
use crate::real::{Real, dot, scale};
use crate::scene::Beside;
use crate::shaders::Frame;
use crate::technique::gradient::gradient_of;
use crate::technique::gradient_taps::weighted_gradient;
use crate::technique::second_derivative::second_derivative_of;
use crate::technique::shading::{Lamps, shade};
use crate::technique::{Filter, Operator};
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
            let mut material = self.classified(0, value);
            let is_on_face = ray_direction == [R::from_f64(0.0); 3];
            let is_lit = self.frame.light_count != 0 && !is_on_face;
            let lamps = self.lamps(p, ray_direction);
            let unlit = |material| match is_on_face {
                true => material,
                false => ambient_of(&self.frame, material, &lamps),
            };
            if !is_lit && self.widgets.is_none() {
                return Some(unlit(material));
            }
            let tap = |step| look_from(volume, settings.filter, step);
            let gradient = self.gradient(p, tap);
            if let Some(widgets) = &self.widgets {
                let steep = steepness(&self.frame, widgets, gradient, tap);
                material = classify_by_gradient(widgets, material, value, steep);
            }
            let [r, g, b, extinction] = material;
            if !is_lit {
                return Some(unlit(material));
            }
            let [r, g, b] = shade(&self.frame, [r, g, b], gradient, &lamps);
            return Some([r, g, b, extinction]);
        }
        self.mixed_channels(look_from, place)
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

/// A material without lights: all light is ambient.
fn ambient_of<R: Real>(frame: &Frame, [r, g, b, extinction]: [R; 4], lamps: &Lamps<R>) -> [R; 4] {
    let [r, g, b] = scale([r, g, b], lamps.ambient(frame));
    [r, g, b, extinction]
}
