//! glTF 2.0 in one binary file (Khronos, "glTF 2.0 Specification", sections 3 and 4): triangles of the nodes of its scene.
//!
//! ```text
//! "glTF"  <2  <length of the file   <length "JSON" text   <length "BIN" bytes
//! place in the scene = product of the matrices of the nodes above * POSITION
//! ```
//!
//! The places stay as the file has them, as our writer leaves them: the world is not turned to y up. Colours are COLOR_0 times
//! the base colour of the material. Textures, skins and morph targets are passed over; files beside it, compressed
//! and sparse accessors, and what is no list of triangles, are refused. A node has one parent.

#![allow(
    clippy::arithmetic_side_effects,
    reason = "vectors of f64: nothing wraps or panics"
)]

mod accessor;
mod document;

use super::{Corner, Parts};
use crate::format::convert::to_u64;
use crate::format::problem::{escape, invalid, missing, unsupported};
use crate::volume::{Limits, Problem};
use accessor::Accessor;
use document::{Document, Node, Primitive};
use glam::{DAffine3, DMat4, DQuat, DVec3, Vec3};

/// The word of errors.
const GLB: &str = "glb";
const MAGIC: &[u8] = b"glTF";
const HEADER_BYTES: usize = 12;
const JSON: &[u8] = b"JSON";
const BIN: &[u8] = b"BIN\0";

/// Modes of primitives: triangles.
const TRIANGLES: u32 = 4;

/// True where a file begins as every binary glTF file does.
pub(super) fn recognizes(first: &[u8]) -> bool {
    first.starts_with(MAGIC)
}

/// The triangles of the scene.
pub(super) fn read(bytes: &[u8], limits: &Limits) -> Result<Parts, Problem> {
    let (text, binary) = chunks(bytes)?;
    let document = document::read(text)?;
    if let Some(name) = document.extensions_required.first() {
        return Err(unsupported(GLB, format!("extension {}", escape(name))));
    }
    let scene = document.scenes.get(document.scene);
    let scene = scene.ok_or_else(|| {
        let found = format!("{} of {}", document.scene, document.scenes.len());
        invalid(GLB, "scene", "one of the scenes", &found)
    })?;
    let mut parts = Parts::new(GLB, limits);
    let mut left: Vec<(usize, DAffine3)> = Vec::new();
    left.extend(scene.nodes.iter().map(|&node| (node, DAffine3::IDENTITY)));
    let mut is_seen = vec![false; document.nodes.len()];
    while let Some((number, above)) = left.pop() {
        let field = format!("nodes[{number}]");
        let node = document.nodes.get(number).zip(is_seen.get_mut(number));
        let Some((node, is_seen)) = node.filter(|(_, is_seen)| !**is_seen) else {
            let wanted = format!("a node of {}, under one parent", document.nodes.len());
            return Err(invalid(GLB, &field, wanted, &number.to_string()));
        };
        *is_seen = true;
        let scene_from_node = above * placed(node, &field)?;
        left.extend(node.children.iter().map(|&node| (node, scene_from_node)));
        let Some(mesh) = node.mesh else { continue };
        let mesh = document.meshes.get(mesh).ok_or_else(|| {
            let wanted = format!("one of {} meshes", document.meshes.len());
            invalid(GLB, &format!("{field}.mesh"), wanted, &mesh.to_string())
        })?;
        for primitive in &mesh.primitives {
            add(&mut parts, &document, binary, primitive, scene_from_node)?;
        }
    }
    Ok(parts)
}

/// The text, and the bytes behind it; none where there are none.
fn chunks(bytes: &[u8]) -> Result<(&[u8], &[u8]), Problem> {
    let number = |at: usize| {
        let bytes = bytes.get(at..).and_then(|rest| rest.first_chunk::<4>());
        bytes.map(|bytes| u32::from_le_bytes(*bytes))
    };
    match number(4) {
        Some(2) => {}
        found => {
            let found = found.map_or("the end of the file".to_owned(), |n| n.to_string());
            return Err(invalid(GLB, "version", "2", &found));
        }
    }
    if number(8).map(u64::from) != Some(to_u64(bytes.len())) {
        let wanted = format!("{} bytes, which the file has", bytes.len());
        let found = number(8).unwrap_or_default().to_string();
        return Err(invalid(GLB, "length", wanted, &found));
    }
    let mut rest = bytes.get(HEADER_BYTES..).unwrap_or_default();
    let mut all: Vec<&[u8]> = Vec::new();
    for wanted in [JSON, BIN] {
        if rest.is_empty() {
            break;
        }
        let cut = || invalid(GLB, "chunk", "a length, a type and so many bytes", "less");
        let (length, behind) = rest.split_first_chunk::<4>().ok_or_else(cut)?;
        let (kind, behind) = behind.split_first_chunk::<4>().ok_or_else(cut)?;
        if kind != wanted {
            let [wanted, found] = [wanted, kind].map(String::from_utf8_lossy);
            return Err(invalid(GLB, "chunk", wanted.trim_end_matches('\0'), &found));
        }
        let length = usize::try_from(u32::from_le_bytes(*length)).unwrap_or(usize::MAX);
        let (chunk, behind) = behind.split_at_checked(length).ok_or_else(cut)?;
        all.push(chunk);
        rest = behind;
    }
    let text = all.first().ok_or_else(|| missing(GLB, "JSON"))?;
    Ok((text, all.get(1).copied().unwrap_or_default()))
}

