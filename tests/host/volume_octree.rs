//! The octree against the set itself: leaves that tile, canonical nodes, addresses in Morton order.

use crate::voxel_sets::{random, sets, voxels};
use stratavox::volume::{Address, Leaf, MixedNode, NodeState, Octree, VoxelSet};

/// What is wrong, where anything is.
type Found = Result<(), String>;

#[test]
fn an_octree_gives_back_the_set() {
    for set in sets() {
        let octree = Octree::new(&set);
        assert_eq!(octree.decode(), set, "{:?}", set.dims());
        let longest = set.dims().into_iter().max().unwrap_or(0);
        assert_eq!(octree.side(), u64::from(longest.next_power_of_two()));
        for outside in [[set.dims()[0], 0, 0], [0, 0, 2 * longest], [u32::MAX; 3]] {
            assert!(!octree.contains(outside), "{outside:?}");
        }
    }
}

/// Leaves of an octree against the set: they tile the cube once, hold what it has there, and no full one has a voxel outside of
/// the grid.
fn check_leaves(set: &VoxelSet, octree: &Octree) -> Found {
    let [nx, ny, nz] = set.dims();
    let mut covered = vec![0_u32; (nx * ny * nz) as usize];
    let mut volume = 0;
    for leaf in octree.leaves() {
        volume += leaf.side.pow(3);
        let end = |k: usize| (u64::from(leaf.min[k]) + leaf.side).min(set.dims()[k].into());
        let [x1, y1, z1] = [0, 1, 2].map(|k| end(k) as u32);
        for z in leaf.min[2]..z1 {
            for y in leaf.min[1]..y1 {
                for x in leaf.min[0]..x1 {
                    covered[(x + nx * (y + ny * z)) as usize] += 1;
                    if set.contains([x, y, z]) != leaf.is_full {
                        return Err(format!("{leaf:?} at {x}, {y}, {z}"));
                    }
                }
            }
        }
        let is_inside = (0..3).all(|k| u64::from(leaf.min[k]) + leaf.side == end(k));
        if !is_inside && leaf.is_full {
            return Err(format!("{leaf:?} in {:?}", set.dims()));
        }
    }
    match volume == octree.side().pow(3) && covered.iter().all(|&times| times == 1) {
        true => Ok(()),
        false => Err(format!(
            "leaves of {volume} voxels, each covered as {covered:?} say"
        )),
    }
}

#[test]
fn leaves_tile_the_cube_once() {
    for set in sets() {
        assert_eq!(check_leaves(&set, &Octree::new(&set)), Ok(()));
    }
}

/// What lies outside of the grid is empty: an octree of what is full there is another.
#[test]
fn leaves_that_are_full_outside_of_the_grid_are_seen() {
    let mut seen = 0;
    for set in sets() {
        let side = Octree::new(&set).side() as u32;
        let is_inside = |voxel: [u32; 3]| (0..3).all(|k| voxel[k] < set.dims()[k]);
        let padded = VoxelSet::by([side; 3], |voxel| !is_inside(voxel) || set.contains(voxel));
        let is_seen = check_leaves(&set, &Octree::new(&padded)).is_err();
        // Without a voxel beside the grid there is nothing to see.
        assert_eq!(is_seen, set.dims() != [side; 3], "{:?}", set.dims());
        seen += usize::from(is_seen);
    }
    assert!(seen > 50, "{seen}");
}

/// Mixed nodes of an octree, which is canonical: none has eight children that are all full or all empty.
fn check_canonical(nodes: &[MixedNode]) -> Found {
    let is_alike = |node: &MixedNode| node.full == 0xff || node.full | node.mixed == 0;
    match nodes
        .iter()
        .find(|node| is_alike(node) || node.full & node.mixed != 0)
    {
        None => Ok(()),
        Some(node) => Err(format!("{node:?}")),
    }
}

