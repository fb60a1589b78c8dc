//! An octree of full and empty voxels, without empty space of its own: only mixed nodes are stored.
//!
//! ```text
//! root     the smallest cube of 2^depth voxels a side around the grid; what lies outside of the grid is empty
//! node     a cube that is full, empty, or mixed: halved along each axis into eight
//! stored   of a mixed node which of its children are full (8 bits), which are mixed (8 bits), and where these begin
//! nodes    1 + 8 (mixed nodes)
//! ```
//!
//! No mixed node has eight children that are all full or all empty: of a set there is one octree.

mod address;
mod along;
mod build;

pub use address::{Address, AddressError};

use super::VoxelSet;

/// What a node holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum NodeState {
    /// No full voxel.
    Empty,
    /// Full voxels alone.
    Full,
    /// Both; it has children.
    Mixed,
}

/// A mixed node as it is stored: eight bytes. Child x + 2y + 4z has that bit in `full`, in `mixed`, or in none of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct MixedNode {
    /// Number of the first mixed child among [`Octree::nodes`]; the others follow.
    pub first_mixed: u32,
    /// Children that are full.
    pub full: u8,
    /// Children that are mixed.
    pub mixed: u8,
    /// Nothing.
    pub unused: [u8; 2],
}

impl MixedNode {
    /// What a child holds, and where it is stored if it is mixed.
    fn child(&self, child: u8) -> (NodeState, usize) {
        let bit = 1_u8 << child;
        let before = (self.mixed & (bit - 1)).count_ones();
        let stored = self.first_mixed as usize + before as usize;
        match (self.full & bit != 0, self.mixed & bit != 0) {
            (true, _) => (NodeState::Full, stored),
            (false, true) => (NodeState::Mixed, stored),
            (false, false) => (NodeState::Empty, stored),
        }
    }
}

/// The octree of a set of voxels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Octree {
    dims: [u32; 3],
    depth: u32,
    root: NodeState,
    /// Mixed nodes level by level, the root first.
    nodes: Vec<MixedNode>,
}

/// A cube that is full or empty.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Leaf {
    /// Where it is in the octree.
    pub address: Address,
    /// Its first voxel.
    pub min: [u32; 3],
    /// Voxels a side.
    pub side: u64,
    /// Whether it is full.
    pub is_full: bool,
}

/// How many nodes of a size there are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "the names say it")]
pub struct LevelCount {
    /// Voxels a side of the nodes.
    pub side: u64,
    pub empty: u64,
    pub full: u64,
    pub mixed: u64,
}

impl Octree {
    /// Voxels of the grid along x, y, z.
    pub fn dims(&self) -> [u32; 3] {
        self.dims
    }

    /// Voxels along a side of the root.
    pub fn side(&self) -> u64 {
        1 << self.depth
    }

    /// The mixed nodes as they are stored, level by level from the root down.
    pub fn nodes(&self) -> &[MixedNode] {
        &self.nodes
    }

    /// How many nodes there are, with leaves.
    pub fn node_count(&self) -> u64 {
        1 + 8 * self.nodes.len() as u64
    }

    /// How many leaves there are, full and empty.
    pub fn leaf_count(&self) -> u64 {
        1 + 7 * self.nodes.len() as u64
    }

    /// Size of the stored nodes in memory.
    pub fn bytes(&self) -> u64 {
        size_of_val(self.nodes.as_slice()) as u64
    }

    /// The nodes of each size, the root first, down to the smallest there are.
    pub fn levels(&self) -> Vec<LevelCount> {
        let is = |state: NodeState| u64::from(self.root == state);
        let mut levels = vec![LevelCount {
            side: self.side(),
            empty: is(NodeState::Empty),
            full: is(NodeState::Full),
            mixed: is(NodeState::Mixed),
        }];
        let mut rest = self.nodes.as_slice();
        while !rest.is_empty() {
            let above = levels[levels.len() - 1];
            let (of_level, others) = rest.split_at(above.mixed as usize);
            let count = |bits: fn(&MixedNode) -> u8| {
                let ones = of_level
                    .iter()
                    .map(|node| u64::from(bits(node).count_ones()));
                ones.sum::<u64>()
            };
            let (full, mixed) = (count(|node| node.full), count(|node| node.mixed));
            levels.push(LevelCount {
                side: above.side / 2,
                empty: 8 * above.mixed - full - mixed,
                full,
                mixed,
            });
            rest = others;
        }
        levels
    }

    /// What the node of an address holds; `None` where a leaf or a voxel has no such node inside.
    pub fn at(&self, address: &Address) -> Option<NodeState> {
        let mut state = self.root;
        let mut stored = 0;
        for digit in address.digits() {
            if state != NodeState::Mixed {
                return None;
            }
            (state, stored) = self.nodes[stored].child(digit - 1);
        }
        Some(state)
    }

    /// Whether `voxel` is full; voxels outside of the grid are not.
    pub fn contains(&self, voxel: [u32; 3]) -> bool {
        if voxel.iter().any(|&n| u64::from(n) >= self.side()) {
            return false;
        }
        let mut state = self.root;
        let mut stored = 0;
        for level in (0..self.depth).rev() {
            if state != NodeState::Mixed {
                break;
            }
            let upper = |k: usize| ((voxel[k] >> level & 1) << k) as u8;
            (state, stored) = self.nodes[stored].child(upper(0) + upper(1) + upper(2));
        }
        state == NodeState::Full
    }

    /// The set that the octree is of.
    pub fn decode(&self) -> VoxelSet {
        VoxelSet::by(self.dims, |voxel| self.contains(voxel))
    }

    /// All leaves in the order of their addresses. Together they tile the cube.
    pub fn leaves(&self) -> impl Iterator<Item = Leaf> + '_ {
        let root = Leaf {
            address: Address::default(),
            min: [0; 3],
            side: self.side(),
            is_full: self.root == NodeState::Full,
        };
        let mut waiting = vec![(root, self.root, 0)];
        std::iter::from_fn(move || {
            loop {
                let (node, state, stored) = waiting.pop()?;
                if state != NodeState::Mixed {
                    return Some(node);
                }
                for child in (0..8).rev() {
                    let (state, stored) = self.nodes[stored].child(child);
                    let half = node.side / 2;
                    let upper = |k: usize| u32::from(child >> k & 1) * half as u32;
                    let inside = Leaf {
                        address: node.address.child(child),
                        min: std::array::from_fn(|k| node.min[k] + upper(k)),
                        side: half,
                        is_full: state == NodeState::Full,
                    };
                    waiting.push((inside, state, stored));
                }
            }
        })
    }
}
