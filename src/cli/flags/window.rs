//! `--window`: over which values a transfer function is spread.

use super::{ClassificationFlags, Error, Numbers};
use crate::{
    technique::Mode,
    transfer::{Colormap, ValueSummary, Window},
};
use serde::{Deserialize, Serialize};
use std::{fmt, str::FromStr};

/// `LO,HI`, `auto` or `full`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub enum WindowWord {
    /// [`ValueSummary::most`].
    Auto,
    /// From the least value to the largest.
    Full,
    /// From the first to the second.
    Values([f64; 2]),
}

impl WindowWord {
    /// The window, where the word names its ends.
    pub fn window(self) -> Result<Option<Window>, Error> {
        let Self::Values([low, high]) = self else {
            return Ok(None);
        };
        let window = Window::new(low, high).ok_or_else(|| {
            Error::usage(
                format!("--window {low},{high}: wanted a low value and a higher one"),
                "--window -200,300",
            )
        })?;
        Ok(Some(window))
    }

    /// The same word by its ends, for values like those of `summary`.
    pub fn of_values(self, summary: &ValueSummary) -> Self {
        let window = match self {
            Self::Values(_) => return self,
            Self::Auto => summary.most(),
            Self::Full => Window::of_range(summary.range),
        };
        Self::Values([window.low(), window.high()])
    }
}

impl ClassificationFlags {
    /// These flags with the ends of the window instead of `auto` or `full`. The values of a volume say nothing of its
    /// integrals: those find their own window, as if nothing was said.
    pub fn with_window_of(
        &self,
        mode: Mode,
        summary: impl FnOnce() -> Result<ValueSummary, Error>,
    ) -> Result<Self, Error> {
        let window = match self.window {
            Some(WindowWord::Auto | WindowWord::Full) if mode == Mode::Xray => None,
            Some(word @ (WindowWord::Auto | WindowWord::Full)) => Some(word.of_values(&summary()?)),
            window => window,
        };
        Ok(Self {
            window,
            ..self.clone()
        })
    }

    /// The map of `--colormap`.
    pub fn map(&self) -> Result<Option<Colormap>, Error> {
        let map = self.colormap.as_deref().map(str::parse).transpose();
        map.map_err(|problem| Error::usage(problem, "--colormap viridis"))
    }
}

impl FromStr for WindowWord {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "auto" => Ok(Self::Auto),
            "full" => Ok(Self::Full),
            _ => match text.parse() {
                Ok(Numbers(ends)) => Ok(Self::Values(ends)),
                Err(problem) => Err(format!("wanted auto, full or LO,HI: {problem}")),
            },
        }
    }
}

impl fmt::Display for WindowWord {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Auto => f.write_str("auto"),
            Self::Full => f.write_str("full"),
            Self::Values(ends) => Numbers(*ends).fmt(f),
        }
    }
}

impl TryFrom<String> for WindowWord {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<WindowWord> for String {
    fn from(word: WindowWord) -> Self {
        word.to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_window_comes_back_from_its_word() {
        for text in ["auto", "full", "-200,300.5"] {
            let word: WindowWord = text.parse().expect(text);
            assert_eq!(word.to_string(), text);
        }
        for text in ["Auto", "1", "1,2,3", ""] {
            let problem = text.parse::<WindowWord>().expect_err(text);
            assert!(problem.contains("auto, full or LO,HI"), "{problem}");
        }
    }
}