/// Eight full children in the place of a full one, where it is the last of the last level but one: all others stay where they are.
#[test]
fn siblings_that_are_not_merged_are_seen() {
    let mut seen = 0;
    for set in sets() {
        let mut nodes = Octree::new(&set).nodes().to_vec();
        assert_eq!(check_canonical(&nodes), Ok(()));
        let Some(node) = nodes.iter_mut().rev().find(|node| node.full != 0) else {
            continue;
        };
        let bit = 1 << node.full.ilog2();
        node.full &= !bit;
        node.mixed |= bit;
        for (full, mixed) in [(0xff, 0), (0, 0)] {
            let child = MixedNode {
                full,
                mixed,
                ..MixedNode::default()
            };
            let with_child = [nodes.as_slice(), &[child]].concat();
            assert!(check_canonical(&with_child).is_err(), "{:?}", set.dims());
        }
        seen += 1;
    }
    assert!(seen > 50, "{seen}");
}

/// The nodes of a cube by their definition: one, and those of its children where it is mixed.
fn nodes_of(set: &VoxelSet, min: [u32; 3], side: u32) -> u64 {
    let mut cube = voxels([side; 3]).map(|v| set.contains([0, 1, 2].map(|k| min[k] + v[k])));
    let first = cube.next().expect("a voxel");
    if cube.all(|is_full| is_full == first) {
        return 1;
    }
    let half = side / 2;
    let children = voxels([2; 3]).map(|v| [0, 1, 2].map(|k| min[k] + half * v[k]));
    1 + children.map(|min| nodes_of(set, min, half)).sum::<u64>()
}

#[test]
fn nodes_are_as_few_as_there_can_be() {
    for set in sets() {
        let octree = Octree::new(&set);
        let mixed = octree.nodes().len() as u64;
        assert_eq!(octree.node_count(), 1 + 8 * mixed);
        assert_eq!(octree.bytes(), 8 * mixed);
        assert_eq!(octree.leaf_count(), octree.leaves().count() as u64);
        assert_eq!(check_canonical(octree.nodes()), Ok(()));
        let levels = octree.levels();
        let counts = levels
            .iter()
            .map(|level| level.empty + level.full + level.mixed);
        assert_eq!(counts.sum::<u64>(), octree.node_count());
        assert_eq!(levels.iter().map(|level| level.mixed).sum::<u64>(), mixed);
        for level in &levels {
            let is = |leaf: &Leaf, is_full| leaf.side == level.side && leaf.is_full == is_full;
            let count = |is_full| octree.leaves().filter(|leaf| is(leaf, is_full)).count() as u64;
            assert_eq!([count(false), count(true)], [level.empty, level.full]);
        }
        if octree.side() <= 16 {
            let side = octree.side() as u32;
            assert_eq!(octree.node_count(), nodes_of(&set, [0; 3], side));
        }
    }
}

/// The address by its definition, from where the leaf is: digits 1 + x + 2 y + 4 z of the halves, or of the axes in another order.
fn address(leaf: &Leaf, octree: &Octree, [x, y, z]: [usize; 3]) -> String {
    let mut text = String::new();
    let mut half = octree.side() / 2;
    while half >= leaf.side {
        let bit = |k: usize| u64::from(leaf.min[k]) / half % 2;
        text += &(1 + bit(x) + 2 * bit(y) + 4 * bit(z)).to_string();
        half /= 2;
    }
    text
}

/// Bits of z, y and x in turn, from the highest.
fn morton(min: [u32; 3]) -> u128 {
    let bits = (0..32)
        .rev()
        .flat_map(|bit| [2, 1, 0].map(|k| min[k] >> bit & 1));
    bits.fold(0, |code, bit| code << 1 | u128::from(bit))
}

