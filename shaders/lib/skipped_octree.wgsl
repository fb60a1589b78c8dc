// As skipped_cells.wgsl, by the octree of the voxels that matter: from cube to cube, each found from the root down by the bits of
// a voxel. CPU reference: `Octree::contains` (src/volume/octree/mod.rs).

#import full_voxels

// What a node holds. Of a mixed one d has two words: number of the first mixed child, and a bit for each child, those of
// full ones first, of mixed ones behind.
const EMPTY_NODE: u32 = 0u;
const MIXED_NODE: u32 = 2u;
// Before the nodes: how often the root is halved down to voxels, and what it holds.
const NODES: u32 = 2u;

fn skipped(so_far: Accumulator, line: SampleLine, start: i32) -> i32 {
    var k = start;
    loop {
        if !may_skip(line, k) {
            break;
        }
        let voxel = voxel_of_sample(line, k);
        var level = full_voxels.d[0];
        var holds = full_voxels.d[1];
        var node = NODES;
        while holds == MIXED_NODE {
            level--;
            let upper = (voxel >> vec3(level)) & vec3(1u);
            let child = upper.x + 2u * upper.y + 4u * upper.z;
            let bits = full_voxels.d[node + 1u] >> child;
            holds = (bits & 1u) + ((bits >> 7u) & 2u);
            let before = (full_voxels.d[node + 1u] >> 8u) & ((1u << child) - 1u);
            node = NODES + 2u * (full_voxels.d[node] + countOneBits(before));
        }
        if holds != EMPTY_NODE {
            break;
        }
        let first = (voxel >> vec3(level)) << vec3(level);
        k = first_sample_beyond_box(line, k, first, first + (1u << level));
    }
    return k;
}
