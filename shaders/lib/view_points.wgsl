// Scattered points as a view sees them, and those that a tile of the picture may see. CPU reference:
// src/technique/splat/points/view_points.rs, reference.rs.

#import ray

struct ViewPoint {
    center: vec3<f32>,
    inverse_std: f32,
    value: f32,
    // Of matter along a ray through its centre.
    length: f32,
    // What of it a ray through its centre meets.
    density: f32,
}

// From front to back.
struct ViewPoints {
    all: array<ViewPoint>,
}

// Where the list of each tile begins, the end of the last, and the lists.
struct TilePoints {
    numbers: array<u32>,
}

@group(0) @binding(44) var<storage, read> view_points: ViewPoints;
@group(0) @binding(45) var<storage, read> tile_points: TilePoints;

// First and end of what this recording takes of a tile's list.
fn list_of(corner: vec2<u32>) -> vec2<u32> {
    let tiles = (frame.extent_pixels + TILE_PIXELS - 1u) / TILE_PIXELS;
    let tile = corner / TILE_PIXELS;
    let lists = tiles.x * tiles.y + 1u;
    let i = tile.x + tiles.x * tile.y;
    let list = lists + vec2(tile_points.numbers[i], tile_points.numbers[i + 1u]);
    return min(list.x + vec2(frame.points_first, frame.points_end), list.yy);
}

// The point at that place of the lists.
fn listed(place: u32) -> ViewPoint {
    return view_points.all[tile_points.numbers[place]];
}

// How far from its centre a ray passes, in its standard deviations, squared; beyond all reach where that is behind the eye.
fn square_of(point: ViewPoint, ray: Ray) -> f32 {
    let from_eye = point.center - ray.origin;
    let t = dot(from_eye, ray.direction);
    let off = (from_eye - t * ray.direction) * point.inverse_std;
    return select(1e30, dot(off, off), t > 0.0);
}
