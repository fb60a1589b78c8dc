// The coarse grid that light is followed through: at most 128 cells an axis, none smaller than a voxel, all of one
// extinction inside. CPU reference: src/technique/light_plan.rs.

struct LightGrid {
    cells: vec3<u32>,
    // Bundles of paths: one for what comes from all around, one for each light.
    bundle_count: u32,
    // Size of a cell in voxel space.
    cell_voxels: vec3<f32>,
    // World length of the shortest side of a cell.
    cell_length: f32,
    // How many times a cell is looked at along each axis.
    looks: vec3<u32>,
    // Not 0: a cell has the mean of the extinctions that are found there, and not that of opacities.
    adds_extinctions: u32,
}

struct LightNumbers {
    d: array<f32>,
}

@group(0) @binding(26) var<uniform> light_grid: LightGrid;

fn cell_index(cell: vec3<u32>) -> u32 {
    return cell.x + light_grid.cells.x * (cell.y + light_grid.cells.y * cell.z);
}
