//! From latitude and longitude to the world by the file's own latitudes and longitudes of two dimensions.
//!
//! ```text
//! P(u, v) = (1 - u)(1 - v) P00 + u (1 - v) P10 + (1 - u) v P01 + u v P11     longitude, latitude between four columns
//! (u, v) -= J^-1 (P(u, v) - P)                                               Newton's method, from the middle of the four
//! ```
//!
//! Columns lie in the middles of voxels; the half step around them goes on as the last one does. A quad is left out that has a
//! corner without a number, no area, a pole inside, or a side [`TORN`] times as long as the median: there the arrays are torn.
//! Quads are found by the longitudes and latitudes that blocks of them span.

use crate::cli::{Error, flow::Variables, flow::numbers};
use crate::volume::Header;
use glam::{DAffine3, DVec3};

/// Of the median side.
const TORN: f64 = 16.0;
/// Quads along a side of the smallest blocks.
const BLOCK: usize = 4;
/// Steps of Newton's method: it doubles its digits in each.
const MOST_STEPS: usize = 12;
/// Of a quad's side: what rounding leaves of a place on its border.
const SLACK: f64 = 1e-9;
/// Bytes of a column: its two numbers as they are read, and twice as they are kept.
const BYTES_PER_COLUMN: u64 = 48;

/// Latitudes and longitudes of columns, and where they are drawn.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Arrays {
    world_from_voxel: DAffine3,
    voxel_from_world: DAffine3,
    columns: [usize; 2],
    /// Longitude and latitude of the columns and of the border around them, degrees, x fastest.
    places: Vec<[f64; 2]>,
    /// The longest side that is not torn, degrees of a great circle.
    longest: f64,
    /// Degrees between neighbours, the median.
    step: f64,
    /// From blocks of quads to all of them.
    levels: Vec<Level>,
}

/// What blocks of quads span; both sides of the next level are half as many.
#[derive(Clone, Debug, PartialEq)]
struct Level {
    sides: [usize; 2],
    spans: Vec<Option<Span>>,
}

/// Degrees from and to; longitudes from the first one eastwards, 360 at most.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Span {
    longitudes: [f64; 2],
    latitudes: [f64; 2],
}

impl Arrays {
    /// Those of the variables that the header names; `None` where it names none, or they span nothing of the Earth.
    ///
    /// # Errors
    /// Where they cannot be read, or take too much memory.
    pub fn read(header: &Header, variables: &Variables<'_>) -> Result<Option<Self>, Error> {
        let Some(names) = &header.earth_arrays else {
            return Ok(None);
        };
        let [nx, ny, _] = header.dims;
        let wanted = BYTES_PER_COLUMN * u64::from(nx) * u64::from(ny);
        if wanted > variables.limits.max_bytes {
            return Err(Error::Memory(format!(
                "the latitudes and longitudes of {nx} x {ny} columns take {wanted} bytes, and there are {}",
                variables.limits.max_bytes
            )));
        }
        let read = |name: &String| -> Result<Option<Vec<f32>>, Error> {
            let source = variables.open(name)?;
            if source.header().dims != [nx, ny, 1] {
                return Ok(None);
            }
            let volume = variables.read(source.as_ref(), 0, 0)?;
            Ok(Some(numbers(&volume, 1.0)))
        };
        let [latitude, longitude] = names;
        let (Some(latitudes), Some(longitudes)) = (read(latitude)?, read(longitude)?) else {
            return Ok(None);
        };
        let places = longitudes.iter().zip(&latitudes);
        let places = places.map(|(&x, &y)| [f64::from(x), f64::from(y)]);
        Ok(Self::of(
            [nx as usize, ny as usize],
            places.collect(),
            header.world_from_voxel,
        ))
    }

    /// Of so many columns along x and y, with the longitude and the latitude of each, x fastest.
    fn of(columns: [usize; 2], places: Vec<[f64; 2]>, world_from_voxel: DAffine3) -> Option<Self> {
        if columns.iter().any(|&n| n < 2) {
            return None;
        }
        let mut arrays = Self {
            world_from_voxel,
            voxel_from_world: world_from_voxel.inverse(),
            columns,
            places: with_border(columns, &places),
            longest: f64::INFINITY,
            step: 0.0,
            levels: Vec::new(),
        };
        arrays.step = arrays.median_side()?;
        arrays.longest = TORN * arrays.step;
        arrays.levels = arrays.spans();
        let is_somewhere = arrays.levels.last()?.spans.iter().any(Option::is_some);
        is_somewhere.then_some(arrays)
    }

