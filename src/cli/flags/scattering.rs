//! `--scattering`: matter that scatters light once on its way to the eye.

use super::{EnvironmentWord, Error, LightFlags, PathFlags, shadows::ShadowsWord};
use crate::technique::pathtrace::PathTracing;
use crate::technique::{Settings, SingleScattering, Technique};
use serde::{Deserialize, Serialize};
use std::{fmt, str::FromStr};

/// Every word of `--scattering`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
#[allow(missing_docs, reason = "the names say it")]
pub enum ScatteringWord {
    #[default]
    None,
    Single,
}

impl FromStr for ScatteringWord {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "none" => Ok(Self::None),
            "single" => Ok(Self::Single),
            "multiple" => Err("--scattering multiple is --technique pathtrace".to_owned()),
            _ => Err("wanted none or single".to_owned()),
        }
    }
}

impl fmt::Display for ScatteringWord {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::None => "none",
            Self::Single => "single",
        })
    }
}

impl TryFrom<String> for ScatteringWord {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<ScatteringWord> for String {
    fn from(word: ScatteringWord) -> Self {
        word.to_string()
    }
}

/// What single scattering goes with.
pub(super) const SINGLE: &str = "--scattering single is for --technique raycast --mode composite of one volume of numbers, by --filter \
                                 linear and nearest, with lights (--light, --environment R,G,B) that need no --shading: leave out \
                                 the other flag, or take --technique pathtrace, which scatters more than once";

impl PathFlags {
    /// True where a picture is of light that is scattered once.
    pub fn scatters_once(&self) -> bool {
        self.scattering == Some(ScatteringWord::Single)
    }

    /// How many bundles of light are followed for a picture of light that is scattered once.
    pub(super) fn bundle_count(&self, light: &LightFlags) -> u32 {
        // Without a light and a sky there is that of the eye.
        let lights = match self.environment {
            None if !light.has_lights() => 1,
            _ => light.light.len(),
        };
        let lights = match light.shadows {
            None | Some(ShadowsWord::Volume) => lights as u32,
            Some(_) => 0,
        };
        let has_sky = self.environment.is_some() && light.shadows != Some(ShadowsWord::Off);
        lights + u32::from(has_sky)
    }

    /// Refuses a picture of the sky before it is read.
    pub(super) fn check_sky(&self) -> Result<(), Error> {
        match self.environment {
            Some(EnvironmentWord::Picture(_)) if self.scatters_once() => Err(Error::usage(
                "--scattering single: an environment picture is for --technique pathtrace",
                "--environment R,G,B is an even sky",
            )),
            _ => Ok(()),
        }
    }

    /// The settings with single scattering, where it is asked for.
    pub(super) fn scattered(
        &self,
        light: &LightFlags,
        settings: Settings,
    ) -> Result<Settings, Error> {
        if !self.scatters_once() {
            return match light.shadows {
                Some(ShadowsWord::March) => Err(Error::usage(
                    "--shadows march follows light from each sample, for --scattering single",
                    match settings.technique.traces_paths() {
                        true => "path tracing has shadows without a flag",
                        false => "--shadows volume is for --shading phong too",
                    },
                )),
                _ => Ok(settings),
            };
        }
        if settings.technique == Technique::Pathtrace {
            return Err(Error::usage(
                "--scattering single is for --technique raycast",
                "--technique pathtrace --bounces 1 scatters once too, by random paths",
            ));
        }
        let single = match light.shadows {
            Some(ShadowsWord::Off) => SingleScattering::Open,
            None | Some(ShadowsWord::Volume) => SingleScattering::Volume,
            Some(ShadowsWord::March) => SingleScattering::March,
            Some(ShadowsWord::HalfAngle) => {
                return Err(Error::usage(
                    "--scattering single: --shadows half-angle is for --technique slices-3d",
                    "--shadows off, volume or march are for rays",
                ));
            }
        };
        if !light.disc_light.is_empty() {
            return Err(Error::usage(
                "--scattering single: a disc looks larger the nearer matter is, and --disc-light is for --technique pathtrace",
                "--point-light is a light of no size",
            ));
        }
        if single == SingleScattering::Volume && !light.point_light.is_empty() {
            return Err(Error::usage(
                "--scattering single: --shadows volume follows light that is parallel, and that of --point-light is not",
                "--shadows march follows it from each sample, --shadows off lets all of it come",
            ));
        }
        let light_size_degrees = match single {
            SingleScattering::Volume => light.size()?,
            SingleScattering::Open | SingleScattering::March => settings.path.light_size_degrees,
        };
        Ok(Settings {
            single_scattering: Some(single),
            path: PathTracing {
                light_size_degrees,
                ..settings.path
            },
            ..settings
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_than_once_is_for_paths() {
        assert_eq!("single".parse(), Ok(ScatteringWord::Single));
        assert_eq!("none".parse(), Ok(ScatteringWord::None));
        let refused = "multiple".parse::<ScatteringWord>().expect_err("refused");
        assert!(refused.contains("--technique pathtrace"), "{refused}");
    }
}
