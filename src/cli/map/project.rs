//! From latitude and longitude to the map that the world is drawn on.
//!
//! ```text
//! degrees          x = longitude * length of a degree, y = latitude * length of a degree
//! Mercator         x = R cos(p1) l,  y = R cos(p1) ln tan(45 + p / 2)
//! Lambert          n = ln(cos p1 / cos p2) / ln(tan(45 + p2 / 2) / tan(45 + p1 / 2)),  n = sin p1 where p1 = p2
//!                  r = R cos p1 / n * (tan(45 + p1 / 2) / tan(45 + p / 2))^n,  x = r sin(n l),  y = -r cos(n l)
//! moved pole       as degrees, of longitude and latitude from that pole (`volume::MovedPole`)
//! arrays           between the columns of the file with their own longitudes and latitudes (`arrays`)
//! stereographic    r = R (1 + sin|p1|) cos p / (1 + sin(s p)),  x = r sin l,  y = -s r cos l,  s the sign of p1
//! ```
//!
//! l the longitude from the one that runs straight north, p1 and p2 the true latitudes, on a sphere of 6370 km as WRF has it.
//! Snyder, "Map Projections: A Working Manual", USGS Professional Paper 1395, 1987, chapters 7, 15, 21.

use super::arrays::Arrays;
use crate::volume::{Header, MapCorner, MapKind, MapProjection, MovedPole};
use glam::DVec3;
use std::sync::Arc;

/// Of a step.
const MOST_OFF: f64 = 0.05;
/// Kilometres.
const RADIUS: f64 = 6370.0;

/// Degrees between places of a line that is bent on the map.
pub(super) const FINE: f64 = 0.25;
/// The same of the finest grids.
const FINEST: f64 = 0.01;
/// Turns that look for the border of a map: a millionth of a piece.
const HALVINGS: u32 = 20;

/// Takes places of the Earth to the world.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Projection {
    /// Lengths of a degree along x and y.
    Degrees([f64; 2]),
    /// The same from another pole, around a longitude of the grid.
    MovedPole {
        pole: MovedPole,
        degree_lengths: [f64; 2],
        middle: f64,
    },
    /// A map, and what lies in the origin of the world.
    Map {
        kind: MapKind,
        true_latitudes: [f64; 2],
        longitude: f64,
        origin: [f64; 2],
    },
    /// The file's own latitudes and longitudes.
    Arrays(Arc<Arrays>),
}

impl Projection {
    /// That of a volume; `None` where it has no place on the Earth.
    pub fn of(header: &Header) -> Option<Self> {
        if let Some(map) = &header.map {
            return match (map.pole, header.degree_lengths) {
                (Some(pole), [Some(x), Some(y)]) => Some(Self::MovedPole {
                    pole,
                    degree_lengths: [x, y],
                    middle: middle(header) / x,
                }),
                _ => Self::of_map(map),
            };
        }
        match header.degree_lengths {
            [Some(x), Some(y)] if header.is_earth => Some(Self::Degrees([x, y])),
            _ => None,
        }
    }

    fn of_map(map: &MapProjection) -> Option<Self> {
        let first = map.true_latitudes[0]?;
        let [latitude, longitude] = map.center?;
        if matches!(map.kind, MapKind::LatitudeLongitude | MapKind::Curvilinear) {
            return None;
        }
        let unmoved = Self::Map {
            kind: map.kind,
            true_latitudes: [first, map.true_latitudes[1].unwrap_or(first)],
            longitude: map.standard_longitude.unwrap_or(longitude),
            origin: [0.0; 2],
        };
        let origin = unmoved.place([longitude, latitude])?;
        match unmoved {
            Self::Map {
                kind,
                true_latitudes,
                longitude,
                ..
            } => Some(Self::Map {
                kind,
                true_latitudes,
                longitude,
                origin,
            }),
            Self::Degrees(_) | Self::MovedPole { .. } | Self::Arrays(_) => None,
        }
    }

    /// How far the corner that is farthest off lies from where the latitudes of the file have it, world length, where that
    /// is more than a twentieth of a step.
    pub fn disagreement(&self, map: &MapProjection) -> Option<f64> {
        let off = |corner: MapCorner| {
            let [latitude, longitude] = corner.latitude_longitude;
            let [x, y] = self.place([longitude, latitude])?;
            let off = (x - corner.world[0]).hypot(y - corner.world[1]);
            (off > MOST_OFF * corner.step).then_some(off)
        };
        let all = map.corners.into_iter().flatten().filter_map(off);
        all.max_by(f64::total_cmp)
    }

