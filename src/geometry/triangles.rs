//! Triangles with colours at their corners, seen as they are: light is for who makes them to put into the colours.

use glam::DVec3;

/// A corner of triangles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corner {
    /// World.
    pub place: DVec3,
    /// Linear Rec. 709.
    pub color: [f32; 3],
}

/// Triangles, each between three corners; colours between them are linear.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Triangles {
    corners: Vec<Corner>,
    triangles: Vec<[u32; 3]>,
}

impl Triangles {
    /// Adds triangles, each by the numbers of its corners among those that come with it.
    ///
    /// # Panics
    /// Where a triangle names a corner that is not there, and where there would be more than 2^32 corners.
    pub fn add(&mut self, corners: &[Corner], triangles: impl IntoIterator<Item = [u32; 3]>) {
        let first = self.corners.len();
        self.corners.extend_from_slice(corners);
        let end = u32::try_from(self.corners.len()).expect("at most 2^32 corners");
        let moved = triangles.into_iter().map(|numbers| {
            let numbers = numbers.map(|number| first as u32 + number);
            assert!(
                numbers.iter().all(|&number| number < end),
                "a corner that is not there"
            );
            numbers
        });
        self.triangles.extend(moved);
    }

    /// Adds all of the other.
    ///
    /// # Panics
    /// Where there would be more than 2^32 corners.
    pub fn append(&mut self, other: &Self) {
        self.add(&other.corners, other.triangles.iter().copied());
    }

    /// How many triangles there are.
    pub fn len(&self) -> usize {
        self.triangles.len()
    }

    /// True where there is none.
    pub fn is_empty(&self) -> bool {
        self.triangles.is_empty()
    }

    /// All corners.
    pub(crate) fn all_corners(&self) -> &[Corner] {
        &self.corners
    }

    /// Which of them each triangle is between: three numbers a triangle.
    pub(crate) fn numbers(&self) -> &[u32] {
        self.triangles.as_flattened()
    }

    /// The corners of a triangle.
    pub(super) fn corners(&self, triangle: usize) -> [Corner; 3] {
        self.triangles[triangle].map(|i| self.corners[i as usize])
    }
}
