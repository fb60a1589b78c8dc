//! Triangles in world space, and files of them.

mod glb;
mod ply;
mod stl;

use glam::{DVec3, Vec3};
use std::io::{self, Write};
use std::path::Path;

/// A surface of triangles. Seen from outside their corners run counter-clockwise.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Corners in world space.
    pub positions: Vec<DVec3>,
    /// Three indices into `positions` a triangle.
    pub triangles: Vec<[u32; 3]>,
    /// A linear colour for each corner, 0 to 1, or none at all. Only glTF keeps them.
    pub colors: Vec<Vec3>,
}

/// A kind of file for a [`Mesh`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeshFormat {
    /// Stanford's polygon file, binary, with normals.
    Ply,
    /// Stereolithography, binary: triangles without neighbours, millimetres by custom.
    Stl,
    /// glTF 2.0 in one binary file, with normals.
    Glb,
}

impl MeshFormat {
    /// By the ending of a file's name.
    pub fn of_path(path: &Path) -> Option<Self> {
        let ending = path.extension()?.to_str()?.to_ascii_lowercase();
        match ending.as_str() {
            "ply" => Some(Self::Ply),
            "stl" => Some(Self::Stl),
            "glb" => Some(Self::Glb),
            _ => None,
        }
    }
}

impl Mesh {
    /// Writes all of it.
    ///
    /// # Errors
    /// What `out` says; [`io::ErrorKind::InvalidData`] where the format has no room for so many triangles.
    pub fn write(&self, format: MeshFormat, out: &mut impl Write) -> io::Result<()> {
        match format {
            MeshFormat::Ply => ply::write(self, out),
            MeshFormat::Stl => stl::write(self, out),
            MeshFormat::Glb => glb::write(self, out),
        }
    }

    /// Twice the area of a triangle as a vector that points outside.
    pub fn area_vector(&self, [a, b, c]: [u32; 3]) -> DVec3 {
        let [a, b, c] = [a, b, c].map(|i| self.positions[i as usize]);
        (b - a).cross(c - a)
    }

    /// Area of all triangles, in world units squared.
    pub fn area(&self) -> f64 {
        let twice = |&triangle: &[u32; 3]| self.area_vector(triangle).length();
        self.triangles.iter().map(twice).sum::<f64>() / 2.0
    }

    /// What the surface encloses, in world units cubed, by the divergence theorem: the sum of
    /// a . (b x c) / 6. Of a surface with holes it says nothing.
    pub fn volume(&self) -> f64 {
        let origin = self.positions.first().copied().unwrap_or_default();
        let six_times = |triangle: &[u32; 3]| {
            let [a, b, c] = triangle.map(|i| self.positions[i as usize] - origin);
            a.dot(b.cross(c))
        };
        self.triangles.iter().map(six_times).sum::<f64>() / 6.0
    }

    /// A unit normal for each corner: the mean of its triangles, weighted by area.
    pub fn normals(&self) -> Vec<Vec3> {
        let mut sums = vec![DVec3::ZERO; self.positions.len()];
        for &triangle in &self.triangles {
            let area = self.area_vector(triangle);
            for corner in triangle {
                sums[corner as usize] += area;
            }
        }
        let unit = |sum: DVec3| sum.normalize_or(DVec3::Z).as_vec3();
        sums.into_iter().map(unit).collect()
    }
}
