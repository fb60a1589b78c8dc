//! STL, stereolithography (3D Systems 1988): triangles that share no corners, in bytes or in words.
//!
//! ```text
//! bytes   80 of text  <count  of each triangle: <normal  <3 corners, all of f32,  two bytes more
//! words   solid NAME  { facet normal x y z  outer loop  { vertex x y z } x 3  endloop  endfacet }  endsolid NAME
//! ```
//!
//! Files of bytes may begin with `solid` too: those are of bytes whose length is what their count makes it. Normals are those of
//! the corners; the two bytes, where some programs put a colour, are passed over.

use super::{Corner, Parts};
use crate::format::convert::to_u64;
use crate::format::problem::{invalid, unsupported};
use crate::format::text::number;
use crate::volume::{Limits, Problem};
use glam::DVec3;

/// The word of errors.
const STL: &str = "stl";
const HEADER_BYTES: usize = 84;
const TRIANGLE_BYTES: usize = 50;
/// Of a triangle, behind its normal.
const CORNERS_AT: usize = 12;

/// The triangles of a file.
pub(super) fn read(bytes: &[u8], limits: &Limits) -> Result<Parts, Problem> {
    let promise = bytes.get(80..).and_then(|rest| rest.first_chunk::<4>());
    let promise = promise.map(|count| u32::from_le_bytes(*count));
    let promised_bytes = |count: u32| {
        let triangles = u64::from(count).saturating_mul(to_u64(TRIANGLE_BYTES));
        triangles.saturating_add(to_u64(HEADER_BYTES))
    };
    let found = to_u64(bytes.len());
    match promise {
        Some(count) if promised_bytes(count) == found => of_bytes(bytes, limits),
        _ if bytes.trim_ascii_start().starts_with(b"solid") => of_words(bytes, limits),
        Some(count) => {
            let wanted = format!(
                "the {} bytes that {count} triangles take, or a text that begins with solid",
                promised_bytes(count)
            );
            Err(invalid(STL, "length", wanted, &format!("{found} bytes")))
        }
        None => {
            let wanted = format!("{HEADER_BYTES} bytes at least, or a text that begins with solid");
            Err(invalid(STL, "length", wanted, &format!("{found} bytes")))
        }
    }
}

fn of_bytes(bytes: &[u8], limits: &Limits) -> Result<Parts, Problem> {
    let mut parts = Parts::new(STL, limits);
    let triangles = bytes.get(HEADER_BYTES..).unwrap_or_default();
    for triangle in triangles.chunks_exact(TRIANGLE_BYTES) {
        let (numbers, _) = triangle
            .get(CORNERS_AT..)
            .unwrap_or_default()
            .as_chunks::<4>();
        let mut numbers = numbers.iter().map(|n| f64::from(f32::from_le_bytes(*n)));
        let mut next = || numbers.next().unwrap_or(f64::NAN);
        let corners = [(); 3].map(|()| DVec3::new(next(), next(), next()));
        add(&mut parts, corners, "triangle")?;
    }
    Ok(parts)
}

fn of_words(bytes: &[u8], limits: &Limits) -> Result<Parts, Problem> {
    let Ok(text) = std::str::from_utf8(bytes) else {
        return Err(unsupported(STL, "text that is not UTF-8"));
    };
    let mut parts = Parts::new(STL, limits);
    let mut corners: Vec<DVec3> = Vec::new();
    let mut is_open = false;
    for (nth, line) in text.lines().enumerate() {
        let words: Vec<&str> = line.split_ascii_whitespace().take(6).collect();
        let at = || format!("line {}", nth.saturating_add(1));
        let wrong = |wanted: &str| invalid(STL, &at(), wanted, line);
        match (words.as_slice(), is_open) {
            ([], _) | (["facet", ..] | ["outer", "loop"] | ["endloop"], true) => {}
            (["solid", ..], false) => is_open = true,
            (["endsolid", ..], true) if corners.is_empty() => is_open = false,
            (["vertex", x, y, z], true) => {
                let place = [x, y, z].map(|word| number(word).unwrap_or(f64::NAN));
                corners.push(DVec3::from_array(place));
                if corners.len() > 3 {
                    return Err(wrong("three corners of a triangle"));
                }
            }
            (["endfacet"], true) => {
                let found = corners.len();
                let three = <[DVec3; 3]>::try_from(std::mem::take(&mut corners));
                let wanted = "three corners before it";
                let wrong = |_| invalid(STL, &at(), wanted, &found.to_string());
                add(&mut parts, three.map_err(wrong)?, &at())?;
            }
            (_, true) => {
                return Err(wrong(
                    "facet, outer loop, vertex x y z, endloop, endfacet or endsolid",
                ));
            }
            (_, false) => return Err(wrong("solid")),
        }
    }
    match is_open {
        true => Err(invalid(STL, "end", "endsolid", "none")),
        false => Ok(parts),
    }
}

fn add(parts: &mut Parts, corners: [DVec3; 3], field: &str) -> Result<(), Problem> {
    let first = parts.corners();
    let number = to_u64(parts.mesh.triangles.len()).saturating_add(1);
    let named = || match field {
        "triangle" => format!("triangle {number}"),
        _ => field.to_owned(),
    };
    for place in corners {
        let corner = Corner {
            place,
            normal: None,
            color: None,
        };
        parts.corner(&corner, named)?;
    }
    parts.triangle([0, 1, 2], [first, parts.corners()], named)
}
