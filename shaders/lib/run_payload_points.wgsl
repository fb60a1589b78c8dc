// Payload of full voxels for conformance pictures, which search points: floats of 32 bits.

#import classified_runs

// Red, green and blue times depth, and depth, of the full voxel of this rank.
fn run_payload(first: u32, rank: u32) -> vec4<f32> {
    let at = first + 4u * rank;
    let words = vec4(
        classified_runs.d[at],
        classified_runs.d[at + 1u],
        classified_runs.d[at + 2u],
        classified_runs.d[at + 3u],
    );
    return bitcast<vec4<f32>>(words);
}