    /// True where the line between two longitudes goes over the edge of the map: on it, it would go around the Earth.
    fn is_over_edge(&self, a: f64, b: f64) -> bool {
        match *self {
            Self::Degrees(_) => (b - a).abs() > 180.0,
            Self::MovedPole { .. }
            | Self::Arrays(_)
            | Self::Map {
                kind: MapKind::PolarStereographic,
                ..
            } => false,
            Self::Map { longitude, .. } => {
                (wrapped(longitude, b) - wrapped(longitude, a)).abs() > 180.0
            }
        }
    }

    /// True where two places that lie beside each other on the Earth do not on the map.
    fn are_apart(&self, a: [f64; 2], b: [f64; 2]) -> bool {
        match self {
            Self::Arrays(arrays) => arrays.are_apart(a, b),
            Self::MovedPole { degree_lengths, .. } => {
                (b[0] - a[0]).abs() > 180.0 * degree_lengths[0]
            }
            _ => false,
        }
    }

    /// World length along x once around the Earth; `None` where the map does not go around it along x.
    pub fn turn_length(&self) -> Option<f64> {
        match *self {
            Self::Degrees([x, _])
            | Self::MovedPole {
                degree_lengths: [x, _],
                ..
            } => Some(360.0 * x),
            Self::Map {
                kind: MapKind::Mercator,
                true_latitudes: [first, _],
                ..
            } => Some(std::f64::consts::TAU * RADIUS * first.to_radians().cos()),
            Self::Map { .. } | Self::Arrays(_) => None,
        }
    }

    /// Degrees between places of a line that is bent on the map.
    fn fine(&self) -> f64 {
        match self {
            // Two places from column to column.
            Self::Arrays(arrays) => FINE.min(0.5 * arrays.step()).max(FINEST),
            _ => FINE,
        }
    }

    /// The last place on the map along the straight way from one that is on it to one that is not; `None` where the map ends
    /// nowhere that lines should be drawn to.
    fn border(&self, on: [f64; 2], off: [f64; 2]) -> Option<[f64; 2]> {
        let Self::Arrays(arrays) = self else {
            return None;
        };
        let mut last = None;
        let [mut inside, mut outside] = [0.0, 1.0];
        for _ in 0..HALVINGS {
            let part = 0.5 * (inside + outside);
            match arrays.place([0, 1].map(|k| on[k] + part * (off[k] - on[k]))) {
                Some(place) => (last, inside) = (Some(place), part),
                None => outside = part,
            }
        }
        last
    }

    /// The latitude in degrees of x and y of the world.
    pub fn latitude(&self, at: [f64; 2]) -> f64 {
        self.earth(at)[1]
    }

    /// Longitude and latitude in degrees of x and y of the world.
    pub fn earth(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let (kind, true_latitudes, middle, origin) = match *self {
            Self::Arrays(ref arrays) => return arrays.earth([x, y]),
            Self::Degrees([along_x, along_y]) => return [x / along_x, y / along_y],
            Self::MovedPole {
                pole,
                degree_lengths: [along_x, along_y],
                ..
            } => return pole.earth_from_grid([x / along_x, y / along_y]),
            Self::Map {
                kind,
                true_latitudes,
                longitude,
                origin,
            } => (kind, true_latitudes, longitude, origin),
        };
        let [x, y] = [x + origin[0], y + origin[1]];
        let [p1, p2] = true_latitudes.map(f64::to_radians);
        // The latitude of tan(45 + p / 2).
        let of_tan = |tan: f64| 2.0 * tan.atan() - std::f64::consts::FRAC_PI_2;
        let [l, p] = match kind {
            MapKind::Mercator => {
                let scale = RADIUS * p1.cos();
                [x / scale, of_tan((y / scale).exp())]
            }
            MapKind::Lambert => {
                let n = cone(p1, p2);
                let r = x.hypot(y);
                let ratio = RADIUS * p1.cos() / (n.abs() * r);
                // r has the sign of n.
                let l = (n.signum() * x).atan2(-n.signum() * y) / n;
                [l, of_tan(half_tan(p1) * ratio.powf(1.0 / n))]
            }
            MapKind::PolarStereographic => {
                let side = p1.signum();
                let far = x.hypot(y) / (RADIUS * (1.0 + p1.abs().sin()));
                let p = side * (std::f64::consts::FRAC_PI_2 - 2.0 * far.atan());
                [x.atan2(-side * y), p]
            }
            MapKind::LatitudeLongitude | MapKind::Curvilinear => [f64::NAN; 2],
        };
        [middle + l.to_degrees(), p.to_degrees()]
    }

