//! Surfaces of triangles from files: PLY, binary glTF and STL, told apart by content.
//!
//! ```text
//! file -> corners with normals and colours, triangles by the numbers of their corners
//! ```
//!
//! A file is read whole. What it holds takes memory in proportion to its bytes; where parts of a glTF file are used several
//! times, at most what the limits allow.

mod glb;
mod ply;
mod stl;

use super::convert::to_u64;
use super::place::{open_regular, whole};
use super::problem::{at, invalid, io};
use crate::mesh::Mesh;
use crate::volume::{Limits, Problem, ReadError};
use glam::{DVec3, Vec3};
use std::io::{BufRead, BufReader};
use std::path::Path;

/// Bytes of a corner and of a triangle in memory.
const CORNER_BYTES: u64 = 48;
const TRIANGLE_BYTES: u64 = 12;

/// What a file has of a surface.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshFile {
    /// The surface, in the coordinates of the file. Colours are linear.
    pub mesh: Mesh,
    /// A unit normal for each corner: that of the file, else the mean of its triangles.
    pub normals: Vec<Vec3>,
}

/// The surface of a file.
///
/// # Errors
/// The file is of no known kind, is cut, holds no triangles, or says something that cannot be. The error names the file, the
/// field, what was wanted and what was found.
pub fn read_mesh(path: &Path, limits: &Limits) -> Result<MeshFile, ReadError> {
    let read = || {
        let bytes = whole(path, limits.max_bytes, "a file of a surface")?;
        if super::ply::recognizes(&bytes) {
            ply::read(&bytes, limits)
        } else if glb::recognizes(&bytes) {
            glb::read(&bytes, limits)
        } else {
            stl::read(&bytes, limits)
        }
    };
    read().and_then(Parts::whole).map_err(at(path))
}

/// Whether a file holds a surface and not scattered points: by its content, and where that has no mark by the ending of its
/// name.
///
/// # Errors
/// It cannot be opened, or is a PLY file whose head is wrong.
pub fn is_mesh(path: &Path, limits: &Limits) -> Result<bool, ReadError> {
    let read = || {
        let (file, _) = open_regular(path)?;
        let mut input = BufReader::new(file);
        let first = input.fill_buf().map_err(io("reading the file"))?;
        if super::ply::recognizes(first) {
            let head = super::ply::Head::read(input, limits.max_header_bytes)?;
            return Ok(head.has_faces());
        }
        let ending = path.extension().and_then(|ending| ending.to_str());
        let ends = |wanted: &str| ending.is_some_and(|ending| ending.eq_ignore_ascii_case(wanted));
        Ok(glb::recognizes(first) || ends("stl") || ends("glb"))
    };
    read().map_err(at(path))
}

/// A surface in the making.
struct Parts {
    /// The word of errors.
    format: &'static str,
    mesh: Mesh,
    /// Of each corner; zero where the file says none.
    normals: Vec<Vec3>,
    has_colors: bool,
    most_bytes: u64,
}

/// A corner as a file has it.
struct Corner {
    place: DVec3,
    normal: Option<Vec3>,
    /// Linear.
    color: Option<Vec3>,
}

impl Parts {
    fn new(format: &'static str, limits: &Limits) -> Self {
        Self {
            format,
            mesh: Mesh::default(),
            normals: Vec::new(),
            has_colors: false,
            most_bytes: limits.max_bytes,
        }
    }

    /// How many corners there are.
    fn corners(&self) -> u64 {
        to_u64(self.mesh.positions.len())
    }

    /// The next corner; of an error the `field` of its place.
    fn corner(&mut self, corner: &Corner, field: impl FnOnce() -> String) -> Result<(), Problem> {
        if !corner.place.is_finite() {
            let found = corner.place.to_string();
            return Err(invalid(
                self.format,
                &field(),
                "three finite numbers",
                &found,
            ));
        }
        self.mesh.positions.push(corner.place);
        self.normals.push(corner.normal.unwrap_or_default());
        self.mesh.colors.push(corner.color.unwrap_or(Vec3::ONE));
        self.has_colors |= corner.color.is_some();
        self.room()
    }

    /// The next triangle, by numbers of corners, of which there are those from `first` to `end`; of an error the `field`.
    fn triangle(
        &mut self,
        numbers: [u64; 3],
        [first, end]: [u64; 2],
        field: impl FnOnce() -> String,
    ) -> Result<(), Problem> {
        let count = end.saturating_sub(first);
        let number = |number: u64| {
            let place = first.checked_add(number).filter(|_| number < count);
            place.and_then(|place| u32::try_from(place).ok())
        };
        match numbers.map(number) {
            [Some(a), Some(b), Some(c)] => self.mesh.triangles.push([a, b, c]),
            _ => {
                let wanted = format!("numbers of corners under {count}");
                let found = format!("{} {} {}", numbers[0], numbers[1], numbers[2]);
                return Err(invalid(self.format, &field(), wanted, &found));
            }
        }
        self.room()
    }

    fn room(&self) -> Result<(), Problem> {
        let triangles = to_u64(self.mesh.triangles.len());
        let wanted_bytes = (self.corners().saturating_mul(CORNER_BYTES))
            .saturating_add(triangles.saturating_mul(TRIANGLE_BYTES));
        match wanted_bytes > self.most_bytes {
            true => Err(Problem::Limit {
                what: "a surface".to_owned(),
                wanted_bytes,
                limit_bytes: self.most_bytes,
            }),
            false => Ok(()),
        }
    }

    /// All of it, with normals where the file has none.
    fn whole(mut self) -> Result<MeshFile, Problem> {
        if self.mesh.triangles.is_empty() {
            return Err(invalid(self.format, "triangles", "one at least", "none"));
        }
        let is_said = |normal: &Vec3| normal.is_finite() && *normal != Vec3::ZERO;
        if !self.normals.iter().all(is_said) {
            self.normals = self.mesh.normals();
        }
        for normal in &mut self.normals {
            *normal = normal.normalize_or(Vec3::Z);
        }
        if !self.has_colors {
            self.mesh.colors = Vec::new();
        }
        Ok(MeshFile {
            mesh: self.mesh,
            normals: self.normals,
        })
    }
}
