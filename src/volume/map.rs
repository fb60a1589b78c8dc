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
    /// The corners, by which others can see whether the file agrees with itself. `None` where the file does not say.
    pub corners: [Option<MapCorner>; 4],
    /// Of latitudes and longitudes whose pole is moved: where it is. `None` where it is not moved, or the file does not say.
    pub pole: Option<MovedPole>,
}

impl MapProjection {
    /// A map of which nothing but its kind is known.
    pub fn of_kind(kind: MapKind) -> Self {
        Self {
            kind,
            true_latitudes: [None; 2],
            standard_longitude: None,
            center: None,
            corners: [None; 4],
            pole: None,
        }
    }
}

/// A grid of latitudes and longitudes that count from another pole than the Earth's, degrees.
///
/// ```text
/// a = latitude of the pole, l = longitude - longitude of the pole - 180, p = latitude
/// grid longitude = atan2(cos p sin l, sin a cos p cos l + cos a sin p) + that of the Earth's pole
/// grid latitude  = asin(sin a sin p - cos a cos p cos l)
/// ```
///
/// CF Conventions, appendix F, rotated pole.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "json", derive(serde::Serialize, serde::Deserialize))]
pub struct MovedPole {
    /// Where the grid's north pole is.
    pub latitude: f64,
    /// Where the grid's north pole is.
    pub longitude: f64,
    /// The longitude of the Earth's north pole on the grid.
    pub grid_longitude: f64,
}

impl MovedPole {
    /// Longitude and latitude on the grid, the longitude within 180 of the grid's `middle`.
    pub fn grid_from_earth(&self, [longitude, latitude]: [f64; 2], middle: f64) -> [f64; 2] {
        let l = (longitude - self.longitude - 180.0).to_radians();
        let (sin_p, cos_p) = latitude.to_radians().sin_cos();
        let (sin_a, cos_a) = self.latitude.to_radians().sin_cos();
        let x = sin_a * cos_p * l.cos() + cos_a * sin_p;
        let y = cos_p * l.sin();
        let z = sin_a * sin_p - cos_a * cos_p * l.cos();
        let found = y.atan2(x).to_degrees() + self.grid_longitude;
        let near = (found - middle + 180.0).rem_euclid(360.0) - 180.0;
        // Of a sine that is nearly 1 the angle would lose half of its digits.
        [middle + near, z.atan2(x.hypot(y)).to_degrees()]
    }

    /// Longitude, -180 to 180, and latitude on the Earth.
    pub fn earth_from_grid(&self, [longitude, latitude]: [f64; 2]) -> [f64; 2] {
        let back = Self {
            latitude: self.latitude,
            longitude: self.grid_longitude,
            grid_longitude: self.longitude,
        };
        // The way back is the way there with both poles exchanged.
        back.grid_from_earth([longitude, latitude], 0.0)
    }
}

/// The point in a corner of a grid on a map.
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
    /// Latitudes and longitudes that bend.
    Curvilinear,
}

impl MapKind {
    /// What people call it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Lambert => "Lambert conformal",
            Self::PolarStereographic => "polar stereographic",
            Self::Mercator => "Mercator",
            Self::LatitudeLongitude => "latitude and longitude",
            Self::Curvilinear => "curvilinear",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By PROJ 9 (pyproj), `+proj=ob_tran +o_proj=longlat +o_lon_p=N +o_lat_p=A +lon_0=180+L`: latitude and longitude of the
    /// pole, the grid's longitude of the Earth's, a place, and the same on the grid.
    #[test]
    fn a_pole_is_moved_as_by_proj() {
        for (pole, earth, grid) in POLES {
            let [latitude, longitude, grid_longitude] = pole;
            let pole = MovedPole {
                latitude,
                longitude,
                grid_longitude,
            };
            let found = pole.grid_from_earth(earth, grid[0]);
            let back = pole.earth_from_grid(grid);
            for k in [0, 1] {
                assert!(
                    (found[k] - grid[k]).abs() < 1e-9,
                    "{found:?}, wanted {grid:?}"
                );
                assert!(
                    (back[k] - earth[k]).abs() < 1e-9,
                    "{back:?}, wanted {earth:?}"
                );
            }
        }
    }

    /// Pole, place on the Earth, place on the grid.
    const POLES: [([f64; 3], [f64; 2], [f64; 2]); 8] = [
        (
            [39.25, -162.0, 0.0],
            [-93.809, 7.519],
            [-98.143_056_392_036_03, 21.593_331_101_635_965],
        ),
        (
            [39.25, -162.0, 0.0],
            [-46.556, 17.666],
            [-60.137_632_123_088_42, -7.181_106_799_935_934],
        ),
        (
            [38.5, 140.0, 25.0],
            [45.008, -73.86],
            [-175.601_512_112_767_7, -38.090_777_823_021_675],
        ),
        (
            [38.5, 140.0, 25.0],
            [-174.286, 57.37],
            [-17.266_259_177_298_686, 54.976_310_176_738_08],
        ),
        (
            [-70.0, 30.0, -15.0],
            [-86.151, -45.164],
            [115.184_408_272_887_05, 34.061_157_002_335_47],
        ),
        (
            [-70.0, 30.0, -15.0],
            [177.441, -5.055],
            [-161.795_387_613_072_88, -11.791_340_365_490_353],
        ),
        (
            [90.0, 180.0, 0.0],
            [120.453, -4.02],
            [120.452_999_999_999_99, -4.019_999_999_999_998],
        ),
        (
            [90.0, 180.0, 0.0],
            [49.786, -59.395],
            [49.786_000_000_000_02, -59.395_000_000_000_01],
        ),
    ];

    #[test]
    fn longitudes_on_a_grid_go_on_from_its_middle() {
        let pole = MovedPole {
            latitude: 39.25,
            longitude: -162.0,
            grid_longitude: 0.0,
        };
        let [near, _] = pole.grid_from_earth([18.0, 50.0], 0.0);
        let [far, _] = pole.grid_from_earth([18.0, 50.0], 350.0);
        assert!((far - near - 360.0).abs() < 1e-9, "{near} {far}");
        // The Earth's own poles.
        let north = pole.grid_from_earth([77.0, 90.0], 0.0);
        assert!(
            north[0].abs() < 1e-9 && (north[1] - 39.25).abs() < 1e-9,
            "{north:?}"
        );
        let own = MovedPole {
            latitude: 90.0,
            longitude: 0.0,
            grid_longitude: 0.0,
        };
        let same = own.grid_from_earth([12.0, 34.0], 0.0);
        assert!((same[1] - 34.0).abs() < 1e-9, "{same:?}");
    }
}
