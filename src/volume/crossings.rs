//! Which part of a ray lies in a box of voxels.
//!
//! ```text
//! t_k(p) = (p - o_k) / d_k                   where the ray o + t d crosses plane p of axis k
//! t from max_k t_k(near_k), and from 0,  to  min_k t_k(far_k)
//! ```
//!
//! Each crossing is rounded once, alike for all boxes that have the face, and never decreases along the ray. So the parts
//! that boxes cut out of a ray tile it without gap or overlap, whichever way a grid is cut into boxes.

/// A part of a ray along which all voxels are full, or all are empty.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayInterval {
    /// Parameter t of the ray where it begins.
    pub start: f64,
    /// Parameter t of the ray where it ends.
    pub end: f64,
    /// Whether the voxels in between are full.
    pub is_full: bool,
}

/// A ray whose numbers are finite.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    origin: [f64; 3],
    direction: [f64; 3],
}

impl Line {
    /// `None` where a number is not finite: no plane is crossed at a known place.
    pub fn new(origin: [f64; 3], direction: [f64; 3]) -> Option<Self> {
        let is_finite = origin.iter().chain(&direction).all(|n| n.is_finite());
        is_finite.then_some(Self { origin, direction })
    }

    /// Where the ray is between planes `low` (included) and `high` of axis `k`; ends before it starts where it never is.
    pub fn between(&self, k: usize, low: u64, high: u64) -> [f64; 2] {
        let (o, d) = (self.origin[k], self.direction[k]);
        let (low, high) = (low as f64, high as f64);
        if d == 0.0 {
            return match low <= o && o < high {
                true => [f64::NEG_INFINITY, f64::INFINITY],
                false => [f64::INFINITY, f64::NEG_INFINITY],
            };
        }
        let (near, far) = if d > 0.0 { (low, high) } else { (high, low) };
        [near, far].map(|plane| (plane - o) / d)
    }

    /// The part from t = 0 on that lies in a grid of `dims` voxels; `None` where there is none.
    pub fn in_grid(&self, dims: [u32; 3]) -> Option<[f64; 2]> {
        (0..3).try_fold([0.0, f64::INFINITY], |part, k| {
            both(part, self.between(k, 0, dims[k].into()))
        })
    }

    /// Whether coordinate `k` decreases along the ray.
    pub fn is_backward(&self, k: usize) -> bool {
        self.direction[k] < 0.0
    }

    /// The voxel number along axis `k` that the ray is in just behind `t`, in a grid of `count`; the ray is in the grid
    /// there.
    pub fn voxel_behind(&self, k: usize, t: f64, count: u32) -> u32 {
        let last = f64::from(count) - 1.0;
        let mut voxel = (self.origin[k] + t * self.direction[k])
            .floor()
            .clamp(0.0, last) as u32;
        // The product may have been rounded over a plane.
        let part = |voxel: u32| self.between(k, voxel.into(), u64::from(voxel) + 1);
        while part(voxel)[1] <= t
            && let Some(next) = self.next(k, voxel, count)
        {
            voxel = next;
        }
        while part(voxel)[0] > t
            && let Some(before) = self.before(k, voxel, count)
        {
            voxel = before;
        }
        voxel
    }

    /// The voxel number behind `voxel` along axis `k`; `None` where the grid ends.
    pub fn next(&self, k: usize, voxel: u32, count: u32) -> Option<u32> {
        match self.is_backward(k) {
            true => voxel.checked_sub(1),
            false => Some(voxel + 1).filter(|&next| next < count),
        }
    }

    fn before(&self, k: usize, voxel: u32, count: u32) -> Option<u32> {
        match self.is_backward(k) {
            true => Some(voxel + 1).filter(|&before| before < count),
            false => voxel.checked_sub(1),
        }
    }
}

/// What two parts of a ray have in common; `None` where that is nothing or a point.
pub(super) fn both(a: [f64; 2], b: [f64; 2]) -> Option<[f64; 2]> {
    let [start, end] = [a[0].max(b[0]), a[1].min(b[1])];
    (start < end).then_some([start, end])
}

/// Parts of a ray in their order, neighbours of a kind put together.
#[derive(Debug, Default)]
pub(super) struct Intervals(pub Vec<RayInterval>);

impl Intervals {
    /// Adds what follows.
    pub fn push(&mut self, [start, end]: [f64; 2], is_full: bool) {
        if start >= end {
            return;
        }
        match self.0.last_mut() {
            Some(last) if last.is_full == is_full && last.end == start => last.end = end,
            _ => self.0.push(RayInterval {
                start,
                end,
                is_full,
            }),
        }
    }
}
