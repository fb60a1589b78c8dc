//! All cells of a grid, layer by layer; the corners on an edge are made once and shared by its cells.
//!
//! The planes of the sweep are those of the voxel centres, and those of the grid box, where values are clamped. A
//! closed border adds a plane of no thickness outside, where nothing is inside.

use super::Border;
use super::cell::{corners_of_edge, pieces, share_a_face};
use crate::mesh::Mesh;
use crate::volume::Volume;
use glam::DVec3;

const NONE: u32 = u32::MAX;

/// One plane along an axis: where it is in voxel space, and which voxels it shows.
#[derive(Clone, Copy)]
struct Plane {
    at: f64,
    /// `None`: outside.
    voxel: Option<u32>,
}

fn planes(dim: u32, border: Border) -> Vec<Plane> {
    let plane = |at, voxel| Plane { at, voxel };
    let ends = |at, voxel| {
        let outside = (border == Border::Closed).then_some(plane(at, None));
        (outside, plane(at, Some(voxel)))
    };
    let (before, first) = ends(0.0, 0);
    let (after, last) = ends(f64::from(dim), dim - 1);
    let centers = (0..dim).map(|i| plane(f64::from(i) + 0.5, Some(i)));
    let start = before.into_iter().chain([first]);
    start.chain(centers).chain([last]).chain(after).collect()
}

pub(super) fn surface(volume: &Volume, level: f64, border: Border) -> Option<Mesh> {
    let axes: [Vec<Plane>; 3] = std::array::from_fn(|k| planes(volume.dims[k], border));
    let [nx, ny, nz] = [0, 1, 2].map(|k| axes[k].len());
    let field = Field { volume, level };
    let mut sweep = Sweep {
        axes: &axes,
        volume,
        made: vec![[NONE; 3]; 2 * nx * ny],
        mesh: Mesh::default(),
    };
    let layer = |z: usize| -> Vec<Option<f64>> {
        let nodes = (0..nx * ny).map(|i| [axes[0][i % nx], axes[1][i / nx], axes[2][z]]);
        nodes.map(|node| field.at(node)).collect()
    };
    let mut below = layer(0);
    for z in 0..nz - 1 {
        let above = layer(z + 1);
        for y in 0..ny - 1 {
            for x in 0..nx - 1 {
                let corner = |c: usize| {
                    let node = x + (c & 1) + nx * (y + (c >> 1 & 1));
                    if c & 4 == 0 { below[node] } else { above[node] }
                };
                let mut values = [0.0; 8];
                let mut all_valid = true;
                for (c, value) in values.iter_mut().enumerate() {
                    match corner(c) {
                        Some(number) => *value = number,
                        None => all_valid = false,
                    }
                }
                if all_valid {
                    sweep.cell([x, y, z], values)?;
                }
            }
        }
        // The upper plane is the lower one of the next layer.
        let (lower, upper) = sweep.made.split_at_mut(nx * ny);
        lower.copy_from_slice(upper);
        upper.fill([NONE; 3]);
        below = above;
    }
    if volume.world_from_voxel.matrix3.determinant() < 0.0 {
        for triangle in &mut sweep.mesh.triangles {
            triangle.swap(1, 2);
        }
    }
    Some(sweep.mesh)
}

struct Field<'a> {
    volume: &'a Volume,
    level: f64,
}

impl Field<'_> {
    /// The value less the level; `None` for no data.
    fn at(&self, node: [Plane; 3]) -> Option<f64> {
        let [Some(x), Some(y), Some(z)] = node.map(|plane| plane.voxel) else {
            return Some(-1.0);
        };
        let volume = self.volume;
        let [nx, ny, _] = volume.dims.map(|n| n as usize);
        let index = x as usize + nx * (y as usize + ny * z as usize);
        if volume
            .validity
            .as_ref()
            .is_some_and(|valid| valid[index] == 0)
        {
            return None;
        }
        let stored = f64::from(volume.voxels.stored(index));
        Some(stored * volume.rescale.slope + volume.rescale.intercept - self.level)
    }
}

