//! TopoJSON: lines of objects that share their parts.
//!
//! Bostock and Metcalf, "The TopoJSON Format Specification", version 1, 2013:
//!
//! ```text
//! topology    {"type": "Topology", "transform": {"scale": [a, b], "translate": [c, d]}, "objects": {name: object}, "arcs": [arc]}
//! arc         [[x, y], ...]     with a transform each but the first is a step from the one before, and
//!                               longitude = a x + c, latitude = b y + d
//! object      {"type": "LineString", "arcs": [i, ...]}, lists of these in others; ~i is arc i from its end
//! ```
//!
//! Lines are the arcs that objects use, each once, however many share it: a border between two areas is one line.

use super::{GeographicLine, checked, on_edges};
use crate::format::problem::invalid;
use crate::volume::Problem;
use serde::de::{DeserializeSeed, IgnoredAny, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};
use std::collections::BTreeMap;
use std::fmt;

/// The word of errors.
const TOPOJSON: &str = "topojson";

/// True where an object of JSON says that it is a topology.
pub(super) fn recognizes(text: &[u8]) -> bool {
    #[derive(Deserialize)]
    struct Named {
        r#type: String,
    }

    serde_json::from_slice(text).is_ok_and(|named: Named| named.r#type == "Topology")
}

/// All lines of the text.
pub(super) fn lines(text: &[u8]) -> Result<Vec<GeographicLine>, Problem> {
    let topology: Topology = serde_json::from_slice(text).map_err(|error| {
        let place = format!("line {}, column {}", error.line(), error.column());
        invalid(TOPOJSON, &place, "a topology", &error.to_string())
    })?;
    let mut is_used = vec![false; topology.arcs.len()];
    for object in topology.objects.values() {
        object.mark(&mut is_used)?;
    }
    let arcs = topology.arcs.into_iter().zip(is_used).enumerate();
    let used = arcs.filter(|(_, (arc, is_used))| *is_used && arc.len() > 1);
    let transform = topology.transform;
    let lines = used.map(|(index, (arc, _))| {
        let line = line_of(arc, transform.as_ref());
        line.map_err(|(found, wanted)| {
            invalid(
                TOPOJSON,
                &format!("arcs: {index}"),
                wanted,
                &found.to_string(),
            )
        })
    });
    let lines: Vec<GeographicLine> = lines.collect::<Result<_, _>>()?;
    if lines.is_empty() {
        return Err(invalid(TOPOJSON, "objects", "a line", "none"));
    }
    Ok(lines)
}

#[derive(Deserialize)]
struct Topology {
    #[serde(default)]
    transform: Option<Transform>,
    objects: BTreeMap<String, Object>,
    arcs: Vec<Vec<Position>>,
}

#[derive(Deserialize)]
struct Transform {
    scale: [f64; 2],
    translate: [f64; 2],
}

/// What arcs are put together to.
#[derive(Deserialize)]
struct Object {
    #[serde(rename = "type")]
    _kind: Option<Kind>,
    #[serde(default)]
    arcs: Indices,
    #[serde(default)]
    geometries: Vec<Object>,
}

#[derive(Deserialize)]
enum Kind {
    Point,
    MultiPoint,
    LineString,
    MultiLineString,
    Polygon,
    MultiPolygon,
    GeometryCollection,
}

impl Object {
    /// Notes the arcs that it uses.
    fn mark(&self, is_used: &mut [bool]) -> Result<(), Problem> {
        let count = is_used.len();
        for &index in &self.arcs.0 {
            let arc = if index < 0 { !index } else { index };
            let known = usize::try_from(arc)
                .ok()
                .and_then(|arc| is_used.get_mut(arc));
            let known = known.ok_or_else(|| {
                let wanted = format!("arcs of which there are {count}, counted from 0");
                invalid(TOPOJSON, "objects", wanted, &index.to_string())
            })?;
            *known = true;
        }
        self.geometries
            .iter()
            .try_for_each(|object| object.mark(is_used))
    }
}

/// In degrees; else what is wrong: a number, what would do.
fn line_of(
    arc: Vec<Position>,
    transform: Option<&Transform>,
) -> Result<GeographicLine, (f64, &'static str)> {
    let mut at = [0.0; 2];
    let place = |Position(position)| {
        let Some(Transform { scale, translate }) = transform else {
            return checked(position);
        };
        let ([x, y], [step_x, step_y]) = (at, position);
        let ([a, b], [c, d]) = (scale, translate);
        at = [x + step_x, y + step_y];
        let [x, y] = at;
        checked(on_edges([a * x + c, b * y + d]))
    };
    arc.into_iter().map(place).collect()
}

/// Two numbers; whatever there is more is passed over.
struct Position([f64; 2]);

impl<'de> Deserialize<'de> for Position {
    fn deserialize<D: Deserializer<'de>>(reader: D) -> Result<Self, D::Error> {
        struct Two;

        impl<'de> Visitor<'de> for Two {
            type Value = Position;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a position of two numbers")
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Position, A::Error> {
                let mut next = |index| {
                    let number = list.next_element()?;
                    number.ok_or_else(|| serde::de::Error::invalid_length(index, &self))
                };
                let position = [next(0)?, next(1)?];
                while let Some(IgnoredAny) = list.next_element()? {}
                Ok(Position(position))
            }
        }

        reader.deserialize_seq(Two)
    }
}

/// Numbers of arcs, in lists as deep as their object is.
#[derive(Default)]
struct Indices(Vec<i64>);

impl<'de> Deserialize<'de> for Indices {
    fn deserialize<D: Deserializer<'de>>(reader: D) -> Result<Self, D::Error> {
        let mut indices = Vec::new();
        Flat(&mut indices).deserialize(reader)?;
        Ok(Self(indices))
    }
}

struct Flat<'a>(&'a mut Vec<i64>);

impl<'de> DeserializeSeed<'de> for Flat<'_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, reader: D) -> Result<(), D::Error> {
        reader.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for Flat<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("whole numbers of arcs in lists")
    }

    fn visit_i64<E>(self, index: i64) -> Result<(), E> {
        self.0.push(index);
        Ok(())
    }

    fn visit_u64<E: serde::de::Error>(self, index: u64) -> Result<(), E> {
        let index = i64::try_from(index);
        let index = index.map_err(|_| E::custom("wanted numbers of arcs that are there"))?;
        self.0.push(index);
        Ok(())
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<(), A::Error> {
        while let Some(()) = list.next_element_seed(Flat(&mut *self.0))? {}
        Ok(())
    }
}
