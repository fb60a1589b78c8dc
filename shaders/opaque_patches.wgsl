// Early termination of slices that are blended from front to back: which squares of the picture no further slice can
// change. One thread a square. A pixel counts as done where the rounded alpha is 1, for then
//
//     C + (1 - A) s = C + 0 s = C        for every fragment s, exactly
//
// so the picture is the same to the bit. A square is left out from the first batch on before which all its pixels were.

#import patch_grid

struct OpaqueSince {
    // The batch that is drawn next, from 1 on.
    batch: u32,
    // The last batch that is drawn; 2^32 - 1: all.
    d: array<u32>,
}

@group(0) @binding(1) var blended: texture_2d<f32>;
@group(0) @binding(41) var<storage, read_write> opaque_since: OpaqueSince;

@compute @workgroup_size(8, 4)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let grid = patch_grid();
    if any(id.xy >= grid) {
        return;
    }
    let square = id.x + grid.x * id.y;
    if opaque_since.d[square] < opaque_since.batch {
        return;
    }
    let first = id.xy * frame.patch_pixels;
    let end = min(first + frame.patch_pixels, frame.extent_pixels);
    for (var y = first.y; y < end.y; y++) {
        for (var x = first.x; x < end.x; x++) {
            if textureLoad(blended, vec2<i32>(vec2(x, y)), 0).w != 1.0 {
                return;
            }
        }
    }
    opaque_since.d[square] = opaque_since.batch - 1u;
}
