// What a technique left, as linear premultiplied colour. Legal inside a host's rendering.

#import resolve_{source}

@fragment
fn main(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    return premultiplied(vec2<i32>(position.xy));
}
