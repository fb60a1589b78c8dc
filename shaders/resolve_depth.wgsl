// The depth of what a technique left, in a host's depth buffer. Nothing is written where there is none.
// Legal inside a host's rendering.

#import ray
#import depth_of_{output}

@group(0) @binding(1) var left: texture_2d<f32>;

@fragment
fn main(@builtin(position) position: vec4<f32>) -> @builtin(frag_depth) f32 {
    let found = textureLoad(left, vec2<i32>(position.xy), 0);
    let t = depth_of(found);
    if t < 0.0 {
        discard;
    }
    let world = pixel_ray(position.xy);
    let point = vec4(world.origin + t * world.direction, 1.0);
    let depth = dot(frame.host_z, point) / dot(frame.host_w, point);
    // Beyond the far plane nothing is drawn; what lies before the near plane hides all.
    let far = 1.0 - frame.host_near;
    if (depth - far) * (far - frame.host_near) > 0.0 {
        discard;
    }
    return clamp(depth, 0.0, 1.0);
}
