//! Words of `--section`: which way planes face, and where they lie.

use super::{Error, Numbers};
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::{fmt, str::FromStr};

/// The planes of `--section`, one or more.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Planes(pub(super) Vec<Cuts>);

/// More have no room in a picture.
pub(super) const MOST_CUTS: u32 = 64;

/// One word of `--section`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cuts {
    pub plane: Plane,
    pub place: Place,
}

/// Where planes that face the same way lie.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Place {
    /// One, through the target.
    Target,
    /// So many, evenly from end to end.
    All(u32),
    /// One of so many, counted from 1.
    Nth(u32, u32),
    /// One, so far along the axis of its direction; `--at` says it, no word of `--section`.
    At(f64),
}

/// The direction that a plane faces.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs, reason = "the names say it")]
pub(super) enum Plane {
    Axial,
    Coronal,
    Sagittal,
    Normal(Numbers<3>),
}

impl Plane {
    /// The unit vector towards the eye. Radiologists look so that the patient's right is left in the picture; maps of
    /// the Earth have the east on the right.
    pub fn normal(self, is_earth: bool) -> Result<DVec3, Error> {
        match self {
            Self::Axial if is_earth => Ok(DVec3::Z),
            Self::Coronal if is_earth => Ok(DVec3::NEG_Y),
            Self::Axial => Ok(DVec3::NEG_Z),
            Self::Coronal => Ok(DVec3::Y),
            Self::Sagittal => Ok(DVec3::NEG_X),
            Self::Normal(Numbers(normal)) => DVec3::from(normal).try_normalize().ok_or_else(|| {
                Error::usage(
                    "--section 0,0,0: a plane needs a direction",
                    "--section 0,0,1 is seen from above",
                )
            }),
        }
    }

    /// The unit vector along which `--at` counts: an axis of the world, or the normal as it was given.
    pub fn axis(self, is_earth: bool) -> Result<DVec3, Error> {
        match self {
            Self::Axial => Ok(DVec3::Z),
            Self::Coronal => Ok(DVec3::Y),
            Self::Sagittal => Ok(DVec3::X),
            Self::Normal(_) => self.normal(is_earth),
        }
    }
}

impl FromStr for Planes {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        // A normal has commas of its own.
        let words: Result<Vec<Cuts>, String> = match text.parse() {
            Ok(cuts) => Ok(vec![cuts]),
            Err(problem) if text.contains(',') => {
                let all: Result<_, String> = text.split(',').map(str::parse).collect();
                all.map_err(|_| problem)
            }
            Err(problem) => Err(problem),
        };
        let words = words?;
        let count = words.iter().map(|cuts| cuts.count()).sum::<u32>();
        if count > MOST_CUTS {
            return Err(format!("wanted at most {MOST_CUTS} planes, found {count}"));
        }
        Ok(Self(words))
    }
}

impl Cuts {
    fn count(self) -> u32 {
        match self.place {
            Place::Target | Place::Nth(..) | Place::At(_) => 1,
            Place::All(count) => count,
        }
    }

    /// Each plane by itself.
    pub fn each(self) -> Vec<Self> {
        match self.place {
            Place::Target | Place::Nth(..) | Place::At(_) => vec![self],
            Place::All(count) => {
                let nth = |nth| Self {
                    place: Place::Nth(nth, count),
                    ..self
                };
                (1..=count).map(nth).collect()
            }
        }
    }
}

impl FromStr for Cuts {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        const WANTED: &str = "wanted axial, coronal, sagittal, several of them with commas between, or the normal NX,NY,NZ of a \
            plane; axial:12 for twelve, axial:3/12 for the third of them";
        let (plane, place) = match text.split_once(':') {
            None => (text, Some(Place::Target)),
            Some((plane, place)) => (plane, place_of(place)),
        };
        Ok(Self {
            plane: plane.parse().map_err(|_| WANTED.to_owned())?,
            place: place.ok_or_else(|| WANTED.to_owned())?,
        })
    }
}

/// `12` or `3/12`.
fn place_of(text: &str) -> Option<Place> {
    let number = |text: &str| text.parse().ok().filter(|n| (1..=MOST_CUTS).contains(n));
    match text.split_once('/') {
        // More than there may be is said with their sum.
        None => text
            .parse()
            .ok()
            .filter(|&n| n > 0 && n < 1 << 16)
            .map(Place::All),
        Some((nth, count)) => {
            let (nth, count) = (number(nth)?, number(count)?);
            (nth <= count).then_some(Place::Nth(nth, count))
        }
    }
}

impl fmt::Display for Cuts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.plane.fmt(f)?;
        match self.place {
            Place::Target | Place::At(_) => Ok(()),
            Place::All(count) => write!(f, ":{count}"),
            Place::Nth(nth, count) => write!(f, ":{nth}/{count}"),
        }
    }
}

impl fmt::Display for Planes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, cuts) in self.0.iter().enumerate() {
            let comma = if i > 0 { "," } else { "" };
            write!(f, "{comma}{cuts}")?;
        }
        Ok(())
    }
}

impl FromStr for Plane {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "axial" => Ok(Self::Axial),
            "coronal" => Ok(Self::Coronal),
            "sagittal" => Ok(Self::Sagittal),
            _ => text.parse().map(Self::Normal),
        }
    }
}

impl fmt::Display for Plane {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Axial => f.write_str("axial"),
            Self::Coronal => f.write_str("coronal"),
            Self::Sagittal => f.write_str("sagittal"),
            Self::Normal(normal) => normal.fmt(f),
        }
    }
}

impl TryFrom<String> for Planes {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<Planes> for String {
    fn from(planes: Planes) -> Self {
        planes.to_string()
    }
}
