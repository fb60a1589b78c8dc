//! GeoJSON: the lines of geometries, features and collections of them.
//!
//! RFC 7946, "The GeoJSON Format", 2016, section 3:
//!
//! ```text
//! position   [longitude, latitude, ...]
//! line       [position, position, ...]      LineString
//! lines      [line, ...]                    MultiLineString, Polygon (its rings)
//! areas      [lines, ...]                   MultiPolygon
//! ```
//!
//! Lines are taken out as the text is read: no tree of it is made. Members that say nothing of lines are passed over, and so
//! are geometries of points.

mod coordinates;

use super::GeographicLine;
use crate::format::problem::{escape, invalid};
use crate::volume::Problem;
use coordinates::Coordinates;
use serde::de::{DeserializeSeed, IgnoredAny, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};
use std::fmt;

/// The word of errors.
const GEOJSON: &str = "geojson";

/// All lines of the text.
pub(super) fn lines(text: &[u8]) -> Result<Vec<GeographicLine>, Problem> {
    let mut reader = serde_json::Deserializer::from_slice(text);
    let read = Object(Role::Any).deserialize(&mut reader);
    let read = read.and_then(|lines| reader.end().map(|()| lines));
    let lines = read.map_err(|error| problem(&error))?;
    if lines.is_empty() {
        return Err(invalid(GEOJSON, "coordinates", "a line", "none"));
    }
    Ok(lines)
}

/// Between what was wanted and what was found, in errors of ours.
const FOUND: &str = ", found ";

/// `wanted` and `found` in the error of a reader.
fn wrong<E: serde::de::Error>(wanted: &str, found: &str) -> E {
    E::custom(format!("{wanted}{FOUND}{}", escape(found)))
}

/// A sentence of ours from one of the parser's.
fn problem(error: &serde_json::Error) -> Problem {
    let (line, column) = (error.line(), error.column());
    let text = error.to_string();
    let place = format!(" at line {line} column {column}");
    let text = text.strip_suffix(&place).unwrap_or(&text);
    let (wanted, found) = match text.split_once(FOUND) {
        Some((wanted, found)) if error.is_data() => (wanted.to_owned(), found.to_owned()),
        _ => ("GeoJSON".to_owned(), text.to_owned()),
    };
    let place = format!("line {line}, column {column}");
    invalid(GEOJSON, &place, wanted, &found)
}

/// What an object may be, by what it stands in.
#[derive(Clone, Copy, PartialEq)]
enum Role {
    Any,
    Feature,
    Geometry,
}

/// What an object says it is.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    /// With so many lists around a number; 0 where there may be no line.
    Geometry {
        name: &'static str,
        depth: u32,
    },
    GeometryCollection,
    Feature,
    FeatureCollection,
}

const GEOMETRIES: [(&str, u32); 6] = [
    ("Point", 1),
    ("MultiPoint", 2),
    ("LineString", 2),
    ("MultiLineString", 3),
    ("Polygon", 3),
    ("MultiPolygon", 4),
];

impl Kind {
    fn of(text: &str) -> Option<Self> {
        let geometry = GEOMETRIES.iter().find(|(name, _)| *name == text);
        match (geometry, text) {
            (Some(&(name, depth)), _) => Some(Self::Geometry { name, depth }),
            (None, "GeometryCollection") => Some(Self::GeometryCollection),
            (None, "Feature") => Some(Self::Feature),
            (None, "FeatureCollection") => Some(Self::FeatureCollection),
            _ => None,
        }
    }

    fn may_be(self, role: Role) -> bool {
        match role {
            Role::Any => true,
            Role::Feature => self == Self::Feature,
            Role::Geometry => matches!(self, Self::Geometry { .. } | Self::GeometryCollection),
        }
    }
}

impl Role {
    fn wanted(self) -> &'static str {
        match self {
            Self::Any => {
                "`type` FeatureCollection, Feature, GeometryCollection or that of a geometry"
            }
            Self::Feature => "`type` Feature",
            Self::Geometry => "`type` of a geometry, such as LineString",
        }
    }
}

/// Reads an object to its lines.
struct Object(Role);

impl<'de> DeserializeSeed<'de> for Object {
    type Value = Vec<GeographicLine>;

    fn deserialize<D: Deserializer<'de>>(self, reader: D) -> Result<Self::Value, D::Error> {
        reader.deserialize_map(self)
    }
}

