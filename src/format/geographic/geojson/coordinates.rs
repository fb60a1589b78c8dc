//! Coordinates of GeoJSON: lists in lists of numbers, as deep as their geometry is.

use super::super::{GeographicLine, checked};
use super::wrong;
use serde::de::{IgnoredAny, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};
use std::fmt;

/// What a list of lists is, by how many lists are around a number.
#[derive(Debug, PartialEq)]
pub(super) enum Coordinates {
    /// Of whatever depth.
    Empty,
    Number(f64),
    Position([f64; 2]),
    Line(GeographicLine),
    /// Lists of lines, or with another list around of areas.
    Lines {
        depth: u32,
        lines: Vec<GeographicLine>,
    },
}

/// Lists around a number of lines of areas.
const DEEPEST: u32 = 4;

impl Coordinates {
    fn depth(&self) -> Option<u32> {
        match self {
            Self::Empty => None,
            Self::Number(_) => Some(0),
            Self::Position(_) => Some(1),
            Self::Line(_) => Some(2),
            Self::Lines { depth, .. } => Some(*depth),
        }
    }

    /// The lines of a geometry of this name, which has so many lists around a number; else what was wanted and found.
    pub fn lines(self, name: &str, wanted: u32) -> Result<Vec<GeographicLine>, (String, String)> {
        let found = self.depth();
        if found.is_some_and(|found| found != wanted) {
            let lists = |depth: u32| format!("{depth} lists around each number");
            return Err((
                format!("`coordinates` of a {name} with {}", lists(wanted)),
                lists(found.unwrap_or(0)),
            ));
        }
        match self {
            Self::Line(line) if name == "LineString" => match line.len() {
                1 => Err((
                    "`coordinates` of a LineString with two positions".to_owned(),
                    "one".to_owned(),
                )),
                _ => Ok(vec![line]),
            },
            Self::Lines { lines, .. } => Ok(lines),
            _ => Ok(Vec::new()),
        }
    }
}

impl<'de> Deserialize<'de> for Coordinates {
    fn deserialize<D: Deserializer<'de>>(reader: D) -> Result<Self, D::Error> {
        reader.deserialize_any(Nested)
    }
}

struct Nested;

const WANTED: &str = "`coordinates` as numbers or lists of one depth";

impl<'de> Visitor<'de> for Nested {
    type Value = Coordinates;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(WANTED)
    }

    fn visit_f64<E>(self, number: f64) -> Result<Coordinates, E> {
        Ok(Coordinates::Number(number))
    }

    fn visit_i64<E>(self, number: i64) -> Result<Coordinates, E> {
        Ok(Coordinates::Number(number as f64))
    }

    fn visit_u64<E>(self, number: u64) -> Result<Coordinates, E> {
        Ok(Coordinates::Number(number as f64))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Coordinates, A::Error> {
        // A ring or an area without anything in it says nothing.
        let first = loop {
            match list.next_element()? {
                Some(Coordinates::Empty) => {}
                Some(first) => break first,
                None => return Ok(Coordinates::Empty),
            }
        };
        match first {
            Coordinates::Empty => Ok(Coordinates::Empty),
            Coordinates::Number(longitude) => position(longitude, list),
            Coordinates::Position(first) => {
                let mut line = vec![first];
                while let Some(next) = list.next_element()? {
                    match next {
                        Coordinates::Position(place) => line.push(place),
                        _ => return Err(wrong("positions only in a line", "something else")),
                    }
                }
                Ok(Coordinates::Line(line))
            }
            Coordinates::Line(first) => {
                let mut lines = Vec::new();
                push(&mut lines, first);
                while let Some(next) = list.next_element()? {
                    match next {
                        Coordinates::Line(line) => push(&mut lines, line),
                        Coordinates::Empty => {}
                        _ => return Err(wrong(WANTED, "several depths")),
                    }
                }
                Ok(Coordinates::Lines { depth: 3, lines })
            }
            Coordinates::Lines { depth, mut lines } => {
                let around = depth.saturating_add(1);
                if around > DEEPEST {
                    return Err(wrong("`coordinates` of four lists at most", "five"));
                }
                while let Some(next) = list.next_element()? {
                    match next {
                        Coordinates::Lines {
                            depth: other,
                            lines: mut more,
                        } if other == depth => lines.append(&mut more),
                        Coordinates::Empty => {}
                        _ => return Err(wrong(WANTED, "several depths")),
                    }
                }
                Ok(Coordinates::Lines {
                    depth: around,
                    lines,
                })
            }
        }
    }
}

/// A point is no line.
fn push(lines: &mut Vec<GeographicLine>, line: GeographicLine) {
    if line.len() > 1 {
        lines.push(line);
    }
}

fn position<'de, A: SeqAccess<'de>>(longitude: f64, mut list: A) -> Result<Coordinates, A::Error> {
    let Some(Coordinates::Number(latitude)) = list.next_element()? else {
        return Err(wrong("a position of longitude and latitude", "one number"));
    };
    // Heights, and whatever there is more.
    while let Some(IgnoredAny) = list.next_element()? {}
    let place = checked([longitude, latitude]);
    place
        .map(Coordinates::Position)
        .map_err(|(found, wanted)| wrong(wanted, &found.to_string()))
}
