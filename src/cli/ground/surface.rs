//! A surface over the columns of a grid: linear in triangles between the middles of columns, level from there to the sides
//! of the box.
//!
//! ```text
//! nodes      at 0, 1/2, 3/2, ..., n - 1/2, n along each axis of voxels
//! triangles  two a cell of nodes, parted from its first corner to its last
//! ```

use crate::geometry::{Corner, Triangles};
use crate::volume::Grid;
use glam::{DAffine3, DVec3};

/// Heights in the world, one a column of voxels, x fastest; NaN where there is no ground.
#[derive(Clone, Debug)]
pub struct Surface {
    world_from_voxel: DAffine3,
    voxel_from_world: DAffine3,
    dims: [u32; 2],
    heights: Vec<f64>,
}

impl Surface {
    /// Over the columns of a grid whose third axis is upright; `None` where there are not as many heights.
    pub fn new(grid: &Grid, heights: Vec<f64>) -> Option<Self> {
        let [nx, ny, _] = grid.dims;
        let fits = heights.len() as u64 == u64::from(nx) * u64::from(ny) && !heights.is_empty();
        fits.then(|| Self {
            world_from_voxel: grid.world_from_voxel,
            voxel_from_world: grid.world_from_voxel.inverse(),
            dims: [nx, ny],
            heights,
        })
    }

    /// The lowest height.
    pub fn lowest(&self) -> f64 {
        self.heights.iter().copied().fold(f64::INFINITY, f64::min)
    }

    /// A place in voxels of the columns.
    pub fn voxel(&self, place: DVec3) -> [f64; 2] {
        let voxel = self.voxel_from_world.transform_point3(place);
        [voxel.x, voxel.y]
    }

    /// The height at x and y of a place; `None` outside of the box and where there is no ground.
    pub fn height(&self, place: DVec3) -> Option<f64> {
        let at = self.voxel(place);
        let cell = [0, 1].map(|k| {
            let n = f64::from(self.dims[k]);
            (0.0..=n).contains(&at[k]).then(|| {
                let node = ((at[k] + 0.5).floor() as u32).min(self.dims[k]);
                let [low, high] = [node, node + 1].map(|node| self.node(k, node));
                (node, (at[k] - low) / (high - low))
            })
        });
        let [Some((i, s)), Some((j, t))] = cell else {
            return None;
        };
        let height = |i, j| self.of_node([i, j]);
        let [from, to] = [height(i, j), height(i + 1, j + 1)];
        let found = match s >= t {
            true => from + s * (height(i + 1, j) - from) + t * (to - height(i + 1, j)),
            false => from + t * (height(i, j + 1) - from) + s * (to - height(i, j + 1)),
        };
        found.is_finite().then_some(found)
    }

    /// A line that lies on the surface, so finely cut that it keeps to it, and where there is none as it was.
    pub fn draped(&self, line: &[DVec3]) -> Vec<Vec<DVec3>> {
        let mut parts: Vec<Vec<DVec3>> = Vec::new();
        let mut was_over = None;
        for pair in line.windows(2) {
            let [a, b] = [pair[0], pair[1]].map(|place| self.voxel(place));
            let cells = (a[0] - b[0]).abs().max((a[1] - b[1]).abs());
            let count = (PIECES_PER_CELL * cells).ceil().clamp(1.0, MOST_PIECES) as u32;
            for i in 0..=count {
                let place = pair[0].lerp(pair[1], f64::from(i) / f64::from(count));
                let height = self.height(place);
                // It does not climb the side of the box.
                if was_over != Some(height.is_some()) {
                    parts.push(Vec::new());
                    was_over = Some(height.is_some());
                }
                let z = height.unwrap_or(place.z);
                let draped = DVec3::new(place.x, place.y, z);
                if let Some(part) = parts.last_mut()
                    && part.last() != Some(&draped)
                {
                    part.push(draped);
                }
            }
        }
        parts.retain(|part| part.len() > 1);
        parts
    }

    /// Its triangles, heights stretched, in colours of nodes by their place; none where a corner has no ground or colour.
    pub fn triangles(
        &self,
        stretch: DVec3,
        color: impl Fn(DVec3, DVec3) -> Option<[f32; 3]>,
    ) -> Triangles {
        let [across, down] = self.dims.map(|n| n + 2);
        let nodes = (0..down).flat_map(|j| (0..across).map(move |i| [i, j]));
        let corners: Vec<Option<Corner>> = nodes
            .map(|node| {
                let place = self.place(node);
                let color = color(place, self.normal(node, stretch))?;
                let place = stretch * place;
                place.z.is_finite().then_some(Corner { place, color })
            })
            .collect();
        let is_there = |numbers: &[u32; 3]| {
            let mut numbers = numbers.iter();
            numbers.all(|&number| corners[number as usize].is_some())
        };
        let cells = (0..down - 1).flat_map(|j| (0..across - 1).map(move |i| j * across + i));
        let all = cells.flat_map(|first| {
            let [right, below, last] = [first + 1, first + across, first + across + 1];
            [[first, right, last], [first, last, below]]
        });
        let all: Vec<[u32; 3]> = all.filter(is_there).collect();
        let bare = Corner {
            place: DVec3::ZERO,
            color: [0.0; 3],
        };
        let corners: Vec<Corner> = corners
            .iter()
            .map(|corner| corner.unwrap_or(bare))
            .collect();
        let mut triangles = Triangles::default();
        triangles.add(&corners, all);
        triangles
    }

