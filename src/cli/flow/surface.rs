//! Surfaces in a picture, with a light at the eye.
//!
//! ```text
//! colour of a corner   (A + D |n . v|) c     v the way to the eye; between corners linear (Gouraud 1971)
//! normal drawn         M^-T n                M from the coordinates of the file to the drawn world
//! ```

use crate::format::mesh::MeshFile;
use crate::geometry::{self, Triangles, dull};
use glam::{DAffine3, DVec3};

/// A corner in the drawn world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Corner {
    pub place: DVec3,
    /// A unit vector, on either side.
    pub normal: DVec3,
    /// Linear.
    pub color: [f32; 3],
}

/// A surface in the drawn world.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Surface {
    pub corners: Vec<Corner>,
    /// By the numbers of corners.
    pub triangles: Vec<[u32; 3]>,
}

impl Surface {
    /// What a file has, put into the drawn world; in one colour, or its own, or else this grey.
    pub fn of(
        file: &MeshFile,
        drawn_from_file: DAffine3,
        one: Option<[f32; 3]>,
        grey: [f32; 3],
    ) -> Self {
        let upright = drawn_from_file.matrix3.inverse().transpose();
        let corner = |(i, (&place, normal)): (usize, (&DVec3, &glam::Vec3))| Corner {
            place: drawn_from_file.transform_point3(place),
            normal: (upright * normal.as_dvec3()).normalize_or_zero(),
            color: one.unwrap_or(file.mesh.colors.get(i).map_or(grey, |c| c.to_array())),
        };
        let corners = file.mesh.positions.iter().zip(&file.normals).enumerate();
        Self {
            corners: corners.map(corner).collect(),
            triangles: file.mesh.triangles.clone(),
        }
    }

    /// Adds it as it is seen from where a place finds the eye, which is a unit vector away from it.
    pub fn add(&self, triangles: &mut Triangles, to_eye: impl Fn(DVec3) -> DVec3) {
        let lit = |corner: &Corner| {
            let light = dull(corner.normal.dot(to_eye(corner.place))) as f32;
            geometry::Corner {
                place: corner.place,
                color: corner.color.map(|c| c * light),
            }
        };
        let corners: Vec<_> = self.corners.iter().map(lit).collect();
        triangles.add(&corners, self.triangles.iter().copied());
    }

    /// The corners of the box around it.
    pub fn bounds(&self) -> [DVec3; 2] {
        let places = || self.corners.iter().map(|corner| corner.place);
        [
            places().fold(DVec3::INFINITY, DVec3::min),
            places().fold(DVec3::NEG_INFINITY, DVec3::max),
        ]
    }
}
