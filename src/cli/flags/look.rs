//! `--look`: which defaults hold where no flag says otherwise.

use super::paths::PhaseWord;
use super::{EnvironmentWord, LightWord, SceneFlags, ToneWord};
use crate::cli::progress::Progress;
use crate::look::{context, is_cloud};
use crate::technique::pathtrace::Phase;
use crate::technique::{Mode, Technique};
use crate::transfer::Context;
use crate::volume::Header;
use clap::ValueEnum;
use serde::{Deserialize, Serialize};

/// Every word of `--look`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Look {
    /// Fitted to what is visible, lit where light helps, classified by meaning, on an opaque background
    Auto,
    /// The whole box at zoom 1, without light, one sample a voxel, transparent
    Plain,
    /// As auto, by path tracing: surfaces under a wide light and an even sky, with soft shadows
    Cinematic,
}

impl SceneFlags {
    /// True under `--look auto`. Nothing said is `plain`: a verb whose default is `auto` says so first, by
    /// [`Self::default_to_auto`].
    pub fn is_auto(&self) -> bool {
        matches!(self.look, Some(Look::Auto | Look::Cinematic))
    }

    /// Takes the first of several variables, and says so, where the look may choose and no flag does.
    pub fn take_first_variable(&mut self, header: &Header, progress: &Progress) {
        if self.is_auto()
            && let Some(note) = self.input.take_first_variable(header)
        {
            progress.note(&note);
        }
    }

    /// True where thin components of CT are drawn: always but in plain composites of [`Look::Auto`].
    pub fn keeps_all(&self, mode: Mode) -> bool {
        let is_composite = mode == Mode::Composite && self.section.section.is_none();
        let keeps = self.input.keep_all.unwrap_or(!self.is_auto());
        keeps || !is_composite || !self.picture.aov.is_empty()
    }

    /// `auto` unless a flag or a scene file says otherwise; pictures for conformance are `plain`.
    ///
    /// Scattered points are splatted, or what a word says, whatever the look is.
    pub fn default_to_auto(&mut self) {
        self.choose_for_points();
        self.set_cinematic();
        self.look.get_or_insert(match self.sampling.conformance {
            true => Look::Plain,
            false => Look::Auto,
        });
        // Opaque edges at one ray a pixel look broken.
        if self.has_lines() && self.is_auto() && !self.traces_paths() {
            self.sampling.aa.get_or_insert(4);
        }
    }

    /// The flags that `--look cinematic` stands for; those that are given stay.
    fn set_cinematic(&mut self) {
        if self.look != Some(Look::Cinematic) {
            return;
        }
        self.sampling.technique.get_or_insert(Technique::Pathtrace);
        if !self.traces_paths() {
            return;
        }
        let path = &mut self.path;
        path.environment
            .get_or_insert(EnvironmentWord::Even([SKY; 3]));
        path.density_scale.get_or_insert(DENSITY);
        path.f0.get_or_insert(F0);
        path.roughness.get_or_insert(ROUGHNESS);
        self.picture.tone.get_or_insert(ToneWord::Neutral);
        path.denoise_picture |= path.spp.is_none_or(|paths| paths >= LEAST_DENOISED);
        if !self.light.has_lights() {
            self.light
                .light
                .push(LightWord::of_camera(KEY_LIGHT.into()));
        }
    }
}

impl SceneFlags {
    /// What the file says of its values, where the look may choose by it.
    pub fn context(&self, header: &Header) -> Option<Context> {
        self.is_auto().then(|| Context {
            is_cloud: self.is_cinematic() && is_cloud(header),
            ..context(header)
        })
    }

    /// What `--look cinematic` takes this matter for: clouds scatter almost all light forward and have no surfaces.
    pub fn set_matter(&mut self, header: &Header) {
        if !self.is_cinematic() {
            return;
        }
        let names_a_function = self.classification.names_a_function();
        let path = &mut self.path;
        let size = &mut self.light.light_size;
        match is_cloud(header) && !names_a_function {
            true => {
                self.picture.exposure.get_or_insert(CLOUD_EXPOSURE);
                size.get_or_insert(SUN_DEGREES);
                path.albedo.get_or_insert(CLOUD_ALBEDO);
                let phase = Phase::HenyeyGreenstein(CLOUD_COSINE);
                path.phase.get_or_insert(PhaseWord(phase));
                path.surface_scattering.get_or_insert(0.0);
            }
            false => {
                size.get_or_insert(KEY_LIGHT_DEGREES);
                path.surface_scattering.get_or_insert(SURFACE);
                self.picture.exposure.get_or_insert(EXPOSURE);
            }
        }
    }

    fn is_cinematic(&self) -> bool {
        self.look == Some(Look::Cinematic) && self.traces_paths()
    }
}

/// Next to no light is lost in a cloud.
const CLOUD_EXPOSURE: f64 = 0.5;
/// Wider than the sun, so that few paths are enough.
const SUN_DEGREES: f64 = 5.0;
/// Droplets absorb next to nothing of visible light.
const CLOUD_ALBEDO: f64 = 0.999;
/// The mean cosine of what droplets far larger than the wavelength scatter.
const CLOUD_COSINE: f64 = 0.85;
/// Of `--look cinematic`: from 45 degrees left of the eye and 40 degrees above it.
const KEY_LIGHT: [f64; 3] = [-0.54, 0.64, 0.54];
const KEY_LIGHT_DEGREES: f64 = 40.0;
const SKY: f64 = 0.35;
const SURFACE: f64 = 8.0;
const DENSITY: f64 = 0.5;
/// Of skin, bone and plastic.
const F0: f64 = 0.04;
const ROUGHNESS: f64 = 0.45;
/// What is lit from one side and takes a part of the light at each bounce is a fifteenth to a sixth as bright as white without it, as
/// five volumes show (`docs/gallery.md`); with it an eighth to a third.
const EXPOSURE: f64 = 1.0;
/// Paths a pixel that tell what is noise.
const LEAST_DENOISED: u32 = 4;
