// The cover of slices where only some patches of them are drawn (slice_patches.wgsl): squares of the picture, two
// triangles a slice or a point. Of v vertices a square vertex i shows slice i / v mod LAYER_SLICES of the layer that
// entry i / (v LAYER_SLICES) of all batches names. An instance for each would fill few lanes of graphics cards; on
// processors it takes as long. Each fragment belongs to one square, and it alone decides whether it has a sample.

#import patch_entry
#import vertex_{parameters}

struct Patches {
    d: array<u32>,
}

// Squares in which no further slice can change anything, since which batch.
struct OpaqueSince {
    batch: u32,
    d: array<u32>,
}

@group(0) @binding(40) var<storage, read> patches_listed: Patches;
@group(0) @binding(41) var<storage, read> opaque_since: OpaqueSince;

@vertex
fn main(@builtin(vertex_index) vertex: u32) -> Vertex {
    let batch = vertex / entry_vertices() / batch_capacity();
    let entry = patches_listed.d[vertex / entry_vertices()];
    let side = select(1u, BLOCK_SIDE, entry >= BLOCK);
    let square = (entry & ~BLOCK) / BATCH_LAYERS;
    let layer = batch * BATCH_LAYERS + entry % BATCH_LAYERS;
    let nth = layer * LAYER_SLICES + vertex / square_vertices() % LAYER_SLICES;
    let across = patch_grid().x;
    let first = vec2(square % across, square / across);
    let is_drawn = nth < frame.slice_count && changes(first, side);
    let pixels = side * frame.patch_pixels;
    let ndc = square_vertex(vertex % square_vertices(), first * frame.patch_pixels, pixels);
    // All in one point that is out of sight: no fragment.
    let place = vec4(select(vec2(-2.0), ndc, is_drawn), 0.5, 1.0);
    return vertex_of(place, slice_of(nth), f32(pixels));
}

// Whether a further slice can change anything in the squares of a block.
fn changes(first: vec2<u32>, side: u32) -> bool {
    let grid = patch_grid();
    let end = min(first + side, grid);
    for (var y = first.y; y < end.y; y++) {
        for (var x = first.x; x < end.x; x++) {
            if opaque_since.d[x + grid.x * y] >= opaque_since.batch {
                return true;
            }
        }
    }
    return false;
}
