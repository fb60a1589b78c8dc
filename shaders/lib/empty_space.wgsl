// Ways through empty space. Samples lie on a line, in cells from the corner of the grid of macro cells:
//
//     x(k) = at + k step
//
// Where the nearest cell with matter is `distance` cells away, nothing is seen until the ray leaves the cube of cells that
// are nearer. What is left out would have added nothing at all, and what comes next is a sample of the lattice: the
// picture is the same to the bit (`sampling.md` 5). The halo of the cells has half a voxel to spare, more than f32
// loses on the way.

#import ray

const CELL_VOXELS: u32 = 8u;

struct SampleLine {
    at: vec3<f32>,
    step: vec3<f32>,
    steps_per_cell: vec3<f32>,
    last_cell: vec3<f32>,
    // Only these lie on the line.
    first: i32,
    end: i32,
    // Whether anything is known of the cells.
    is_known: bool,
}

// With the samples at t = line.x + k line.y; from samples.x to samples.y they lie there.
fn sample_line(voxel: Ray, line: vec2<f32>, samples: vec2<i32>) -> SampleLine {
    let cell = f32(CELL_VOXELS);
    let tiny = vec3(1e-20);
    let along = line.y * voxel.direction / cell;
    // Along an axis on which the ray stays where it is, it leaves no cube.
    let step = select(along, tiny, abs(along) < tiny);
    return SampleLine(
        (voxel.origin + line.x * voxel.direction - frame.cells_origin) / cell,
        step,
        1.0 / step,
        vec3<f32>(frame.cells) - 1.0,
        samples.x,
        samples.y,
        frame.cells.x != 0u,
    );
}

// Whether sample k may be left out.
fn may_skip(line: SampleLine, k: i32) -> bool {
    return line.is_known && k >= line.first && k < line.end;
}

// The cell that sample k lies in.
fn cell_of(line: SampleLine, k: i32) -> vec3<i32> {
    return vec3<i32>(clamp(line.at + f32(k) * line.step, vec3(0.0), line.last_cell));
}

fn cell_index(cell: vec3<i32>) -> u32 {
    let cells = vec3<i32>(frame.cells);
    return frame.cells_first + u32(cell.x + cells.x * (cell.y + cells.y * cell.z));
}

// The first sample that lies outside of the distance around the cell of sample k.
fn first_sample_beyond(line: SampleLine, k: i32, cell: vec3<i32>, distance: i32) -> i32 {
    let ahead = select(vec3(1 - distance), vec3(distance), line.step > vec3(0.0));
    return first_sample_past(line, k, vec3<f32>(cell + ahead));
}

// The first sample past the planes, in cells, of which a ray at sample k meets one along each axis.
fn first_sample_past(line: SampleLine, k: i32, planes: vec3<f32>) -> i32 {
    let leaves = (planes - line.at) * line.steps_per_cell;
    return max(k + 1, i32(ceil(min(leaves.x, min(leaves.y, leaves.z)))));
}
