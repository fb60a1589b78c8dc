//! Path tracing: flags to [`PathTracing`].

use super::idle::no_effect;
use super::numbers::positive;
use super::{EnvironmentWord, Error, FocusWord, LightFlags, Numbers, ScatteringWord, finite};
use crate::technique::Light;
use crate::technique::pathtrace::{Lens, PathTracing, Phase};
use clap::Args;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use std::{fmt, str::FromStr};

const HEADING: &str = "Path tracing";

/// The flags, none of them filled in.
#[derive(Args, Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct PathFlags {
    /// Light that matter scatters once on its way to the eye, without noise, by --technique raycast: none, matter shines in
    /// its colours, or single, by --light, --environment R,G,B, --phase, --albedo, --density-scale and --shadows [default: none]
    #[arg(long, value_name = "none|single", help_heading = HEADING)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scattering: Option<ScatteringWord>,
    /// Paths a pixel: noise halves with four times as many [default: 64]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=MOST_PATHS), help_heading = HEADING)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spp: Option<u32>,
    /// End where the error of the picture is this part of its light, 0.01: 1 %; looked at after 16, 32, 64 and so on paths,
    /// up to --spp [default: none; with it or --seconds, --spp is 4096]
    #[arg(long, value_name = "PART", value_parser = positive, help_heading = HEADING)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub noise: Option<f64>,
    /// End after so many seconds of tracing, with the paths that there are: the picture then depends on the machine
    #[arg(long, value_name = "S", value_parser = positive, help_heading = HEADING)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub seconds: Option<f64>,
    /// Other numbers, other noise; frame k of a film has k more [default: 0]
    #[arg(long, value_name = "N", help_heading = HEADING)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub seed: Option<u32>,
    /// How often light is scattered at most; 0: matter shines in its colours, as in --technique raycast [default: as
    /// often as it is]
    #[arg(long, value_name = "N", help_heading = HEADING)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bounces: Option<u32>,
    /// Multiplies extinction [default: 1]
    #[arg(long, value_name = "F", value_parser = positive, help_heading = HEADING)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub density_scale: Option<f64>,
    /// Multiplies the part of light that is scattered and not absorbed, which is the colour of the transfer function
    /// [default: 1]
    #[arg(long, value_name = "F", value_parser = finite, help_heading = HEADING)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub albedo: Option<f64>,
    /// Where matter scatters light to: isotropic, rayleigh, hg:G with the mean cosine G (over 0: forward), or hg:F,G1,G2, two
    /// lobes of which the first has the part F [default: that of the --tf file, else isotropic]
    #[arg(long, value_name = "PHASE", allow_hyphen_values = true, help_heading = HEADING)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub phase: Option<PhaseWord>,
    /// Light from all around: linear red, green and blue, or a picture of all directions, .hdr or .exr, twice as wide as it
    /// is high [default: none]
    #[arg(long, value_name = "R,G,B|FILE", help_heading = HEADING)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub environment: Option<EnvironmentWord>,
    /// Multiplies light from all around [default: 1]
    #[arg(long, value_name = "F", value_parser = positive, requires = "environment", help_heading = HEADING)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub environment_strength: Option<f64>,
    /// Turns the picture of --environment about z, degrees from x to y [default: 0]
    #[arg(long, value_name = "DEG", value_parser = finite, allow_hyphen_values = true, requires = "environment", help_heading = HEADING)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub environment_turn: Option<f64>,
    /// How much of matter scatters as a surface across its gradient: an edge as steep as the range of values over a voxel
    /// does so by the chance 1 - exp(-S) [default: 0, none]
    #[arg(long, value_name = "S", value_parser = finite, help_heading = HEADING)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub surface_scattering: Option<f64>,
    /// How much of light surfaces mirror that they are seen across: 0.04 for skin, bone and plastic, 1 for metal; 0: they
    /// reflect as Lambert says [default: 0]
    #[arg(long, value_name = "F", value_parser = finite, help_heading = HEADING)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub f0: Option<f64>,
    /// How wide reflections are that --f0 asks for, from 0.05, polished, to 1 [default: 0.4]
    #[arg(long, value_name = "F", value_parser = finite, help_heading = HEADING)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub roughness: Option<f64>,
    /// Depth of field: half of the width of the lens, world length [default: none, all is sharp]
    #[arg(long, value_name = "LENGTH", value_parser = positive, help_heading = HEADING)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub aperture_radius: Option<f64>,
    /// How far ahead of the eye is sharp: a world length, target, where the camera is turned to, or auto, where the middle of
    /// the picture meets matter [default: target]
    #[arg(long, value_name = "LENGTH|target|auto", requires = "aperture_radius", help_heading = HEADING)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub focus_distance: Option<FocusWord>,
    /// Take the noise out of the picture, by what two halves of the paths say of it; 4 paths at least
    #[arg(long, help_heading = HEADING)]
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub denoise_picture: bool,
}

