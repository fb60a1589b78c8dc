//! The surface where a volume has one value, as triangles: marching cubes (Lorensen & Cline 1987) whose
//! ambiguous faces are decided as the trilinear field decides them (Nielson & Hamann 1991).
//!
//! ```text
//! corner on an edge   a + t (b - a),   t = (level - value_a) / (value_b - value_a)    exact in the field
//! ambiguous face      saddle = (ac - bd) / (a + c - b - d);   inside corners a, c are joined where saddle >= level
//! ```
//!
//! A face is decided by its own four values alone, so both cells at it agree: the surface has no cracks. What is
//! inside has at least the level. A tunnel inside one cell is not looked for.

mod cell;
mod sweep;

use crate::mesh::Mesh;
use crate::volume::Volume;

/// What stands at the border of the grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Border {
    /// The surface ends there, as a picture of it does.
    Open,
    /// What is inside is closed by the faces of the grid box, as printers of solids want it.
    Closed,
}

/// The surface of `level` in the trilinear field of `volume`, out to its grid box.
///
/// `None` where it has more corners than 2^32. Cells with a voxel without data have no part of it.
pub fn isosurface(volume: &Volume, level: f64, border: Border) -> Option<Mesh> {
    sweep::surface(volume, level, border)
}
