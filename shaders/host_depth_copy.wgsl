// A host's depth buffer, copied into a depth attachment of ours: own = depth, or 1 - depth where the host's nearer depth
// is the smaller one, so that in the copy the larger is always nearer. 1 - d is exact for d of 1/2 to 1 (Sterbenz), where
// nearly all depths of a standard projection lie; the depth of a far plane at 1 becomes 0, that of nothing.

#import frame

@group(0) @binding(1) var host_depth: texture_2d<f32>;

@fragment
fn main(@builtin(position) position: vec4<f32>) -> @builtin(frag_depth) f32 {
    let depth = textureLoad(host_depth, vec2<i32>(position.xy), 0).x;
    return select(depth, 1.0 - depth, frame.flips_host_depth != 0u);
}
