// As skipped_cells.wgsl, by the runs of voxels that matter, along x: from where a ray enters a row to the next run of it, or to the
// end of a word of 32 voxels. CPU reference: `RunBits::rank` (src/volume/runs/bits.rs).

#import full_voxels

const WORD_VOXELS: u32 = 32u;

fn skipped(so_far: Accumulator, line: SampleLine, start: i32) -> i32 {
    let dims = voxels_along();
    let words_of_row = (dims.x + WORD_VOXELS - 1u) / WORD_VOXELS;
    var k = start;
    loop {
        if !may_skip(line, k) {
            break;
        }
        let voxel = voxel_of_sample(line, k);
        let word = voxel.x / WORD_VOXELS;
        let bit = voxel.x % WORD_VOXELS;
        // Beside each mask stands how many full voxels come before it.
        let full = full_voxels.d[2u * (word + words_of_row * (voxel.y + dims.y * voxel.z))];
        if ((full >> bit) & 1u) == 1u {
            break;
        }
        // Empty from behind the last full voxel before this one to the next.
        let before = full & ((1u << bit) - 1u);
        let first = WORD_VOXELS * word + (WORD_VOXELS - countLeadingZeros(before));
        let end = WORD_VOXELS * word + min(bit + countTrailingZeros(full >> bit), WORD_VOXELS);
        k = first_sample_beyond_box(line, k, vec3(first, voxel.yz), vec3(end, voxel.yz + 1u));
    }
    return k;
}