    /// x and y of a longitude and a latitude in degrees, world; `None` where the map has no such place.
    pub fn place(&self, [longitude, latitude]: [f64; 2]) -> Option<[f64; 2]> {
        if let Self::Arrays(arrays) = self {
            return arrays.place([longitude, latitude]);
        }
        if let Self::MovedPole {
            pole,
            degree_lengths,
            middle,
        } = *self
        {
            let place = pole.grid_from_earth([longitude, latitude], middle);
            return Some([0, 1].map(|k| place[k] * degree_lengths[k]));
        }
        let Self::Map {
            kind,
            true_latitudes,
            longitude: middle,
            origin,
        } = *self
        else {
            let Self::Degrees([x, y]) = *self else {
                return None;
            };
            return Some([longitude * x, latitude * y]);
        };
        let l = wrapped(middle, longitude).to_radians();
        let p = latitude.to_radians();
        let [p1, p2] = true_latitudes.map(f64::to_radians);
        let [x, y] = match kind {
            MapKind::Mercator => {
                let scale = RADIUS * p1.cos();
                [scale * l, scale * half_tan(p).ln()]
            }
            MapKind::Lambert => {
                let n = cone(p1, p2);
                let r = RADIUS * p1.cos() / n * (half_tan(p1) / half_tan(p)).powf(n);
                [r * (n * l).sin(), -r * (n * l).cos()]
            }
            MapKind::PolarStereographic => {
                let side = p1.signum();
                let r = RADIUS * (1.0 + p1.abs().sin()) * p.cos() / (1.0 + (side * p).sin());
                [r * l.sin(), -side * r * l.cos()]
            }
            MapKind::LatitudeLongitude | MapKind::Curvilinear => return None,
        };
        let place = [x - origin[0], y - origin[1]];
        // Poles of maps that have none are far away.
        place
            .iter()
            .all(|n| n.is_finite() && n.abs() < 1e6)
            .then_some(place)
    }
}

/// Degrees from the middle of a map to a longitude, -180 to 180.
fn wrapped(middle: f64, longitude: f64) -> f64 {
    (longitude - middle + 180.0).rem_euclid(360.0) - 180.0
}

/// How often a longitude is to be turned around the Earth, so that from another one it lies the shorter way; none where both
/// are as long.
pub(super) fn turns(from: f64, to: f64) -> f64 {
    let turns = (from - to) / 360.0;
    if turns.abs() > 0.5 {
        turns.round()
    } else {
        0.0
    }
}

/// How many straight pieces of a map, no longer than `fine` degrees, stand for a line that is straight in longitude and latitude.
pub(super) fn pieces(a: [f64; 2], b: [f64; 2], fine: f64) -> u32 {
    let degrees = (b[0] - a[0]).abs().max((b[1] - a[1]).abs());
    (degrees / fine).ceil().max(1.0) as u32
}

/// Takes a line to the map, so many degrees to the east; gives its parts between edges of the map.
pub(super) fn projected_line(
    projection: &Projection,
    line: &[[f64; 2]],
    turn: f64,
    mut give: impl FnMut(Vec<[f64; 2]>),
) {
    let is_bent = !matches!(projection, Projection::Degrees(_));
    let mut part = Vec::new();
    let mut before: Option<[f64; 2]> = None;
    for &[longitude, latitude] in line {
        let mut place = [longitude + turn, latitude];
        let from = before.unwrap_or(place);
        if is_bent {
            place[0] += 360.0 * turns(from[0], place[0]);
        }
        let count = match is_bent {
            true => pieces(from, place, projection.fine()),
            false => 1,
        };
        let mut last = from;
        for i in 1..=count {
            let part_of_way = f64::from(i) / f64::from(count);
            let at = match i == count {
                true => place,
                false => [0, 1].map(|k| from[k] + part_of_way * (place[k] - from[k])),
            };
            if projection.is_over_edge(last[0], at[0]) {
                give(std::mem::take(&mut part));
            }
            match projection.place(at) {
                Some(place) => {
                    if part.is_empty() {
                        part.extend(projection.border(at, last));
                    }
                    let last = part.last().copied().unwrap_or(place);
                    if projection.are_apart(last, place) {
                        give(std::mem::take(&mut part));
                    }
                    part.push(place);
                }
                None => {
                    if !part.is_empty() {
                        part.extend(projection.border(last, at));
                    }
                    give(std::mem::take(&mut part));
                }
            }
            last = at;
        }
        before = Some(place);
    }
    give(part);
}