/// From a node to what is above it.
fn placed(node: &Node, field: &str) -> Result<DAffine3, Problem> {
    let matrix = match node.matrix {
        Some(matrix) => DMat4::from_cols_array(&matrix),
        None => {
            let [x, y, z, w] = node.rotation.unwrap_or([0.0, 0.0, 0.0, 1.0]);
            let scale = DVec3::from_array(node.scale.unwrap_or([1.0; 3]));
            let translation = DVec3::from_array(node.translation.unwrap_or_default());
            let turn = DQuat::from_xyzw(x, y, z, w);
            // Some programs write few digits.
            let is_near = (turn.length() - 1.0).abs() < 1e-3;
            let turn = is_near.then(|| turn.normalize());
            let turn = turn.ok_or_else(|| {
                let found = format!("{x} {y} {z} {w}");
                invalid(
                    GLB,
                    &format!("{field}.rotation"),
                    "a unit quaternion",
                    &found,
                )
            })?;
            DMat4::from_scale_rotation_translation(scale, turn, translation)
        }
    };
    let [.., last] = matrix.transpose().to_cols_array_2d();
    match matrix.is_finite() && last == [0.0, 0.0, 0.0, 1.0] {
        true => Ok(DAffine3::from_mat4(matrix)),
        false => {
            let wanted = "finite numbers whose last row is 0 0 0 1";
            Err(invalid(
                GLB,
                &format!("{field}.matrix"),
                wanted,
                &matrix.to_string(),
            ))
        }
    }
}

fn add(
    parts: &mut Parts,
    document: &Document,
    binary: &[u8],
    primitive: &Primitive,
    scene_from_node: DAffine3,
) -> Result<(), Problem> {
    if primitive.mode.unwrap_or(TRIANGLES) != TRIANGLES {
        let what = "primitives other than triangles (mode 4)";
        return Err(unsupported(GLB, what));
    }
    let accessor = |number: Option<usize>, field: &str, components: &[usize]| {
        let of = |number| Accessor::new(document, binary, number, field, components);
        number.map(of).transpose()
    };
    let attributes = &primitive.attributes;
    let places = accessor(attributes.position, "POSITION", &[3])?;
    let places = places.ok_or_else(|| missing(GLB, "POSITION"))?;
    let normals = accessor(attributes.normal, "NORMAL", &[3])?;
    let colors = accessor(attributes.color, "COLOR_0", &[3, 4])?;
    let indices = accessor(primitive.indices, "indices", &[1])?;
    for (field, beside) in [("NORMAL", &normals), ("COLOR_0", &colors)] {
        if let Some(beside) = beside
            && beside.count != places.count
        {
            let wanted = format!("{}, one a POSITION", places.count);
            return Err(invalid(GLB, field, wanted, &beside.count.to_string()));
        }
    }
    let material = primitive
        .material
        .and_then(|number| document.materials.get(number));
    let base = material.and_then(|material| material.pbr.as_ref()?.base);
    let base = base.map(|[r, g, b, _]| DVec3::new(r, g, b).as_vec3());
    let turned = scene_from_node.matrix3;
    // A plane of no volume has no normals.
    let upright = turned.inverse().transpose();
    let first = parts.corners();
    let mut normals = normals.iter().flat_map(Accessor::rows);
    let mut colors = colors.iter().flat_map(Accessor::rows);
    for (nth, [x, y, z, _]) in places.rows().enumerate() {
        let color = colors
            .next()
            .map(|[r, g, b, _]| DVec3::new(r, g, b).as_vec3());
        let color = match (color, base) {
            (None, None) => None,
            (color, base) => Some(color.unwrap_or(Vec3::ONE) * base.unwrap_or(Vec3::ONE)),
        };
        let normal = normals
            .next()
            .map(|[x, y, z, _]| upright * DVec3::new(x, y, z));
        let corner = Corner {
            place: scene_from_node.transform_point3(DVec3::new(x, y, z)),
            normal: normal.map(|normal| normal.normalize_or_zero().as_vec3()),
            color: color.map(|color| color.clamp(Vec3::ZERO, Vec3::ONE)),
        };
        parts.corner(&corner, || format!("POSITION {nth}"))?;
    }
    let end = parts.corners();
    let count = indices
        .as_ref()
        .map_or(places.count, |indices| indices.count);
    if !count.is_multiple_of(3) {
        let wanted = "a multiple of three corners";
        return Err(invalid(GLB, "indices", wanted, &count.to_string()));
    }
    match indices {
        Some(indices) => {
            let mut numbers = indices.rows().map(|[number, ..]| {
                let whole = crate::format::text::whole(number);
                whole
                    .and_then(|n| u64::try_from(n).ok())
                    .unwrap_or(u64::MAX)
            });
            for nth in 0..to_u64(count) / 3 {
                let mut next = || numbers.next().unwrap_or(u64::MAX);
                let triangle = [next(), next(), next()];
                parts.triangle(triangle, [first, end], || {
                    format!("indices, triangle {nth}")
                })?;
            }
        }
        None => {
            for nth in 0..to_u64(count) / 3 {
                let at = nth.saturating_mul(3);
                let triangle = [0, 1, 2].map(|k: u64| at.saturating_add(k));
                parts.triangle(triangle, [first, end], || format!("triangle {nth}"))?;
            }
        }
    }
    Ok(())
}
