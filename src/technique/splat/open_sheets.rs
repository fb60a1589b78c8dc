//! Sheets that face the eye, those that a slice of voxels reaches into: CPU reference of the window of
//! `shaders/lib/splat_image.wgsl`.
//!
//! ```text
//! sheet k:  k step <= forward . x < (k + 1) step
//! ```

use super::MAX_OPEN_SHEETS;
use super::line::Line;
use super::reference::Range;
use crate::ray::{Ray, vector};
use crate::real::{Real, dot};
use crate::shaders::Frame;

/// Rounding closes no sheet too early: so much of one.
const SLACK: f64 = 1.0 / 1024.0;

/// Where the sheet before plane edge `k` ends and the next begins: forward . x = k step.
pub(super) fn edge_of<R: Real>(frame: &Frame, world: &Ray<R>, k: i32) -> R {
    let forward = vector(frame.forward);
    let height = R::from_f64(f64::from(k)) * R::from_f32(frame.step_world);
    (height - dot(forward, world.origin)) / dot(forward, world.direction)
}

/// Sheets that face the eye, those that the slices of now may have a part in.
pub(super) struct OpenSheets<R> {
    /// The number of the first, and of the last that there is.
    pub first: i32,
    pub last: i32,
    sums: [[R; 4]; MAX_OPEN_SHEETS],
    /// Where they begin and end, from the crossing of the slice of now, in deviations.
    edges: [R; MAX_OPEN_SHEETS + 1],
    /// Heights along forward: of the eye, along the ray, a step.
    height: R,
    slope: R,
    step: R,
}

impl<R: Real> OpenSheets<R> {
    pub fn new(
        frame: &Frame,
        world: &Ray<R>,
        line: &Line<R>,
        range: &Range<R>,
        [front, back]: [R; 2],
    ) -> Self {
        let zero = R::from_f64(0.0);
        let forward = vector(frame.forward);
        let mut found = Self {
            first: 0,
            last: 0,
            sums: [[zero; 4]; MAX_OPEN_SHEETS],
            edges: [zero; MAX_OPEN_SHEETS + 1],
            height: dot(forward, world.origin),
            slope: dot(forward, world.direction),
            step: R::from_f32(frame.step_world),
        };
        let low = range.t[0].max(front - line.reach);
        let high = range.t[1].min(back + line.reach);
        found.first = found.sheet_at(low).floor().to_i32();
        found.last = found.sheet_at(high).ceil().to_i32() - 1;
        found
    }

    /// Which sheet lies at `t`, with a fraction.
    fn sheet_at(&self, t: R) -> R {
        (self.height + t * self.slope) / self.step
    }

    /// Whether the first ends before `t`.
    pub fn is_done_before(&self, t: R) -> bool {
        let reached = self.sheet_at(t) - R::from_f64(SLACK);
        self.first <= self.last && R::from_f64(f64::from(self.first + 1)) <= reached
    }

    /// Takes out the sums of the first.
    pub fn close(&mut self) -> [R; 4] {
        let closed = self.sums[0];
        self.sums.rotate_left(1);
        self.sums[MAX_OPEN_SHEETS - 1] = [R::from_f64(0.0); 4];
        self.first += 1;
        closed
    }

    /// The slice that is crossed at `t` is next.
    pub fn move_to(&mut self, line: &Line<R>, range: &Range<R>, t: R) {
        for (s, edge) in self.edges.iter_mut().enumerate() {
            let number = R::from_f64(f64::from(self.first + s as i32));
            let at = (number * self.step - self.height) / self.slope;
            *edge = line.kappa * (at.max(range.part[0]).min(range.part[1]) - t);
        }
    }

    /// Adds the parts of a splat.
    pub fn add(&mut self, line: &Line<R>, drift: R, weight: R, numbers: [R; 4]) {
        let densest = line.kappa * drift;
        let mut lower = line.before(self.edges[0] - densest);
        for (sums, ends) in self.sums.iter_mut().zip(self.edges.windows(2)) {
            if line.is_behind(ends[0] - densest) {
                break;
            }
            let x = ends[1] - densest;
            if line.is_before(x) {
                continue;
            }
            let upper = line.before(x);
            // Rounding makes no weight negative: a sheet lies between its voxels.
            let part = weight * (upper - lower).max(R::from_f64(0.0));
            *sums = std::array::from_fn(|c| sums[c] + part * numbers[c]);
            lower = upper;
        }
    }
}
