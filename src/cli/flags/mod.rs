//! The flags of a picture: one struct a topic, the same for the command line and for a scene file.
//!
//! A flag that was not given is `None` here, so that flags can be laid over a scene; what is missing is
//! filled in where a struct is turned into what the library takes.

mod annotate;
mod camera;
mod channels;
mod classification;
mod color;
mod component;
mod cuts;
mod darkness;
mod denoise;
mod devices;
mod empty_space;
mod environment;
mod field;
mod focus;
mod gradient_filter;
mod gradients;
mod idle;
mod inlined;
mod input;
mod intermediate;
mod labels;
mod lamps;
mod level_or_height;
mod levels;
mod light;
mod look;
mod modes;
mod numbers;
mod occlusion;
mod opacity;
mod paths;
mod picture;
mod point_grid;
mod points;
mod sampling;
mod sampling_numbers;
mod scattering;
mod section;
mod section_words;
mod shadows;
mod subject;
mod time;
mod values;
mod window;
mod with;
mod words;

pub use crate::look::{context, summary};
pub use annotate::{AnnotateFlags, ScaleWord};
pub use camera::{CameraFlags, FrameWord, ProjectionWord, ViewWord};
pub use channels::{ChannelFlags, ChannelWord, Plan};
pub use classification::{Classification, ClassificationFlags};
pub use color::ColorWord;
pub use component::Component;
pub use denoise::DenoiseWord;
pub use environment::EnvironmentWord;
pub use focus::FocusWord;
pub use gradient_filter::GradientFlags;
pub use gradients::{boundaries_of, refuse_gradients_in};
pub use inlined::{Inlined, function_in, inlined};
pub use input::{InputFlags, PHANTOM, relative};
pub use labels::LabelFlags;
pub use level_or_height::LevelOrHeight;
pub use levels::LevelFlags;
pub use light::{LightFlags, LightWord, ShadingWord};
pub use look::Look;
pub use modes::ModeFlags;
pub use numbers::{Background, Numbers, Size, finite, positive};
pub use opacity::OpacityFlags;
pub use paths::PathFlags;
pub use picture::{PictureFlags, ToneWord};
pub use point_grid::{PointGrid, PointGridFlags};
pub use points::PointLookFlags;
pub use sampling::{Depth, SamplingFlags};
pub use scattering::ScatteringWord;
pub use section::SectionFlags;
pub use subject::Subject;
pub use values::{preset, with_causes};
pub use window::WindowWord;
pub use with::{WithFlags, WithWord};

use super::Error;
use super::flow::{BarbFlags, FlowFlags, FlowStyleFlags};
use super::ground::GroundFlags;
use super::map::MapFlags;
use crate::cli::renderer::REFERENCE;
use crate::picture::{ColorSpace, Tone};
use crate::technique::Settings;
use crate::technique::pathtrace::{PathTracing, Phase};
use clap::Args;
use serde::{Deserialize, Serialize};

