//! Lines as coloured tubes of triangles.

use super::colors::LineColors;
use crate::flow::Line;
use crate::flow::write::{LineValues, tubes};
use crate::mesh::MeshFormat;
use glam::Vec3;
use std::io::{self, Write};

/// A tube's radius as a part of the box's diagonal.
const RADIUS: f64 = 1e-3;

/// Writes tubes around the lines, in one colour or in those of their values.
pub(super) fn write_tubes(
    lines: &[Line],
    values: &LineValues,
    diagonal: f64,
    one: Option<[f32; 3]>,
    out: &mut impl Write,
) -> io::Result<()> {
    let colors = LineColors::new(values, one, None, None);
    let color =
        |line: usize, vertex: usize| Vec3::from_array(colors.of(values.numbers[line][vertex]));
    let mesh = tubes(lines, RADIUS * diagonal, color).ok_or_else(|| {
        io::Error::new(
            io::ErrorKind::InvalidData,
            "more than 2^32 corners of tubes",
        )
    })?;
    mesh.write(MeshFormat::Glb, out)
}
