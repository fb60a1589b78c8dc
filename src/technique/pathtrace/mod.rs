//! Path tracing: matter as a medium that absorbs and scatters, with surfaces in it (Kajiya & Von Herzen 1984; Kajiya 1986).
//!
//! ```text
//! L(x, w) = integral over the ray of T sigma (albedo (light + integral over the sphere of p(c) L(x', w'))) + T sky
//! ```
//!
//! Opacity of the transfer function is extinction, its colour the albedo. Each pixel is the mean of independent paths, which
//! is the answer of this equation but for noise: its standard deviation falls as 1 / sqrt(paths).

mod denoise;
mod elementary;
mod guides;
mod lamp;
mod layers;
mod levels;
mod majorants;
mod noise;
mod phase;
mod random;
#[doc(hidden)]
pub mod reference;
mod rules;
mod sky;
mod sobol;
mod surface;
mod walk;

pub(crate) use denoise::denoised;
pub(crate) use elementary::turn_of;
pub(crate) use guides::{GUIDE_IMAGES, Guide, guide_of};
pub use lamp::{Lamp, LampShape};
pub(crate) use layers::{PATH_IMAGES, PathMeans, images_of, numbers_of};
pub(crate) use noise::{PathBlocks, luminance};
pub(crate) use phase::phase_value;
pub use sky::{SkyError, SkyPicture};
pub(crate) use sobol::{half_of_path, left_of_half};

use super::gather::{Gather, GatherDesc, RayPass, rays_of};
use super::registry::TechniqueDesc;
use super::{Error, Light, SampleInputs, View};
use crate::color::decode_srgb;
use crate::gpu;
use crate::resident::TextureLayout;
use crate::shaders::{CELL_VOXELS, Frame, FrameFields, MAX_LIGHTS, TURNS_OF_WAY};
pub use crate::transfer::Phase;
use crate::transfer::{Absorption, GradientTransfer, TransferFunction};
use glam::DVec3;
use majorants::{AmountPoints, Majorants};

/// What paths are. Other techniques do not look at it.
#[derive(Clone, Debug, PartialEq)]
pub struct PathTracing {
    /// Paths a pixel, at most; at least 1.
    pub samples: u32,
    /// The number of the first of them: pictures of paths `0..a` and `a..b` add up to that of `0..b`.
    pub first_sample: u32,
    /// Of a host's frame ([`crate::embed::Renderer::record`]): so many more of them, 1 to 8. Other pictures do not look at it.
    pub samples_per_frame: u32,
    /// Other numbers, other noise.
    pub seed: u32,
    /// How often light is scattered at most; 0: it is not, and matter shines in its colours as in a composite. `None`: as
    /// often as it is.
    pub bounces: Option<u32>,
    /// What extinctions are multiplied by; positive.
    pub density: f64,
    /// What albedos are multiplied by, 0 to 1.
    pub albedo: f64,
    /// Where the medium scatters light to.
    pub phase: Phase,
    /// At most [`MAX_LIGHTS`] with those that have a place. A light of colour 1 makes a white surface across its way white: its irradiance is pi.
    pub lights: Vec<Light>,
    /// Lights that have a place.
    pub lamps: Vec<Lamp>,
    /// How wide `lights` look, in degrees, 0 to 90.
    pub light_size_degrees: f64,
    /// Radiance from all around, linear red, green and blue; or what that of a picture is multiplied by.
    pub sky: [f64; 3],
    /// What comes from where. Directions to its light are drawn at each collision.
    pub sky_picture: Option<SkyPicture>,
    /// By how much the picture is turned about z, degrees, positive from x to y.
    pub sky_turn_degrees: f64,
    /// Whether the eye sees the sky behind the volume; else the picture is transparent where there is no matter.
    pub shows_sky: bool,
    /// The picture ends where its noise ([`Traced::noise`](crate::offscreen::Traced)) is no more than this, looked at where the
    /// number of paths has doubled. The CPU reference traces all.
    pub noise: Option<f64>,
    /// The picture ends after so many seconds, with the paths that have been traced. The CPU reference traces all.
    pub seconds: Option<f64>,
    /// Take the noise out of the picture by what two halves of the paths say of it; 4 paths at least.
    pub denoise: bool,
    /// How much of matter is surface: a collision is one with a surface by the chance 1 - exp(-`surface` |gradient|), the
    /// gradient in ranges of values a smallest spacing. 0: there are none.
    pub surface: f64,
    /// Reflectance of surfaces at right angles, 0 to 1. 0: they reflect as Lambert says; over 0: they have a coat that
    /// shines.
    pub f0: f64,
    /// How rough the coat is, 0.05 to 1: the root of the width of its reflections.
    pub roughness: f64,
    /// Of a perspective camera; `None`: all is sharp.
    pub lens: Option<Lens>,
}

