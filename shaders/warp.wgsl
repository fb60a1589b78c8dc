// Shear-warp's picture from its intermediate image: the ray of a pixel meets the base plane between four base pixels,
// which are mixed bilinearly as they are blended. CPU reference: src/technique/shear_warp/reference.rs.

#import frame
#import warp_{source}

@group(0) @binding(1) var base: texture_2d<f32>;
@group(0) @binding(6) var picture: texture_storage_2d<rgba32float, write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if any(id.xy >= textureDimensions(picture)) {
        return;
    }
    let place = vec4(vec2<f32>(id.xy) + 0.5, 1.0, 0.0) * frame.base_from_pixel;
    var found = WarpSum();
    // Not before the eye otherwise.
    if place.z > 0.0 {
        let middles = place.xy / place.z - 0.5;
        let low = floor(middles);
        let part = middles - low;
        found = warp_add(found, base_at(vec2<i32>(low)), (1.0 - part.x) * (1.0 - part.y));
        found = warp_add(found, base_at(vec2<i32>(low) + vec2(1, 0)), part.x * (1.0 - part.y));
        found = warp_add(found, base_at(vec2<i32>(low) + vec2(0, 1)), (1.0 - part.x) * part.y);
        found = warp_add(found, base_at(vec2<i32>(low) + vec2(1, 1)), part.x * part.y);
    }
    textureStore(picture, id.xy, warp_end(found));
}

// A base pixel; outside of the image there is nothing.
fn base_at(at: vec2<i32>) -> vec4<f32> {
    if any(at < vec2(0)) || any(at >= vec2<i32>(frame.extent_pixels)) {
        return vec4(0.0);
    }
    return textureLoad(base, at, 0);
}