    /// Upright walls at the sides of the box, from the surface down to a height, in one colour.
    pub fn walls(&self, stretch: DVec3, down_to: f64, color: [f32; 3]) -> Triangles {
        let [right, far] = self.dims.map(|n| n + 1);
        let rows = (0..=right).map(|i| [i, 0]);
        let back = (0..=right).map(|i| [i, far]);
        let columns = (0..=far).map(|j| [0, j]);
        let other = (0..=far).map(|j| [right, j]);
        let sides: [Vec<[u32; 2]>; 4] = [
            rows.collect(),
            back.collect(),
            columns.collect(),
            other.collect(),
        ];
        let mut triangles = Triangles::default();
        for side in sides {
            for pair in side.windows(2) {
                let [a, b] = [self.place(pair[0]), self.place(pair[1])];
                if !(a.z.is_finite() && b.z.is_finite()) {
                    continue;
                }
                let foot = |place: DVec3| DVec3::new(place.x, place.y, down_to);
                let corners = [a, b, foot(b), foot(a)].map(|place| Corner {
                    place: stretch * place,
                    color,
                });
                triangles.add(&corners, [[0, 1, 2], [0, 2, 3]]);
            }
        }
        triangles
    }

    /// A node along an axis, in voxels.
    fn node(&self, axis: usize, node: u32) -> f64 {
        let n = f64::from(self.dims[axis]);
        (f64::from(node) - 0.5).clamp(0.0, n)
    }

    fn of_node(&self, node: [u32; 2]) -> f64 {
        let [x, y] = [0, 1].map(|k| node[k].saturating_sub(1).min(self.dims[k] - 1));
        self.heights[y as usize * self.dims[0] as usize + x as usize]
    }

    fn place(&self, node: [u32; 2]) -> DVec3 {
        let [x, y] = [0, 1].map(|k| self.node(k, node[k]));
        let place = self
            .world_from_voxel
            .transform_point3(DVec3::new(x, y, 0.0));
        DVec3::new(place.x, place.y, self.of_node(node))
    }

    /// Upward, by the neighbours on both sides.
    fn normal(&self, [i, j]: [u32; 2], stretch: DVec3) -> DVec3 {
        let last = self.dims.map(|n| n + 1);
        let along = |from: [u32; 2], to: [u32; 2]| stretch * (self.place(to) - self.place(from));
        let x = along([i.saturating_sub(1), j], [(i + 1).min(last[0]), j]);
        let y = along([i, j.saturating_sub(1)], [i, (j + 1).min(last[1])]);
        let normal = x.cross(y).normalize_or_zero();
        if normal.z < 0.0 { -normal } else { normal }
    }
}

