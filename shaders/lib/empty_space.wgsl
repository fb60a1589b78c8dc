// Ways through empty space: from a position in a cell whose nearest cell with matter is `room` cells away, nothing is seen
// until the ray leaves the cube of cells nearer than that. What is left out would have added nothing at all, and the
// samples behind are those of the lattice: the picture is the same to the bit (`sampling.md` 5).
// Twin: src/resident/empty_space.rs.

#import ray

const CELL_VOXELS: u32 = 8u;

fn macro_cell_index_at(position: vec3<f32>) -> u32 {
    let cell = macro_cell_at(position);
    return frame.cells_first + cell.x + frame.cells.x * (cell.y + frame.cells.y * cell.z);
}

// Rounding may take a sample a little out of the brick.
fn macro_cell_at(position: vec3<f32>) -> vec3<u32> {
    let cell = (position - frame.cells_origin) / f32(CELL_VOXELS);
    return vec3<u32>(clamp(cell, vec3(0.0), vec3<f32>(frame.cells - 1u)));
}

// Where the ray leaves the room.
fn end_of_room(voxel: Ray, position: vec3<f32>, room: u32) -> f32 {
    let cell = vec3<i32>(macro_cell_at(position));
    let ahead = select(1 - vec3(i32(room)), vec3(i32(room)), voxel.direction > vec3(0.0));
    let face = frame.cells_origin + vec3<f32>(cell + ahead) * f32(CELL_VOXELS);
    let tiny = vec3(1e-20);
    let t = (face - voxel.origin) / select(voxel.direction, tiny, abs(voxel.direction) < tiny);
    return min(t.x, min(t.y, t.z));
}
