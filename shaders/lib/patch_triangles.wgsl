// A square (or a block of them) as two triangles. Edges lie between pixels, half a pixel from the nearest centre.

#import frame

fn square_vertices() -> u32 {
    return 6u;
}

const CORNERS = array<vec2<u32>, 6>(
    vec2(0u, 0u),
    vec2(1u, 0u),
    vec2(1u, 1u),
    vec2(0u, 0u),
    vec2(1u, 1u),
    vec2(0u, 1u),
);

fn blocks_can_be_drawn() -> bool {
    return true;
}

// Where vertex `corner` lies that begins at a pixel and is so many wide.
fn square_vertex(corner: u32, first: vec2<u32>, pixels: u32) -> vec2<f32> {
    var corners = CORNERS;
    let place = first + pixels * corners[corner];
    return 2.0 * vec2<f32>(place) / vec2<f32>(frame.extent_pixels) - 1.0;
}