    /// Degrees between neighbours, the median.
    pub fn step(&self) -> f64 {
        self.step
    }

    /// Places of the world that are so far from each other do not lie beside each other on the Earth.
    pub fn are_apart(&self, a: [f64; 2], b: [f64; 2]) -> bool {
        let far = self.columns.map(|n| 0.25 * n as f64);
        let [from, to] = [a, b].map(|at| self.voxel(at));
        (0..2).any(|k| (to[k] - from[k]).abs() > far[k].max(2.0))
    }

    /// x and y of a longitude and a latitude; `None` off the grid.
    pub fn place(&self, at: [f64; 2]) -> Option<[f64; 2]> {
        if at.iter().any(|n| !n.is_finite()) {
            return None;
        }
        let top = self.levels.len().checked_sub(1)?;
        // Most of the Earth lies off the grid.
        let all = *self.levels[top].spans.first()?;
        if !all.is_some_and(|span| span.has(at)) {
            return None;
        }
        let mut blocks = vec![(top, [0, 0])];
        while let Some((level, [i, j])) = blocks.pop() {
            let Level { sides, spans } = &self.levels[level];
            if !spans[j * sides[0] + i].is_some_and(|span| span.has(at)) {
                continue;
            }
            if level > 0 {
                let [nx, ny] = self.levels[level - 1].sides;
                // The last that is pushed is looked at first.
                for [a, b] in [[1, 1], [0, 1], [1, 0], [0, 0]] {
                    let [i, j] = [2 * i + a, 2 * j + b];
                    if i < nx && j < ny {
                        blocks.push((level - 1, [i, j]));
                    }
                }
                continue;
            }
            for [i, j] in self.quads_of([i, j]) {
                if let Some([u, v]) = self.quad([i, j]).and_then(|quad| inverse(quad, at)) {
                    let x = self.voxel_of_node(0, i, u);
                    let y = self.voxel_of_node(1, j, v);
                    let place = DVec3::new(x, y, 0.5);
                    let place = self.world_from_voxel.transform_point3(place);
                    return Some([place.x, place.y]);
                }
            }
        }
        None
    }

    /// Longitude and latitude of x and y; off the grid those of its border.
    pub fn earth(&self, at: [f64; 2]) -> [f64; 2] {
        let voxel = self.voxel(at);
        let cell = [0, 1].map(|k| {
            let [first, last] = [0, self.columns[k]];
            // Nodes are half a step apart at both borders.
            let from_border = (voxel[k] + 0.5).floor().max(0.0) as usize;
            let node = from_border.clamp(first, last);
            let [low, high] = [0.0, 1.0].map(|u| self.voxel_of_node(k, node, u));
            (node, ((voxel[k] - low) / (high - low)).clamp(0.0, 1.0))
        });
        let [(i, u), (j, v)] = cell;
        let corners = self.corners([i, j]);
        corners.map_or([f64::NAN; 2], |corners| between(corners, [u, v]))
    }

    fn voxel(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let voxel = self
            .voxel_from_world
            .transform_point3(DVec3::new(x, y, 0.0));
        [voxel.x, voxel.y]
    }

    /// Where a part of the way from a node to the next lies along an axis, voxels from the border.
    fn voxel_of_node(&self, k: usize, node: usize, part: f64) -> f64 {
        let at = |node: usize| (node as f64 - 0.5).clamp(0.0, self.columns[k] as f64);
        at(node) + part * (at(node + 1) - at(node))
    }

    fn quad_counts(&self) -> [usize; 2] {
        self.columns.map(|n| n + 1)
    }

    /// The quads of a block of the first level.
    fn quads_of(&self, [i, j]: [usize; 2]) -> impl Iterator<Item = [usize; 2]> + use<> {
        let [nx, ny] = self.quad_counts();
        let range = |block: usize, n: usize| BLOCK * block..(BLOCK * (block + 1)).min(n);
        range(j, ny).flat_map(move |j| range(i, nx).map(move |i| [i, j]))
    }

