//! What stands at a place of a ray: `sampling.md` 4 and 7, T5 and A17 to A19 of the exact answers, written a second
//! time in f64. Numbers of colours are blended as they are.
//!
//! ```text
//! extinction   s = -ln(1 - min(a, 1 - 2^-12)) / d0            of several: the sum, their colours weighted by it
//! light        c (ambient o + sum L t diffuse |n.l|) + sum L t specular |n.h|^e   n of central differences, o and t
//!              what comes through of all light and of a lamp (`light.rs`)
//! contour      max(0, 1 - |f - v| / (r h |grad f|))           half-width r in smallest spacings h (Levoy 1988)
//! triangle     max(0, 1 - |f - v| / (w s / top))              rectangle, bell: as they say
//! ```

use super::PictureCase;
use super::light::Open;
use super::voxels::{Numbers, stack_of};
use crate::technique::{Filter, Light, LightSpace, Role, Shading};
use crate::transfer::{Shape, TransferFunction, Widget};
use glam::{DMat3, DVec3};

/// One of the volumes that are seen together.
#[derive(Clone, Debug)]
#[allow(missing_docs, reason = "the names say it")]
pub struct Part {
    pub numbers: Numbers,
    pub function: TransferFunction,
    pub role: Role,
}

/// All of them, as a shot sees them.
#[derive(Clone, Copy, Debug)]
pub struct Matter<'a> {
    shot: &'a PictureCase,
    parts: &'a [Part],
    stack: Option<usize>,
    open: Option<&'a Open>,
}

impl<'a> Matter<'a> {
    /// The first is the scene's volume.
    pub fn new(shot: &'a PictureCase, parts: &'a [Part], open: Option<&'a Open>) -> Self {
        Self {
            shot,
            parts,
            stack: stack_of(shot),
            open,
        }
    }

    /// The value of a part at a place in voxel space.
    pub fn value(&self, part: usize, place: DVec3) -> f64 {
        let Part { numbers, role, .. } = &self.parts[part];
        let filter = match role {
            Role::Labels => Filter::Nearest,
            _ => self.shot.settings.filter,
        };
        numbers.at(filter, place, self.stack)
    }

    /// Colour and extinction at a place, seen along a direction of the world.
    pub fn at(&self, place: DVec3, along: DVec3) -> ([f64; 3], f64) {
        let materials = (0..self.parts.len()).filter(|&i| self.parts[i].role != Role::Opacity);
        let (mut light, mut all) = (DVec3::ZERO, 0.0);
        for part in materials {
            let (color, extinction) = self.of(part, place);
            light += extinction * color;
            all += extinction;
        }
        let color = match all > 0.0 {
            true => light / all,
            false => DVec3::ZERO,
        };
        let color = match &self.shot.settings.shading {
            Some(shading) => self.lit(shading, color, place, along),
            None => color * self.ambient(place, along),
        };
        (color.to_array(), all)
    }

    /// Extinction of an opacity per reference length of a function.
    fn extinction(&self, function: &TransferFunction, opacity: f64) -> f64 {
        let spacing = self.shot.grid.smallest_spacing();
        let length = function.reference_length.unwrap_or(spacing);
        -(-opacity.min(1.0 - 1.0 / 4096.0)).ln_1p() / length
    }

    fn of(&self, index: usize, place: DVec3) -> (DVec3, f64) {
        let function = &self.parts[index].function;
        let value = self.value(index, place);
        let color = DVec3::from_array(function.srgb(value));
        if let Some(opacity) = self
            .parts
            .get(index + 1)
            .filter(|p| p.role == Role::Opacity)
        {
            let of = &opacity.function;
            let opacity = of.opacity(self.value(index + 1, place));
            return (color, self.extinction(of, opacity));
        }
        let own = self.extinction(function, function.opacity(value));
        let Some(gradient_transfer) = &function.gradient_transfer else {
            return (color, own);
        };
        let slope = self.gradient(place).length();
        let steepest = gradient_transfer.steepest.expect("said by whoever asks");
        let (mut light, mut all) = (own * color, own);
        for widget in &gradient_transfer.widgets {
            let share = self.share(widget, value, slope, slope / steepest);
            let extinction = self.extinction(function, widget.opacity * share);
            let color = widget.srgb.map_or(color, DVec3::from_array);
            light += extinction * color;
            all += extinction;
        }
        let color = if all > 0.0 { light / all } else { color };
        (color, all)
    }

