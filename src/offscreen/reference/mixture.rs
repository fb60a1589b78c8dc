//! What several volumes are made of in one place: each classified, and lit on the surface across its own gradient.

use super::{ReferenceRays, filtered, moved};
use crate::real::Real;
use crate::scene::{Beside, Scene};
use crate::technique::lit_mixture::{channel_gradient, label_gradient};
use crate::technique::mixture::{color_of, colored, dimmed, material_of};
use crate::technique::own_grid::place_in_channel;
use crate::technique::{Filter, Role};
use crate::volume::Volume;
use crate::volume::labels::{DIMMED, marks_of};

/// A position in voxels of the first volume, and along which direction it is seen.
#[derive(Clone, Copy)]
pub(super) struct SeenPlace<R> {
    pub p: [R; 3],
    pub ray_direction: [R; 3],
}

impl<R: Real> ReferenceRays<'_, R> {
    /// Of volumes that are one colour; `look_from` looks so many voxels away.
    pub(super) fn mixed_colors(
        &self,
        look_from: impl Fn(&Volume, Filter, [i32; 3]) -> Option<R>,
        place: SeenPlace<R>,
    ) -> Option<[R; 4]> {
        let settings = self.scene.settings;
        let count = self.volumes.len();
        let color_at = |step| {
            let mut found = [R::from_f64(0.0); 4];
            for (number, volume) in found.iter_mut().zip(&self.volumes) {
                *number = look_from(volume, settings.filter, step)?;
            }
            let [r, g, b, alpha] = found;
            Some(color_of([r, g, b], (count == 4).then_some(alpha)))
        };
        let (srgb, value) = color_at([0; 3])?;
        let material = match self.scene.beside {
            Beside::Classified(_) => {
                let [r, g, b] = srgb;
                [r, g, b, value / R::from_f64(self.scene.reference_length())]
            }
            _ => colored(srgb, self.classified(0, value)[3], settings.color_space),
        };
        let channel = if count == 4 { 3 } else { 0 };
        let gradient = || channel_gradient(&self.frame, channel, |step| Some(color_at(step)?.1));
        Some(self.lit_in(material, place, gradient))
    }

    /// Of volumes that are things of their own.
    pub(super) fn mixed_channels(
        &self,
        look_from: impl Fn(&Volume, Filter, [i32; 3]) -> Option<R>,
        place: SeenPlace<R>,
    ) -> Option<[R; 4]> {
        let look = |c: usize, volume: &Volume, filter, step| {
            if volume.grid() == self.volumes[0].grid() {
                return look_from(volume, filter, step);
            }
            let own = place_in_channel(&self.frame, c, moved(place.p, step))?;
            filtered(volume, filter, own)
        };
        let own_filter = |c: usize| self.filter_of(c);
        let mut found = [None; crate::shaders::MAX_CHANNELS as usize];
        for (c, volume) in self.volumes.iter().enumerate() {
            found[c] = look(c, volume, own_filter(c), [0; 3]);
            if self.roles[c] == Role::Labels {
                found[c]?;
            }
        }
        let lit = |c: usize, value: R, material: [R; 4]| {
            let tap = |step| look(c, self.volumes[c], own_filter(c), step);
            self.lit_in(material, place, || match self.roles[c] {
                Role::Labels => label_gradient(&self.frame, c, value, tap),
                Role::Numbers | Role::Opacity | Role::Material => {
                    channel_gradient(&self.frame, c, tap)
                }
            })
        };
        let classify = |c, value| self.classified(c, value);
        let material = material_of(&self.roles, &found[..self.roles.len()], classify, lit)?;
        let dimmed_mark = Some(R::from_f64(DIMMED.into()));
        let is_dimmed =
            |(c, marks): &(usize, Volume)| look(*c, marks, Filter::Nearest, [0; 3]) == dimmed_mark;
        Some(match self.marks.iter().any(is_dimmed) {
            true => dimmed(material, R::from_f32(self.frame.dim)),
            false => material,
        })
    }

    /// The gradient of one of the channels on one grid, which `part`, 0 to 1, finds by their shares of the extinction: CPU reference of
    /// `shaders/lib/matter_by_channels.wgsl`.
    pub(super) fn gradient_of_channels(&self, p: [R; 3], part: R) -> [R; 3] {
        let zero = R::from_f64(0.0);
        let look = |c: usize, step| filtered(self.volumes[c], self.filter_of(c), moved(p, step));
        let values: Vec<_> = (0..self.volumes.len()).map(|c| look(c, [0; 3])).collect();
        let shares = std::cell::RefCell::new(Vec::new());
        let classify = |c, value| self.classified(c, value);
        material_of(&self.roles, &values, classify, |c, value, material| {
            shares.borrow_mut().push((c, value, material[3]));
            material
        });
        let shares = shares.into_inner();
        let sum = shares.iter().fold(zero, |sum, share| sum + share.2);
        let mut left = part * sum;
        let mut met = None;
        for &(c, value, own) in &shares {
            if own > zero && left >= zero {
                met = Some((c, value));
            }
            left = left - own;
        }
        let Some((c, value)) = met else {
            return [zero; 3];
        };
        match self.roles[c] {
            Role::Labels => label_gradient(&self.frame, c, value, |step| look(c, step)),
            Role::Numbers | Role::Opacity | Role::Material => {
                channel_gradient(&self.frame, c, |step| look(c, step))
            }
        }
    }

    /// Nothing lies between two labels.
    fn filter_of(&self, channel: usize) -> Filter {
        match self.roles[channel] {
            Role::Labels => Filter::Nearest,
            Role::Numbers | Role::Opacity | Role::Material => self.scene.settings.filter,
        }
    }

    /// A material with the light that falls on it.
    fn lit_in(
        &self,
        [r, g, b, extinction]: [R; 4],
        place: SeenPlace<R>,
        gradient: impl FnOnce() -> [R; 3],
    ) -> [R; 4] {
        if extinction == R::from_f64(0.0) {
            return [r, g, b, extinction];
        }
        self.lit_by(
            [r, g, b, extinction],
            place.p,
            place.ray_direction,
            gradient,
        )
    }
}

/// Which voxels of the scene's label maps are dimmed, by their channels.
pub(super) fn marks_of_scene(scene: &Scene) -> Vec<(usize, Volume)> {
    let parts = scene.volumes().into_iter().zip(scene.roles()).enumerate();
    let maps = parts.filter(|(_, (_, role))| *role == Role::Labels);
    maps.filter_map(|(c, (map, _))| Some((c, marks_of(map)?)))
        .collect()
}
