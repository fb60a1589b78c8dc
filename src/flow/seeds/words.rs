//! The words of `--flow-seeds`.
//!
//! ```text
//! even[:D]   grid:NX,NY,NZ   random:N[,SEED]   plane:x|y|z=V,N   rake:X,Y,Z,X,Y,Z,N   where:VAR>V,N   FILE.csv
//! ```

use super::choice::Comparison;
use glam::DVec3;
use std::fmt::Write;
use std::path::PathBuf;
use std::str::FromStr;

/// More seeds are no picture.
const MOST: u32 = 1_000_000;

/// An axis of the world.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "the names say it")]
pub enum Axis {
    X,
    Y,
    Z,
}

/// How seeds are chosen.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Seeds {
    /// Lines at an even distance from each other.
    #[default]
    Even,
    /// The same at this distance, in the world as it is seen.
    EvenAt(f64),
    /// So many along each axis of the grid.
    Grid([u32; 3]),
    /// Anywhere in the box.
    Random {
        /// How many.
        count: u32,
        /// Another number gives others.
        seed: u32,
    },
    /// On a plane of the world, `count` times `count`.
    Plane {
        /// The axis across it.
        axis: Axis,
        /// Where on that axis, world.
        at: f64,
        /// Along each side.
        count: u32,
    },
    /// On a straight line.
    Rake {
        /// The first place, world.
        from: DVec3,
        /// The last place, world.
        to: DVec3,
        /// How many.
        count: u32,
    },
    /// In random voxels where a variable is over, or under, a threshold.
    Where {
        /// The name of the variable.
        variable: String,
        /// Over or under.
        comparison: Comparison,
        /// The threshold.
        threshold: f64,
        /// How many.
        count: u32,
    },
    /// Those of a file.
    File(PathBuf),
}

/// Why words are no seeds.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SeedsError {
    /// No way of choosing has that name.
    #[error(
        "wanted even, grid:NX,NY,NZ, random:N, plane:z=V,N, rake:X,Y,Z,X,Y,Z,N, where:VAR>V,N or a file .csv, found {0}"
    )]
    Unknown(String),
    /// What follows the name is something else.
    #[error("{way}: wanted {wanted}, found {found}")]
    Wrong {
        /// The name.
        way: &'static str,
        /// What follows it.
        wanted: &'static str,
        /// What was found.
        found: String,
    },
    /// More than there may be.
    #[error("wanted at most {MOST} seeds, found {0}")]
    TooMany(u64),
}

impl Seeds {
    /// How many there are at most; `None` where a field or a file says.
    pub fn count(&self) -> Option<u64> {
        match *self {
            Self::Even | Self::EvenAt(_) | Self::File(_) => None,
            Self::Grid(counts) => Some(
                counts
                    .into_iter()
                    .map(u64::from)
                    .fold(1, u64::saturating_mul),
            ),
            Self::Random { count, .. } | Self::Rake { count, .. } | Self::Where { count, .. } => {
                Some(count.into())
            }
            Self::Plane { count, .. } => Some(u64::from(count) * u64::from(count)),
        }
    }
}

impl FromStr for Seeds {
    type Err = SeedsError;

    fn from_str(text: &str) -> Result<Self, SeedsError> {
        let (way, rest) = text.split_once(':').unwrap_or((text, ""));
        let ends_in_csv = text.to_ascii_lowercase().ends_with(".csv");
        let seeds = match way {
            "even" if rest.is_empty() && !text.contains(':') => Ok(Self::Even),
            "even" => even(rest).ok_or(("even", "a distance over 0")),
            "grid" => grid(rest).ok_or(("grid", "three whole numbers of 1 and more, NX,NY,NZ")),
            "random" => random(rest).ok_or(("random", "whole numbers N or N,SEED, N at least 1")),
            "plane" => plane(rest).ok_or(("plane", "x=V,N, y=V,N or z=V,N, N at least 1")),
            "rake" => rake(rest).ok_or(("rake", "two places and a whole number, X,Y,Z,X,Y,Z,N")),
            "where" => chosen(rest).ok_or(("where", "VAR>V,N or VAR<V,N, N at least 1")),
            _ if ends_in_csv => Ok(Self::File(text.into())),
            _ => return Err(SeedsError::Unknown(shown(text))),
        };
        let seeds = seeds.map_err(|(way, wanted)| SeedsError::Wrong {
            way,
            wanted,
            found: shown(rest),
        })?;
        match seeds.count() {
            Some(count) if count > MOST.into() => Err(SeedsError::TooMany(count)),
            _ => Ok(seeds),
        }
    }
}

/// A text as a message repeats it.
fn shown(text: &str) -> String {
    let mut shown = String::new();
    let _ = write!(shown, "{:?}", text.chars().take(80).collect::<String>());
    shown
}

fn finite(text: &str) -> Option<f64> {
    text.trim().parse().ok().filter(|n: &f64| n.is_finite())
}

