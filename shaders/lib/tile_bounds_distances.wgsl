// What is empty does not count: from both ends of the box through cubes of empty cells to the first that may not be.

#import tile_frustum
#import distance_map

// The least way that is worth a look, in voxels.
const LEAST_VOXELS: f32 = 2.0;

fn tile_bounds(frustum: TileFrustum, within: vec2<f32>) -> vec2<f32> {
    // Cut faces are seen in empty space too, and surfaces that a ray meets between two bricks belong to the farther
    // one.
    let is_known = frame.cells.x != 0u && frame.cut_faces == 0u && (frame.level_count == 0u || frame.is_only_brick != 0u);
    if !is_known || !(within.x < within.y) {
        return within;
    }
    let fastest = max(frustum.direction.x, max(frustum.direction.y, frustum.direction.z));
    let slowest = min(frustum.direction.x, min(frustum.direction.y, frustum.direction.z));
    let least = LEAST_VOXELS / max(fastest, -slowest);
    var left = within;
    loop {
        let empty = empty_around(frustum, left.x);
        if !(empty.x <= left.x && left.x + least < empty.y) {
            break;
        }
        left.x = empty.y;
        if left.x >= left.y {
            break;
        }
    }
    loop {
        if left.x >= left.y {
            break;
        }
        let empty = empty_around(frustum, left.y);
        if !(left.y <= empty.y && empty.x + least < left.y) {
            break;
        }
        left.y = empty.x;
    }
    return left;
}

// Where the frustum lies in the cube of empty cells around its middle at s; nowhere where there is none. Cells end at
// the grid, and so does what is not empty.
fn empty_around(frustum: TileFrustum, s: f32) -> vec2<f32> {
    let last = vec3<i32>(frame.cells) - 1;
    let size = f32(CELL_VOXELS);
    let place = (frustum.origin + s * frustum.direction - frame.cells_origin) / size;
    let cell = vec3<i32>(clamp(place, vec3(0.0), vec3<f32>(last)));
    let distance = distance_to_occupied(cell);
    if distance == 0 || distance == i32(HOMOGENEOUS) {
        return vec2(ENDLESS, -ENDLESS);
    }
    let first_cell = cell + 1 - distance;
    let end_cell = cell + distance;
    let low = select(frame.cells_origin + size * vec3<f32>(first_cell), vec3(-ENDLESS), first_cell <= vec3(0));
    let high = select(frame.cells_origin + size * vec3<f32>(end_cell), vec3(ENDLESS), end_cell > last);
    return inside_of(frustum, vec2(0.0, ENDLESS), low, high);
}
