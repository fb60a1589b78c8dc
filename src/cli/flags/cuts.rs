//! A box of free orientation that is kept, and what a cut looks like: the words.
//!
//! ```text
//! R = Rz Ry Rx        the box is turned about the world's x, then y, then z, by its centre c
//! |a_k . (x - c)| <= s_k / 2        a_k column k of R: two clip planes an axis
//! ```

use super::{Error, Numbers};
use crate::technique::{ClipPlane, CutFaces};
use glam::{DMat3, DVec3};
use serde::{Deserialize, Serialize};
use std::{fmt, str::FromStr};

/// `CX,CY,CZ,SX,SY,SZ[,RX,RY,RZ]`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct ClipBox {
    center: [f64; 3],
    size: [f64; 3],
    degrees: Option<[f64; 3]>,
}

/// `own`, or the window `LO,HI`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub enum CutFacesWord {
    /// The picture's own colours.
    Own,
    /// Greys of a window.
    Grey([f64; 2]),
}

impl ClipBox {
    /// The six planes, two an axis of the box.
    pub fn planes(&self) -> Result<[ClipPlane; 6], Error> {
        if let Some(size) = self.size.iter().find(|size| **size <= 0.0) {
            return Err(Error::usage(
                format!("--clip-box {self}: a size of {size}, wanted sizes over 0"),
                "--clip-box 0,0,0,50,50,100,0,0,30 turns a box by 30 degrees about the world's z",
            ));
        }
        let [x, y, z] = self.degrees.unwrap_or_default().map(f64::to_radians);
        let turn =
            DMat3::from_rotation_z(z) * DMat3::from_rotation_y(y) * DMat3::from_rotation_x(x);
        let center = DVec3::from(self.center);
        let side = |i: usize| {
            let sign = if i.is_multiple_of(2) { 1.0 } else { -1.0 };
            let normal = sign * turn.col(i / 2);
            ClipPlane {
                normal,
                offset: normal.dot(center) - 0.5 * self.size[i / 2],
            }
        };
        Ok(std::array::from_fn(side))
    }
}

impl FromStr for ClipBox {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let three = |numbers: &[f64]| std::array::from_fn(|k| numbers[k]);
        match text.matches(',').count() {
            8 => {
                let Numbers(all) = text.parse::<Numbers<9>>()?;
                Ok(Self {
                    center: three(&all[..3]),
                    size: three(&all[3..6]),
                    degrees: Some(three(&all[6..])),
                })
            }
            5 => {
                let Numbers(all) = text.parse::<Numbers<6>>()?;
                Ok(Self {
                    center: three(&all[..3]),
                    size: three(&all[3..]),
                    degrees: None,
                })
            }
            commas => Err(format!(
                "wanted 6 or 9 numbers separated by commas, found {}",
                commas + 1
            )),
        }
    }
}

impl fmt::Display for ClipBox {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{},{}", Numbers(self.center), Numbers(self.size))?;
        let turned = |degrees| write!(f, ",{}", Numbers::<3>(degrees));
        self.degrees.map_or(Ok(()), turned)
    }
}

impl TryFrom<String> for ClipBox {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<ClipBox> for String {
    fn from(word: ClipBox) -> Self {
        word.to_string()
    }
}

impl CutFacesWord {
    /// What it stands for.
    pub fn cut_faces(self) -> CutFaces {
        match self {
            Self::Own => CutFaces::Own,
            Self::Grey(window) => CutFaces::Grey(window),
        }
    }
}

impl FromStr for CutFacesWord {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text == "own" {
            return Ok(Self::Own);
        }
        let Numbers([low, high]) = text.parse::<Numbers<2>>()?;
        if low < high {
            Ok(Self::Grey([low, high]))
        } else {
            Err(format!("wanted LO,HI with LO under HI, found {text}"))
        }
    }
}

impl fmt::Display for CutFacesWord {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Own => f.write_str("own"),
            Self::Grey(window) => Numbers(*window).fmt(f),
        }
    }
}

impl TryFrom<String> for CutFacesWord {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<CutFacesWord> for String {
    fn from(word: CutFacesWord) -> Self {
        word.to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn keeps(word: &str, p: [f64; 3]) -> bool {
        let planes = word.parse::<ClipBox>().expect("a box").planes();
        let planes = planes.expect("six planes");
        planes
            .iter()
            .all(|plane| plane.normal.dot(p.into()) >= plane.offset)
    }

    #[test]
    fn a_box_is_turned_about_x_then_y_then_z() {
        // Long along its own x. About y by -90 degrees that comes to lie along z, and then about z nothing happens;
        // in the other order it would lie along y.
        let word = "1,2,3,20,2,2,0,-90,90";
        assert!(keeps(word, [1.0, 2.0, 12.0]) && keeps(word, [1.0, 2.0, -6.0]));
        assert!(!keeps(word, [1.0, 11.0, 3.0]) && !keeps(word, [10.0, 2.0, 3.0]));
        // Its own y, about x by 90 degrees along z, about y by 90 degrees along x.
        let word = "0,0,0,2,20,2,90,90,0";
        assert!(keeps(word, [9.0, 0.0, 0.0]) && !keeps(word, [0.0, 0.0, 9.0]));
        // By 45 degrees a corner reaches out by the root of two.
        let word = "0,0,0,2,2,2,0,0,45";
        assert!(keeps(word, [1.4, 0.0, 0.0]) && !keeps(word, [0.8, 0.8, 0.0]));
    }

    #[test]
    fn words_come_back_from_their_own_text_and_what_is_wrong_is_said() {
        for text in ["1,2,3,4,5,6", "1,2,3,4,5,6,-7,8.5,9"] {
            assert_eq!(text.parse::<ClipBox>().expect("a box").to_string(), text);
        }
        for text in ["own", "-100,300.5"] {
            let word: CutFacesWord = text.parse().expect("a word");
            assert_eq!(word.to_string(), text);
        }
        assert!("1,2,3,4,5,6,7".parse::<ClipBox>().is_err());
        assert!("5,5".parse::<CutFacesWord>().is_err());
        let flat: ClipBox = "0,0,0,1,0,1".parse().expect("numbers");
        let said = flat.planes().expect_err("refused").to_string();
        assert!(said.contains("over 0"), "{said}");
    }
}