fn count(text: &str) -> Option<u32> {
    text.trim().parse().ok().filter(|&n| n > 0)
}

fn even(text: &str) -> Option<Seeds> {
    finite(text).filter(|&d| d > 0.0).map(Seeds::EvenAt)
}

fn grid(text: &str) -> Option<Seeds> {
    let counts: Option<Vec<u32>> = text.split(',').map(count).collect();
    Some(Seeds::Grid(counts?.try_into().ok()?))
}

fn random(text: &str) -> Option<Seeds> {
    let (first, seed) = match text.split_once(',') {
        None => (text, 0),
        Some((first, seed)) => (first, seed.trim().parse().ok()?),
    };
    let count = count(first)?;
    Some(Seeds::Random { count, seed })
}

fn plane(text: &str) -> Option<Seeds> {
    let (axis, rest) = text.split_once('=')?;
    let (at, number) = rest.split_once(',')?;
    let axis = match axis.trim() {
        "x" => Axis::X,
        "y" => Axis::Y,
        "z" => Axis::Z,
        _ => return None,
    };
    Some(Seeds::Plane {
        axis,
        at: finite(at)?,
        count: count(number)?,
    })
}

fn rake(text: &str) -> Option<Seeds> {
    let (places, number) = text.rsplit_once(',')?;
    let places: Option<Vec<f64>> = places.split(',').map(finite).collect();
    let [a, b, c, d, e, f]: [f64; 6] = places?.try_into().ok()?;
    Some(Seeds::Rake {
        from: DVec3::new(a, b, c),
        to: DVec3::new(d, e, f),
        count: count(number)?,
    })
}

fn chosen(text: &str) -> Option<Seeds> {
    let at = text.rfind(['>', '<'])?;
    let (variable, rest) = text.split_at(at);
    let (threshold, number) = rest[1..].split_once(',')?;
    let variable = variable.trim();
    if variable.is_empty() {
        return None;
    }
    Some(Seeds::Where {
        variable: variable.to_owned(),
        comparison: match rest.starts_with('>') {
            true => Comparison::Over,
            false => Comparison::Under,
        },
        threshold: finite(threshold)?,
        count: count(number)?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_way_is_understood() {
        let parsed = |text: &str| {
            text.parse::<Seeds>()
                .unwrap_or_else(|e| panic!("{text}: {e}"))
        };
        assert_eq!(parsed("even"), Seeds::Even);
        assert_eq!(parsed("even:2.5"), Seeds::EvenAt(2.5));
        assert_eq!(parsed("grid:3,4,5"), Seeds::Grid([3, 4, 5]));
        let random = |count, seed| Seeds::Random { count, seed };
        assert_eq!(parsed("random:9"), random(9, 0));
        assert_eq!(parsed("random:9,4"), random(9, 4));
        let plane = Seeds::Plane {
            axis: Axis::Z,
            at: -1.5,
            count: 8,
        };
        assert_eq!(parsed("plane:z=-1.5,8"), plane);
        let rake = Seeds::Rake {
            from: DVec3::new(0.0, 1.0, 2.0),
            to: DVec3::new(-3.0, 4.0, 5.0),
            count: 7,
        };
        assert_eq!(parsed("rake:0,1,2,-3,4,5,7"), rake);
        let updraft = Seeds::Where {
            variable: "W".to_owned(),
            comparison: Comparison::Over,
            threshold: 5.0,
            count: 100,
        };
        assert_eq!(parsed("where:W>5,100"), updraft);
        assert_eq!(parsed("a/seeds.csv"), Seeds::File("a/seeds.csv".into()));
    }

    #[test]
    fn what_is_wrong_is_said_with_what_was_wanted_and_found() {
        for (text, wanted, found) in [
            ("even:0", "a distance over 0", "\"0\""),
            ("even:", "a distance", "\"\""),
            ("grid:3,4", "NX,NY,NZ", "\"3,4\""),
            ("grid:3,4,0", "1 and more", "\"3,4,0\""),
            ("random:-1", "N at least 1", "\"-1\""),
            ("plane:w=1,2", "x=V,N", "\"w=1,2\""),
            ("rake:1,2,3,4,5,7", "two places", "\"1,2,3,4,5,7\""),
            ("where:W=5,100", "VAR>V,N", "\"W=5,100\""),
            ("where:W>nan,1", "VAR>V,N", "\"W>nan,1\""),
            ("circle:4", "wanted even, grid", "\"circle:4\""),
            ("plane:z=0,2000", "at most 1000000", "4000000"),
            (
                "grid:4000000000,4000000000,1",
                "at most",
                "16000000000000000000",
            ),
        ] {
            let said = text.parse::<Seeds>().expect_err(text).to_string();
            assert!(
                said.contains(wanted) && said.contains(found),
                "{text}: {said}"
            );
        }
    }
}
