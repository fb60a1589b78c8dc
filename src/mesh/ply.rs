//! PLY 1.0, binary little-endian (Turk 1994): positions as doubles, normals as floats.

use super::Mesh;
use std::io::{self, Write};

pub(super) fn write(mesh: &Mesh, out: &mut impl Write) -> io::Result<()> {
    write!(
        out,
        "ply\nformat binary_little_endian 1.0\ncomment stratavox\n\
         element vertex {}\nproperty double x\nproperty double y\nproperty double z\n\
         property float nx\nproperty float ny\nproperty float nz\n\
         element face {}\nproperty list uchar uint vertex_indices\nend_header\n",
        mesh.positions.len(),
        mesh.triangles.len()
    )?;
    for (position, normal) in mesh.positions.iter().zip(mesh.normals()) {
        out.write_all(bytemuck::bytes_of(&position.to_array()))?;
        out.write_all(bytemuck::bytes_of(&normal.to_array()))?;
    }
    for triangle in &mesh.triangles {
        out.write_all(&[3])?;
        out.write_all(bytemuck::bytes_of(triangle))?;
    }
    Ok(())
}