/// A thin lens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lens {
    /// Half of its width, world length. A point `z` ahead is a circle on the plane of focus, 2 `radius` |z - D| / z wide.
    pub radius: f64,
    /// How far ahead of the eye is sharp, world length; `None`: where the camera's target is.
    pub focus: Option<f64>,
}

impl Default for PathTracing {
    fn default() -> Self {
        Self {
            samples: 64,
            first_sample: 0,
            samples_per_frame: 1,
            seed: 0,
            bounces: None,
            density: 1.0,
            albedo: 1.0,
            phase: Phase::default(),
            lights: Vec::new(),
            lamps: Vec::new(),
            light_size_degrees: 0.0,
            sky: [0.0; 3],
            sky_picture: None,
            sky_turn_degrees: 0.0,
            shows_sky: false,
            noise: None,
            seconds: None,
            denoise: false,
            surface: 0.0,
            f0: 0.0,
            roughness: 0.4,
            lens: None,
        }
    }
}

/// Path tracing, to those who ask.
pub(super) static DESC: TechniqueDesc = TechniqueDesc {
    casts_rays: true,
    draws_stacks: false,
    splats: false,
    traces_paths: true,
    streams: false,
    // `Settings::check_paths` refuses by name.
    supports: |_| Ok(()),
    has_half_angle: false,
    base_plane: None,
    layouts: &[TextureLayout::Texture3d],
    layout_of: |_| TextureLayout::Texture3d,
    longest_sample_count: |view| view.longest_sample_count(),
    set_slices: |_, _, _| 0,
    gather,
    slice_shaders: None,
};

fn gather(desc: &GatherDesc) -> Result<Box<dyn Gather>, gpu::Error> {
    let variant = desc.variant;
    let transfer = match variant.transfer {
        kept @ ("points" | "stored") => kept,
        _ => "table",
    };
    let levels = match variant.has_levels {
        true => ".levels",
        false => "",
    };
    let found = match variant.mix {
        SampleInputs::Channels => ".by_channels",
        mix if mix.uses_gradient() => ".by_gradient",
        _ => "",
    };
    let name = format!(
        "pathtrace.{}.{}.{transfer}{found}{levels}",
        variant.filter, variant.holes
    );
    let pass = RayPass::paths(desc.gpu, variant.shader(&name))?;
    Ok(rays_of(desc.gpu, pass))
}

/// How many paths a pixel has in one pass at most.
pub(crate) const PATHS_OF_PASS: u32 = 8;
/// The same where a driver ends loops after so many turns, and for functions of gradients, whose taps are turns of loops.
const PATHS_OF_LOOP: u32 = 4;
const PATHS_OF_TAPS: u32 = 2;

/// As many as one pass has at most, of matter of such a function.
pub(crate) fn paths_at_once(function: Option<&TransferFunction>, max_loop_turns: u32) -> u32 {
    match max_loop_turns {
        u32::MAX => PATHS_OF_PASS,
        _ => paths_of_loop(function),
    }
}

fn paths_of_loop(function: Option<&TransferFunction>) -> u32 {
    match function.is_some_and(|f| f.gradient_transfer.is_some()) {
        true => PATHS_OF_TAPS,
        false => PATHS_OF_LOOP,
    }
}

/// Turns of loops after which the paths of one pass end by chance, of the 2^16 that drivers that count them allow
/// ([`crate::gpu::Caps::max_loop_turns`]), for rounds of at most so many turns. Such drivers go once through each loop that stands there,
/// whether it is asked for or not, and once more through each than its turns.
///
/// The rest is for paths that are to end: where n rounds are left and a collision takes two of them, four paths want more with the chance
/// that of n / 2 throws fewer than 4 end one. By 1/2, of 64 rounds: 1.3e-6. By 1/8, where [`MANY_ROUNDS`](crate::shaders::MANY_ROUNDS)
/// come before, so that a round has at most 54 turns and 303 are left: 3e-6.
const MOST_TURNS: [(u32, u32); 3] = [(64, 3 << 14), (128, 7 << 13), (u32::MAX, 1 << 15)];
/// Of one turn of a way: itself, and a medium's two searches.
const TURNS_OF_EVENT: u32 = 1 + 2;
/// Of a round: itself, the end of its turns, a ray's place in its pixel, a function that returns early, and a cube root.
const TURNS_OF_ROUND: u32 = 4 + 5;
/// Of an event: a mask's layers and rows.
const TURNS_OF_MASK: u32 = 10;
/// Of one collision: the taps of a gradient.
const TURNS_OF_TAPS: u32 = 7;
/// Of an event where second derivatives are asked.
const TURNS_OF_SECOND: u32 = 28;
/// Of an event, and of a collision, with several volumes: whether there is data, values, materials; shares and the taps of a label.
const TURNS_OF_CHANNELS: u32 = 3 * 5;
const TURNS_OF_CHANNEL_MET: u32 = 5 * 5 + 15;

