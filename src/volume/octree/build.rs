//! From voxels to nodes: which cubes of each size hold any full voxel, and which hold no empty one.

use super::{MixedNode, NodeState, Octree};
use crate::volume::VoxelSet;

/// Of the cubes of one size in the grid.
struct Level {
    /// Those that hold a full voxel.
    any: VoxelSet,
    /// Those that hold no empty one; what lies outside of the grid is empty.
    all: VoxelSet,
}

impl Level {
    fn state(&self, cube: [u32; 3]) -> NodeState {
        match (self.any.contains(cube), self.all.contains(cube)) {
            (false, _) => NodeState::Empty,
            (true, true) => NodeState::Full,
            (true, false) => NodeState::Mixed,
        }
    }

    /// The cubes twice as large.
    fn doubled(&self) -> Self {
        let dims = self.any.dims().map(|n| n.div_ceil(2));
        let any = |cube| children(cube).any(|child| self.any.contains(child));
        let all = |cube| children(cube).all(|child| self.all.contains(child));
        Self {
            any: VoxelSet::by(dims, any),
            all: VoxelSet::by(dims, all),
        }
    }
}

/// The eight cubes inside one, x fastest.
fn children(cube: [u32; 3]) -> impl Iterator<Item = [u32; 3]> {
    (0..8_u32).map(move |child| std::array::from_fn(|k| 2 * cube[k] + (child >> k & 1)))
}

impl Octree {
    /// The octree of `set`.
    ///
    /// # Panics
    /// Where 2^32 nodes or more are mixed.
    pub fn new(set: &VoxelSet) -> Self {
        let dims = set.dims();
        let depth = depth_of(dims);
        let mut levels = vec![Level {
            any: set.clone(),
            all: set.clone(),
        }];
        for size in 0..depth as usize {
            levels.push(levels[size].doubled());
        }
        let root = levels[depth as usize].state([0; 3]);
        let mut nodes = Vec::new();
        let mut mixed = vec![[0; 3]];
        mixed.retain(|_| root == NodeState::Mixed);
        // From the root down: the mixed children of a level are the nodes of the next, in the order of their parents.
        for level in levels.iter().rev().skip(1) {
            let first_of_next = nodes.len() + mixed.len();
            let mut next = Vec::new();
            for cube in mixed {
                let first = u32::try_from(first_of_next + next.len());
                let mut node = MixedNode {
                    first_mixed: first.expect("less than 2^32 mixed nodes"),
                    ..MixedNode::default()
                };
                for (bit, child) in children(cube).enumerate() {
                    match level.state(child) {
                        NodeState::Empty => {}
                        NodeState::Full => node.full |= 1 << bit,
                        NodeState::Mixed => {
                            node.mixed |= 1 << bit;
                            next.push(child);
                        }
                    }
                }
                nodes.push(node);
            }
            mixed = next;
        }
        Self {
            dims,
            depth,
            root,
            nodes,
        }
    }
}

/// How often the smallest cube of a power of two around the grid is halved down to voxels.
fn depth_of(dims: [u32; 3]) -> u32 {
    let longest = dims.into_iter().max().unwrap_or(0);
    u32::BITS - longest.saturating_sub(1).leading_zeros()
}
