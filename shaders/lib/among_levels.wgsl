// Where a walk is among the values of surfaces (crossing_levels.wgsl).

struct AmongLevels {
    // The cell that it is in, by its lower corner, where is_in_cell, and where the walk leaves it along each axis.
    cell: vec3<i32>,
    is_in_cell: bool,
    leave: vec3<f32>,
    // How many levels lie at or under the value, here and before the last step; UNKNOWN: it is to be looked up.
    rank: i32,
    before: i32,
    // Where the last step ends. At a surface, how steep the field is along each axis.
    t: f32,
    slope: vec3<f32>,
    // Across the face that the walk has come into the cell by: the slope, where there is no other.
    face: vec3<f32>,
}

const UNKNOWN: i32 = -1;

fn from_rank(rank: i32) -> AmongLevels {
    return AmongLevels(vec3(0), false, vec3(0.0), rank, rank, 0.0, vec3(0.0), vec3(0.0));
}

// The surface that the last step ends at.
fn crossed_level(at: AmongLevels) -> u32 {
    return u32(min(at.rank, at.before));
}
