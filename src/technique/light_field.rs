//! The light volume on the CPU: CPU reference of `shaders/light_cells.wgsl`, `light_volume.wgsl` and `lib/light.wgsl`.
//!
//! ```text
//! A = k mean of (1 - exp(-sigma_i L))     sigma = -ln(1 - min(A, 1 - 2^-12)) / L        of a cell
//! sigma = k mean of sigma_i                                                              of one where light is scattered
//! open = sum over r of w_r exp(-sum of sigma d)                                          at a node, of a bundle
//! ambient light at p = 1 - s (1 - open(p + d v))     light i: open(p + d l_i)            trilinear between nodes
//! light that is scattered at p: open(p), ln open trilinear between nodes
//! ```

use super::LightPlan;
use crate::ray::vector;
use crate::real::{Real, add, dot, scale};
use crate::shaders::Frame;
use crate::transfer::{extinction, opacity_over};

/// Nothing that counts comes through more.
const DARK: f64 = 12.0;
/// ln 2^-24: where light is scattered nothing is darker.
const DARKEST: f64 = -16.635_532;

/// What comes through to each node, bundle after bundle.
#[derive(Clone, Debug)]
pub struct LightField<R> {
    open: Vec<R>,
}

impl<R: Real> LightField<R> {
    /// Follows light through matter. `extinction_at` says how much there is at a position in voxel space; `None` for
    /// no data.
    pub fn new(
        plan: &LightPlan,
        frame: &Frame,
        extinction_at: impl Fn([R; 3]) -> Option<R> + Sync,
    ) -> Self {
        let [nx, ny, nz] = plan.cells;
        let cells = layers(nz, |z| {
            let mut layer = Vec::with_capacity((nx * ny) as usize);
            for y in 0..ny {
                layer.extend((0..nx).map(|x| cell(plan, frame, [x, y, z], &extinction_at)));
            }
            layer
        });
        Self::through(plan, &cells)
    }

    /// The same of cells whose extinctions are known.
    pub fn through(plan: &LightPlan, cells: &[R]) -> Self {
        let nodes = plan.cells.map(|n| n + 1);
        let open = layers(nodes[2] * plan.bundle_count, |layer| {
            let (bundle, z) = (layer / nodes[2], layer % nodes[2]);
            let mut found = Vec::with_capacity((nodes[0] * nodes[1]) as usize);
            for y in 0..nodes[1] {
                let node = |x| [x, y, z].map(|n| n as i32);
                found.extend((0..nodes[0]).map(|x| open(plan, cells, bundle, node(x))));
            }
            found
        });
        Self { open }
    }

    /// What comes through to each node, x fastest, bundle after bundle.
    pub fn open(&self) -> &[R] {
        &self.open
    }

    /// Part of the light from all around at a position in voxel space, seen along a ray.
    pub fn ambient_at(&self, frame: &Frame, voxel: [R; 3], ray_direction: [R; 3]) -> R {
        let one = R::from_f64(1.0);
        if frame.occlusion_strength == 0.0 {
            return one;
        }
        one - R::from_f32(frame.occlusion_strength)
            * (one - self.through_at(frame, 0, voxel, ray_direction.map(|d| -d)))
    }

    /// Part of the light of a lamp there.
    pub fn lamp_at(&self, frame: &Frame, lamp: usize, voxel: [R; 3]) -> R {
        let [x, y, z, w] = frame.light_directions[lamp];
        if frame.has_shadows == 0 || w != 0.0 {
            return R::from_f64(1.0);
        }
        let bundle = frame.shadow_bundle + lamp as u32;
        self.through_at(frame, bundle, voxel, vector([x, y, z]))
    }

    /// Part of the light of a bundle at a position inside of matter: between nodes optical depths are interpolated. CPU
    /// reference of `light_depth.wgsl`.
    pub(super) fn scattered_at(&self, frame: &Frame, bundle: u32, voxel: [R; 3]) -> R {
        let depth_of = |open: R| open.max(R::from_f32(1e-30)).ln().max(R::from_f64(DARKEST));
        self.between_nodes(frame, bundle, voxel, depth_of).exp()
    }

    /// A cell nearer to where light comes from.
    fn through_at(&self, frame: &Frame, bundle: u32, voxel: [R; 3], towards: [R; 3]) -> R {
        let way = scale(towards, R::from_f32(frame.light_reach));
        let step = frame
            .voxel_from_world
            .map(|[x, y, z, _]| dot(vector([x, y, z]), way));
        self.between_nodes(frame, bundle, add(voxel, step), |open| open)
    }

    /// What `of` makes of what comes through to nodes, trilinear between them.
    fn between_nodes(&self, frame: &Frame, bundle: u32, voxel: [R; 3], of: impl Fn(R) -> R) -> R {
        let (zero, one) = (R::from_f64(0.0), R::from_f64(1.0));
        let cells = vector::<R>(frame.light_cells);
        let per_voxel = vector::<R>(frame.light_cells_per_voxel);
        let at: [R; 3] = std::array::from_fn(|k| (voxel[k] * per_voxel[k]).max(zero).min(cells[k]));
        let low: [R; 3] = std::array::from_fn(|k| at[k].floor().min(cells[k] - one));
        let nodes = frame.light_cells.map(|n| n as usize + 1);
        let part: [R; 3] = std::array::from_fn(|k| at[k] - low[k]);
        let low = low.map(|n| n.to_i32() as usize);
        let mut open = zero;
        for corner in 0..8 {
            let bit = |k: usize| corner >> k & 1;
            let weight = |k: usize| if bit(k) == 1 { part[k] } else { one - part[k] };
            let [x, y, z] = std::array::from_fn(|k| low[k] + bit(k));
            let index = x + nodes[0] * (y + nodes[1] * (z + nodes[2] * bundle as usize));
            open = open + weight(0) * weight(1) * weight(2) * of(self.open[index]);
        }
        open
    }
}