impl<'de> Visitor<'de> for Object {
    type Value = Vec<GeographicLine>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "an object with {}", self.0.wanted())
    }

    fn visit_map<A: MapAccess<'de>>(self, mut members: A) -> Result<Self::Value, A::Error> {
        let mut kind = None;
        let mut coordinates = None;
        let (mut geometry, mut geometries, mut features) = (None, None, None);
        while let Some(name) = members.next_key::<Name>()? {
            let is_twice = match name {
                Name::Type => {
                    let text: String = members.next_value()?;
                    let found = Kind::of(&text).filter(|kind| kind.may_be(self.0));
                    let found = found.ok_or_else(|| wrong(self.0.wanted(), &text))?;
                    kind.replace(found).is_some()
                }
                Name::Coordinates => coordinates.replace(members.next_value()?).is_some(),
                Name::Geometry => geometry
                    .replace(members.next_value_seed(MaybeGeometry)?)
                    .is_some(),
                Name::Geometries => geometries
                    .replace(members.next_value_seed(List(Role::Geometry))?)
                    .is_some(),
                Name::Features => features
                    .replace(members.next_value_seed(List(Role::Feature))?)
                    .is_some(),
                Name::Other => {
                    let IgnoredAny = members.next_value()?;
                    false
                }
            };
            if is_twice {
                return Err(wrong("each member once", name.text()));
            }
        }
        let kind = kind.ok_or_else(|| wrong(self.0.wanted(), "none"))?;
        let missing = |member: &str| wrong(&format!("`{member}`"), "none");
        match kind {
            Kind::Geometry { name, depth } => {
                let found: Coordinates = coordinates.ok_or_else(|| missing("coordinates"))?;
                let lines = found.lines(name, depth);
                lines.map_err(|(wanted, found)| wrong(&wanted, &found))
            }
            Kind::GeometryCollection => geometries.ok_or_else(|| missing("geometries")),
            Kind::Feature => geometry.ok_or_else(|| missing("geometry")),
            Kind::FeatureCollection => features.ok_or_else(|| missing("features")),
        }
    }
}

/// Members that say something of lines.
#[derive(Clone, Copy)]
enum Name {
    Type,
    Coordinates,
    Geometry,
    Geometries,
    Features,
    Other,
}

impl Name {
    fn text(self) -> &'static str {
        match self {
            Self::Type => "`type` twice",
            Self::Coordinates => "`coordinates` twice",
            Self::Geometry => "`geometry` twice",
            Self::Geometries => "`geometries` twice",
            Self::Features => "`features` twice",
            Self::Other => "another twice",
        }
    }
}

impl<'de> Deserialize<'de> for Name {
    fn deserialize<D: Deserializer<'de>>(reader: D) -> Result<Self, D::Error> {
        struct Text;

        impl Visitor<'_> for Text {
            type Value = Name;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("the name of a member")
            }

            fn visit_str<E>(self, text: &str) -> Result<Name, E> {
                Ok(match text {
                    "type" => Name::Type,
                    "coordinates" => Name::Coordinates,
                    "geometry" => Name::Geometry,
                    "geometries" => Name::Geometries,
                    "features" => Name::Features,
                    _ => Name::Other,
                })
            }
        }

        reader.deserialize_identifier(Text)
    }
}

/// A geometry, or null where a feature has none.
struct MaybeGeometry;

impl<'de> DeserializeSeed<'de> for MaybeGeometry {
    type Value = Vec<GeographicLine>;

    fn deserialize<D: Deserializer<'de>>(self, reader: D) -> Result<Self::Value, D::Error> {
        reader.deserialize_option(self)
    }
}

impl<'de> Visitor<'de> for MaybeGeometry {
    type Value = Vec<GeographicLine>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a geometry or null")
    }

    fn visit_none<E>(self) -> Result<Self::Value, E> {
        Ok(Vec::new())
    }

    fn visit_unit<E>(self) -> Result<Self::Value, E> {
        Ok(Vec::new())
    }

    fn visit_some<D: Deserializer<'de>>(self, reader: D) -> Result<Self::Value, D::Error> {
        Object(Role::Geometry).deserialize(reader)
    }
}

/// The lines of all objects of a list.
struct List(Role);

impl<'de> DeserializeSeed<'de> for List {
    type Value = Vec<GeographicLine>;

    fn deserialize<D: Deserializer<'de>>(self, reader: D) -> Result<Self::Value, D::Error> {
        reader.deserialize_seq(self)
    }
}

impl<'de> Visitor<'de> for List {
    type Value = Vec<GeographicLine>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "a list of objects with {}", self.0.wanted())
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut objects: A) -> Result<Self::Value, A::Error> {
        let mut lines = Vec::new();
        while let Some(mut more) = objects.next_element_seed(Object(self.0))? {
            lines.append(&mut more);
        }
        Ok(lines)
    }
}