    /// The corners of a quad, longitudes going on from the first; `None` where one has no number.
    fn corners(&self, [i, j]: [usize; 2]) -> Option<[[f64; 2]; 4]> {
        let row = self.columns[0] + 2;
        let first = j * row + i;
        let found = [first, first + 1, first + row, first + row + 1].map(|at| self.places[at]);
        let is_known = found.iter().flatten().all(|n| n.is_finite());
        let from = found[0][0];
        is_known.then(|| found.map(|[x, y]| [from + turned(x - from), y]))
    }

    /// The corners of a quad that has places.
    fn quad(&self, at: [usize; 2]) -> Option<[[f64; 2]; 4]> {
        let corners = self.corners(at)?;
        let sides = [[0, 1], [2, 3], [0, 2], [1, 3]];
        let is_whole = sides
            .iter()
            .all(|&[a, b]| arc(corners[a], corners[b]) <= self.longest);
        let longitudes = corners.map(|[x, _]| x);
        let low = longitudes.iter().copied().fold(f64::INFINITY, f64::min);
        let high = longitudes.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let [ax, ay] = [0, 1].map(|k| corners[3][k] - corners[0][k]);
        let [bx, by] = [0, 1].map(|k| corners[2][k] - corners[1][k]);
        let has_area = (ax * by - ay * bx).abs() > 0.0;
        (is_whole && has_area && high - low < 180.0).then_some(corners)
    }

    /// The median side of quads between columns; `None` where it is 0 or none is known.
    fn median_side(&self) -> Option<f64> {
        let [nx, ny] = self.columns;
        let inner = (1..ny).flat_map(|j| (1..nx).map(move |i| [i, j]));
        let corners = inner.filter_map(|at| self.corners(at));
        let mut sides: Vec<f64> = corners
            .flat_map(|[a, b, c, _]| [arc(a, b), arc(a, c)])
            .collect();
        let middle = sides.len() / 2;
        if sides.is_empty() {
            return None;
        }
        let (_, &mut median, _) = sides.select_nth_unstable_by(middle, f64::total_cmp);
        (median > 0.0).then_some(median)
    }

    fn spans(&self) -> Vec<Level> {
        let sides = self.quad_counts().map(|n| n.div_ceil(BLOCK));
        let blocks = (0..sides[1]).flat_map(|j| (0..sides[0]).map(move |i| [i, j]));
        let of_block = |block| {
            let quads = self.quads_of(block).filter_map(|at| self.quad(at));
            quads.map(Span::of).reduce(Span::with)
        };
        let mut levels = vec![Level {
            sides,
            spans: blocks.map(of_block).collect(),
        }];
        loop {
            let last = &levels[levels.len() - 1];
            if last.sides == [1, 1] {
                return levels;
            }
            let sides = last.sides.map(|n| n.div_ceil(2));
            let blocks = (0..sides[1]).flat_map(|j| (0..sides[0]).map(move |i| [i, j]));
            let of_parts = |[i, j]: [usize; 2]| {
                let parts = [[0, 0], [1, 0], [0, 1], [1, 1]].map(|[a, b]| [2 * i + a, 2 * j + b]);
                let parts = parts.into_iter();
                let there = parts.filter(|[i, j]| *i < last.sides[0] && *j < last.sides[1]);
                let spans = there.filter_map(|[i, j]| last.spans[j * last.sides[0] + i]);
                spans.reduce(Span::with)
            };
            let spans = blocks.map(of_parts).collect();
            levels.push(Level { sides, spans });
        }
    }
}

impl Span {
    fn of(corners: [[f64; 2]; 4]) -> Self {
        let ends = |k: usize| {
            let all = corners.iter().map(|corner| corner[k]);
            [
                all.clone().fold(f64::INFINITY, f64::min) - SLACK,
                all.fold(f64::NEG_INFINITY, f64::max) + SLACK,
            ]
        };
        Self {
            longitudes: ends(0),
            latitudes: ends(1),
        }
    }

    /// One that has both.
    fn with(self, other: Self) -> Self {
        let middle = |[low, high]: [f64; 2]| 0.5 * (low + high);
        let off = middle(other.longitudes) - middle(self.longitudes);
        let turn = turned(off) - off;
        let [low, high] = other.longitudes.map(|end| end + turn);
        let low = low.min(self.longitudes[0]);
        let high = high.max(self.longitudes[1]).min(low + 360.0);
        let [[a, b], [c, d]] = [self.latitudes, other.latitudes];
        Self {
            longitudes: [low, high],
            latitudes: [a.min(c), b.max(d)],
        }
    }

