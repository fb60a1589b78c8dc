//! Colours as they are written on the command line: by name, in hex, or as numbers.

use std::{fmt, str::FromStr};

use serde::{Deserialize, Serialize};

/// Names of colours, sRGB: the basic names of CSS, but that `green` is full green (CSS calls it lime, and half of it
/// green), `grey` a half, and `orange` half way between red and yellow.
const NAMES: [(&str, [f64; 3]); 23] = [
    ("black", [0.0, 0.0, 0.0]),
    ("white", [1.0, 1.0, 1.0]),
    ("grey", [0.5, 0.5, 0.5]),
    ("gray", [0.5, 0.5, 0.5]),
    ("silver", [0.75, 0.75, 0.75]),
    ("red", [1.0, 0.0, 0.0]),
    ("green", [0.0, 1.0, 0.0]),
    ("lime", [0.0, 1.0, 0.0]),
    ("blue", [0.0, 0.0, 1.0]),
    ("cyan", [0.0, 1.0, 1.0]),
    ("aqua", [0.0, 1.0, 1.0]),
    ("magenta", [1.0, 0.0, 1.0]),
    ("fuchsia", [1.0, 0.0, 1.0]),
    ("yellow", [1.0, 1.0, 0.0]),
    ("orange", [1.0, 0.5, 0.0]),
    ("maroon", [0.5, 0.0, 0.0]),
    ("olive", [0.5, 0.5, 0.0]),
    ("navy", [0.0, 0.0, 0.5]),
    ("purple", [0.5, 0.0, 0.5]),
    ("teal", [0.0, 0.5, 0.5]),
    ("pink", [1.0, 0.75, 0.8]),
    ("brown", [0.65, 0.16, 0.16]),
    ("gold", [1.0, 0.84, 0.0]),
];

/// Straight sRGB and alpha, 0 to 1, of `NAME`, `#RGB`, `#RRGGBB`, `#RRGGBBAA`, `R:G:B` or `R:G:B:A`.
pub fn rgba(text: &str) -> Result<[f64; 4], String> {
    if let Some(&(_, [r, g, b])) = NAMES
        .iter()
        .find(|(name, _)| name.eq_ignore_ascii_case(text))
    {
        return Ok([r, g, b, 1.0]);
    }
    let found = match text.strip_prefix('#') {
        Some(digits) => of_hex(digits),
        None => of_numbers(text),
    };
    found.ok_or_else(|| {
        let names = NAMES.map(|(name, _)| name).join(", ");
        format!(
            "no colour {text:?}: wanted #RGB, #RRGGBB, #RRGGBBAA, R:G:B or R:G:B:A from 0 to 1, or one of {names}"
        )
    })
}

/// The same where nothing can be transparent.
pub fn rgb(text: &str) -> Result<[f64; 3], String> {
    let [r, g, b, alpha] = rgba(text)?;
    match alpha {
        1.0 => Ok([r, g, b]),
        _ => Err(format!("{text:?}: this colour takes no alpha")),
    }
}

fn of_hex(digits: &str) -> Option<[f64; 4]> {
    let digit = |c: char| c.to_digit(16).map(f64::from);
    let digits: Vec<f64> = digits.chars().map(digit).collect::<Option<_>>()?;
    let channels: Vec<f64> = match digits.len() {
        3 => digits.iter().map(|d| d / 15.0).collect(),
        6 | 8 => digits
            .chunks(2)
            .map(|pair| (16.0 * pair[0] + pair[1]) / 255.0)
            .collect(),
        _ => return None,
    };
    Some(with_alpha(&channels))
}

fn of_numbers(text: &str) -> Option<[f64; 4]> {
    let numbers: Vec<f64> = text
        .split(':')
        .map(|n| n.parse().ok())
        .collect::<Option<_>>()?;
    let right = matches!(numbers.len(), 3 | 4) && numbers.iter().all(|n| (0.0..=1.0).contains(n));
    right.then(|| with_alpha(&numbers))
}

fn with_alpha(channels: &[f64]) -> [f64; 4] {
    std::array::from_fn(|c| channels.get(c).copied().unwrap_or(1.0))
}

/// A colour without alpha, sRGB.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct ColorWord(pub [f64; 3]);

impl FromStr for ColorWord {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        rgb(text).map(Self)
    }
}

impl fmt::Display for ColorWord {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [r, g, b] = self.0;
        write!(f, "{r}:{g}:{b}")
    }
}

impl TryFrom<String> for ColorWord {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<ColorWord> for String {
    fn from(color: ColorWord) -> Self {
        color.to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_colour_is_a_name_hex_digits_or_numbers() {
        for (text, wanted) in [
            ("Orange", [1.0, 0.5, 0.0, 1.0]),
            ("#f80", [1.0, 136.0 / 255.0, 0.0, 1.0]),
            ("#ff8000", [1.0, 128.0 / 255.0, 0.0, 1.0]),
            ("#FF800033", [1.0, 128.0 / 255.0, 0.0, 0.2]),
            ("0:0.5:1", [0.0, 0.5, 1.0, 1.0]),
            ("0:0.5:1:0.25", [0.0, 0.5, 1.0, 0.25]),
        ] {
            assert_eq!(rgba(text), Ok(wanted), "{text}");
        }
    }

    #[test]
    fn what_is_no_colour_is_refused() {
        for text in [
            "", "#", "#12", "#12345", "#gggggg", "#é0", "1:1", "0:0:2", "0:nan:0", "puce", "1,1,1",
        ] {
            let problem = rgba(text).expect_err(text);
            assert!(problem.contains(&format!("{text:?}")), "{problem}");
        }
        assert!(rgb("#ffffff80").is_err());
        assert_eq!(rgb("#ffffffff"), Ok([1.0; 3]));
    }
}
