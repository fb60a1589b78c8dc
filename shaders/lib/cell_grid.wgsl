// Macro cells: the brick's own voxels in cubes of CELL_VOXELS a side, from its first voxel on.
// CPU reference: src/resident/macro_cells.rs.

const CELL_VOXELS: u32 = 8u;

struct CellGrid {
    // How many there are along each axis, and which of all bricks' cells is the first.
    cells: vec3<u32>,
    first: u32,
    // The brick's first voxel, and what its texture holds.
    origin: vec3<i32>,
    halo: i32,
    stored_min: vec3<i32>,
    code_scale: f32,
    stored_last: vec3<i32>,
    code_offset: f32,
    slope: f32,
    intercept: f32,
    codes_are_integers: u32,
    // How far beyond the voxels' values a filtered one may lie: a multiple of half their range (filters with negative
    // weights), values, and parts of the larger of both ends (rounding).
    overshoot: f32,
    slack: f32,
    rounding: f32,
    // The axis of a stack.
    axis: u32,
}

@group(0) @binding(30) var<uniform> cell_grid: CellGrid;

fn cell_index(cell: vec3<u32>) -> u32 {
    return cell_grid.first + cell.x + cell_grid.cells.x * (cell.y + cell_grid.cells.y * cell.z);
}
