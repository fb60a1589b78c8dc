// What clip planes leave of a ray.

#import frame

fn clipped(whole: vec2<f32>, origin: vec3<f32>, direction: vec3<f32>) -> vec2<f32> {
    var interval = whole;
    for (var i = 0u; i < frame.clip_plane_count; i++) {
        interval = clip_interval(interval, frame.clip_planes[i], origin, direction);
    }
    return interval;
}

// Keeps the part of the interval with dot(plane.xyz, point) >= plane.w.
fn clip_interval(interval: vec2<f32>, plane: vec4<f32>, origin: vec3<f32>, direction: vec3<f32>) -> vec2<f32> {
    let height = dot(plane.xyz, origin) - plane.w;
    let slope = dot(plane.xyz, direction);
    if abs(slope) < 1e-20 {
        return select(vec2(interval.x, interval.x), interval, height >= 0.0);
    }
    let t = -height / slope;
    return select(vec2(interval.x, min(interval.y, t)), vec2(max(interval.x, t), interval.y), slope > 0.0);
}
