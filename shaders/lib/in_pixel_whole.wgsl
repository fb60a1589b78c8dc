// All rays go through their pixels at the same place (in_pixel_cut.wgsl has others).

fn place_in_pixel(pixel: vec2<f32>) -> vec2<f32> {
    return pixel;
}