struct Sweep<'a> {
    axes: &'a [Vec<Plane>; 3],
    volume: &'a Volume,
    /// For each node of the two planes of a layer, the corner on its edge along x, y, z.
    made: Vec<[u32; 3]>,
    mesh: Mesh,
}

impl Sweep<'_> {
    fn cell(&mut self, cell: [usize; 3], values: [f64; 8]) -> Option<()> {
        let inside = values.iter().filter(|&&value| value >= 0.0).count();
        if inside == 0 || inside == 8 {
            return Some(());
        }
        let mut is_room = true;
        pieces(values, |around| {
            let mut corners = [0; 12];
            for (corner, &edge) in corners.iter_mut().zip(around) {
                match self.corner(cell, edge.into(), &values) {
                    Some(made) => *corner = made,
                    None => is_room = false,
                }
            }
            self.fill(around, &corners[..around.len()]);
        });
        is_room.then_some(())
    }

    /// The corner on an edge of the cell, made where it is not there yet.
    fn corner(&mut self, cell: [usize; 3], edge: usize, values: &[f64; 8]) -> Option<u32> {
        let [from, to] = corners_of_edge(edge);
        let axis = edge / 4;
        let bit = |k: usize| from >> k & 1;
        let [nx, ny] = [self.axes[0].len(), self.axes[1].len()];
        let node = cell[0] + bit(0) + nx * (cell[1] + bit(1) + ny * bit(2));
        if self.made[node][axis] == NONE {
            let position = |corner: usize| {
                let at = |k: usize| self.axes[k][cell[k] + (corner >> k & 1)].at;
                DVec3::new(at(0), at(1), at(2))
            };
            let part = values[from] / (values[from] - values[to]);
            let voxel = position(from).lerp(position(to), part);
            let index = u32::try_from(self.mesh.positions.len()).ok()?;
            self.made[node][axis] = Some(index).filter(|&index| index != NONE)?;
            let world = self.volume.world_from_voxel.transform_point3(voxel);
            self.mesh.positions.push(world);
        }
        Some(self.made[node][axis])
    }

    /// Triangles of a polygon: of all ways the one with the shortest diagonals, none of them in a face of the cell,
    /// where the neighbour could draw it too.
    fn fill(&mut self, edges: &[u8], corners: &[u32]) {
        let count = corners.len();
        if count == 3 {
            self.mesh
                .triangles
                .push([corners[0], corners[1], corners[2]]);
            return;
        }
        let at = |i: usize| self.mesh.positions[corners[i] as usize];
        let price = |i: usize, j: usize| {
            let is_side = j - i == 1 || j - i == count - 1;
            if is_side {
                return 0.0;
            }
            let in_face = if share_a_face(edges[i], edges[j]) {
                FORBIDDEN
            } else {
                0.0
            };
            at(i).distance_squared(at(j)) + in_face
        };
        // best[i][j]: the least price of the polygon i, i + 1, ..., j, and the corner on its side i j.
        let mut best = [[(0.0, 0_usize); MOST_CORNERS]; MOST_CORNERS];
        for length in 2..count {
            for i in 0..count - length {
                let j = i + length;
                let least = (i + 1..j)
                    .map(|k| (best[i][k].0 + best[k][j].0 + price(i, k) + price(k, j), k))
                    .min_by(|a, b| a.0.total_cmp(&b.0));
                best[i][j] = least.expect("a corner between them");
            }
        }
        let mut parts = vec![[0, count - 1]];
        while let Some([i, j]) = parts.pop() {
            if j - i < 2 {
                continue;
            }
            let k = best[i][j].1;
            self.mesh
                .triangles
                .push([corners[i], corners[k], corners[j]]);
            parts.extend([[i, k], [k, j]]);
        }
    }
}

/// A cell has twelve edges.
const MOST_CORNERS: usize = 12;

/// More than all other diagonals of a polygon together cost.
const FORBIDDEN: f64 = 1e60;
