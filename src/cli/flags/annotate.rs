//! Words and marks over the picture.

use super::{Error, color::ColorWord, positive};
use crate::annotate::Marks;
use clap::{Args, ValueEnum};
use serde::{Deserialize, Serialize};
use std::str::FromStr;

const HEADING: &str = "Annotation";

/// The flags, none of them filled in.
#[derive(Args, Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct AnnotateFlags {
    /// Draw over the picture: bar, time, orientation, scale, title=TEXT, box, ticks, axes, source; without a list the
    /// first four. In .exr and .npy a layer of its own [default: nothing]
    #[arg(long, value_name = "LIST", num_args = 0..=1, default_missing_value = Marks::USUAL, help_heading = HEADING)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub annotate: Option<Marks>,
    /// Height of an em of the words, in pixels [default: a fortieth of the picture's height, at least 11]
    #[arg(long, value_name = "PX", value_parser = positive, help_heading = HEADING)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub annotate_size: Option<f64>,
    /// Colour of words and marks [default: black or white, by what lies under them]
    #[arg(long, value_name = "auto|R:G:B", help_heading = HEADING)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub annotate_color: Option<InkWord>,
    /// How values are spread along the colour bar
    #[arg(long, value_name = "linear|log", help_heading = HEADING)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub colormap_scale: Option<ScaleWord>,
}

impl AnnotateFlags {
    /// What can be said wrong before a voxel is read.
    pub fn check(&self) -> Result<(), Error> {
        self.annotate
            .as_ref()
            .map_or(Ok(()), |marks| Ok(marks.check()?))
    }

    /// Flags that change nothing without `--annotate`, a sentence each.
    pub fn idle(&self) -> Vec<&'static str> {
        if self.annotate.is_some() || *self == Self::default() {
            return Vec::new();
        }
        vec![
            "--annotate-size, --annotate-color and --colormap-scale have no effect without --annotate",
        ]
    }
}

/// `auto` or a colour.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct InkWord(pub Option<ColorWord>);

impl FromStr for InkWord {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "auto" => Ok(Self(None)),
            _ => text.parse().map(|color| Self(Some(color))),
        }
    }
}

impl TryFrom<String> for InkWord {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<InkWord> for String {
    fn from(word: InkWord) -> Self {
        word.0.map_or("auto".to_owned(), |color| color.to_string())
    }
}

/// Every word of `--colormap-scale`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[allow(missing_docs, reason = "the names say it")]
pub enum ScaleWord {
    #[default]
    Linear,
    Log,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_title_of_other_letters_is_refused_by_its_letter() {
        let of = |title: &str| AnnotateFlags {
            annotate: Some(format!("title={title}").parse().expect("marks")),
            ..AnnotateFlags::default()
        };
        of("Škoda → 5 µm ≤ α").check().expect("letters");
        let error = of("Жук").check().expect_err("refused");
        assert_eq!(error.exit_code(), 2);
        assert!(
            error
                .to_string()
                .contains("--annotate title: no letter 'Ж'"),
            "{error}"
        );
    }
}