/// Their number is an f32 somewhere.
const MOST_PATHS: i64 = 1 << 20;
/// Where something else ends the picture.
const MOST_UNASKED: u32 = 4096;

/// A flag, and whether it is there.
type Given = (&'static str, bool);

impl PathFlags {
    /// What paths are, with the lights that others name; without [`Self::phase`], which a function may have too.
    pub fn path(&self, light: &LightFlags, shows_sky: bool) -> Result<PathTracing, Error> {
        let default = PathTracing::default();
        let mut lights: Vec<Light> = light.light.iter().map(|word| word.light()).collect();
        if !light.has_lights() && self.environment.is_none() {
            lights.push(Light::of_eye());
        }
        let (sky, sky_picture) = match &self.environment {
            None => (default.sky, None),
            Some(EnvironmentWord::Even(light)) => (*light, None),
            Some(EnvironmentWord::Picture(file)) => ([1.0; 3], Some(file.picture()?)),
        };
        let strength = self.environment_strength.unwrap_or(1.0);
        Ok(PathTracing {
            samples: self.spp.unwrap_or(match self.noise.or(self.seconds) {
                Some(_) => MOST_UNASKED,
                None => default.samples,
            }),
            noise: self.noise,
            seconds: self.seconds,
            seed: self.seed.unwrap_or(default.seed),
            bounces: self.bounces,
            density: self.density_scale.unwrap_or(default.density),
            albedo: self.albedo.unwrap_or(default.albedo),
            lights,
            lamps: light.lamps(),
            light_size_degrees: light.light_size.unwrap_or(default.light_size_degrees),
            sky: sky.map(|c| strength * c),
            sky_picture,
            sky_turn_degrees: self.environment_turn.unwrap_or(default.sky_turn_degrees),
            shows_sky,
            denoise: self.denoise_picture,
            surface: self.surface_scattering.unwrap_or(default.surface),
            f0: self.f0.unwrap_or(default.f0),
            roughness: self.roughness.unwrap_or(default.roughness),
            lens: self.aperture_radius.map(|radius| Lens {
                radius,
                focus: self.focus_distance.and_then(FocusWord::length),
            }),
            ..default
        })
    }

    /// Whether where it is sharp is yet to be found: until then that is where the camera is turned to.
    pub fn finds_focus(&self) -> bool {
        self.focus_distance == Some(FocusWord::Auto)
    }

    /// Refuses what looks from several places, `this`, with a focus that is found for one.
    pub fn check_no_focus(&self, this: &str) -> Result<(), Error> {
        match self.finds_focus() {
            true => Err(Error::usage(
                format!("--focus-distance auto is found for one picture, and {this} has several"),
                "--focus-distance LENGTH or target",
            )),
            false => Ok(()),
        }
    }

    /// The picture of the sky.
    pub fn file(&self) -> Option<&Path> {
        self.environment.as_ref().and_then(EnvironmentWord::file)
    }

    /// The same words with another path.
    pub fn with_paths(&self, path: impl Fn(&Path) -> PathBuf) -> Self {
        Self {
            environment: self.environment.as_ref().map(|word| word.with_path(path)),
            ..self.clone()
        }
    }

    /// Flags that change nothing where paths are traced.
    pub(super) fn idle_of_paths(&self) -> Option<String> {
        let is_idle = self.roughness.is_some() && self.f0.is_none();
        no_effect(&[("--roughness", is_idle)], "without --f0")
    }

    /// Flags that change nothing where light is scattered once without paths.
    pub(super) fn idle_of_rays(&self) -> Option<String> {
        let (of_paths, _) = self.given();
        no_effect(&of_paths, "without --technique pathtrace")
    }

    /// Flags that change nothing where light is not scattered.
    pub(super) fn idle(&self) -> Vec<String> {
        let (_, of_medium) = self.given();
        let why = "without --technique pathtrace or --scattering single";
        let of_medium = no_effect(&of_medium, why);
        self.idle_of_rays().into_iter().chain(of_medium).collect()
    }

    /// Which flags are there: those of paths alone, and those of all light that scatters.
    fn given(&self) -> ([Given; 12], [Given; 5]) {
        let Self {
            scattering: _,
            spp,
            noise,
            seconds,
            seed,
            bounces,
            density_scale,
            albedo,
            phase,
            environment,
            environment_strength,
            environment_turn,
            surface_scattering,
            f0,
            roughness,
            aperture_radius,
            focus_distance,
            denoise_picture,
        } = self;
        let of_paths = [
            ("--spp", spp.is_some()),
            ("--noise", noise.is_some()),
            ("--seconds", seconds.is_some()),
            ("--seed", seed.is_some()),
            ("--bounces", bounces.is_some()),
            ("--environment-turn", environment_turn.is_some()),
            ("--surface-scattering", surface_scattering.is_some()),
            ("--f0", f0.is_some()),
            ("--roughness", roughness.is_some()),
            ("--aperture-radius", aperture_radius.is_some()),
            ("--focus-distance", focus_distance.is_some()),
            ("--denoise-picture", *denoise_picture),
        ];
        let of_medium = [
            ("--density-scale", density_scale.is_some()),
            ("--albedo", albedo.is_some()),
            ("--phase", phase.is_some()),
            ("--environment", environment.is_some()),
            ("--environment-strength", environment_strength.is_some()),
        ];
        (of_paths, of_medium)
    }
}

/// `isotropic`, `rayleigh`, `hg:G` or `hg:F,G1,G2`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct PhaseWord(pub Phase);

impl FromStr for PhaseWord {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wanted = || "wanted isotropic, rayleigh, hg:G or hg:F,G1,G2".to_owned();
        Ok(Self(match text {
            "isotropic" => Phase::Isotropic,
            "rayleigh" => Phase::Rayleigh,
            _ => {
                let numbers = text.strip_prefix("hg:").ok_or_else(wanted)?;
                match numbers.matches(',').count() {
                    0 => Phase::HenyeyGreenstein(Numbers::<1>::from_str(numbers)?.0[0]),
                    2 => {
                        let [part, g1, g2] = Numbers::<3>::from_str(numbers)?.0;
                        Phase::TwoLobes { part, g: [g1, g2] }
                    }
                    _ => return Err(wanted()),
                }
            }
        }))
    }
}

impl fmt::Display for PhaseWord {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            Phase::Isotropic => f.write_str("isotropic"),
            Phase::Rayleigh => f.write_str("rayleigh"),
            Phase::HenyeyGreenstein(g) => write!(f, "hg:{g}"),
            Phase::TwoLobes { part, g: [g1, g2] } => write!(f, "hg:{part},{g1},{g2}"),
        }
    }
}

impl TryFrom<String> for PhaseWord {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<PhaseWord> for String {
    fn from(word: PhaseWord) -> Self {
        word.to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_phase_comes_back_from_its_word() {
        for text in [
            "isotropic",
            "rayleigh",
            "hg:0.85",
            "hg:-0.3",
            "hg:0.7,0.8,-0.4",
        ] {
            let word: PhaseWord = text.parse().expect("a phase");
            assert_eq!(word.to_string(), text);
        }
        for text in ["mie", "hg", "hg:", "hg:1,2", "hg:a", "0.5"] {
            assert!(text.parse::<PhaseWord>().is_err(), "{text}");
        }
    }
}
