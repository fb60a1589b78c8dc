//! What keeps light from matter: words of `--shadows`.

use super::Error;
use crate::technique::{Settings, Shadows};
use clap::ValueEnum;
use serde::{Deserialize, Serialize};

/// Every word of `--shadows`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[allow(missing_docs, reason = "the names say it")]
pub enum ShadowsWord {
    #[default]
    Off,
    #[value(help = "slices half way to one light, by --technique slices-3d in --mode composite")]
    HalfAngle,
}

/// What half-angle slicing goes together with.
const HALF_ANGLE: &str = "--shadows half-angle is for --technique slices-3d --mode composite, one volume, and --filter \
                          nearest or linear without --preintegrated";

impl ShadowsWord {
    /// What it stands for.
    pub fn shadows(self) -> Shadows {
        match self {
            Self::Off => Shadows::Off,
            Self::HalfAngle => Shadows::HalfAngle,
        }
    }

    /// The settings with shadows of so many lights, where they go together.
    pub fn cast(self, settings: Settings, lights: usize) -> Result<Settings, Error> {
        if self == Self::HalfAngle && lights > 1 {
            return Err(Error::usage(
                format!(
                    "--shadows half-angle: slices lie half way to one light, and {lights} are given"
                ),
                "give --light once",
            ));
        }
        let settings = Settings {
            shadows: self.shadows(),
            ..settings
        };
        match settings.check_ways() {
            Err(problem) if self == Self::HalfAngle => {
                Err(Error::usage(problem.to_string(), HALF_ANGLE))
            }
            _ => Ok(settings),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::technique::{Filter, Mode, Technique};

    #[test]
    fn half_angle_slices_are_refused_by_name_where_they_are_not() {
        let slices = || Settings {
            technique: Technique::Slices3d,
            ..Settings::default()
        };
        let word = ShadowsWord::HalfAngle;
        let cast = word.cast(slices(), 1).expect("slices");
        assert_eq!(cast.shadows, Shadows::HalfAngle);
        let others = [
            Settings::default(),
            Settings {
                technique: Technique::Slices2d,
                ..Settings::default()
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
            let what = format!("{other:?}");
            let error = word.cast(other, 1).expect_err(&what);
            assert!(error.to_string().contains("half-angle"), "{error}");
            assert_eq!(error.hint(), Some(HALF_ANGLE));
        }
        let error = word.cast(slices(), 2).expect_err("two lights");
        assert!(error.to_string().contains("2 are given"), "{error}");
    }
}
