//! Lights at a place: parameters, and the CPU reference of `shaders/lib/lamp.wgsl`, which has the formulas.

use super::elementary::around;
use crate::color::decode_srgb;
use crate::real::{Real, dot, scale, sub};
use crate::shaders::{Frame, FrameFields};
use crate::technique::{Error, View};
use glam::DVec3;

/// A light at a place. One of colour 1 makes a white surface white that lies where the camera is turned to and across the
/// way to it: its irradiance there is pi, whatever its distance and size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lamp {
    /// The middle of it, in world space.
    pub place: DVec3,
    /// What shines there.
    pub shape: LampShape,
    /// sRGB numbers from 0 to 1.
    pub srgb: [f64; 3],
}

/// What a [`Lamp`] is. It hides nothing, and is not seen itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LampShape {
    /// A ball that shines to all sides. Single scattering takes it for a point.
    Sphere {
        /// World length, over 0 for path tracing; `None`: 1/400 of the diagonal of the volume.
        radius: Option<f64>,
    },
    /// A disc that faces what the camera is turned to, and shines to that side alone.
    Disc {
        /// World length, over 0.
        radius: f64,
    },
}

/// Of half the diagonal: so small that shadows are sharp, so large that matter beside it has a brightness.
const DEFAULT_RADIUS: f64 = 1.0 / 200.0;

impl LampShape {
    /// The radius, where a word says it.
    pub fn radius(self) -> Option<f64> {
        match self {
            Self::Sphere { radius } => radius,
            Self::Disc { radius } => Some(radius),
        }
    }
}

impl View<'_> {
    /// The parameters of light `i`.
    pub(super) fn set_lamp(
        &self,
        i: usize,
        lamp: &Lamp,
        fields: &mut FrameFields,
    ) -> Result<(), Error> {
        let to_target = self.camera.target - lamp.place;
        let squared = to_target.length_squared();
        let name = "the distance of a light from what the camera is turned to";
        Error::unless(squared > 0.0, name, "a length over 0", squared.sqrt())?;
        let of_volume = 0.5 * DEFAULT_RADIUS * self.grid.diagonal();
        let radius = lamp.shape.radius().unwrap_or(of_volume);
        let (facing, area) = match lamp.shape {
            LampShape::Sphere { .. } => (DVec3::ZERO, squared),
            LampShape::Disc { .. } => (to_target.normalize(), squared + radius * radius),
        };
        // Of a point the intensity, of others the radiance.
        let factor = match self.settings.single_scattering {
            Some(_) => squared,
            None => area / (radius * radius),
        };
        let place = (lamp.place - self.grid.center()).extend(1.0);
        fields.light_directions[i] = place.as_vec4().to_array();
        fields.lamps[i] = facing.extend(radius).as_vec4().to_array();
        let [r, g, b] = lamp.srgb.map(|c| (factor * decode_srgb(c)) as f32);
        fields.light_colors[i] = [r, g, b, 1.0];
        Ok(())
    }
}

/// What a lamp gives at a place.
pub struct LampLight<R> {
    /// A unit vector.
    pub way: [R; 3],
    /// World length to where the light begins.
    pub reach: R,
    /// As of a light far away.
    pub color: [R; 3],
}

/// Whether light `i` has a place.
pub fn is_lamp(frame: &Frame, i: usize) -> bool {
    frame.light_directions[i][3] != 0.0
}

/// By directions that are drawn from these numbers.
pub fn light_of_lamp<R: Real>(
    frame: &Frame,
    i: usize,
    place: [R; 3],
    numbers: [R; 2],
) -> LampLight<R> {
    let n = |x: f64| R::from_f64(x);
    let vector = |[x, y, z, _]: [f32; 4]| [x, y, z].map(R::from_f32);
    let (facing, radius) = (vector(frame.lamps[i]), R::from_f32(frame.lamps[i][3]));
    let to_lamp = sub(vector(frame.light_directions[i]), place);
    let squared = dot(to_lamp, to_lamp).max(n(1e-30));
    let distance = squared.sqrt();
    let part = radius * radius / squared;
    let is_inside = part >= n(1.0);
    let cone = match is_inside {
        true => n(2.0),
        false => part / (n(1.0) + (n(1.0) - part).sqrt()),
    };
    let aside = numbers[0] * cone;
    let way = around(
        scale(to_lamp, n(1.0) / distance),
        n(1.0) - aside,
        numbers[1],
    );
    let chord = radius * radius - squared * aside * (n(2.0) - aside);
    let chord = chord.max(n(0.0)).sqrt();
    let middle = distance * (n(1.0) - aside);
    let color = scale(vector(frame.light_colors[i]), n(2.0) * cone);
    if facing == [n(0.0); 3] {
        let reach = match is_inside {
            true => middle + chord,
            false => middle - chord,
        };
        return LampLight { way, reach, color };
    }
    let slope = dot(facing, way);
    let t = dot(facing, to_lamp) / slope;
    let beside = sub(scale(way, t), to_lamp);
    let is_met = slope < n(0.0) && t > n(0.0) && dot(beside, beside) <= radius * radius;
    LampLight {
        way,
        reach: t,
        color: match is_met {
            true => color,
            false => [n(0.0); 3],
        },
    }
}
