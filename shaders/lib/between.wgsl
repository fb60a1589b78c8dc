// Between the slices of a stack (Rezk-Salama et al. 2000): plane i lies at the height 1/2 + i / n along the axis of
// the stack, with n planes a slice, so that every n-th is a slice.
// CPU reference: src/technique/slices_2d/between.rs.

#import stack

// So much of the way from one slice to the next.
struct Level {
    below: i32,
    part: f32,
}

// By whole numbers: on a slice the part is 0, however a device divides.
fn level_of_plane(plane: i32) -> Level {
    let planes = i32(frame.planes_per_slice);
    // Planes before the first slice: whole numbers are divided towards 0.
    let shifted = plane + planes;
    return Level(shifted / planes - 1, f32(shifted % planes) / frame.planes_per_slice);
}

fn level_at(height: f32) -> Level {
    let lattice = height - 0.5;
    let below = floor(lattice);
    return Level(i32(below), lattice - below);
}

fn height_of_plane(plane: f32) -> f32 {
    return 0.5 + plane / frame.planes_per_slice;
}

// The slices of a level; beyond the outermost there is only that.
fn slices_of(level: Level) -> vec2<i32> {
    let last = i32(frame.dims[frame.slice_axis]) - 1;
    return clamp(vec2(level.below, level.below + 1), vec2(0), vec2(last));
}
