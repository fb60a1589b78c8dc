//! The leaves that a ray meets, from front to back.
//!
//! Along a ray no coordinate ever turns round. So children stand from front to back in the order of their numbers, with
//! the bits of backward axes turned over.

use super::{NodeState, Octree};
use crate::volume::RayInterval;
use crate::volume::crossings::{Intervals, Line, both};

/// A node that a ray meets.
struct Met {
    state: NodeState,
    stored: usize,
    min: [u64; 3],
    side: u64,
    part: [f64; 2],
}

impl Octree {
    /// The parts of the ray `origin + t direction`, in voxel space and from t = 0 on, that lie in full and in empty voxels of
    /// the grid: the same intervals, to the bit, as [`Runs::along`](crate::volume::Runs::along).
    pub fn along(&self, origin: [f64; 3], direction: [f64; 3]) -> Vec<RayInterval> {
        let mut found = Intervals::default();
        let Some(line) = Line::new(origin, direction) else {
            return found.0;
        };
        let Some(part) = line.in_grid(self.dims) else {
            return found.0;
        };
        let root = Met {
            state: self.root,
            stored: 0,
            min: [0; 3],
            side: self.side(),
            part,
        };
        self.meet(&line, root, &mut found);
        found.0
    }

    fn meet(&self, line: &Line, node: Met, found: &mut Intervals) {
        if node.state != NodeState::Mixed {
            found.push(node.part, node.state == NodeState::Full);
            return;
        }
        let half = node.side / 2;
        let backward = (0..3).fold(0, |bits, k| bits | u8::from(line.is_backward(k)) << k);
        for number in 0..8_u8 {
            let child = number ^ backward;
            let min: [u64; 3] =
                std::array::from_fn(|k| node.min[k] + u64::from(child >> k & 1) * half);
            let part = (0..3).try_fold(node.part, |part, k| {
                both(part, line.between(k, min[k], min[k] + half))
            });
            let Some(part) = part else { continue };
            let (state, stored) = self.nodes[node.stored].child(child);
            let met = Met {
                state,
                stored,
                min,
                side: half,
                part,
            };
            self.meet(line, met, found);
        }
    }
}
