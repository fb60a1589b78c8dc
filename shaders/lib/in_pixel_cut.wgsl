// Where in a pixel its ray goes through, where each pixel has a place of its own: stratified sampling (Cook 1986), one
// place in a square of the pixel for each of its rays. The hash is pcg3d of M. Jarzynski and M. Olano (Hash Functions
// for GPU Rendering, JCGT 9(3), 2020). CPU reference: src/ray.rs.

#import frame

fn place_in_pixel(pixel: vec2<f32>) -> vec2<f32> {
    var place = pixel;
    // Once, or not at all.
    for (var i = 0u; i < frame.is_uneven; i++) {
        place += in_cell(vec2<u32>(pixel));
    }
    return place;
}

// From the middle of the square, under half of its side.
fn in_cell(pixel: vec2<u32>) -> vec2<f32> {
    var v = vec3(pixel, frame.cell_seed) * 1664525u + 1013904223u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v ^= v >> vec3(16u);
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    return (vec2<f32>(v.xy >> vec2(8u)) / 16777216.0 - 0.5) * frame.cell_pixels;
}
