// What shaders/path_noise.wgsl has found of tiles, of the whole picture: one workgroup.
// CPU reference: src/technique/pathtrace/noise.rs.

#import noise_tiles

struct TileSums {
    d: array<vec2<f32>>,
}

// What the host reads.
struct Told {
    deviations: f32,
    squares: f32,
    // Of each pixel. 0: nothing is told.
    paths: u32,
}

@group(0) @binding(3) var<storage, read_write> tile_sums: TileSums;
@group(0) @binding(4) var<storage, read_write> told: Told;

@compute @workgroup_size(GROUP_SIDE, GROUP_SIDE)
fn main(@builtin(local_invocation_id) own: vec3<u32>) {
    let thread = GROUP_SIDE * own.y + own.x;
    let tiles = noise_tiles();
    var sum = vec2(0.0);
    for (var tile = thread; tile < tiles.x * tiles.y; tile += GROUP_THREADS) {
        sum += tile_sums.d[tile];
    }
    let all_of_them = sum_of_group(thread, sum);
    if thread == 0u {
        told.deviations = all_of_them.x;
        told.squares = all_of_them.y;
        told.paths = frame.path_before + frame.path_count;
    }
}
