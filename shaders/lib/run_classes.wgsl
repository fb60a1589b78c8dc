// What voxels are, by their codes, which are the bits of stored numbers: whether they are full, and their payload. The host makes
// both for each code; nothing is computed here but places.

#import run_list

struct RunVoxels {
    // Codes without gaps, then masks as those of the words.
    d: array<u32>,
}

struct RunClasses {
    // A bit for each code, then payloads.
    d: array<u32>,
}

@group(0) @binding(62) var<storage, read> run_voxels: RunVoxels;
@group(0) @binding(63) var<storage, read> run_classes: RunClasses;

const RUN_MASK_VOXELS: u32 = 32u;

// The number of the first voxel of a word.
fn first_of_word(word: u32) -> u32 {
    let row = word / run_build.words_per_row;
    return row * run_build.row_length + RUN_MASK_VOXELS * (word % run_build.words_per_row);
}

fn code_of(voxel: u32) -> u32 {
    let codes_per_word = 32u / run_build.code_bits;
    let shift = run_build.code_bits * (voxel % codes_per_word);
    return (run_voxels.d[voxel / codes_per_word] >> shift) & ((1u << run_build.code_bits) - 1u);
}