    fn has(&self, [longitude, latitude]: [f64; 2]) -> bool {
        let [west, east] = self.longitudes;
        let [south, north] = self.latitudes;
        (longitude - west).rem_euclid(360.0) <= east - west && (south..=north).contains(&latitude)
    }
}

/// The places of columns with a border half a step around them.
fn with_border([nx, ny]: [usize; 2], places: &[[f64; 2]]) -> Vec<[f64; 2]> {
    // From the outer one away from the inner one by half of their way.
    let beyond = |outer: [f64; 2], inner: [f64; 2]| {
        let way = [turned(outer[0] - inner[0]), outer[1] - inner[1]];
        [0, 1].map(|k| outer[k] + 0.5 * way[k])
    };
    let along = |row: &[[f64; 2]]| -> Vec<[f64; 2]> {
        let first = beyond(row[0], row[1]);
        let last = beyond(row[nx - 1], row[nx - 2]);
        let inner = row.iter().copied();
        std::iter::once(first).chain(inner).chain([last]).collect()
    };
    let rows: Vec<Vec<[f64; 2]>> = places.chunks(nx).map(along).collect();
    let border = |outer: usize, inner: usize| {
        let pairs = rows[outer].iter().zip(&rows[inner]);
        pairs.map(|(&outer, &inner)| beyond(outer, inner))
    };
    let first: Vec<[f64; 2]> = border(0, 1).collect();
    let last: Vec<[f64; 2]> = border(ny - 1, ny - 2).collect();
    let all = std::iter::once(first).chain(rows).chain([last]);
    all.flatten().collect()
}

/// P(u, v).
fn between([a, b, c, d]: [[f64; 2]; 4], [u, v]: [f64; 2]) -> [f64; 2] {
    [0, 1].map(|k| {
        (1.0 - u) * (1.0 - v) * a[k] + u * (1.0 - v) * b[k] + (1.0 - u) * v * c[k] + u * v * d[k]
    })
}

/// u and v of a place in a quad; `None` where it does not lie there.
fn inverse(corners: [[f64; 2]; 4], [longitude, latitude]: [f64; 2]) -> Option<[f64; 2]> {
    let [a, b, c, d] = corners;
    // Near the quad.
    let at = [a[0] + turned(longitude - a[0]), latitude];
    let [mut u, mut v] = [0.5; 2];
    for _ in 0..MOST_STEPS {
        let found = between(corners, [u, v]);
        let off = [0, 1].map(|k| found[k] - at[k]);
        let along_u = [0, 1].map(|k| (1.0 - v) * (b[k] - a[k]) + v * (d[k] - c[k]));
        let along_v = [0, 1].map(|k| (1.0 - u) * (c[k] - a[k]) + u * (d[k] - b[k]));
        let area = along_u[0] * along_v[1] - along_u[1] * along_v[0];
        let step = [
            (off[0] * along_v[1] - off[1] * along_v[0]) / area,
            (along_u[0] * off[1] - along_u[1] * off[0]) / area,
        ];
        if !step.iter().all(|n| n.is_finite()) {
            return None;
        }
        u -= step[0];
        v -= step[1];
        if step.iter().all(|n| n.abs() < SLACK) {
            let inside = -SLACK..=1.0 + SLACK;
            return (inside.contains(&u) && inside.contains(&v)).then_some([u, v]);
        }
    }
    None
}

/// An angle from -180 to 180.
fn turned(degrees: f64) -> f64 {
    (degrees + 180.0).rem_euclid(360.0) - 180.0
}