/// What paths want to know of the volume that they go through.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Medium<'a> {
    /// Its function.
    pub function: &'a TransferFunction,
    /// How it takes light away.
    pub absorption: Absorption,
    /// Whether voxels lack data.
    pub has_holes: bool,
    /// Whether its control points are searched.
    pub is_searched: bool,
    /// The range of the volume's values.
    pub value_range: [f64; 2],
    /// The shortest side of a voxel, world.
    pub smallest_spacing: f64,
    /// The most extinction of other volumes in the same place; `None`: there are none.
    pub beside: Option<f64>,
}

/// The most extinction that a function gives any value at any gradient.
pub(crate) fn most_extinction(function: &TransferFunction, absorption: Absorption) -> f64 {
    let [extinction, _] = AmountPoints::of(function, absorption);
    extinction.most_between([f64::NEG_INFINITY, f64::INFINITY])
}

/// Light that matter sends out is found at tentative collisions: no farther apart than this on average, in voxels.
const EMISSION_SPACINGS: f64 = 8.0;

/// Tentative collisions on a side of a macro cell, in the mean, where it holds the densest matter: 375 in a voxel, through which
/// no light comes. What has more of them takes very long where dense matter ends within a cell.
const MOST_IN_CELL: f64 = 3000.0;

/// How many turns of a path a way through such a cell takes at most where drivers end loops ([`MOST_TURNS`]): the way of the eye and the
/// one of its light come through it.
const MOST_OF_TURNS: f64 = 0.5;
/// What that is called where it is too many.
pub(crate) const SHARE_OF_TURNS: &str =
    "the share of a path's turns that dense matter takes in one macro cell";

/// f32 rounds a table's entries and the products with them.
const MAJORANT_SLACK: f64 = 1.0 + 1e-5;

/// What the parameters of paths are told of the volume: the same for all views of it.
#[derive(Clone, Debug)]
pub(crate) struct MediumFields {
    majorants: Majorants,
    /// Turns of loops that an event takes, and a collision.
    turns: [u32; 2],
    paths_of_loop: u32,
    surface: f32,
    /// Tentative collisions in a macro cell.
    in_cell: f64,
}

impl PathTracing {
    /// What parameters do not know without the volume.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] where matter is so dense that ways take too long ([`MOST_IN_CELL`]).
    pub(crate) fn fields_of(&self, medium: &Medium) -> Result<MediumFields, Error> {
        let Medium {
            function,
            absorption,
            has_holes,
            is_searched,
            value_range: [low, high],
            smallest_spacing,
            beside,
        } = *medium;
        let [extinction, emission] = AmountPoints::of(function, absorption);
        let of_others = beside.unwrap_or(0.0);
        let span = extinction.span(emission.span(None)).unwrap_or_default();
        let majorants = Majorants::new(span, |ends| {
            let most = extinction.most_between(ends) + of_others;
            let most = MAJORANT_SLACK * self.density * most;
            match emission.most_between(ends) > 0.0 {
                true => most.max(1.0 / (EMISSION_SPACINGS * smallest_spacing)),
                false => most,
            }
        });
        let cell = f64::from(CELL_VOXELS) * smallest_spacing;
        let in_cell = f64::from(majorants.of_all()) * cell;
        let name = "tentative collisions in a macro cell";
        Error::unless(in_cell <= MOST_IN_CELL, name, "at most 3000", in_cell)?;
        // A search halves the points of colour and of opacity.
        let medium = function.medium.iter();
        let medium = medium.map(|m| m.extinction.len() + m.albedo.len() + m.emission.len());
        let points = function.color.len() + function.opacity.len() + medium.sum::<usize>();
        let points = (points + 1).ilog2() + 2;
        let is_colored = function
            .medium
            .as_ref()
            .is_some_and(|m| m.has_colored_extinction());
        let sum = |parts: &[(bool, u32)]| -> u32 {
            let there = parts.iter().filter(|(is_there, _)| *is_there);
            there.map(|(_, turns)| turns).sum()
        };
        let gradients = function.gradient_transfer.as_ref();
        let widgets = gradients.map_or(0, |g| 2 + (g.share.len() + g.widgets.len()) as u32);
        let uses_gradient = gradients.is_some();
        let uses_second = gradients.is_some_and(GradientTransfer::needs_second);
        let are_several = beside.is_some();
        let event = sum(&[
            (uses_gradient, TURNS_OF_TAPS + widgets),
            (uses_second, TURNS_OF_SECOND),
            (uses_gradient && has_holes, 6 * TURNS_OF_MASK),
            (uses_second && has_holes, 19 * TURNS_OF_MASK),
            (are_several, TURNS_OF_CHANNELS),
            (are_several && has_holes, 8 * TURNS_OF_MASK),
            (are_several && is_searched, 8 * points),
            (has_holes, TURNS_OF_MASK),
            (is_searched, 2 * points),
            (is_colored, points),
            (function.emits(), points),
        ]);
        let collision = sum(&[
            (self.surface > 0.0, TURNS_OF_TAPS),
            (self.surface > 0.0 && are_several, TURNS_OF_CHANNEL_MET),
            (has_holes && self.surface > 0.0, 6 * TURNS_OF_MASK),
        ]);
        let range = high - low;
        Ok(MediumFields {
            majorants,
            turns: [event, collision],
            paths_of_loop: paths_of_loop(Some(function)),
            in_cell,
            surface: match range > 0.0 {
                true => (self.surface * smallest_spacing / range) as f32,
                false => 0.0,
            },
        })
    }
}