/// Everything that decides what a picture shows.
#[derive(Args, Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[allow(missing_docs, reason = "the names say it")]
pub struct SceneFlags {
    /// The version of a scene file.
    #[arg(skip)]
    pub stratavox_scene: u32,
    /// Which defaults hold: auto fits, lights and classifies by what the volume is; plain computes what the flags say
    /// and nothing else [default: auto]
    #[arg(long)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub look: Option<Look>,
    #[command(flatten)]
    pub input: InputFlags,
    #[command(flatten)]
    pub sampling: SamplingFlags,
    #[command(flatten)]
    pub modes: ModeFlags,
    #[command(flatten)]
    pub classification: ClassificationFlags,
    #[command(flatten)]
    pub opacity: OpacityFlags,
    #[command(flatten)]
    pub channels: ChannelFlags,
    #[command(flatten)]
    pub with: WithFlags,
    #[command(flatten)]
    pub labels: LabelFlags,
    #[command(flatten)]
    pub flow: FlowFlags,
    #[command(flatten)]
    pub flow_style: FlowStyleFlags,
    #[command(flatten)]
    pub barbs: BarbFlags,
    #[command(flatten)]
    pub map: MapFlags,
    #[command(flatten)]
    pub ground: GroundFlags,
    #[command(flatten)]
    pub point_look: PointLookFlags,
    #[command(flatten)]
    pub point_grid: PointGridFlags,
    #[command(flatten)]
    pub light: LightFlags,
    #[command(flatten)]
    pub path: PathFlags,
    #[command(flatten)]
    pub gradient: GradientFlags,
    #[command(flatten)]
    pub camera: CameraFlags,
    #[command(flatten)]
    pub section: SectionFlags,
    #[command(flatten)]
    pub picture: PictureFlags,
    #[command(flatten)]
    pub annotate: AnnotateFlags,
    /// Take noise out of the numbers first: gaussian[:SIGMA], median, bilateral[:SIGMA[:VALUE]], nlm[:VALUE]; SIGMA in
    /// voxels [default: 1], VALUE what is no noise any more [default: twice the noise found], and of nlm, the slowest
    /// and best of them, the deviation of the noise [default: that found]
    #[arg(long, value_name = "FILTER")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub denoise: Option<DenoiseWord>,
    /// A Vulkan device by name, index or UUID, `cpu` for a software one, or `reference` for no Vulkan at all; where
    /// many pictures are drawn it may be said again, and they are shared out
    #[arg(long, value_name = "DEVICE")]
    #[serde(with = "devices", skip_serializing_if = "Vec::is_empty")]
    pub device: Vec<String>,
}

impl SceneFlags {
    /// Reads the files of functions that the words name.
    pub fn inline_files(&mut self) -> Result<(), Error> {
        self.classification.inline_file()?;
        self.with.inline_files()
    }

    /// True where geometry is drawn with the volume: what words ask for, or points as spheres.
    pub fn has_lines(&self) -> bool {
        self.geometry_word().is_some() || self.points_are_spheres()
    }