/// Degrees of the great circle between two places.
fn arc(a: [f64; 2], b: [f64; 2]) -> f64 {
    let sin2 = |degrees: f64| (0.5 * degrees.to_radians()).sin().powi(2);
    let cosines = a[1].to_radians().cos() * b[1].to_radians().cos();
    let chord2 = sin2(b[1] - a[1]) + cosines * sin2(b[0] - a[0]);
    (2.0 * chord2.clamp(0.0, 1.0).sqrt().asin()).to_degrees()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A grid that is turned by 30 degrees and sheared, its middle on the 180th meridian; two kilometres a column.
    fn bent(columns: [usize; 2]) -> Vec<[f64; 2]> {
        let [nx, ny] = columns;
        let all = (0..ny).flat_map(|j| (0..nx).map(move |i| [i, j]));
        let place = |[i, j]: [usize; 2]| {
            let x = 0.5 * (i as f64 - 0.5 * nx as f64);
            let y = 0.5 * (j as f64 - 0.5 * ny as f64);
            let (sin, cos) = 30_f64.to_radians().sin_cos();
            let longitude = 180.0 + cos * x - sin * y + 0.01 * x * y;
            [turned(longitude), 50.0 + sin * x + cos * y]
        };
        all.map(place).collect()
    }

    fn arrays(columns: [usize; 2], places: Vec<[f64; 2]>) -> Option<Arrays> {
        let world = DAffine3::from_scale_rotation_translation(
            DVec3::new(2.0, -2.0, 1.0),
            glam::DQuat::IDENTITY,
            DVec3::new(-7.0, 30.0, 0.0),
        );
        Arrays::of(columns, places, world)
    }

    #[test]
    fn columns_lie_in_the_middles_of_voxels_and_the_way_back_is_the_same() {
        let columns = [23, 14];
        let places = bent(columns);
        let arrays = arrays(columns, places.clone()).expect("a map");
        for (n, &[longitude, latitude]) in places.iter().enumerate() {
            let wanted = [
                -7.0 + 2.0 * ((n % 23) as f64 + 0.5),
                30.0 - 2.0 * ((n / 23) as f64 + 0.5),
            ];
            for turn in [-360.0, 0.0, 720.0] {
                let found = arrays.place([longitude + turn, latitude]).expect("a place");
                for k in [0, 1] {
                    assert!((found[k] - wanted[k]).abs() < 1e-7, "{found:?} {wanted:?}");
                }
            }
            let back = arrays.earth(wanted);
            assert!(turned(back[0] - longitude).abs() < 1e-9, "{back:?}");
            assert!((back[1] - latitude).abs() < 1e-9, "{back:?}");
        }
        // Between columns and in the border around them.
        for [i, j] in [
            [0.2, 0.3],
            [4.9, 7.1],
            [22.9, 13.8],
            [11.0, 0.0],
            [23.0, 14.0],
        ] {
            let world = [-7.0 + 2.0 * i, 30.0 - 2.0 * j];
            let found = arrays.place(arrays.earth(world)).expect("a place");
            for k in [0, 1] {
                assert!((found[k] - world[k]).abs() < 1e-7, "{found:?} {world:?}");
            }
        }
        // Off the grid.
        for at in [[-170.0, 30.0], [0.0, 50.0], [180.0, f64::NAN]] {
            assert_eq!(arrays.place(at), None, "{at:?}");
        }
    }

    /// A place that is found lies where the arrays have it, wherever the grid is torn or has no numbers.
    #[test]
    fn torn_quads_and_holes_have_no_places() {
        let columns = [23, 14];
        let mut places = bent(columns);
        // A block as models leave it that compute nothing there, and one column without a number.
        for j in 3..9 {
            for i in 5..12 {
                places[23 * j + i] = [0.0, 0.0];
            }
        }
        places[23 * 11 + 18] = [f64::NAN, 50.0];
        let arrays = arrays(columns, places.clone()).expect("a map");
        let whole = bent(columns);
        assert_eq!(arrays.place(whole[23 * 6 + 8]), None);
        assert_eq!(arrays.place(whole[23 * 11 + 18]), None);
        assert!(arrays.place(whole[23 * 12 + 20]).is_some());
        // Nothing is drawn along the long sides between both.
        for part in [0.1, 0.3, 0.5, 0.7, 0.9] {
            let [x, y] = [whole[23 * 3 + 4][0].rem_euclid(360.0), whole[23 * 3 + 4][1]];
            assert_eq!(arrays.place([part * x, part * y]), None, "{part}");
        }
    }

    #[test]
    fn arrays_without_an_area_are_no_map() {
        assert!(arrays([5, 4], vec![[0.0, 0.0]; 20]).is_none());
        assert!(arrays([5, 4], vec![[f64::NAN; 2]; 20]).is_none());
        assert!(arrays([20, 1], vec![[1.0, 2.0]; 20]).is_none());
        let line = (0..20).map(|i| [f64::from(i), f64::from(i)]).collect();
        assert!(arrays([5, 4], line).is_none());
    }
}
