//! STL, binary: 80 bytes of text, a count, and for each triangle its normal, its corners and two spare bytes.

use super::Mesh;
use glam::DVec3;
use std::io::{self, ErrorKind, Write};

pub(super) fn write(mesh: &Mesh, out: &mut impl Write) -> io::Result<()> {
    let count = u32::try_from(mesh.triangles.len())
        .map_err(|_| io::Error::new(ErrorKind::InvalidData, "more than 2^32 triangles"))?;
    // A text that begins with "solid" would be taken for the form in words.
    let mut text = [b' '; 80];
    text[..9].copy_from_slice(b"stratavox");
    out.write_all(&text)?;
    out.write_all(&count.to_le_bytes())?;
    for &triangle in &mesh.triangles {
        let normal = mesh.area_vector(triangle).normalize_or(DVec3::ZERO);
        let corners = triangle.map(|i| mesh.positions[i as usize]);
        for vector in std::iter::once(normal).chain(corners) {
            out.write_all(bytemuck::bytes_of(&vector.as_vec3().to_array()))?;
        }
        out.write_all(&[0, 0])?;
    }
    Ok(())
}
