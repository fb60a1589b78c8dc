// Runs of classified voxels, second pass: of the sums of blocks (shaders/run_words.wgsl) the sums of all blocks before, and behind
// them the sum of all. One workgroup, each thread a share of neighbours.

#import run_list

var<workgroup> sums: array<vec2<u32>, RUN_THREADS>;

@compute @workgroup_size(8, 8)
fn main(@builtin(local_invocation_id) id: vec3<u32>) {
    let thread = thread_of(id);
    let share = (run_build.block_count + RUN_THREADS - 1u) / RUN_THREADS;
    let first = run_build.texel_count + min(thread * share, run_build.block_count);
    let end = run_build.texel_count + min((thread + 1u) * share, run_build.block_count);
    var own = vec2(0u);
    for (var block = first; block < end; block++) {
        own += run_list.d[block];
    }
    sums[thread] = own;
    workgroupBarrier();
    var before = vec2(0u);
    for (var other = 0u; other < thread; other++) {
        before += sums[other];
    }
    for (var block = first; block < end; block++) {
        let sum = run_list.d[block];
        run_list.d[block] = before;
        before += sum;
    }
    if thread == RUN_THREADS - 1u {
        run_list.d[run_build.texel_count + run_build.block_count] = before;
    }
}