    /// The first flag that asks for geometry.
    pub fn geometry_word(&self) -> Option<&'static str> {
        let words = [
            ("--flow", self.flow.flow.is_some()),
            ("--map", self.map.map.is_some()),
            ("--coast", self.map.coast.is_some()),
            ("--coast-by", self.map.coast_by.is_some()),
            ("--barbs", self.barbs.barbs.is_some()),
            ("--ground", self.ground.ground.is_some()),
            ("--with", self.with.shapes().next().is_some()),
        ];
        let mut given = words.into_iter().filter(|(_, is_given)| *is_given);
        given.next().map(|(word, _)| word)
    }

    /// True where pixels are means of random paths.
    pub fn traces_paths(&self) -> bool {
        let technique = self.sampling.technique;
        technique.is_some_and(|technique| technique.traces_paths())
    }

    /// How many bundles of paths of light are followed for a picture.
    pub fn bundle_count(&self) -> u32 {
        match self.path.scatters_once() {
            true => self.path.bundle_count(&self.light),
            false => self.light.bundle_count(),
        }
    }

    /// True where nothing of the volume is seen.
    pub fn hides_volume(&self) -> bool {
        self.flow_style.hide_volume || self.points_are_spheres()
    }

    /// What to compute, for a picture kept so exactly.
    pub fn settings(&self, depth: Depth) -> Result<Settings, Error> {
        self.settings_of(&self.sampling, depth)
    }

    /// The same with other words of sampling.
    pub fn settings_of(&self, sampling: &SamplingFlags, depth: Depth) -> Result<Settings, Error> {
        self.settings_in(sampling, depth).map_err(|error| {
            self.section.named_in(error, sampling, |sampling| {
                self.settings_in(sampling, depth).is_ok()
            })
        })
    }

    fn settings_in(&self, sampling: &SamplingFlags, depth: Depth) -> Result<Settings, Error> {
        let settings = self.section.settings(sampling, depth)?;
        if self.picture.shows_sky() && !settings.technique.traces_paths() {
            return Err(Error::usage(
                "--background environment is for --technique pathtrace",
                "--background COLOR lies behind pictures of all techniques",
            ));
        }
        if self.picture.shows_sky() && self.path.environment.is_none() {
            return Err(Error::usage(
                "--background environment shows the light of --environment, and there is none",
                "--environment R,G,B or a picture is a sky, --background COLOR needs none",
            ));
        }
        if self.picture.tone() != Tone::default() && settings.color_space == ColorSpace::Display {
            return Err(Error::usage(
                "--tone and --exposure are of linear light, and --color-space display has none",
                "leave out --color-space",
            ));
        }
        self.path.check_sky()?;
        let ends = self.path.noise.is_some() || self.path.seconds.is_some();
        if ends && self.device.iter().any(|device| device == REFERENCE) {
            return Err(Error::usage(
                "--noise and --seconds end pictures of devices, and --device reference traces all paths of --spp",
                "--spp N says how many",
            ));
        }
        let settings = Settings {
            shading: self.light.shading(settings.mode)?,
            ambient_occlusion: self.light.occlusion(settings.mode)?,
            gradient_filter: self.gradient.filter(),
            gradient_storage: self.gradient.keep(),
            dim: self.labels.dim()?,
            path: PathTracing {
                phase: self.phase(),
                ..self.path.path(&self.light, self.picture.shows_sky())?
            },
            ..settings
        };
        let settings = self.path.scattered(&self.light, settings)?;
        sampling::check_ways(&settings)?;
        if !self.wants_slabs() {
            return Ok(settings);
        }
        let slabs = Settings {
            preintegrated: true,
            ..settings.clone()
        };
        // What a file asks for gives way to what a person does.
        Ok(match slabs.check_ways() {
            Ok(()) => slabs,
            Err(_) => settings,
        })
    }

    /// That of a word, else of the function's file.
    fn phase(&self) -> Phase {
        let of_file = || self.classification.medium().and_then(|medium| medium.phase);
        let word = self.path.phase.map(|word| word.0);
        word.or_else(of_file).unwrap_or_default()
    }

    /// False where nothing in the picture depends on a gradient; a function that is read may make something of it.
    fn may_have_gradients(&self) -> bool {
        let mode = self.sampling.mode.unwrap_or_default();
        self.light.is_lit(mode) || !mode.is_projection() && self.classification.names_a_function()
    }

    /// True where the function asks for slabs and no word is against it.
    fn wants_slabs(&self) -> bool {
        let is_one = !self.channels.are_given()
            && self.input.component != Some(Component::All)
            && self.labels.labels.is_none()
            && !self.opacity.are_given()
            && self.with.volumes().next().is_none();
        is_one && self.classification.wants_slabs() && !self.sampling.says_how()
    }

    /// Flags that change nothing under the others, and light that is missing, a sentence each.
    pub fn idle(&self) -> Vec<String> {
        let mode = self.sampling.mode.unwrap_or_default();
        let topics = [
            self.sampling.idle(),
            self.modes.idle(mode, self.traces_paths()),
            self.gradient.idle(self.may_have_gradients()),
            self.camera.idle(self.section.section.is_some()),
            self.annotate.idle(),
        ];
        let mut notes = topics.concat();
        if self.light.is_half_angle() && self.sampling.order.is_some() {
            notes.push("--order has no effect on half-angle slices, they come from the light");
        }
        if self.camera.frame.is_some() && self.section.section.is_some() {
            notes.push("--frame has no effect with --section, which shows all of its plane");
        }
        let notes = notes.into_iter().map(str::to_owned);
        let of_light = self.idle_of_light(mode).into_iter();
        let notes = notes.chain(of_light).chain(self.idle_medium());
        notes.chain(self.darkness()).collect()
    }
}
