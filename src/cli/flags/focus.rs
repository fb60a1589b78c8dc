//! Where a lens is sharp.

use serde::{Deserialize, Serialize};
use std::{fmt, str::FromStr};

/// `LENGTH`, `target` or `auto`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Written", into = "Written")]
pub enum FocusWord {
    /// So far ahead of the eye, world length.
    Length(f64),
    /// Where the camera is turned to.
    Target,
    /// At what the middle of the picture shows.
    Auto,
}

/// As scene files have it: lengths are numbers there.
#[derive(Serialize, Deserialize)]
#[serde(untagged)]
enum Written {
    Length(f64),
    Word(String),
}

impl FocusWord {
    /// The length, where it is one.
    pub fn length(self) -> Option<f64> {
        match self {
            Self::Length(length) => Some(length),
            Self::Target | Self::Auto => None,
        }
    }
}

impl FromStr for FocusWord {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "target" => Ok(Self::Target),
            "auto" => Ok(Self::Auto),
            _ => super::numbers::positive(text)
                .map(Self::Length)
                .map_err(|wanted| format!("{wanted}, or target, or auto")),
        }
    }
}

impl fmt::Display for FocusWord {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Length(length) => write!(f, "{length}"),
            Self::Target => f.write_str("target"),
            Self::Auto => f.write_str("auto"),
        }
    }
}

impl TryFrom<Written> for FocusWord {
    type Error = String;

    fn try_from(written: Written) -> Result<Self, String> {
        match written {
            Written::Length(length) => length.to_string().parse(),
            Written::Word(word) => word.parse(),
        }
    }
}

impl From<FocusWord> for Written {
    fn from(word: FocusWord) -> Self {
        match word {
            FocusWord::Length(length) => Self::Length(length),
            FocusWord::Target | FocusWord::Auto => Self::Word(word.to_string()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_focus_comes_back_from_its_word_and_from_a_scene() {
        for (text, json) in [
            ("12.5", "12.5"),
            ("target", "\"target\""),
            ("auto", "\"auto\""),
        ] {
            let word: FocusWord = text.parse().expect("a focus");
            assert_eq!(word.to_string(), text);
            assert_eq!(serde_json::to_string(&word).expect("JSON"), json);
            assert_eq!(serde_json::from_str::<FocusWord>(json).expect("JSON"), word);
        }
        for text in ["0", "-1", "inf", "near", ""] {
            assert!(text.parse::<FocusWord>().is_err(), "{text}");
        }
        assert!(serde_json::from_str::<FocusWord>("-2.0").is_err());
    }
}
