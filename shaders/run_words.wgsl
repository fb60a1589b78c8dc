// Runs of classified voxels, first pass: of each 32 voxels of a row a mask, and how many full ones come before in the block.
//
//     full voxels = those with data whose code has a depth over 0
//     runs begin at mask & ~(mask << 1 | whether the voxel before is full)
//
// CPU reference: `RunBits::of_masks` (src/volume/runs/bits.rs). src/resident/classified_runs/on_device.rs records it.

#import run_classes

// Full voxels and runs of the words up to a thread's own.
var<workgroup> counts: array<vec2<u32>, RUN_THREADS>;

@compute @workgroup_size(8, 8)
fn main(
    @builtin(local_invocation_id) id: vec3<u32>,
    @builtin(workgroup_id) block: vec3<u32>,
) {
    let thread = thread_of(id);
    let word = block.x * RUN_THREADS + thread;
    let mask = mask_of(word);
    let starts = mask & ~((mask << 1u) | full_before(word));
    let own = vec2(countOneBits(mask), countOneBits(starts));
    counts[thread] = own;
    workgroupBarrier();
    // By doubling (Hillis and Steele), up to RUN_THREADS.
    add_before(thread, 1u);
    add_before(thread, 2u);
    add_before(thread, 4u);
    add_before(thread, 8u);
    add_before(thread, 16u);
    add_before(thread, 32u);
    if word < run_build.texel_count {
        run_list.d[word] = vec2(mask, counts[thread].x - own.x);
    }
    if thread == RUN_THREADS - 1u {
        run_list.d[run_build.texel_count + block.x] = counts[thread];
    }
}

fn add_before(thread: u32, reach: u32) {
    var before = vec2(0u);
    if thread >= reach {
        before = counts[thread - reach];
    }
    workgroupBarrier();
    counts[thread] += before;
    workgroupBarrier();
}

fn mask_of(word: u32) -> u32 {
    if word >= run_build.word_count {
        return 0u;
    }
    let first = first_of_word(word);
    let in_row = RUN_MASK_VOXELS * (word % run_build.words_per_row);
    let count = min(run_build.row_length - in_row, RUN_MASK_VOXELS);
    var mask = 0u;
    for (var bit = 0u; bit < count; bit++) {
        mask |= is_of_matter(first + bit) << bit;
    }
    if run_build.valid_at > 0u {
        mask &= run_voxels.d[run_build.valid_at + word];
    }
    return mask;
}

// 1 where the voxel before a word in its row is full.
fn full_before(word: u32) -> u32 {
    if word >= run_build.word_count || word % run_build.words_per_row == 0u {
        return 0u;
    }
    var full = is_of_matter(first_of_word(word) - 1u);
    if run_build.valid_at > 0u {
        full &= run_voxels.d[run_build.valid_at + word - 1u] >> (RUN_MASK_VOXELS - 1u);
    }
    return full;
}

// 1 where what the code stands for has a depth over 0.
fn is_of_matter(voxel: u32) -> u32 {
    let code = code_of(voxel);
    return (run_classes.d[code / 32u] >> (code % 32u)) & 1u;
}
