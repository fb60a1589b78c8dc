//! Numbers as they are written on the command line and, in the same way, in a scene file.

use super::color::rgba;
use crate::cli::Error;
use serde::{Deserialize, Serialize};
use std::{fmt, str::FromStr};

/// `X,Y,Z`: as many finite numbers as `N`, separated by commas.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Numbers<const N: usize>(pub [f64; N]);

impl<const N: usize> FromStr for Numbers<N> {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers = text.split(',').map(finite).collect::<Result<Vec<_>, _>>()?;
        let found = numbers.len();
        <[f64; N]>::try_from(numbers)
            .map(Self)
            .map_err(|_| format!("wanted {N} numbers separated by commas, found {found}"))
    }
}

impl<const N: usize> fmt::Display for Numbers<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let words: Vec<_> = self.0.iter().map(f64::to_string).collect();
        f.write_str(&words.join(","))
    }
}

impl Numbers<2> {
    /// Refuses ends of a range of which the first is not under the other; `hint` shows two that are right.
    pub fn check_rises(&self, flag: &str, hint: &str) -> Result<(), Error> {
        let [low, high] = self.0;
        match low < high && (high - low).is_finite() {
            true => Ok(()),
            false => Err(Error::usage(
                format!("{flag} {self}: wanted LO,HI, the first under the other"),
                format!("{flag} {hint}"),
            )),
        }
    }
}

impl<const N: usize> TryFrom<String> for Numbers<N> {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl<const N: usize> From<Numbers<N>> for String {
    fn from(numbers: Numbers<N>) -> Self {
        numbers.to_string()
    }
}

/// `1024x768`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Size(pub [u32; 2]);

impl FromStr for Size {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let sides: Option<Vec<u32>> = text.split('x').map(|side| side.parse().ok()).collect();
        sides
            .and_then(|sides| <[u32; 2]>::try_from(sides).ok())
            .filter(|sides| !sides.contains(&0))
            .map(Self)
            .ok_or_else(|| "wanted WIDTHxHEIGHT in pixels, such as 1024x768".to_owned())
    }
}

impl fmt::Display for Size {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}x{}", self.0[0], self.0[1])
    }
}

impl TryFrom<String> for Size {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<Size> for String {
    fn from(size: Size) -> Self {
        size.to_string()
    }
}

/// `R,G,B`, `R,G,B,A` in sRGB numbers, another word for a colour ([`rgba`]), `none` or `environment`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub enum Background {
    /// The picture is transparent where nothing is.
    None,
    /// The light of `--environment`.
    Environment,
    /// Straight sRGB and alpha, 0 to 1.
    Color([f64; 4]),
}

impl FromStr for Background {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "none" => return Ok(Self::None),
            "environment" => return Ok(Self::Environment),
            _ => {}
        }
        let color = match text.matches(',').count() {
            2 => {
                let [r, g, b] = Numbers::<3>::from_str(text)?.0;
                [r, g, b, 1.0]
            }
            3 => Numbers::<4>::from_str(text)?.0,
            _ => rgba(text)?,
        };
        if color.iter().all(|c| (0.0..=1.0).contains(c)) {
            Ok(Self::Color(color))
        } else {
            Err("wanted numbers from 0 to 1".to_owned())
        }
    }
}

impl fmt::Display for Background {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::None => f.write_str("none"),
            Self::Environment => f.write_str("environment"),
            Self::Color(color) => Numbers(*color).fmt(f),
        }
    }
}

impl TryFrom<String> for Background {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<Background> for String {
    fn from(background: Background) -> Self {
        background.to_string()
    }
}

/// A finite number.
pub fn finite(text: &str) -> Result<f64, String> {
    text.trim()
        .parse()
        .ok()
        .filter(|number: &f64| number.is_finite())
        .ok_or_else(|| format!("wanted a number, found {text:?}"))
}

/// A number from 0 to 1.
pub fn share(text: &str) -> Result<f64, String> {
    finite(text).and_then(|number| match (0.0..=1.0).contains(&number) {
        true => Ok(number),
        false => Err(format!("wanted a number from 0 to 1, found {text}")),
    })
}

/// A finite number over 0.
pub fn positive(text: &str) -> Result<f64, String> {
    finite(text).and_then(|number| {
        if number > 0.0 {
            Ok(number)
        } else {
            Err(format!("wanted a number over 0, found {text}"))
        }
    })
}

/// Stops of light, -64 to 64: what f32 has room for.
pub fn stops(text: &str) -> Result<f64, String> {
    finite(text).and_then(|number| match number.abs() <= 64.0 {
        true => Ok(number),
        false => Err(format!("wanted stops from -64 to 64, found {text}")),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_come_back_from_their_own_text() {
        let numbers = Numbers([0.1, -2.5e-300, 1.0 / 3.0]);
        let text = numbers.to_string();
        assert_eq!(text.parse(), Ok(numbers), "{text}");
    }

    #[test]
    fn what_is_wrong_with_a_list_of_numbers_is_said() {
        for (text, wanted) in [
            ("1,2", "wanted 3 numbers separated by commas, found 2"),
            ("1,2,3,4", "wanted 3 numbers separated by commas, found 4"),
            ("1,two,3", "wanted a number, found \"two\""),
            ("1,,3", "wanted a number, found \"\""),
            ("1,nan,3", "wanted a number, found \"nan\""),
            ("1,1e999,3", "wanted a number, found \"1e999\""),
        ] {
            assert_eq!(text.parse::<Numbers<3>>(), Err(wanted.to_owned()), "{text}");
        }
    }

    #[test]
    fn a_size_is_two_sides_of_at_least_one_pixel() {
        assert_eq!("640x480".parse(), Ok(Size([640, 480])));
        for text in [
            "640",
            "640x",
            "0x480",
            "-1x5",
            "1x2x3",
            "640,480",
            "4294967296x1",
        ] {
            assert!(text.parse::<Size>().is_err(), "{text}");
        }
    }

    #[test]
    fn a_background_is_opaque_unless_it_says_otherwise() {
        assert_eq!("none".parse(), Ok(Background::None));
        assert_eq!(
            "0,0.5,1".parse(),
            Ok(Background::Color([0.0, 0.5, 1.0, 1.0]))
        );
        assert_eq!("white".parse(), Ok(Background::Color([1.0; 4])));
        assert_eq!("0,0,0,0".parse(), Ok(Background::Color([0.0; 4])));
        for text in ["1,1", "2,0,0", "0,0,0,0,0", "puce", "#0000"] {
            assert!(text.parse::<Background>().is_err(), "{text}");
        }
    }
}
