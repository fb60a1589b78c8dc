// A piece of a ray between two ends, cut to the domain. CPU reference: src/lattice.rs.

#import ray

struct Slab {
    front: f32,
    back: f32,
    // 0 or less: outside.
    length: f32,
}

// The piece around plane k, half way to the next plane on both sides.
fn plane_slab(world: Ray, interval: vec2<f32>, k: i32) -> Slab {
    let enter = edge_t(world, k);
    let leave = edge_t(world, k + 1);
    let front = max(enter, interval.x);
    let back = min(leave, interval.y);
    let is_whole = front == enter && back == leave;
    return Slab(front, back, select(back - front, plane_length(world), is_whole));
}

// Half way between planes k - 1 and k: forward . x = k step + offset.
fn edge_t(world: Ray, k: i32) -> f32 {
    return (f32(k) * frame.step_world - plane_height(world)) / dot(frame.forward, world.direction);
}
