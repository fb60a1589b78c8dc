// Runs of classified voxels in the making: parameters of the three passes, and the words (shaders/run_words.wgsl).

// Threads of a workgroup, 8 x 8, which makes so many words; its sums are a block.
const RUN_THREADS: u32 = 64u;

fn thread_of(own: vec3<u32>) -> u32 {
    return own.y * 8u + own.x;
}

struct RunBuild {
    // Voxels of a row, words of a row, words of all rows, and texels of their image, which has more.
    row_length: u32,
    words_per_row: u32,
    word_count: u32,
    texel_count: u32,
    block_count: u32,
    // Bits of a code: 8 or 16.
    code_bits: u32,
    // Where among the words of the voxels those begin that say which have data; 0 where all have.
    valid_at: u32,
    // Where payloads begin among the words of the classes, and words of a payload.
    payload_at: u32,
    payload_words: u32,
    // Which payloads are written, by rank, and whether they are the last.
    first_rank: u32,
    rank_count: u32,
    is_last: u32,
}

// Mask and rank of each texel; then of each block full voxels and runs, and of all.
struct RunList {
    d: array<vec2<u32>>,
}

@group(0) @binding(60) var<uniform> run_build: RunBuild;
@group(0) @binding(61) var<storage, read_write> run_list: RunList;
