//! Surfaces: which values, in which colours.

use super::{Error, color::ColorWord};
use crate::{
    figure::short,
    picture::ColorSpace,
    shaders::MAX_LEVELS,
    technique::Level,
    transfer::{
        Absorption, Points, SURFACE_COLORS, Surface, TransferFunction, ValueSummary,
        classify_by_points, surfaces,
    },
};
use clap::Args;
use serde::{Deserialize, Serialize};

/// The flags, none of them filled in.
#[derive(Args, Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct LevelFlags {
    /// iso: the values of which surfaces are drawn [default: by the values]; --technique pathtrace: solid surfaces that light
    /// meets, in matter [default: none]
    #[arg(long, value_name = "VALUE,...", value_delimiter = ',', value_parser = super::finite, allow_hyphen_values = true, help_heading = HEADING)]
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub iso: Vec<f64>,
    /// iso, pathtrace: the colour of each value, a name, #hex or R:G:B [default: by --tf, --preset or --window, else light ones]
    #[arg(long, value_name = "COLOR,...", value_delimiter = ',', help_heading = HEADING)]
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub iso_color: Vec<ColorWord>,
    /// iso, pathtrace: the opacity of each value, 0 to 1 [default: 1 for the last, 0.25 for those before it]
    #[arg(long, value_name = "A,...", value_delimiter = ',', value_parser = super::finite, allow_hyphen_values = true, help_heading = HEADING)]
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub iso_opacity: Vec<f64>,
    /// iso: colour surfaces by another variable of INPUT, or by another number of its voxels, counted from 0; --tf,
    /// --preset and --window are of its values then
    #[arg(long, value_name = "VARIABLE|N", help_heading = HEADING)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub iso_color_by: Option<String>,
}

const HEADING: &str = "Modes";

/// What a surface takes of the light of those that are named after it.
const THIN: f64 = 0.25;

impl LevelFlags {
    /// What can be said wrong before a voxel is read.
    pub fn check(&self) -> Result<(), Error> {
        if self.iso_color_by.is_some() && !self.iso_color.is_empty() {
            return Err(Error::usage(
                "--iso-color and --iso-color-by both say which colours surfaces have",
                "leave out one of them",
            ));
        }
        let (values, limit) = (self.iso.len(), MAX_LEVELS as usize);
        if values > limit {
            return Err(Error::usage(
                format!("--iso: {values} values, at most {limit} are possible"),
                "--iso -300,250",
            ));
        }
        let lists = [
            ("--iso-color", self.iso_color.len()),
            ("--iso-opacity", self.iso_opacity.len()),
        ];
        for (flag, found) in lists {
            if found > 0 && found != values {
                return Err(Error::usage(
                    format!("{flag} says something of {found} values, and --iso names {values}"),
                    "--iso -300,250 --iso-color orange,white --iso-opacity 0.3,1",
                ));
            }
        }
        match self.iso_opacity.iter().find(|a| !(0.0..=1.0).contains(*a)) {
            Some(found) => Err(Error::usage(
                format!("--iso-opacity {found}: wanted numbers from 0 to 1"),
                "--iso -300,250 --iso-opacity 0.3,1",
            )),
            None => Ok(()),
        }
    }

    /// The surfaces, coloured by `function` where there is one and no word says how, and what a person should know of
    /// them.
    pub fn levels(
        &self,
        function: Option<&TransferFunction>,
        summary: impl FnOnce() -> Result<ValueSummary, Error>,
    ) -> Result<(Vec<Level>, Option<String>), Error> {
        let (chosen, note) = if self.iso.is_empty() {
            let chosen = surfaces(&summary()?);
            let words: Vec<_> = chosen.iter().map(|s| short(s.value)).collect();
            let values = words.join(" and of ");
            (
                chosen,
                Some(format!(
                    "surfaces of the value {values}; --iso takes others"
                )),
            )
        } else {
            (self.named(), None)
        };
        // In sRGB numbers, as the function has them.
        let points = function.map(|f| Points::new(f, Absorption::Opacity, ColorSpace::Display));
        let level = |(i, surface): (usize, Surface)| {
            let Surface {
                value,
                opacity,
                srgb,
            } = surface;
            let of_function = points.as_ref().map(|points| {
                let [r, g, b, _] = classify_by_points(points, value);
                [r, g, b]
            });
            let word = self.iso_color.get(i).map(|color| color.0);
            Level {
                value,
                srgb: word.or(of_function).unwrap_or(srgb),
                opacity,
            }
        };
        Ok((chosen.into_iter().enumerate().map(level).collect(), note))
    }

    /// Those of the words, the last one inside.
    fn named(&self) -> Vec<Surface> {
        let outside_in = self.iso.iter().enumerate().map(|(i, &value)| {
            let from_inside = self.iso.len() - 1 - i;
            let by_order = if from_inside == 0 { 1.0 } else { THIN };
            Surface {
                value,
                opacity: self.iso_opacity.get(i).copied().unwrap_or(by_order),
                srgb: SURFACE_COLORS[from_inside % SURFACE_COLORS.len()],
            }
        });
        outside_in.collect()
    }

    /// True where no word is given.
    pub fn say_nothing(&self) -> bool {
        *self == Self::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flags(iso: &[f64], color: &[&str], opacity: &[f64]) -> LevelFlags {
        LevelFlags {
            iso: iso.to_vec(),
            iso_color: color.iter().map(|c| c.parse().expect("a colour")).collect(),
            iso_opacity: opacity.to_vec(),
            iso_color_by: None,
        }
    }

    #[test]
    fn the_last_value_is_opaque_and_those_before_it_let_its_light_through() {
        let unasked = || -> Result<ValueSummary, Error> { panic!("values decide nothing") };
        let (found, note) = flags(&[1.0, 2.0], &[], &[])
            .levels(None, unasked)
            .expect("levels");
        assert_eq!(note, None);
        assert_eq!(
            found.iter().map(|l| l.value).collect::<Vec<_>>(),
            [1.0, 2.0]
        );
        assert_eq!(
            found.iter().map(|l| l.opacity).collect::<Vec<_>>(),
            [THIN, 1.0]
        );
        let words = flags(&[1.0, 2.0], &["red", "0:0.5:1"], &[0.5, 0.75]);
        let (found, _) = words.levels(None, unasked).expect("levels");
        assert_eq!(found[0].srgb, [1.0, 0.0, 0.0]);
        assert_eq!((found[1].srgb, found[1].opacity), ([0.0, 0.5, 1.0], 0.75));
    }

    #[test]
    fn lists_that_do_not_fit_are_refused_by_name() {
        for (flags, wanted) in [
            (flags(&[1.0; 9], &[], &[]), "9 values, at most 8"),
            (
                flags(&[1.0, 2.0], &["red"], &[]),
                "--iso-color says something of 1 values",
            ),
            (
                flags(&[], &[], &[0.5]),
                "--iso-opacity says something of 1 values",
            ),
            (flags(&[1.0], &[], &[1.5]), "--iso-opacity 1.5"),
        ] {
            let error = flags.check().expect_err("refused");
            assert_eq!(error.exit_code(), 2);
            assert!(error.to_string().contains(wanted), "{error}");
        }
    }
}