impl MediumFields {
    /// Tells the parameters, for a device that ends loops after so many turns.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] where matter is so dense that it would end paths before they are done.
    pub(crate) fn tell(&self, frame: &mut Frame, max_loop_turns: u32) -> Result<(), Error> {
        let majorants = &self.majorants;
        frame.path_bin_first = majorants.first;
        frame.path_bin_scale = majorants.scale;
        frame.path_majorants = majorants.rows;
        frame.path_majorant = majorants.of_all();
        // Clip planes are gone over where a way begins: from the eye, to a light, from a collision.
        let [event, collision] = self.turns;
        let ways = 3 * (frame.clip_plane_count + 1);
        let round = TURNS_OF_WAY * (TURNS_OF_EVENT + event) + TURNS_OF_ROUND + ways + collision;
        let most = MOST_TURNS.iter().find(|(longest, _)| round <= *longest);
        let most = most.map_or(0, |(_, turns)| *turns);
        frame.path_rounds = most / self.paths_of_loop / round;
        frame.path_surface = self.surface;
        let share = self.in_cell / f64::from(frame.path_rounds * TURNS_OF_WAY);
        let is_done = max_loop_turns == u32::MAX || share <= MOST_OF_TURNS;
        let wanted = "at most 0.5 on a driver that ends long loops";
        Error::unless(is_done, SHARE_OF_TURNS, wanted, share)
    }
}

impl View<'_> {
    /// The parameters of paths and their lights.
    pub(super) fn set_paths(&self, fields: &mut FrameFields) -> Result<(), Error> {
        let path = &self.settings.path;
        fields.path_first = path.first_sample;
        fields.path_count = path.samples;
        fields.path_seed = path.seed;
        fields.path_bounces = path.bounces.unwrap_or(u32::MAX);
        fields.path_sky = path.sky.map(|c| c as f32);
        fields.path_sky_turn = (path.sky_turn_degrees / 360.0) as f32;
        fields.path_sky_size = path.sky_picture.as_ref().map_or([0; 2], SkyPicture::size);
        fields.path_sky_shown = path.shows_sky.into();
        fields.draws_all_tiles = (path.shows_sky || path.lens.is_some()).into();
        fields.path_phase = path.phase.numbers();
        fields.path_density = path.density as f32;
        fields.path_albedo = path.albedo as f32;
        fields.path_f0 = path.f0 as f32;
        fields.path_alpha = (path.roughness * path.roughness) as f32;
        self.settings.check_lens(self.camera)?;
        let camera = self.camera.frame();
        if let Some(lens) = path.lens {
            let ahead = (self.camera.target - self.camera.eye).length();
            fields.path_focus = lens.focus.unwrap_or(ahead) as f32;
            let side = |way: DVec3| (lens.radius * way).as_vec3().to_array();
            fields.path_lens_right = side(camera.right);
            fields.path_lens_up = side(camera.up);
        }
        let half = (0.5 * path.light_size_degrees).to_radians();
        fields.path_light_size = (1.0 - half.cos()) as f32;
        let wanted = path.lights.len() + path.lamps.len();
        let limit = MAX_LIGHTS as usize;
        if wanted > limit {
            return Err(Error::TooManyLights { wanted, limit });
        }
        fields.light_count = wanted as u32;
        for (i, light) in path.lights.iter().enumerate() {
            let way: DVec3 = light.way(&camera)?;
            let [r, g, b] = light.srgb.map(|c| decode_srgb(c) as f32);
            fields.light_directions[i] = way.extend(0.0).as_vec4().to_array();
            fields.light_colors[i] = [r, g, b, 1.0];
        }
        for (i, lamp) in (path.lights.len()..).zip(&path.lamps) {
            self.set_lamp(i, lamp, fields)?;
        }
        Ok(())
    }
}
