// Scattered points as a view sees them, and those that a block of the picture may see. CPU reference:
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

// Pixels along the side of the blocks that have a list each.
const LIST_PIXELS: u32 = 4u;

// Where the list of each block begins, the end of the last, and the lists.
struct BlockPoints {
    numbers: array<u32>,
}

@group(0) @binding(44) var<storage, read> view_points: ViewPoints;
@group(0) @binding(45) var<storage, read> block_points: BlockPoints;

// First and end of what this recording takes of the list of a pixel.
fn list_of(pixel: vec2<u32>) -> vec2<u32> {
    let blocks = (frame.extent_pixels + LIST_PIXELS - 1u) / LIST_PIXELS;
    let block = pixel / LIST_PIXELS;
    let lists = blocks.x * blocks.y + 1u;
    let i = block.x + blocks.x * block.y;
    let list = lists + vec2(block_points.numbers[i], block_points.numbers[i + 1u]);
    return min(list.x + vec2(frame.part_first, frame.part_end), list.yy);
}

// The point at that place of the lists.
fn listed(place: u32) -> u32 {
    return block_points.numbers[place];
}

// How far from its centre a ray passes, in its standard deviations, squared; beyond all reach where that is behind the eye.
fn square_of(point: u32, ray: Ray) -> f32 {
    let from_eye = view_points.all[point].center - ray.origin;
    let t = dot(from_eye, ray.direction);
    let off = (from_eye - t * ray.direction) * view_points.all[point].inverse_std;
    return select(1e30, dot(off, off), t > 0.0);
}
