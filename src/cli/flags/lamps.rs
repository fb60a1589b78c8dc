//! Lights at a place: `--point-light` and `--disc-light`.

use super::Numbers;
use crate::technique::pathtrace::{Lamp, LampShape};
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::{fmt, str::FromStr};

/// `X,Y,Z[,R,G,B[,RADIUS]]`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct PointLightWord(Lamp);

/// `X,Y,Z,RADIUS[,R,G,B]`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct DiscLightWord(Lamp);

impl PointLightWord {
    /// The light.
    pub fn lamp(self) -> Lamp {
        self.0
    }
}

impl DiscLightWord {
    /// The light.
    pub fn lamp(self) -> Lamp {
        self.0
    }
}

fn checked(place: [f64; 3], srgb: [f64; 3], shape: LampShape) -> Result<Lamp, String> {
    if !srgb.iter().all(|c| (0.0..=1.0).contains(c)) {
        return Err("wanted a colour of numbers from 0 to 1".to_owned());
    }
    let radius = shape.radius().unwrap_or(0.0);
    let is_disc = matches!(shape, LampShape::Disc { .. });
    if radius < 0.0 || is_disc && radius == 0.0 {
        return Err(format!("wanted a radius over 0, found {radius}"));
    }
    let place = DVec3::from_array(place);
    Ok(Lamp { place, shape, srgb })
}

impl FromStr for PointLightWord {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (place, srgb, radius) = match text.matches(',').count() {
            2 => (Numbers::<3>::from_str(text)?.0, [1.0; 3], None),
            5 => {
                let [x, y, z, r, g, b] = Numbers::<6>::from_str(text)?.0;
                ([x, y, z], [r, g, b], None)
            }
            6 => {
                let [x, y, z, r, g, b, radius] = Numbers::<7>::from_str(text)?.0;
                ([x, y, z], [r, g, b], Some(radius))
            }
            _ => return Err("wanted X,Y,Z or X,Y,Z,R,G,B or X,Y,Z,R,G,B,RADIUS".to_owned()),
        };
        checked(place, srgb, LampShape::Sphere { radius }).map(Self)
    }
}

impl FromStr for DiscLightWord {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (place, radius, srgb) = match text.matches(',').count() {
            3 => {
                let [x, y, z, radius] = Numbers::<4>::from_str(text)?.0;
                ([x, y, z], radius, [1.0; 3])
            }
            6 => {
                let [x, y, z, radius, r, g, b] = Numbers::<7>::from_str(text)?.0;
                ([x, y, z], radius, [r, g, b])
            }
            _ => return Err("wanted X,Y,Z,RADIUS or X,Y,Z,RADIUS,R,G,B".to_owned()),
        };
        checked(place, srgb, LampShape::Disc { radius }).map(Self)
    }
}

impl fmt::Display for PointLightWord {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Lamp { place, shape, srgb } = self.0;
        Numbers(place.to_array()).fmt(f)?;
        let radius = shape.radius();
        if srgb != [1.0; 3] || radius.is_some() {
            write!(f, ",{}", Numbers(srgb))?;
        }
        radius.map_or(Ok(()), |radius| write!(f, ",{radius}"))
    }
}

impl fmt::Display for DiscLightWord {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Lamp { place, shape, srgb } = self.0;
        let radius = shape.radius().unwrap_or(0.0);
        write!(f, "{},{radius}", Numbers(place.to_array()))?;
        match srgb == [1.0; 3] {
            true => Ok(()),
            false => write!(f, ",{}", Numbers(srgb)),
        }
    }
}

impl TryFrom<String> for PointLightWord {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<PointLightWord> for String {
    fn from(word: PointLightWord) -> Self {
        word.to_string()
    }
}

impl TryFrom<String> for DiscLightWord {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<DiscLightWord> for String {
    fn from(word: DiscLightWord) -> Self {
        word.to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_light_at_a_place_comes_back_from_its_own_text() {
        for text in ["0.5,-1,2", "0,0,1,0.25,0.5,1", "1,2,3,1,1,1,0.5"] {
            let word: PointLightWord = text.parse().expect("a light");
            assert_eq!(word.to_string(), text);
        }
        for text in ["0.5,-1,2,3", "0,0,1,0.5,0.25,0.5,1"] {
            let word: DiscLightWord = text.parse().expect("a light");
            assert_eq!(word.to_string(), text);
        }
    }

    #[test]
    fn what_is_no_light_at_a_place_is_refused_with_a_reason() {
        for (text, wanted) in [
            ("1,2", "X,Y,Z,R,G,B,RADIUS"),
            ("1,2,3,4", "X,Y,Z,R,G,B,RADIUS"),
            ("1,0,0,2,0,0", "from 0 to 1"),
            ("1,0,up", "a number"),
            ("1,0,0,1,1,1,-1", "radius"),
        ] {
            let problem = text.parse::<PointLightWord>().expect_err("refused");
            assert!(problem.contains(wanted), "{text}: {problem}");
        }
        for (text, wanted) in [
            ("1,2,3", "X,Y,Z,RADIUS"),
            ("1,2,3,0", "radius over 0"),
            ("1,2,3,1,0,0,2", "from 0 to 1"),
        ] {
            let problem = text.parse::<DiscLightWord>().expect_err("refused");
            assert!(problem.contains(wanted), "{text}: {problem}");
        }
    }
}
