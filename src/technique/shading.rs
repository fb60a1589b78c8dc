//! Two-sided light of Blinn and Phong on the surface that stands across the gradient: the words, the parameters,
//! and the CPU reference of `shaders/lib/shade.wgsl` (`sampling.md` 7).
//!
//! ```text
//! c (o ambient + diffuse sum of t L |n.l|) + specular sum of t L |n.h|^shininess        h = (l + v) / |l + v|
//! w surface + (1 - w) flat                                                              w = g / (g + g0)
//! ```
//!
//! L is a light's colour, l the way to it, v the way to the eye, n the gradient made a unit vector after
//! interpolation; o and t what comes through from all around and from the light, 1 without occlusion and shadows
//! ([`Lamps`]). Where the gradient over one voxel is under 1e-4 of the volume's range there is no surface and the
//! colour stays, as far as light comes there: c (o a + (1 - a) sum of t L / sum of L), a = min(ambient, 1). With a
//! half gradient g0 the two are mixed by the gradient's magnitude g, so that noise does not sparkle. Blinn,
//! "Models of Light Reflection for Computer Synthesized Pictures", SIGGRAPH 1977.

use super::{Error, LightField, Shadows, View};
use crate::camera;
use crate::color::decode_srgb;
use crate::picture::ColorSpace;
use crate::real::{Real, add, dot, scale, sub};
use crate::shaders::{Frame, FrameFields, MAX_LIGHTS};
use glam::DVec3;

/// How samples are lit.
#[derive(Clone, Debug, PartialEq)]
pub struct Shading {
    /// Part of the colour that needs no light.
    pub ambient: f64,
    /// Part of the colour that a surface across the light has.
    pub diffuse: f64,
    /// White that a surface mirrors.
    pub specular: f64,
    /// How sharply it mirrors; positive.
    pub shininess: f64,
    /// The gradient magnitude, in values per world length, at which half of the light is that on a surface; from 0. At
    /// smaller gradients matter is lit evenly, so that noise does not sparkle; 0 lights all gradients as surfaces.
    pub half_gradient: f64,
    /// At most [`MAX_LIGHTS`]; none stands for a white headlight, which shines along the ray of each pixel.
    pub lights: Vec<Light>,
    /// What keeps them from samples.
    pub shadows: Shadows,
    /// Whether light falls on the surfaces that stand across gradients. Else it falls on all matter alike, which then
    /// is as bright as its colour says but for [`Shadows::HalfAngle`]: ambient and lights alone count.
    pub has_surfaces: bool,
}

/// A light that is infinitely far away.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// The way to it, of any length but zero.
    pub towards: DVec3,
    /// What `towards` is given in.
    pub space: LightSpace,
    /// sRGB numbers from 0 to 1.
    pub srgb: [f64; 3],
}

/// The axes that the way to a light is given in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LightSpace {
    /// Those of the world: the light stays beside the volume.
    #[default]
    World,
    /// Right, up and towards the eye: the light moves with the camera.
    Camera,
}

impl Light {
    /// A light beside the volume.
    pub fn of_world(towards: DVec3, srgb: [f64; 3]) -> Self {
        Self {
            towards,
            srgb,
            space: LightSpace::World,
        }
    }

    /// A white one that the eye carries.
    pub fn of_eye() -> Self {
        Self {
            towards: DVec3::Z,
            space: LightSpace::Camera,
            srgb: [1.0; 3],
        }
    }

    /// The unit vector to the light in world space, for a camera with these axes.
    pub(super) fn way(&self, camera: &camera::Frame) -> Result<DVec3, Error> {
        let towards = match self.space {
            LightSpace::World => self.towards,
            LightSpace::Camera => {
                self.towards.x * camera.right + self.towards.y * camera.up
                    - self.towards.z * camera.forward
            }
        };
        towards.try_normalize().ok_or(Error::NoWayToLight)
    }
}

impl Default for Shading {
    fn default() -> Self {
        Self {
            ambient: 0.1,
            diffuse: 0.7,
            specular: 0.2,
            shininess: 10.0,
            half_gradient: 0.0,
            lights: Vec::new(),
            shadows: Shadows::Off,
            has_surfaces: true,
        }
    }
}

impl Shading {
    /// White light on matter without surfaces.
    pub fn plain() -> Self {
        Self {
            has_surfaces: false,
            ..Self::default()
        }
    }
}

/// Under this part of the volume's range over one voxel a gradient is flat.
const FLAT_PART: f64 = 1e-4;
/// What f32 may make of the sums of wide filters over voxels that are all the same, in parts of the largest.
const ROUNDING_PART: f64 = 1.0 / (1u64 << 19) as f64;

impl View<'_> {
    /// Value per world length under which a gradient is no surface, in a volume of this range.
    pub fn flat_gradient(&self, [low, high]: [f64; 2]) -> f32 {
        let of_rounding = ROUNDING_PART * low.abs().max(high.abs());
        let flat = (FLAT_PART * (high - low)).max(of_rounding);
        (flat / self.grid.smallest_spacing()) as f32
    }
}

