// Runs of classified voxels, third pass: payloads of full voxels, each at its rank, and with the last of them the ranks of words.
//
//     rank of the first full voxel of a word = sum of the blocks before + full voxels before in the block
//
// It is run for one part of the ranks after another, so that no buffer is larger than devices have to allow.

#import run_classes

struct RunPayload {
    d: array<u32>,
}

@group(0) @binding(64) var<storage, read_write> run_payloads: RunPayload;

@compute @workgroup_size(8, 8)
fn main(@builtin(local_invocation_id) id: vec3<u32>, @builtin(workgroup_id) block: vec3<u32>) {
    let number = block.x * RUN_THREADS + thread_of(id);
    if number >= run_build.texel_count {
        return;
    }
    let word = run_list.d[number];
    let first = word.y + run_list.d[run_build.texel_count + block.x].x;
    var rest = word.x;
    var rank = first;
    while rest != 0u {
        // Ranks before the first are large numbers here.
        let place = rank - run_build.first_rank;
        if place < run_build.rank_count {
            write_payload(place, code_of(first_of_word(number) + countTrailingZeros(rest)));
        }
        rest &= rest - 1u;
        rank++;
    }
    if run_build.is_last != 0u {
        // Texels behind the last word are 0.
        run_list.d[number] = select(vec2(0u), vec2(word.x, first), number < run_build.word_count);
    }
}

fn write_payload(place: u32, code: u32) {
    let to = place * run_build.payload_words;
    let from_class = run_build.payload_at + code * run_build.payload_words;
    for (var k = 0u; k < run_build.payload_words; k++) {
        run_payloads.d[to + k] = run_classes.d[from_class + k];
    }
}
