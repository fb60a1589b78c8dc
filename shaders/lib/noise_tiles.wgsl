// Tiles of a picture whose noise is summed up: a workgroup each, and the sum over its invocations in pairs, in the same order on
// each device.

#import frame

// Pixels along the side of a tile.
const NOISE_TILE: u32 = 32u;

const GROUP_SIDE: u32 = 8u;
const GROUP_THREADS: u32 = 64u;

var<workgroup> sums: array<vec2<f32>, GROUP_THREADS>;

fn noise_tiles() -> vec2<u32> {
    return (frame.extent_pixels + NOISE_TILE - 1u) / NOISE_TILE;
}

// All invocations come here.
fn sum_of_group(thread: u32, own: vec2<f32>) -> vec2<f32> {
    sums[thread] = own;
    workgroupBarrier();
    for (var stride = GROUP_THREADS / 2u; stride > 0u; stride /= 2u) {
        if thread < stride {
            sums[thread] += sums[thread + stride];
        }
        workgroupBarrier();
    }
    return sums[0];
}
