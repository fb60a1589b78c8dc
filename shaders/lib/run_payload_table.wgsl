// Payload of full voxels for pictures that classify by tables: floats of 16 bits.

#import classified_runs

// Red, green and blue times depth, and depth, of the full voxel of this rank.
fn run_payload(first: u32, rank: u32) -> vec4<f32> {
    let at = first + 2u * rank;
    return vec4(unpack2x16float(classified_runs.d[at]), unpack2x16float(classified_runs.d[at + 1u]));
}
