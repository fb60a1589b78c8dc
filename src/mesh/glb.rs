//! glTF 2.0 in one binary file (Khronos, "glTF 2.0 Specification", sections 3 and 4).
//!
//! The format has floats only: positions are told from the middle of the surface, and the node carries that
//! middle as its translation, so that a patient's coordinates cost no digits. glTF is y up and in metres;
//! the world stays as it is, and the node is not turned.

use super::Mesh;
use glam::DVec3;
use std::io::{self, ErrorKind, Write};

const FLOAT: u32 = 5126;
const UNSIGNED_INT: u32 = 5125;

pub(super) fn write(mesh: &Mesh, out: &mut impl Write) -> io::Result<()> {
    let fold = |f: fn(DVec3, DVec3) -> DVec3, start: f64| {
        mesh.positions.iter().copied().fold(DVec3::splat(start), f)
    };
    let low = fold(DVec3::min, f64::INFINITY);
    let high = fold(DVec3::max, f64::NEG_INFINITY);
    let is_empty = mesh.triangles.is_empty();
    let middle = if is_empty {
        DVec3::ZERO
    } else {
        (low + high) / 2.0
    };
    let corners = mesh.positions.len() as u64;
    let indices = 3 * mesh.triangles.len() as u64;
    let [positions_bytes, indices_bytes] = [12 * corners, 4 * indices];
    let has_colors = !mesh.colors.is_empty();
    if has_colors && mesh.colors.len() != mesh.positions.len() {
        let message = format!("{} colours for {corners} corners", mesh.colors.len());
        return Err(io::Error::new(ErrorKind::InvalidInput, message));
    }
    let colors_at = 2 * positions_bytes + indices_bytes;
    let binary_bytes = colors_at + if has_colors { positions_bytes } else { 0 };
    let [attribute, view, accessor] = match has_colors {
        false => Default::default(),
        true => [
            r#","COLOR_0":3"#.to_owned(),
            format!(r#",{{"buffer":0,"byteOffset":{colors_at},"byteLength":{positions_bytes}}}"#),
            format!(
                r#",{{"bufferView":3,"componentType":{FLOAT},"count":{corners},"type":"VEC3"}}"#
            ),
        ],
    };

    // Bounds of what is written, not of what it was rounded from.
    let [low, high] = [low, high].map(|corner| (corner - middle).as_vec3());
    let json = if is_empty {
        r#"{"asset":{"version":"2.0","generator":"stratavox"},"scene":0,"scenes":[{}]}"#.to_owned()
    } else {
        format!(
            concat!(
                r#"{{"asset":{{"version":"2.0","generator":"stratavox"}},"scene":0,"scenes":[{{"nodes":[0]}}],"#,
                r#""nodes":[{{"mesh":0,"translation":[{},{},{}]}}],"#,
                r#""meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"NORMAL":1{}}},"indices":2}}]}}],"#,
                r#""buffers":[{{"byteLength":{}}}],"#,
                r#""bufferViews":[{{"buffer":0,"byteOffset":0,"byteLength":{}}},"#,
                r#"{{"buffer":0,"byteOffset":{},"byteLength":{}}},{{"buffer":0,"byteOffset":{},"byteLength":{}}}{}],"#,
                r#""accessors":[{{"bufferView":0,"componentType":{},"count":{},"type":"VEC3","min":[{},{},{}],"max":[{},{},{}]}},"#,
                r#"{{"bufferView":1,"componentType":{},"count":{},"type":"VEC3"}},"#,
                r#"{{"bufferView":2,"componentType":{},"count":{},"type":"SCALAR"}}{}]}}"#,
            ),
            middle.x,
            middle.y,
            middle.z,
            attribute,
            binary_bytes,
            positions_bytes,
            positions_bytes,
            positions_bytes,
            2 * positions_bytes,
            indices_bytes,
            view,
            FLOAT,
            corners,
            low.x,
            low.y,
            low.z,
            high.x,
            high.y,
            high.z,
            FLOAT,
            corners,
            UNSIGNED_INT,
            indices,
            accessor,
        )
    };
    let json_bytes = (json.len() as u64).next_multiple_of(4);
    let binary_chunk = if is_empty { 0 } else { 8 + binary_bytes };
    let length = 12 + 8 + json_bytes + binary_chunk;
    let length = u32::try_from(length)
        .map_err(|_| io::Error::new(ErrorKind::InvalidData, "more than the 4 GiB of a .glb"))?;

    out.write_all(b"glTF")?;
    out.write_all(&2_u32.to_le_bytes())?;
    out.write_all(&length.to_le_bytes())?;
    // Both fit: they are parts of `length`.
    out.write_all(&(json_bytes as u32).to_le_bytes())?;
    out.write_all(b"JSON")?;
    out.write_all(json.as_bytes())?;
    out.write_all(&vec![b' '; json_bytes as usize - json.len()])?;
    if is_empty {
        return Ok(());
    }
    out.write_all(&(binary_bytes as u32).to_le_bytes())?;
    out.write_all(b"BIN\0")?;
    for position in &mesh.positions {
        out.write_all(bytemuck::bytes_of(
            &(*position - middle).as_vec3().to_array(),
        ))?;
    }
    for normal in mesh.normals() {
        out.write_all(bytemuck::bytes_of(&normal.to_array()))?;
    }
    for triangle in &mesh.triangles {
        out.write_all(bytemuck::bytes_of(triangle))?;
    }
    for color in &mesh.colors {
        out.write_all(bytemuck::bytes_of(&color.to_array()))?;
    }
    Ok(())
}