/// The extinction of a cell.
fn cell<R: Real>(
    plan: &LightPlan,
    frame: &Frame,
    cell: [u32; 3],
    extinction_at: &impl Fn([R; 3]) -> Option<R>,
) -> R {
    let grid = plan.parameters();
    let size = vector::<R>(grid.cell_voxels);
    let length = R::from_f32(grid.cell_length);
    let n = |x: u32| R::from_f64(x.into());
    let low: [R; 3] = std::array::from_fn(|k| n(cell[k]) * size[k]);
    let [lx, ly, lz] = plan.looks;
    let amount_in = |extinction: R| match plan.adds_extinctions {
        true => extinction,
        false => opacity_over(extinction, length),
    };
    let mut amount = R::from_f64(0.0);
    for look in (0..lz).flat_map(|z| (0..ly).flat_map(move |y| (0..lx).map(move |x| [x, y, z]))) {
        let place = std::array::from_fn(|k| {
            low[k] + (n(look[k]) + R::from_f64(0.5)) * (size[k] / n(plan.looks[k]))
        });
        if let Some(extinction) = extinction_at(place) {
            amount = amount + amount_in(extinction);
        }
    }
    let amount = amount * (kept_share(frame, low, size) / n(lx * ly * lz));
    match plan.adds_extinctions {
        true => amount,
        false => extinction(amount, length),
    }
}

/// The part of a cell that no crop and no clip plane cuts away.
fn kept_share<R: Real>(frame: &Frame, low: [R; 3], size: [R; 3]) -> R {
    let (zero, one) = (R::from_f64(0.0), R::from_f64(1.0));
    let (from, to) = (vector::<R>(frame.domain_min), vector::<R>(frame.domain_max));
    let mut share = one;
    for k in 0..3 {
        let inside = (low[k] + size[k]).min(to[k]) - low[k].max(from[k]);
        share = share * (inside / size[k]).max(zero).min(one);
    }
    let rows = frame.world_from_voxel;
    let half = R::from_f64(0.5);
    let center: [R; 3] = std::array::from_fn(|k| low[k] + half * size[k]);
    let center = rows.map(|[x, y, z, w]| dot(vector([x, y, z]), center) + R::from_f32(w));
    for &[x, y, z, offset] in &frame.clip_planes[..frame.clip_plane_count as usize] {
        let normal = vector::<R>([x, y, z]);
        let height = dot(normal, center) - R::from_f32(offset);
        let slope = |k: usize| dot(normal, rows.map(|row| R::from_f32(row[k]))).abs();
        let width = dot([slope(0), slope(1), slope(2)], size);
        share = share * (height / width + half).max(zero).min(one);
    }
    share
}

/// What comes through to a node by the paths of a bundle.
fn open<R: Real>(plan: &LightPlan, cells: &[R], bundle: u32, node: [i32; 3]) -> R {
    let paths = &plan.paths;
    let range = |[first, end, ..]: [f32; 4]| first as usize..end as usize;
    let mut open = R::from_f64(0.0);
    for path in &paths[range(paths[bundle as usize])] {
        let pieces = &paths[range(*path)];
        open = open + R::from_f32(path[2]) * (-depth_along(plan, cells, node, pieces)).exp();
    }
    open
}

fn depth_along<R: Real>(plan: &LightPlan, cells: &[R], node: [i32; 3], pieces: &[[f32; 4]]) -> R {
    let counts = plan.cells.map(|n| n as usize);
    let mut depth = R::from_f64(0.0);
    for &[x, y, z, length] in pieces {
        let cell: [i32; 3] = std::array::from_fn(|k| node[k] + [x, y, z][k] as i32);
        let is_outside = (0..3).any(|k| !(0..counts[k] as i32).contains(&cell[k]));
        if is_outside || depth > R::from_f64(DARK) {
            break;
        }
        let [x, y, z] = cell.map(|n| n as usize);
        depth = depth + R::from_f32(length) * cells[x + counts[0] * (y + counts[1] * z)];
    }
    depth
}

/// `layer` of each of so many, one behind the other, shared out among the machine's cores.
fn layers<R: Real>(count: u32, layer: impl Fn(u32) -> Vec<R> + Sync) -> Vec<R> {
    let threads = std::thread::available_parallelism().map_or(1, |n| n.get() as u32);
    let threads = threads.min(count.max(1));
    let mut shares = std::thread::scope(|scope| {
        let layer = &layer;
        let workers: Vec<_> = (0..threads)
            .map(|first| {
                let mine = (first..count).step_by(threads as usize);
                scope.spawn(move || mine.map(layer).collect::<Vec<_>>())
            })
            .collect();
        let joined = workers
            .into_iter()
            .map(|worker| worker.join().expect("a cell does not panic"));
        joined.map(Vec::into_iter).collect::<Vec<_>>()
    });
    (0..count as usize)
        .flat_map(|z| shares[z % threads as usize].next().expect("every layer"))
        .collect()
}
