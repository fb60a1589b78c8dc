//! The runs that a ray meets: from row to row, then along the runs of each.

use super::{Run, Runs, others};
use crate::volume::RayInterval;
use crate::volume::crossings::{Intervals, Line, both};

impl Runs {
    /// The parts of the ray `origin + t direction`, in voxel space and from t = 0 on, that lie in full and in empty voxels of
    /// the grid, one behind the other. None of them is a point: a ray through an edge meets the voxels before and behind
    /// it alone. None at all where a number is not finite.
    pub fn along(&self, origin: [f64; 3], direction: [f64; 3]) -> Vec<RayInterval> {
        let mut found = Intervals::default();
        let Some(line) = Line::new(origin, direction) else {
            return found.0;
        };
        let Some([start, end]) = line.in_grid(self.dims) else {
            return found.0;
        };
        let axes = others(self.axis);
        let counts = axes.map(|axis| self.dims[axis]);
        let mut at: [u32; 2] = [0, 1].map(|n| line.voxel_behind(axes[n], start, counts[n]));
        let mut from = start;
        while from < end {
            let leaves = [0, 1].map(|n| {
                let voxel = u64::from(at[n]);
                line.between(axes[n], voxel, voxel + 1)[1]
            });
            let until = leaves[0].min(leaves[1]).min(end);
            let row = at[0] as usize + counts[0] as usize * at[1] as usize;
            self.along_row(row, &line, [from, until], &mut found);
            from = until.max(from);
            for n in 0..2 {
                if leaves[n] > from {
                    continue;
                }
                match line.next(axes[n], at[n], counts[n]) {
                    Some(next) => at[n] = next,
                    None => return found.0,
                }
            }
        }
        found.0
    }

    /// The part of the ray that lies in one row.
    fn along_row(&self, row: usize, line: &Line, part: [f64; 2], found: &mut Intervals) {
        let runs = self.row(row);
        let mut from = part[0];
        let mut meet = |run: &Run| {
            let crossed = line.between(self.axis, run.start.into(), run.end().into());
            if let Some(inside) = both(part, crossed) {
                found.push([from, inside[0]], false);
                found.push(inside, true);
                from = inside[1];
            }
        };
        match line.is_backward(self.axis) {
            true => runs.iter().rev().for_each(&mut meet),
            false => runs.iter().for_each(&mut meet),
        }
        found.push([from, part[1]], false);
    }
}
