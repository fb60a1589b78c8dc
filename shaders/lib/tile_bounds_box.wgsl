// Nothing is known of what lies in the box, or all of it counts.

#import tile_frustum

fn tile_bounds(frustum: TileFrustum, within: vec2<f32>) -> vec2<f32> {
    // Where a picture is put together after its last brick, all pixels are.
    if frame.mida_mip != 0.0 && frame.is_last_brick != 0u && frame.is_first_brick == 0u {
        return vec2(min(within.x, 0.0), ENDLESS);
    }
    return within;
}