#[test]
fn addresses_are_in_morton_order_and_none_begins_another() {
    let mut of_z_first = 0;
    for set in sets() {
        let octree = Octree::new(&set);
        let leaves: Vec<Leaf> = octree.leaves().collect();
        for leaf in &leaves {
            let digits = leaf.address.to_string();
            assert_eq!(digits, address(leaf, &octree, [0, 1, 2]));
            of_z_first += usize::from(digits != address(leaf, &octree, [2, 1, 0]));
            assert_eq!(leaf.address.to_string().parse(), Ok(leaf.address.clone()));
            let state = if leaf.is_full {
                NodeState::Full
            } else {
                NodeState::Empty
            };
            assert_eq!(octree.at(&leaf.address), Some(state));
            let inside: Address = format!("{}1", leaf.address).parse().expect("digits");
            assert_eq!(octree.at(&inside), None);
        }
        for pair in leaves.windows(2) {
            assert!(pair[0].address < pair[1].address, "{pair:?}");
            assert!(morton(pair[0].min) < morton(pair[1].min), "{pair:?}");
            // In order, what begins with an address stands right behind it.
            let [first, second] = [&pair[0], &pair[1]].map(|leaf| leaf.address.digits());
            assert!(!second.starts_with(first), "{pair:?}");
        }
    }
    assert!(
        of_z_first > 1000,
        "children in the order of z first: {of_z_first} seen"
    );
}

#[test]
fn addresses_are_those_of_the_figure() {
    let of_voxel = |wanted: [u32; 3]| {
        let set = VoxelSet::by([8; 3], |voxel| voxel == wanted);
        let full = Octree::new(&set).leaves().find(|leaf| leaf.is_full);
        full.expect("the voxel").address.to_string()
    };
    assert_eq!(of_voxel([5, 3, 0]), "234");
    assert_eq!(of_voxel([2, 7, 0]), "343");
    assert_eq!(of_voxel([0, 0, 7]), "555");
    // A quarter of the plane, and a cube behind it.
    let set = VoxelSet::by([8; 3], |[x, y, z]| x < 2 && (4..6).contains(&y) && z < 2);
    let octree = Octree::new(&set);
    let full: Vec<_> = octree.leaves().filter(|leaf| leaf.is_full).collect();
    assert_eq!(full.len(), 1);
    assert_eq!(full[0].address.to_string(), "31");
    assert_eq!((full[0].min, full[0].side), ([0, 4, 0], 2));
    let state = |text: &str| octree.at(&text.parse().expect("an address"));
    assert_eq!(state(""), Some(NodeState::Mixed));
    assert_eq!(state("3"), Some(NodeState::Mixed));
    assert_eq!(state("33"), Some(NodeState::Empty));
    let error = "390".parse::<Address>().expect_err("refused");
    assert_eq!(
        error.to_string(),
        "an address has digits from 1 to 8, and there is '9'"
    );
}

#[test]
fn the_complement_has_the_same_nodes_with_other_flags() {
    for (n, share) in [(1, 0.5), (8, 0.02), (16, 0.5), (32, 0.98)] {
        let set = random([n; 3], share, 5);
        let others = VoxelSet::by(set.dims(), |voxel| !set.contains(voxel));
        let [octree, turned] = [&set, &others].map(Octree::new);
        assert_eq!(octree.nodes().len(), turned.nodes().len());
        for (node, turned) in octree.nodes().iter().zip(turned.nodes()) {
            assert_eq!(node.first_mixed, turned.first_mixed);
            assert_eq!(node.mixed, turned.mixed);
            assert_eq!(node.full ^ turned.full, !node.mixed);
        }
        for (leaf, turned) in octree.leaves().zip(turned.leaves()) {
            assert_eq!(leaf.address, turned.address);
            assert_ne!(leaf.is_full, turned.is_full);
        }
    }
}

#[test]
fn what_is_full_in_a_set_is_full_in_a_larger_one() {
    for (seed, dims) in [[16; 3], [9, 20, 5], [33, 3, 7]].into_iter().enumerate() {
        let [some, more] = [11, 12].map(|n| random(dims, 0.4, seed as u64 + n));
        let larger = VoxelSet::by(dims, |voxel| some.contains(voxel) || more.contains(voxel));
        let octree = Octree::new(&larger);
        for leaf in Octree::new(&some).leaves().filter(|leaf| leaf.is_full) {
            // The same node, or one around it that has become a leaf.
            let digits = leaf.address.to_string();
            let around = (0..=digits.len()).map(|n| digits[..n].parse().expect("digits"));
            let mut states = around.filter_map(|address: Address| octree.at(&address));
            assert_eq!(states.next_back(), Some(NodeState::Full), "{leaf:?}");
        }
    }
}
