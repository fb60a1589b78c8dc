//! What keeps light from matter: words of `--shadows`.

use super::Error;
use crate::technique::{Settings, Shadows};
use clap::ValueEnum;
use serde::{Deserialize, Serialize};

/// Every word of `--shadows`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ShadowsWord {
    #[default]
    #[value(help = "light goes through everything")]
    Off,
    #[value(help = "light is followed once through a coarse grid, for every technique")]
    Volume,
    #[value(help = "slices half way to one light, by --technique slices-3d in --mode composite")]
    HalfAngle,
}

/// What half-angle slicing goes together with.
const HALF_ANGLE: &str = "--shadows half-angle is for --technique slices-3d --mode composite, one --light, one volume, --filter nearest \
                          or linear, without --preintegrated and --ambient-occlusion; --shadows volume is for all techniques";

impl ShadowsWord {
    /// What it stands for, of lights that look so wide.
    pub fn shadows(self, light_size_degrees: f64) -> Shadows {
        match self {
            Self::Off => Shadows::Off,
            Self::Volume => Shadows::Volume { light_size_degrees },
            Self::HalfAngle => Shadows::HalfAngle,
        }
    }

    /// Whether the settings, of which it is a part, go together with it.
    pub fn check(self, settings: &Settings) -> Result<(), Error> {
        match settings.check_ways() {
            Err(problem) if self == Self::HalfAngle => {
                Err(Error::usage(problem.to_string(), HALF_ANGLE))
            }
            _ => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::technique::{Filter, Light, Mode, Shading, Technique};

    #[test]
    fn half_angle_slices_are_refused_by_name_where_they_are_not() {
        let in_light = |lights| {
            let light = Light::of_world(glam::DVec3::X, [1.0; 3]);
            Settings {
                technique: Technique::Slices3d,
                shading: Some(Shading {
                    lights: vec![light; lights],
                    shadows: Shadows::HalfAngle,
                    ..Shading::plain()
                }),
                ..Settings::default()
            }
        };
        let slices = || in_light(1);
        let word = ShadowsWord::HalfAngle;
        word.check(&slices()).expect("slices");
        let others = [
            Settings {
                technique: Technique::Raycast,
                ..slices()
            },
            Settings {
                technique: Technique::Slices2d,
                ..slices()
            },
            Settings {
                mode: Mode::Mip,
                ..slices()
            },
            Settings {
                filter: Filter::Cubic,
                ..slices()
            },
            Settings {
                preintegrated: true,
                ..slices()
            },
        ];
        for other in others {
            let error = word.check(&other).expect_err("refused");
            let text = error.to_string();
            let names = ["half-angle", "pre-integrated"];
            assert!(names.iter().any(|name| text.contains(name)), "{text}");
            assert_eq!(error.hint(), Some(HALF_ANGLE));
        }
        let error = word.check(&in_light(2)).expect_err("two lights");
        assert!(error.to_string().contains("2 were given"), "{error}");
    }
}
