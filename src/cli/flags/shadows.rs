//! What keeps light from matter: words of `--shadows`.

use crate::technique::Shadows;
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
    #[value(
        help = "light is followed from each sample, by steps as long as those of rays, with --scattering single"
    )]
    March,
    #[value(help = "slices half way to one light, by --technique slices-3d in --mode composite")]
    HalfAngle,
}

/// What half-angle slicing goes together with.
pub(super) const HALF_ANGLE: &str = "--shadows half-angle is for --technique slices-3d --mode composite, one --light, one volume, --filter nearest \
                          or linear, without --preintegrated and --ambient-occlusion; --shadows volume is for all techniques";

impl ShadowsWord {
    /// What it stands for, of lights that look so wide.
    pub fn shadows(self, light_size_degrees: f64) -> Shadows {
        match self {
            // Of light that is scattered, not shaded.
            Self::Off | Self::March => Shadows::Off,
            Self::Volume => Shadows::Volume { light_size_degrees },
            Self::HalfAngle => Shadows::HalfAngle,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::flags::sampling::check_ways;
    use crate::technique::{Filter, Light, Mode, Settings, Shading, Technique};

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
        check_ways(&slices()).expect("slices");
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
            let error = check_ways(&other).expect_err("refused");
            let text = error.to_string();
            let names = ["half-angle", "pre-integrated"];
            assert!(names.iter().any(|name| text.contains(name)), "{text}");
            assert_eq!(error.hint(), Some(HALF_ANGLE));
        }
        let error = check_ways(&in_light(2)).expect_err("two lights");
        assert!(error.to_string().contains("2 were given"), "{error}");
    }
}
