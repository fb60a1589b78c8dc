//! Connected components of a mask: voxels that share a face belong together.
//!
//! Runs along x are joined by union-find: Rosenfeld, Pfaltz, "Sequential Operations in Digital Picture Processing",
//! J. ACM 13(4), 1966; Tarjan, "Efficiency of a Good But Not Linear Set Union Algorithm", J. ACM 22(2), 1975.

use super::VoxelBox;

/// Voxels of a mask that are connected across faces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Component {
    /// How many they are.
    pub voxels: u64,
    /// Where they lie.
    pub bounds: VoxelBox,
    /// Their surface, in the units of `spacing` squared; faces of the grid box do not count.
    pub surface: f64,
}

/// The components of a mask.
#[derive(Debug)]
pub struct Components {
    /// Each of them, in the order of its first voxel.
    pub all: Vec<Component>,
    runs: Vec<Run>,
}

/// Voxels beside each other along x.
#[derive(Clone, Copy, Debug)]
struct Run {
    /// The first voxel, counted in the grid.
    first: usize,
    length: usize,
    /// Before the end another run of the same component, then the component.
    parent: usize,
}

impl Components {
    /// Of the voxels where `mask` is true; as many as `dims` say, x fastest.
    pub fn of(mask: &[bool], dims: [u32; 3], spacing: [f64; 3]) -> Self {
        let [nx, ny, nz] = dims.map(|n| n as usize);
        assert_eq!(mask.len(), nx * ny * nz, "a mask of the grid");
        let [sx, sy, sz] = spacing;
        let areas = [sy * sz, sx * sz, sx * sy];
        let mut runs: Vec<Run> = Vec::new();
        let mut surfaces: Vec<f64> = Vec::new();
        // Where the runs of each row begin.
        let mut rows = Vec::with_capacity(ny * nz + 1);
        for row in 0..ny * nz {
            rows.push(runs.len());
            let (y, z) = (row % ny, row / ny);
            let mut x = 0;
            let voxels = &mask[row * nx..(row + 1) * nx];
            while x < nx {
                let Some(start) = voxels[x..].iter().position(|&is_set| is_set) else {
                    break;
                };
                let start = x + start;
                let length = voxels[start..].iter().position(|&is_set| !is_set);
                let length = length.unwrap_or(nx - start);
                x = start + length;
                let parent = runs.len();
                runs.push(Run {
                    first: row * nx + start,
                    length,
                    parent,
                });
                let inner =
                    |at_low: bool, at_high: bool| 2.0 - f64::from(at_low) - f64::from(at_high);
                let length = length as f64;
                surfaces.push(
                    areas[0] * inner(start == 0, x == nx)
                        + areas[1] * length * inner(y == 0, y + 1 == ny)
                        + areas[2] * length * inner(z == 0, z + 1 == nz),
                );
            }
        }
        rows.push(runs.len());
        for row in 0..ny * nz {
            let before = [
                (row % ny > 0).then(|| (row - 1, areas[1])),
                (row >= ny).then(|| (row - ny, areas[2])),
            ];
            for (other, area) in before.into_iter().flatten() {
                let shift = (row - other) * nx;
                let (mut a, mut b) = (rows[other], rows[row]);
                while a < rows[other + 1] && b < rows[row + 1] {
                    let (start_a, start_b) = (runs[a].first + shift, runs[b].first);
                    let (end_a, end_b) = (start_a + runs[a].length, start_b + runs[b].length);
                    let (start, end) = (start_a.max(start_b), end_a.min(end_b));
                    if start < end {
                        surfaces[b] -= 2.0 * area * (end - start) as f64;
                        join(&mut runs, a, b);
                    }
                    if end_a < end_b { a += 1 } else { b += 1 }
                }
            }
        }
        Self::counted(runs, &surfaces, [nx, ny])
    }

    /// Numbers the components, and adds up what belongs to each.
    fn counted(mut runs: Vec<Run>, surfaces: &[f64], [nx, ny]: [usize; 2]) -> Self {
        let mut all: Vec<Component> = Vec::new();
        for run in 0..runs.len() {
            // A root is the first run of its component: those before have their number already.
            let parent = runs[run].parent;
            runs[run].parent = if parent == run {
                all.push(Component {
                    voxels: 0,
                    bounds: VoxelBox {
                        min: [u32::MAX; 3],
                        max: [0; 3],
                    },
                    surface: 0.0,
                });
                all.len() - 1
            } else {
                runs[parent].parent
            };
            let Run {
                first,
                length,
                parent,
            } = runs[run];
            let component = &mut all[parent];
            let at = [first % nx, first / nx % ny, first / nx / ny].map(|at| at as u32);
            let end = [at[0] + length as u32, at[1] + 1, at[2] + 1];
            component.voxels += length as u64;
            component.surface += surfaces[run];
            for k in 0..3 {
                component.bounds.min[k] = component.bounds.min[k].min(at[k]);
                component.bounds.max[k] = component.bounds.max[k].max(end[k]);
            }
        }
        Self { all, runs }
    }

    /// Each voxel of the mask, runs at a time: the range of voxels, and the number of their component.
    pub fn runs(&self) -> impl Iterator<Item = (std::ops::Range<usize>, usize)> + '_ {
        self.runs
            .iter()
            .map(|run| (run.first..run.first + run.length, run.parent))
    }
}

/// The first run of the component that `run` is of; ways on it are made half as long.
fn root(runs: &mut [Run], mut run: usize) -> usize {
    while runs[run].parent != run {
        runs[run].parent = runs[runs[run].parent].parent;
        run = runs[run].parent;
    }
    run
}

fn join(runs: &mut [Run], a: usize, b: usize) {
    let (a, b) = (root(runs, a), root(runs, b));
    runs[a.max(b)].parent = a.min(b);
}
