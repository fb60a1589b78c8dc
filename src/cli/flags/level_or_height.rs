//! Where something lies over the ground: `3`, a level counted from 0 at the lowest, or a height, `500m`, `1.5km`, `850hPa`.

use crate::cli::Error;
use crate::flow::height_of_pressure;
use crate::volume::{Header, Heights};
use glam::DVec3;
use std::{fmt, str::FromStr};

/// A level of the grid as it is drawn, or a height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LevelOrHeight {
    /// Counted from 0 at the lowest.
    Level(u32),
    /// Above sea level, m.
    Metres(f64),
    /// Where it lies in the standard atmosphere, Pa.
    Pascals(f64),
}

/// Units, and how many metres or pascals they are.
const METRES: [(&str, f64); 2] = [("km", 1e3), ("m", 1.0)];
const PASCALS: [(&str, f64); 2] = [("hPa", 100.0), ("Pa", 1.0)];

impl LevelOrHeight {
    /// Its height in the world before heights are exaggerated, of a grid whose third axis is upright.
    ///
    /// # Errors
    /// Where the grid has no such level, or no such heights; `flag` is what asks.
    pub fn world_height(self, header: &Header, flag: &str) -> Result<f64, Error> {
        let refused = |problem: String| {
            Error::usage(
                format!("{flag} {self}: {problem}"),
                format!("{flag} 0 is the lowest level"),
            )
        };
        match self {
            Self::Level(level) => {
                let count = header.dims[2];
                if level >= count {
                    return Err(refused(format!("wanted a level from 0 to {}", count - 1)));
                }
                let is_rising = header.world_from_voxel.matrix3.z_axis.z > 0.0;
                let voxel = if is_rising { level } else { count - 1 - level };
                let middle = DVec3::new(0.5, 0.5, f64::from(voxel) + 0.5);
                Ok(header.world_from_voxel.transform_point3(middle).z)
            }
            Self::Metres(_) | Self::Pascals(_) if header.heights == Heights::Levels => {
                Err(refused(format!(
                    "levels of the input are only numbers: wanted one from 0 to {}",
                    header.dims[2].saturating_sub(1)
                )))
            }
            Self::Metres(_) if header.heights == Heights::Pressures => Err(refused(
                "heights of the input are pressures: wanted such as 850hPa".to_owned(),
            )),
            Self::Pascals(_) if header.heights != Heights::Pressures => Err(refused(
                "heights of the input are no pressures: wanted such as 1500m".to_owned(),
            )),
            Self::Metres(metres) => match header.length_metres {
                Some(unit) => Ok(metres / unit),
                None => Err(refused("lengths of the input have no unit".to_owned())),
            },
            Self::Pascals(pascals) => {
                let metres = height_of_pressure(pascals);
                let metres =
                    metres.ok_or_else(|| refused("wanted a pressure over 0".to_owned()))?;
                Ok(metres / header.length_metres.unwrap_or(1e3))
            }
        }
    }
}

impl LevelOrHeight {
    /// As a person writes it: `level 3`, `1.5 km`, `850 hPa`.
    pub fn words(self) -> String {
        match self {
            Self::Level(level) => format!("level {level}"),
            Self::Metres(metres) if metres.abs() >= 1e3 => format!("{} km", 1e-3 * metres),
            Self::Metres(metres) => format!("{metres} m"),
            Self::Pascals(pascals) => format!("{} hPa", 0.01 * pascals),
        }
    }
}

impl FromStr for LevelOrHeight {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wanted = || {
            format!(
                "wanted a level such as 0, or a height such as 500m, 1.5km or 850hPa, found {text:?}"
            )
        };
        if let Ok(level) = text.parse() {
            return Ok(Self::Level(level));
        }
        let of = |units: [(&str, f64); 2]| {
            let mut numbers = units.into_iter().filter_map(|(unit, factor)| {
                let number: f64 = text.strip_suffix(unit)?.trim().parse().ok()?;
                Some(number * factor)
            });
            numbers.next().filter(|number| number.is_finite())
        };
        match (of(METRES), of(PASCALS)) {
            (Some(metres), _) => Ok(Self::Metres(metres)),
            (None, Some(pascals)) if pascals > 0.0 => Ok(Self::Pascals(pascals)),
            _ => Err(wanted()),
        }
    }
}

impl fmt::Display for LevelOrHeight {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Level(level) => write!(f, "{level}"),
            Self::Metres(metres) if metres.abs() >= 1e3 => write!(f, "{}km", 1e-3 * metres),
            Self::Metres(metres) => write!(f, "{metres}m"),
            Self::Pascals(pascals) => write!(f, "{}hPa", 0.01 * pascals),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::volume::{Format, VoxelType};
    use glam::DAffine3;

    #[test]
    fn words_are_levels_and_heights_and_come_back() {
        for (text, wanted) in [
            ("0", LevelOrHeight::Level(0)),
            ("12", LevelOrHeight::Level(12)),
            ("10m", LevelOrHeight::Metres(10.0)),
            ("1.5km", LevelOrHeight::Metres(1500.0)),
            ("850hPa", LevelOrHeight::Pascals(85_000.0)),
            ("500Pa", LevelOrHeight::Pascals(500.0)),
        ] {
            let found: LevelOrHeight = text.parse().expect(text);
            assert_eq!(found, wanted);
            assert_eq!(found.to_string().parse(), Ok(wanted));
        }
        assert_eq!(LevelOrHeight::Metres(1500.0).words(), "1.5 km");
        assert_eq!(LevelOrHeight::Pascals(85_000.0).words(), "850 hPa");
        for text in ["", "-1", "1.5", "hPa", "-3hPa", "infm", "3 mi"] {
            assert!(text.parse::<LevelOrHeight>().is_err(), "{text}");
        }
    }

    #[test]
    fn heights_are_those_of_the_grid() {
        let up = DAffine3 {
            matrix3: glam::DMat3::from_diagonal(DVec3::new(2.0, 2.0, 0.5)),
            translation: DVec3::new(0.0, 0.0, 1.0),
        };
        let mut header = Header::new(Format::NetCdf, [4, 4, 6], VoxelType::F32, up);
        header.length_metres = Some(1e3);
        let of = |header: &Header, text: &str| {
            let word: LevelOrHeight = text.parse().expect(text);
            word.world_height(header, "--barbs").ok()
        };
        assert_eq!(of(&header, "0"), Some(1.25));
        assert_eq!(of(&header, "5"), Some(3.75));
        assert_eq!(of(&header, "6"), None);
        assert_eq!(of(&header, "500m"), Some(0.5));
        assert_eq!(of(&header, "850hPa"), None);
        // Levels fall: the last is the lowest.
        header.world_from_voxel.matrix3.z_axis.z = -0.5;
        assert_eq!(of(&header, "0"), Some(-1.75));
        header.heights = Heights::Levels;
        assert_eq!(of(&header, "0"), Some(-1.75));
        assert_eq!((of(&header, "500m"), of(&header, "850hPa")), (None, None));
        header.heights = Heights::Pressures;
        assert_eq!(of(&header, "500m"), None);
        let found = of(&header, "850hPa").expect("a height");
        // 850 hPa lie at 1457 m.
        assert!((found - 1.4573).abs() < 1e-3, "{found}");
    }
}
