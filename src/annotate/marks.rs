//! The words of `--annotate`: a list such as `bar,scale,title=Storm`.

use super::Error;
use crate::figure::letter_lacking;
use std::{fmt, str::FromStr};

/// What is drawn over a picture.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "json", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "json", serde(try_from = "String", into = "String"))]
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
    /// What is meant where no list is given.
    pub const USUAL: &str = "bar,time,orientation,scale";

    /// Refuses a title with letters that cannot be drawn.
    pub fn check(&self) -> Result<(), Error> {
        let lacking = self.title.as_ref().and_then(|title| letter_lacking(title));
        lacking.map_or(Ok(()), |letter| Err(Error::NoLetter(letter)))
    }

    /// True where edges of the volume are drawn.
    pub fn has_box(&self) -> bool {
        self.bounds || self.ticks
    }

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
}