/// Places of a draped line.
const PIECES_PER_CELL: f64 = 4.0;
const MOST_PIECES: f64 = 4096.0;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::{Camera, Projection};
    use crate::geometry::Geometry;
    use glam::dvec3;

    /// 5 by 4 columns of 2 by 3, rows from the north down, heights a plane.
    fn grid() -> Grid {
        Grid {
            dims: [5, 4, 7],
            world_from_voxel: DAffine3 {
                matrix3: glam::DMat3::from_diagonal(dvec3(2.0, -3.0, 0.5)),
                translation: dvec3(10.0, 20.0, 0.0),
            },
        }
    }

    fn plane(place: DVec3) -> f64 {
        0.25 * place.x - 0.5 * place.y + 3.0
    }

    fn surface(height: impl Fn(DVec3) -> f64) -> Surface {
        let grid = grid();
        let middle = |x: u32, y: u32| {
            let voxel = dvec3(f64::from(x) + 0.5, f64::from(y) + 0.5, 0.0);
            grid.world_from_voxel.transform_point3(voxel)
        };
        let all = (0..4).flat_map(|y| (0..5).map(move |x| [x, y]));
        let heights = all.map(|[x, y]| height(middle(x, y))).collect();
        Surface::new(&grid, heights).expect("a surface")
    }

    #[test]
    fn a_plane_is_itself_between_columns_and_level_to_the_sides() {
        let surface = surface(plane);
        for i in 0..=40 {
            for j in 0..=40 {
                let voxel = [f64::from(i) / 8.0, f64::from(j) / 10.0];
                let place = dvec3(10.0 + 2.0 * voxel[0], 20.0 - 3.0 * voxel[1], 99.0);
                let held = [voxel[0].clamp(0.5, 4.5), voxel[1].clamp(0.5, 3.5)];
                let wanted = plane(dvec3(10.0 + 2.0 * held[0], 20.0 - 3.0 * held[1], 0.0));
                let found = surface.height(place).expect("a height");
                assert!((found - wanted).abs() < 1e-12, "{voxel:?}");
            }
        }
        assert_eq!(surface.height(dvec3(9.9, 15.0, 0.0)), None);
        assert_eq!(surface.height(dvec3(15.0, 20.1, 0.0)), None);
        assert!(Surface::new(&grid(), vec![0.0; 19]).is_none());
    }

    /// What is seen from above lies where the height is, at every pixel.
    #[test]
    fn triangles_lie_where_the_height_is_and_walls_below_them() {
        let rough = |place: DVec3| 2.0 + (1.7 * place.x).sin() + (0.9 * place.y).cos();
        let surface = surface(rough);
        let stretch = dvec3(1.0, 1.0, 4.0);
        let triangles = surface.triangles(stretch, |place, normal| {
            assert!(normal.z > 0.0 && (normal.length() - 1.0).abs() < 1e-12);
            Some([place.x as f32, 0.0, 0.0])
        });
        assert_eq!(triangles.len(), 2 * 6 * 5);
        let geometry = Geometry {
            triangles,
            ..Geometry::default()
        };
        let camera = Camera {
            eye: dvec3(15.0, 14.0, 100.0),
            target: dvec3(15.0, 14.0, 0.0),
            up: DVec3::Y,
            projection: Projection::Orthographic { view_height: 13.0 },
            zoom: 1.0,
        };
        let seen = geometry.seen(&camera, [61, 61], [0.0; 2]);
        let rays = camera.rays([61, 61]);
        let mut over = 0;
        for (i, (pixel, distance)) in seen.pixels.iter().zip(&seen.distances).enumerate() {
            let [x, y] = [i % 61, i / 61].map(|n| n as f64 + 0.5);
            let (origin, _) = rays.at(x, y);
            match surface.height(origin) {
                None => assert_eq!(*distance, f64::INFINITY),
                Some(height) => {
                    over += 1;
                    assert!((100.0 - distance - 4.0 * height).abs() < 1e-9, "pixel {i}");
                    assert!((f64::from(pixel[0]) - origin.x).abs() < 1e-5);
                }
            }
        }
        assert!(over > 2000, "{over}");
        // From the south a wall stands from the base up to the surface.
        let geometry = Geometry {
            triangles: surface.walls(stretch, -1.0, [1.0; 3]),
            ..Geometry::default()
        };
        for x in [10.2, 13.0, 17.9] {
            let edge = surface.height(dvec3(x, 8.0, 0.0)).expect("a height");
            for (z, is_wall) in [
                (-4.1, false),
                (-3.9, true),
                (4.0 * edge - 0.1, true),
                (4.0 * edge + 0.1, false),
            ] {
                let camera = Camera {
                    eye: dvec3(x, -50.0, z),
                    target: dvec3(x, 0.0, z),
                    up: DVec3::Z,
                    projection: Projection::Orthographic { view_height: 0.01 },
                    zoom: 1.0,
                };
                let seen = geometry.seen(&camera, [1, 1], [0.0; 2]);
                let wanted = if is_wall { 58.0 } else { f64::INFINITY };
                // The wall of the other side is as high.
                let is_near =
                    (seen.distances[0] - wanted).abs() < 1e-9 || seen.distances[0] == wanted;
                assert!(
                    is_near || !is_wall && seen.distances[0] > 60.0,
                    "{x} {z}: {seen:?}"
                );
            }
        }
    }

    #[test]
    fn a_draped_line_lies_on_the_surface_and_is_cut_at_the_side_of_the_box() {
        let rough = |place: DVec3| 2.0 + (1.7 * place.x).sin() + (0.9 * place.y).cos();
        let surface = surface(rough);
        let line = [dvec3(5.0, 12.0, 0.0), dvec3(25.0, 15.0, 0.0)];
        let parts = surface.draped(&line);
        assert_eq!(parts.len(), 3);
        for part in [&parts[0], &parts[2]] {
            assert!(
                part.iter()
                    .all(|place| place.z == 0.0 && surface.height(*place).is_none())
            );
        }
        assert!(parts[1].len() > 20);
        for pair in parts[1].windows(2) {
            for t in [0.0, 0.5, 1.0] {
                let place = pair[0].lerp(pair[1], t);
                let height = surface.height(place).expect("over the surface");
                // Within a quarter of a cell a chord leaves the triangles by little.
                assert!((place.z - height).abs() < if t == 0.5 { 0.2 } else { 1e-12 });
            }
        }
    }

    #[test]
    fn no_triangle_has_a_corner_without_ground() {
        let surface = surface(|place| {
            if place.x > 16.0 && place.y > 17.0 {
                f64::NAN
            } else {
                1.0
            }
        });
        let hole = surface.triangles(DVec3::ONE, |_, _| Some([0.5; 3]));
        assert!(!hole.is_empty() && hole.len() < 60);
        assert!(surface.height(dvec3(17.0, 18.5, 0.0)).is_none());
        let bare = surface.triangles(DVec3::ONE, |_, _| None);
        assert!(bare.is_empty());
    }
}
