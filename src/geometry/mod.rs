//! Opaque geometry beside a volume: lines as tubes, arrows and points as spheres, all of them round cones; surfaces of
//! triangles.
//!
//! ```text
//! round cone   the hull of two spheres:  p(s) = a + s (b - a),  r(s) = r_a + s (r_b - r_a),  0 <= s <= 1
//! ```
//!
//! Each pixel's ray is intersected with them in f64, its origin moved next to a cone first. What is found is a colour and
//! how far away it is, behind which rays through the volume end.
//!
//! ```
//! use glam::DVec3;
//! use stratavox::camera::{Camera, Projection};
//! use stratavox::geometry::{Geometry, RoundCones, Vertex};
//!
//! let mut cones = RoundCones::default();
//! let vertex = |x: f64| Vertex { place: DVec3::new(x, 0.0, 0.0), radius: 0.5, color: [1.0, 0.5, 0.0] };
//! cones.add_line([vertex(-1.0), vertex(1.0)]);
//! let camera = Camera {
//!     eye: DVec3::new(0.0, 0.0, 8.0),
//!     target: DVec3::ZERO,
//!     up: DVec3::Y,
//!     projection: Projection::Orthographic { view_height: 2.0 },
//!     zoom: 1.0,
//! };
//! let seen = Geometry::from(cones).seen(&camera, [9, 9], [0.0; 2]);
//! assert_eq!(seen.distances[4 * 9 + 4], 7.5);
//! ```

mod bounds;
mod round_cone;
mod seen;
mod triangle;
mod triangles;

pub use round_cone::{Hit, RoundCone};
pub use seen::Seen;
#[cfg(feature = "cli")]
pub(crate) use seen::dull;
pub use triangle::{TriangleHit, triangle_hit};
pub use triangles::{Corner, Triangles};

use glam::DVec3;

/// All that is drawn beside a volume.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Geometry {
    /// Lit from the eye.
    pub cones: RoundCones,
    /// Seen as they are.
    pub triangles: Triangles,
}

impl From<RoundCones> for Geometry {
    fn from(cones: RoundCones) -> Self {
        Self {
            cones,
            triangles: Triangles::default(),
        }
    }
}

/// The end of a round cone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vertex {
    /// World.
    pub place: DVec3,
    /// World length, over 0.
    pub radius: f64,
    /// Linear Rec. 709.
    pub color: [f32; 3],
}

/// Round cones, each between two vertices; a sphere is one whose ends are the same vertex.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RoundCones {
    vertices: Vec<Vertex>,
    segments: Vec<Segment>,
}

/// One of them.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Segment {
    ends: [u32; 2],
    /// No plane cuts it.
    is_whole: bool,
    /// The number of its line; 0 is none.
    line: u32,
}

impl RoundCones {
    /// Adds a line: a cone between each two of the vertices; a sphere where there is one vertex.
    ///
    /// # Panics
    /// Where there would be more than 2^32 vertices.
    pub fn add_line(&mut self, vertices: impl IntoIterator<Item = Vertex>) {
        self.add_line_of(0, vertices);
    }

    /// The same with a number that [`Seen::lines`] tells; 0 is none.
    ///
    /// # Panics
    /// As [`Self::add_line`].
    pub fn add_line_of(&mut self, number: u32, vertices: impl IntoIterator<Item = Vertex>) {
        let segment = |a: usize, b: usize| Segment {
            ends: [a, b].map(|n| u32::try_from(n).expect("at most 2^32 vertices")),
            is_whole: false,
            line: number,
        };
        let first = self.vertices.len();
        self.vertices.extend(vertices);
        let last = self.vertices.len();
        match last - first {
            0 => {}
            1 => self.segments.push(segment(first, first)),
            _ => self
                .segments
                .extend((first..last - 1).map(|i| segment(i, i + 1))),
        }
    }

    /// Adds a sphere that is a symbol: no plane cuts it.
    ///
    /// # Panics
    /// As [`Self::add_line`].
    pub fn add_symbol(&mut self, vertex: Vertex) {
        self.add_line([vertex]);
        self.segments.last_mut().expect("added above").is_whole = true;
    }

    /// Adds all of the other.
    pub fn add(&mut self, other: &Self) {
        let first = self.vertices.len() as u32;
        self.vertices.extend_from_slice(&other.vertices);
        let moved = |segment: &Segment| Segment {
            ends: segment.ends.map(|i| i + first),
            ..*segment
        };
        self.segments.extend(other.segments.iter().map(moved));
    }

    /// How many cones there are.
    pub fn len(&self) -> usize {
        self.segments.len()
    }

    /// True where there is none.
    pub fn is_empty(&self) -> bool {
        self.segments.is_empty()
    }

    /// All ends.
    pub(crate) fn vertices(&self) -> &[Vertex] {
        &self.vertices
    }

    /// Which of them each cone is between: two numbers a cone.
    pub(crate) fn numbers(&self) -> Vec<u32> {
        self.segments
            .iter()
            .flat_map(|segment| segment.ends)
            .collect()
    }

    /// The cone of a segment, and the colours of its ends.
    fn cone(&self, segment: usize) -> (RoundCone, [[f32; 3]; 2]) {
        let ends = self.segments[segment]
            .ends
            .map(|i| self.vertices[i as usize]);
        let cone = RoundCone {
            ends: ends.map(|end| end.place),
            radii: ends.map(|end| end.radius),
        };
        (cone, ends.map(|end| end.color))
    }
}
