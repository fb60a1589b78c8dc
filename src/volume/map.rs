//! The map that a piece of the Earth is drawn on, as weather models say it.
//!
//! ```text
//! x, y (world) = projection(latitude, longitude) - projection(centre)        kilometres on the map
//! ```

/// Which map, where it is true, and what lies in its middle; all angles in degrees, north and east positive.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "json", derive(serde::Serialize, serde::Deserialize))]
pub struct MapProjection {
    /// Which one.
    pub kind: MapKind,
    /// Latitudes at which lengths are true; the second is of a Lambert map. `None` where the file does not say.
    pub true_latitudes: [Option<f64>; 2],
    /// The longitude that runs straight north. `None` where the file does not say.
    pub standard_longitude: Option<f64>,
    /// Latitude and longitude in the middle of the grid. `None` where the file does not say.
    pub center: Option<[f64; 2]>,
    /// A corner, by which others can see whether the file agrees with itself. `None` where the file does not say.
    pub corner: Option<MapCorner>,
}

/// The first point of a grid on a map.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "json", derive(serde::Serialize, serde::Deserialize))]
pub struct MapCorner {
    /// By the latitudes and longitudes in the file, degrees.
    pub latitude_longitude: [f64; 2],
    /// x and y, world, by the steps of the grid.
    pub world: [f64; 2],
    /// World length of a step.
    pub step: f64,
}

/// A kind of map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "json", derive(serde::Serialize, serde::Deserialize))]
pub enum MapKind {
    /// Lambert's conformal conic map.
    Lambert,
    /// The polar stereographic map.
    PolarStereographic,
    /// Mercator's map.
    Mercator,
    /// Latitudes and longitudes, whose pole may be moved.
    LatitudeLongitude,
}

impl MapKind {
    /// What people call it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Lambert => "Lambert conformal",
            Self::PolarStereographic => "polar stereographic",
            Self::Mercator => "Mercator",
            Self::LatitudeLongitude => "latitude and longitude",
        }
    }
}
