//! Words and marks over the picture.

use super::{Error, color::ColorWord, positive};
use crate::cli::figure::letter_lacking;
use clap::{Args, ValueEnum};
use serde::{Deserialize, Serialize};
use std::{fmt, str::FromStr};

const HEADING: &str = "Annotation";

/// The flags, none of them filled in.
#[derive(Args, Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct AnnotateFlags {
    /// Draw over the picture: bar, time, orientation, scale, title=TEXT, box, ticks, axes, source; without a list the
    /// first four. In .exr and .npy a layer of its own [default: nothing]
    #[arg(long, value_name = "LIST", num_args = 0..=1, default_missing_value = "bar,time,orientation,scale", help_heading = HEADING)]
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
        let title = self
            .annotate
            .as_ref()
            .and_then(|marks| marks.title.as_ref());
        match title.and_then(|title| letter_lacking(title)) {
            Some(letter) => Err(Error::usage(
                format!("--annotate title: no letter '{}'", letter.escape_debug()),
                "letters are those of Latin, Greek small letters, digits and signs",
            )),
            None => Ok(()),
        }
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

/// What is drawn over a picture.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
#[allow(missing_docs, reason = "the names say it")]
pub struct Marks {
    pub bar: bool,
    pub time: bool,
    pub orientation: bool,
    pub scale: bool,
    pub bounds: bool,
    pub ticks: bool,
    pub axes: bool,
    pub source: bool,
    pub title: Option<String>,
}

impl Marks {
    fn of(&mut self, word: &str) -> Option<&mut bool> {
        Some(match word {
            "bar" => &mut self.bar,
            "time" => &mut self.time,
            "orientation" => &mut self.orientation,
            "scale" => &mut self.scale,
            "box" => &mut self.bounds,
            "ticks" => &mut self.ticks,
            "axes" => &mut self.axes,
            "source" => &mut self.source,
            _ => return None,
        })
    }
}

impl FromStr for Marks {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let mut marks = Self::default();
        // Behind `title=`, words that are no mark belong to the title, with their commas.
        let mut is_title = false;
        for word in text.split(',') {
            if let Some(is_wanted) = marks.of(word) {
                (*is_wanted, is_title) = (true, false);
            } else if let Some(title) = word.strip_prefix("title=") {
                (marks.title, is_title) = (Some(title.to_owned()), true);
            } else if let (Some(title), true) = (&mut marks.title, is_title) {
                *title += &format!(",{word}");
            } else {
                return Err(format!(
                    "no mark {word:?}: wanted bar, time, orientation, scale, title=TEXT, box, ticks, axes, source, \
                     separated by commas"
                ));
            }
        }
        Ok(marks)
    }
}

impl fmt::Display for Marks {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let flags = [
            (self.bar, "bar"),
            (self.time, "time"),
            (self.orientation, "orientation"),
            (self.scale, "scale"),
            (self.bounds, "box"),
            (self.ticks, "ticks"),
            (self.axes, "axes"),
            (self.source, "source"),
        ];
        let words = flags.into_iter().filter(|(is_wanted, _)| *is_wanted);
        let mut words: Vec<String> = words.map(|(_, word)| word.to_owned()).collect();
        words.extend(self.title.iter().map(|title| format!("title={title}")));
        f.write_str(&words.join(","))
    }
}

impl TryFrom<String> for Marks {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<Marks> for String {
    fn from(marks: Marks) -> Self {
        marks.to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_list_comes_back_as_it_was_and_a_title_keeps_its_commas() {
        let marks: Marks = "title=Wind, 850 hPa,bar,ticks".parse().expect("marks");
        assert!(marks.bar && marks.ticks && !marks.time, "{marks:?}");
        assert_eq!(marks.title.as_deref(), Some("Wind, 850 hPa"));
        assert_eq!(marks.to_string().parse(), Ok(marks));
        let problem = "bar,foo".parse::<Marks>().expect_err("no mark");
        assert!(
            problem.contains("\"foo\"") && problem.contains("orientation"),
            "{problem}"
        );
    }

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
