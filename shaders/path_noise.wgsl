// How noisy a picture of paths is that goes on from frame to frame. Of each pixel, of mean luminance y with the n paths of the frame
// and y0 with the b before it (Welford 1962):
//
//     D += b (b + n) / n (y - y0)^2
//
// and of each tile the sums of D and of y^2.
// CPU reference: src/technique/pathtrace/noise.rs.

#import noise_tiles

struct Deviations {
    // Mean luminance, and D.
    d: array<vec2<f32>>,
}

struct TileSums {
    // Of D, and of squares of the mean luminance.
    d: array<vec2<f32>>,
}

@group(0) @binding(1) var picture: texture_2d<f32>;
@group(0) @binding(2) var<storage, read_write> deviations: Deviations;
@group(0) @binding(3) var<storage, read_write> tile_sums: TileSums;

// Of linear light (ITU-R BT.709).
const LUMINANCE: vec3<f32> = vec3(0.2126, 0.7152, 0.0722);

@compute @workgroup_size(GROUP_SIDE, GROUP_SIDE)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_id) own: vec3<u32>) {
    let before = f32(frame.path_before);
    let count = f32(frame.path_count);
    let weight = before * ((before + count) / count);
    let across = NOISE_TILE / GROUP_SIDE;
    var sum = vec2(0.0);
    for (var turn = 0u; turn < across * across; turn++) {
        let block = vec2(turn % across, turn / across);
        let pixel = NOISE_TILE * group.xy + GROUP_SIDE * block + own.xy;
        if all(pixel < frame.extent_pixels) {
            sum += with_frame(pixel, weight);
        }
    }
    let thread = GROUP_SIDE * own.y + own.x;
    let all_of_them = sum_of_group(thread, sum);
    if thread == 0u {
        tile_sums.d[group.y * noise_tiles().x + group.x] = all_of_them;
    }
}

fn with_frame(pixel: vec2<u32>, weight: f32) -> vec2<f32> {
    let mean = dot(LUMINANCE, textureLoad(picture, vec2<i32>(pixel), 0).xyz);
    let number = pixel.y * frame.extent_pixels.x + pixel.x;
    var deviation = 0.0;
    if frame.path_before != 0u {
        let then = deviations.d[number];
        let change = mean - then.x;
        deviation = then.y + weight * change * change;
    }
    deviations.d[number] = vec2(mean, deviation);
    return vec2(deviation, mean * mean);
}
