// What comes through to each node of the light grid, a corner of cells, one thread a node and bundle: the mean over
// the paths r of a bundle, straight lines cut into the pieces d that lie in one cell each,
//
//     open = sum over r of w_r exp(-sum of sigma d)        sum of w_r = 1
//
// exact for matter that is uniform in each cell, since a straight line from one node goes through the same pieces as
// that from any other. Paths all around give 1 - occlusion (Hernell, Ljung and Ynnerman, "Local Ambient Occlusion in
// Direct Volume Rendering", IEEE TVCG 16(4), 2010), those towards a light give its shadow. Outside the grid is nothing.
// CPU reference: src/technique/light_field.rs.

#import light_grid

struct LightPaths {
    // Of each bundle (first path, end, 0, 0), of each path (first piece, end, weight, 0), pieces (cell, length).
    d: array<vec4<f32>>,
}

@group(0) @binding(27) var<storage, read> light_cells: LightNumbers;
@group(0) @binding(28) var<storage, read> light_paths: LightPaths;
@group(0) @binding(29) var<storage, read_write> light_volume: LightNumbers;

// Nothing that counts comes through more: exp(-12) is 6e-6.
const DARK: f32 = 12.0;

@compute @workgroup_size(4, 4, 4)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let nodes = light_grid.cells + 1u;
    if any(id >= vec3(nodes.xy, nodes.z * light_grid.bundle_count)) {
        return;
    }
    let bundle = light_paths.d[id.z / nodes.z];
    let node = vec3<i32>(vec3(id.xy, id.z % nodes.z));
    var open = 0.0;
    for (var path = u32(bundle.x); path < u32(bundle.y); path++) {
        let pieces = light_paths.d[path];
        open += pieces.z * exp(-depth_along(node, u32(pieces.x), u32(pieces.y)));
    }
    light_volume.d[id.x + nodes.x * (id.y + nodes.y * id.z)] = open;
}

fn depth_along(node: vec3<i32>, first: u32, end: u32) -> f32 {
    var depth = 0.0;
    for (var i = first; i < end; i++) {
        let piece = light_paths.d[i];
        let cell = node + vec3<i32>(piece.xyz);
        // A straight line that has left the grid stays outside.
        if any(cell < vec3(0)) || any(cell >= vec3<i32>(light_grid.cells)) || depth > DARK {
            break;
        }
        depth += piece.w * light_cells.d[cell_index(vec3<u32>(cell))];
    }
    return depth;
}