/// x of the middle of the grid, world.
fn middle(header: &Header) -> f64 {
    let middle = 0.5 * DVec3::from_array(header.dims.map(f64::from));
    header.world_from_voxel.transform_point3(middle).x
}

/// tan(45 + p / 2).
fn half_tan(p: f64) -> f64 {
    (std::f64::consts::FRAC_PI_4 + 0.5 * p).tan()
}

/// n of Lambert's cone.
fn cone(p1: f64, p2: f64) -> f64 {
    match (p1 - p2).abs() < 1e-9 {
        true => p1.sin(),
        false => (p1.cos() / p2.cos()).ln() / (half_tan(p2) / half_tan(p1)).ln(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_equator_lies_between_the_latitudes_of_both_sides() {
        for (kind, true_latitudes) in [
            (MapKind::Mercator, [0.0; 2]),
            (MapKind::Lambert, [-30.0, -60.0]),
            (MapKind::Lambert, [25.0, 25.0]),
            (MapKind::PolarStereographic, [-60.0; 2]),
            (MapKind::PolarStereographic, [70.0; 2]),
        ] {
            let map = MapProjection {
                kind,
                true_latitudes: true_latitudes.map(Some),
                standard_longitude: Some(20.0),
                center: Some([-3.0, 25.0]),
                corners: [None; 4],
                pole: None,
            };
            let projection = Projection::of_map(&map).expect("a map");
            for latitude in [-20.0, -1.0, 0.0, 1.0, 30.0] {
                let place = projection.place([33.0, latitude]).expect("a place");
                let found = projection.latitude(place);
                assert!((found - latitude).abs() < 1e-9, "{kind:?}: {found}");
            }
        }
        let degrees = Projection::Degrees([100.0, 111.0]);
        assert_eq!(degrees.latitude([7.0, -222.0]), -2.0);
    }

    /// A map with other numbers than a file's is not the one of PROJ (the first of `maps_are_those_of_proj`).
    #[test]
    fn wrong_numbers_of_a_map_are_seen() {
        let off = |change: fn(&mut MapProjection), radius: f64| {
            let mut map = MapProjection {
                kind: MapKind::Lambert,
                true_latitudes: [Some(30.0), Some(60.0)],
                standard_longitude: Some(-97.0),
                center: Some([40.0, -90.0]),
                corners: [None; 4],
                pole: None,
            };
            change(&mut map);
            let projection = Projection::of_map(&map).expect("a map");
            let [x, y] = projection.place([-83.0, 45.0]).expect("a place");
            let wanted = [479.750_441_100_790_06, 605.185_836_444_020_3];
            let part = radius / RADIUS;
            (part * x - wanted[0])
                .abs()
                .max((part * y - wanted[1]).abs())
        };
        // Lengths go with the radius.
        assert!(off(|_| (), RADIUS) < 1e-7);
        // Lambert's cone is the same with its parallels swapped.
        assert!(off(|map| map.true_latitudes.reverse(), RADIUS) < 1e-7);
        type Fault = fn(&mut MapProjection);
        let faults: [(&str, Fault, f64); 5] = [
            ("the radius of GRIB files", |_| (), 6371.229),
            ("one parallel", |map| map.true_latitudes[1] = None, RADIUS),
            (
                "the sign of the longitude",
                |map| map.standard_longitude = Some(97.0),
                RADIUS,
            ),
            (
                "the other pole",
                |map| map.true_latitudes = [Some(-30.0), Some(-60.0)],
                RADIUS,
            ),
            (
                "Mercator for Lambert",
                |map| map.kind = MapKind::Mercator,
                RADIUS,
            ),
        ];
        for (what, change, radius) in faults {
            let off = off(change, radius);
            println!("{what}: {off:.2e} km");
            assert!(off > 1e-3, "{what} is off by {off} km");
        }
    }

    #[test]
    fn lines_are_straight_in_degrees_and_end_at_the_edge_of_the_map() {
        let projection = |kind, true_latitudes: [f64; 2]| {
            let map = MapProjection {
                kind,
                true_latitudes: true_latitudes.map(Some),
                standard_longitude: Some(-90.0),
                center: Some([40.0, -90.0]),
                corners: [None; 4],
                pole: None,
            };
            Projection::of_map(&map).expect("a map")
        };
        let parts_of = |projection: &Projection, line: &[[f64; 2]], turn: f64| {
            let mut parts = Vec::new();
            projected_line(projection, line, turn, |part| parts.push(part));
            parts
        };
        let lambert = projection(MapKind::Lambert, [30.0, 60.0]);
        // A border on a parallel, 60 degrees long.
        let line = [[-120.0, 49.0], [-60.0, 49.0]];
        let parts = parts_of(&lambert, &line, 0.0);
        assert_eq!(parts.iter().map(Vec::len).collect::<Vec<_>>(), [241]);
        for (i, place) in parts[0].iter().enumerate() {
            let wanted = lambert.place([-120.0 + 0.25 * i as f64, 49.0]);
            assert_eq!(Some(*place), wanted);
        }
        // The edge of the maps is at 90 east, and lines go the shorter way over the 180th meridian.
        let line = [[89.5, 10.0], [90.5, 12.0], [179.5, 12.0], [-179.5, 12.0]];
        for projection in [lambert, projection(MapKind::Mercator, [20.0, 20.0])] {
            let parts = parts_of(&projection, &line, 0.0);
            let counts: Vec<usize> = parts.iter().map(Vec::len).collect();
            // 8 pieces of two degrees up, half of them before the edge; 356 of 89 degrees, 4 over the meridian.
            assert_eq!(counts, [4, 5 + 356 + 4], "{projection:?}");
        }
        let polar = projection(MapKind::PolarStereographic, [60.0, 60.0]);
        assert_eq!(parts_of(&polar, &line, 0.0).len(), 1);
        let degrees = Projection::Degrees([2.0, 3.0]);
        let parts = parts_of(&degrees, &line, 360.0);
        assert_eq!(parts[0], [[899.0, 30.0], [901.0, 36.0], [1079.0, 36.0]]);
        assert_eq!(parts[1], [[361.0, 36.0]]);
    }

    /// By PROJ 9 (pyproj), +R=6370000: 5 degrees to the north and 7 to the east of a place, from it, in kilometres.
    #[test]
    fn maps_are_those_of_proj() {
        let north = [40.0, -90.0];
        for (kind, true_latitudes, longitude, center, wanted) in [
            (
                MapKind::Lambert,
                [30.0, 60.0],
                -97.0,
                north,
                [479.750_441_100_790_06, 605.185_836_444_020_3],
            ),
            (
                MapKind::Lambert,
                [38.5, 38.5],
                10.0,
                north,
                [769.665_461_935_706_4, -220.443_830_099_875_6],
            ),
            (
                MapKind::PolarStereographic,
                [60.0, 60.0],
                -45.0,
                north,
                [888.093_768_654_082_9, 39.517_722_939_562_056],
            ),
            (
                MapKind::PolarStereographic,
                [-71.0, -71.0],
                20.0,
                [-70.0, 30.0],
                [423.819_021_015_133_67, 475.387_277_370_811_43],
            ),
            (
                MapKind::Mercator,
                [25.0, 25.0],
                -80.0,
                north,
                [705.327_068_894_086_4, 683.913_691_475_487_3],
            ),
        ] {
            let map = MapProjection {
                kind,
                true_latitudes: true_latitudes.map(Some),
                standard_longitude: Some(longitude),
                center: Some(center),
                corners: [
                    None,
                    Some(MapCorner {
                        latitude_longitude: center,
                        world: [0.0; 2],
                        step: 10.0,
                    }),
                    Some(MapCorner {
                        latitude_longitude: [center[0] + 5.0, center[1] + 7.0],
                        world: wanted,
                        step: 10.0,
                    }),
                    None,
                ],
                pole: None,
            };
            let projection = Projection::of_map(&map).expect("a map");
            let [latitude, longitude] = center;
            assert_eq!(projection.place([longitude, latitude]), Some([0.0; 2]));
            assert_eq!(projection.disagreement(&map), None);
            // A kilometre to the east.
            let mut moved = map;
            if let Some(corner) = &mut moved.corners[2] {
                corner.world[0] += 1.0;
            }
            let off = projection.disagreement(&moved).expect("they differ");
            assert!((off - 1.0).abs() < 1e-6, "{off}");
            let found = projection
                .place([longitude + 7.0, latitude + 5.0])
                .expect("a place");
            let back = projection.earth(found);
            assert!((back[1] - latitude - 5.0).abs() < 1e-9);
            assert!((wrapped(longitude, back[0]) - 7.0).abs() < 1e-9, "{kind:?}");
            for k in [0, 1] {
                // A tenth of a millimetre.
                assert!((found[k] - wanted[k]).abs() < 1e-7, "{kind:?} {found:?}");
            }
        }
    }
}
