// What a host has drawn ends a ray, and its near plane begins one. With z and w the rows of the host's clip space, the
// depth of a point p is z . (p, 1) / w . (p, 1), so that a ray o + t d has depth D at
//
//     t = -(z - D w) . (o, 1) / (z - D w) . (d, 0)
//
// Without a far plane the depth of nothing is infinitely far away. Host: src/camera/matrices.rs.

#import ray

// One number a pixel, as the host's depth buffer holds it. Where there is none, something else stands in.
@group(0) @binding(14) var host_depth: texture_2d<f32>;

// The part of an interval of a ray that the host sees.
fn visible_interval(interval: vec2<f32>, world: Ray, pixel: vec2<f32>) -> vec2<f32> {
    if frame.has_host_depth == 0u {
        return interval;
    }
    let drawn = textureLoad(host_depth, vec2<i32>(pixel), 0).x;
    return vec2(
        max(interval.x, distance_at(world, frame.host_near)),
        min(interval.y, distance_at(world, drawn)),
    );
}

// How far along the ray the host's depth is `depth`.
fn distance_at(world: Ray, depth: f32) -> f32 {
    let row = frame.host_z - depth * frame.host_w;
    let rise = dot(row.xyz, world.direction);
    let t = -(dot(row.xyz, world.origin) + row.w) / rise;
    return select(t, 3.4e38, rise == 0.0);
}