    /// Of a widget, where the gradient has this length, which is so much of the steepest.
    fn share(&self, widget: &Widget, f: f64, slope: f64, s: f64) -> f64 {
        let within = |x: f64, [low, high]: [f64; 2]| (low..=high).contains(&x);
        match &widget.shape {
            Shape::Contour { value, half_width } => {
                let reach = half_width * self.shot.grid.smallest_spacing() * slope;
                (1.0 - (f - value).abs() / reach).max(0.0)
            }
            Shape::Triangle {
                value,
                half_width,
                threshold,
                top,
            } => {
                let tent = (1.0 - (f - value).abs() / (half_width * s / top)).max(0.0);
                if within(s, [*threshold, *top]) {
                    tent
                } else {
                    0.0
                }
            }
            Shape::Rectangle { values, gradients } => {
                f64::from(u8::from(within(f, *values) && within(s, *gradients)))
            }
            Shape::Gaussian {
                value,
                gradient,
                sigma_value,
                sigma_gradient,
            } => {
                let [a, b] = [(f - value) / sigma_value, (s - gradient) / sigma_gradient];
                (-0.5 * (a * a + b * b)).exp()
            }
            Shape::Region { points } => {
                let pair = points
                    .windows(2)
                    .find(|p| within(f, [p[0].value, p[1].value]));
                pair.map_or(0.0, |p| {
                    let part = (f - p[0].value) / (p[1].value - p[0].value);
                    s.min(1.0) * (p[0].opacity + part * (p[1].opacity - p[0].opacity))
                })
            }
            Shape::Image { .. } => unreachable!("not asked for"),
        }
    }

    /// Central differences one voxel each way, as a covector of the world.
    fn gradient(&self, place: DVec3) -> DVec3 {
        let slope = |axis: DVec3| 0.5 * (self.value(0, place + axis) - self.value(0, place - axis));
        let of_voxels = DVec3::from_array(DVec3::AXES.map(slope));
        self.shot
            .grid
            .world_from_voxel
            .matrix3
            .inverse()
            .transpose()
            * of_voxels
    }

    /// What is left of the light from all around.
    fn ambient(&self, place: DVec3, along: DVec3) -> f64 {
        self.open.map_or(1.0, |open| open.ambient(place, along))
    }

    fn lit(&self, shading: &Shading, color: DVec3, place: DVec3, along: DVec3) -> DVec3 {
        let gradient = self.gradient(place);
        let [low, high] = self.parts[0].numbers.volume.value_range;
        let flat = 1e-4 * (high - low) / self.shot.grid.smallest_spacing();
        if gradient.length() < flat {
            return color;
        }
        let (normal, to_eye) = (gradient.normalize(), -along);
        let headlight = [Light::of_world(to_eye, [1.0; 3])];
        let camera = self.shot.camera.frame();
        let lights = match shading.lights.is_empty() {
            true => &headlight[..],
            false => &shading.lights,
        };
        let mut lit = shading.ambient * self.ambient(place, along) * color;
        for (i, light) in lights.iter().enumerate() {
            let to_light = match light.space {
                LightSpace::World => light.towards,
                LightSpace::Camera => {
                    DMat3::from_cols(camera.right, camera.up, -camera.forward) * light.towards
                }
            };
            let to_light = to_light.normalize();
            let halfway = (to_light + to_eye).normalize();
            let diffuse = shading.diffuse * normal.dot(to_light).abs();
            let specular = shading.specular * normal.dot(halfway).abs().powf(shading.shininess);
            let left = self.open.map_or(1.0, |open| open.lamp(i, place, to_light));
            lit += left * DVec3::from_array(light.srgb) * (diffuse * color + specular);
        }
        if shading.half_gradient == 0.0 {
            return lit;
        }
        let steepness = gradient.length();
        (shading.half_gradient * color + steepness * lit) / (shading.half_gradient + steepness)
    }
}
