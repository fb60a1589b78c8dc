// The cover of slices where only some patches of them are drawn (slice_patches.wgsl): squares of the picture, six vertices a
// slice. Vertex i shows slice i / 6 mod LAYER_SLICES of the layer that entry i / ENTRY_VERTICES of all batches names. An
// instance of six vertices for each would fill few lanes of graphics cards; on processors it takes as long. Edges lie between
// pixels, half a pixel from the nearest centre: each fragment belongs to one square, and it alone decides whether it has a
// sample.

#import patch_grid
#import vertex_{parameters}

const CORNERS = array<vec2<u32>, 6>(
    vec2(0u, 0u),
    vec2(1u, 0u),
    vec2(1u, 1u),
    vec2(0u, 0u),
    vec2(1u, 1u),
    vec2(0u, 1u),
);

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
    let batch = vertex / ENTRY_VERTICES / batch_capacity();
    let entry = patches_listed.d[vertex / ENTRY_VERTICES];
    let side = select(1u, BLOCK_SIDE, entry >= BLOCK);
    let square = (entry & ~BLOCK) / BATCH_LAYERS;
    let layer = batch * BATCH_LAYERS + entry % BATCH_LAYERS;
    let nth = layer * LAYER_SLICES + vertex / 6u % LAYER_SLICES;
    let across = patch_grid().x;
    let first = vec2(square % across, square / across);
    let is_drawn = nth < frame.slice_count && changes(first, side);
    var corners = CORNERS;
    let corner = first + side * corners[vertex % 6u];
    let ndc = 2.0 * vec2<f32>(corner * frame.patch_pixels) / vec2<f32>(frame.extent_pixels) - 1.0;
    // All six in one point: no fragment.
    return vertex_of(vec4(select(vec2(-1.0), ndc, is_drawn), 0.5, 1.0), slice_of(nth));
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