/// Fills the parameters of light.
pub(super) fn set_shading(
    shading: &Shading,
    camera: &camera::Frame,
    space: ColorSpace,
    fields: &mut FrameFields,
) -> Result<(), Error> {
    let (wanted, limit) = (shading.lights.len(), MAX_LIGHTS as usize);
    if wanted > limit {
        return Err(Error::TooManyLights { wanted, limit });
    }
    fields.ambient = shading.ambient as f32;
    fields.diffuse = shading.diffuse as f32;
    fields.specular = shading.specular as f32;
    fields.shininess = shading.shininess as f32;
    fields.half_gradient = shading.half_gradient as f32;
    if shading.lights.is_empty() {
        fields.light_count = 1;
        fields.light_directions[0] = [0.0, 0.0, 0.0, 1.0];
        fields.light_colors[0] = [1.0; 4];
    } else {
        fields.light_count = wanted as u32;
    }
    for (i, light) in shading.lights.iter().enumerate() {
        let towards = light.way(camera)?;
        let shown = |c: f64| match space {
            ColorSpace::Linear => decode_srgb(c),
            ColorSpace::Display => c,
        };
        let [r, g, b] = light.srgb.map(|c| shown(c) as f32);
        fields.light_directions[i] = towards.extend(0.0).as_vec4().to_array();
        fields.light_colors[i] = [r, g, b, 1.0];
    }
    // To shaders, lights are those on surfaces.
    if !shading.has_surfaces {
        fields.light_count = 0;
    }
    Ok(())
}

/// What comes through to one position in voxel space.
#[derive(Clone, Copy, Debug)]
pub struct Lamps<'a, R> {
    /// `None`: all of it.
    pub field: Option<&'a LightField<R>>,
    /// The position.
    pub voxel: [R; 3],
    /// Along which it is seen, in world space, a unit vector.
    pub ray_direction: [R; 3],
}

impl<R: Real> Lamps<'_, R> {
    /// Part of the light from all around.
    pub fn ambient(&self, frame: &Frame) -> R {
        let found = self
            .field
            .map(|field| field.ambient_at(frame, self.voxel, self.ray_direction));
        found.unwrap_or(R::from_f64(1.0))
    }

    /// Part of the light of a lamp.
    fn lamp(&self, frame: &Frame, lamp: usize) -> R {
        let found = self
            .field
            .map(|field| field.lamp_at(frame, lamp, self.voxel));
        found.unwrap_or(R::from_f64(1.0))
    }
}

/// The colour of a surface across `gradient` (value per world length), where `lamps` shine.
pub fn shade<R: Real>(frame: &Frame, color: [R; 3], gradient: [R; 3], lamps: &Lamps<R>) -> [R; 3] {
    let (zero, ray_direction) = (R::from_f64(0.0), lamps.ray_direction);
    let length = |v: [R; 3]| dot(v, v).sqrt();
    let steepness = length(gradient);
    if steepness < R::from_f32(frame.flat_gradient) || steepness == zero {
        return lit_inside(frame, color, lamps);
    }
    let normal = scale(gradient, R::from_f64(1.0) / steepness);
    let mut lit = scale(color, R::from_f32(frame.ambient) * lamps.ambient(frame));
    let lights = frame.light_directions.iter().zip(&frame.light_colors);
    let lights = lights.take(frame.light_count as usize).enumerate();
    for (i, (&[x, y, z, w], light_color)) in lights {
        let towards_light = if w == 0.0 {
            [x, y, z].map(R::from_f32)
        } else {
            ray_direction.map(|d| -d)
        };
        let halfway = sub(towards_light, ray_direction);
        // Behind the surface and against the eye no halfway stands out.
        let facing = dot(normal, halfway).abs() / length(halfway).max(R::from_f32(1e-6));
        let facing = facing.min(R::from_f64(1.0));
        let diffuse = R::from_f32(frame.diffuse) * dot(normal, towards_light).abs();
        let specular = R::from_f32(frame.specular) * facing.powf(R::from_f32(frame.shininess));
        let through = lamps.lamp(frame, i);
        let added =
            |c: usize| through * R::from_f32(light_color[c]) * (diffuse * color[c] + specular);
        lit = add(lit, [added(0), added(1), added(2)]);
    }
    // Where the half gradient is 0 this is 1 whatever a division is rounded to.
    let half = R::from_f32(frame.half_gradient);
    let surface = R::from_f64(1.0) - half / (steepness + half);
    let even = scale(lit_inside(frame, color, lamps), R::from_f64(1.0) - surface);
    add(even, scale(lit, surface))
}

/// Where there is no surface.
fn lit_inside<R: Real>(frame: &Frame, color: [R; 3], lamps: &Lamps<R>) -> [R; 3] {
    if frame.has_shadows == 0 {
        return scale(color, lamps.ambient(frame));
    }
    let (zero, one, least) = (R::from_f64(0.0), R::from_f64(1.0), R::from_f32(1e-6));
    let (mut all, mut there) = ([zero; 3], [zero; 3]);
    for (i, light) in frame.light_colors.iter().enumerate() {
        if i >= frame.light_count as usize {
            break;
        }
        let [r, g, b, _] = light.map(R::from_f32);
        all = add(all, [r, g, b]);
        there = add(there, scale([r, g, b], lamps.lamp(frame, i)));
    }
    let ambient = R::from_f32(frame.ambient).min(one);
    let part = |c: usize| {
        // A colour that no light has is missing nothing.
        let share = match all[c] > least {
            true => there[c] / all[c],
            false => one,
        };
        ambient * lamps.ambient(frame) + (one - ambient) * share
    };
    [0, 1, 2].map(|c| color[c] * part(c))
}
