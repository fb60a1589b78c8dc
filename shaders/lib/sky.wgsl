// Light from all around by a picture of it, of equal steps of longitude and latitude: the first row above, the middle column
// along x, the picture turning to the right where longitude falls.
//
//     u = 1/2 - longitude / 2 pi + turn      v = 1/2 - latitude / pi
//
// Radiance is bilinear; directions are drawn by texels, as much light as they have (alias method, Vose 1991), evenly in the
// solid angle of one. CPU reference: src/technique/pathtrace/sky.rs.

#import frame
#import elementary

struct SkyTexel {
    r: f32,
    g: f32,
    b: f32,
    // Of directions in the texel, per steradian.
    density: f32,
    // The chance that the texel is taken where it is drawn, and which one is else.
    chance: f32,
    other: u32,
}

struct Sky {
    d: array<SkyTexel>,
}

@group(0) @binding(48) var<storage, read> sky: Sky;

struct SkyLight {
    radiance: vec3<f32>,
    density: f32,
}

fn has_sky_picture() -> bool {
    return frame.path_sky_size.x != 0u;
}

fn sky_texel(x: i32, y: i32) -> u32 {
    let size = vec2<i32>(frame.path_sky_size);
    let row = clamp(y, 0, size.y - 1);
    // At most one texel beyond. No remainder: drivers on CPUs divide whole numbers one by one.
    let column = x + select(0, size.x, x < 0) - select(0, size.x, x >= size.x);
    return u32(row * size.x + column);
}

fn sky_radiance(texel: u32) -> vec3<f32> {
    return vec3(sky.d[texel].r, sky.d[texel].g, sky.d[texel].b);
}

fn sky_at(way: vec3<f32>) -> SkyLight {
    if !has_sky_picture() {
        return SkyLight(frame.path_sky, 0.0);
    }
    let u = 0.5 - turn_of(way.xy) + frame.path_sky_turn;
    let v = 0.5 - 2.0 * turn_of(vec2(sqrt(dot(way.xy, way.xy)), way.z));
    let place = vec2(u - floor(u), v) * vec2<f32>(frame.path_sky_size);
    let own = vec2<i32>(floor(place));
    let corner = floor(place - 0.5);
    let weight = place - 0.5 - corner;
    let at = vec2<i32>(corner);
    let above = sky_radiance(sky_texel(at.x, at.y)) * (1.0 - weight.x) + sky_radiance(sky_texel(at.x + 1, at.y)) * weight.x;
    let below = sky_radiance(sky_texel(at.x, at.y + 1)) * (1.0 - weight.x)
        + sky_radiance(sky_texel(at.x + 1, at.y + 1)) * weight.x;
    let radiance = above * (1.0 - weight.y) + below * weight.y;
    return SkyLight(radiance * frame.path_sky, sky.d[sky_texel(own.x, own.y)].density);
}

// A direction to where much light comes from.
fn sky_drawn(numbers: vec4<f32>) -> vec3<f32> {
    let size = frame.path_sky_size;
    let count = size.x * size.y;
    var texel = min(u32(numbers.x * f32(count)), count - 1u);
    if numbers.y >= sky.d[texel].chance {
        texel = sky.d[texel].other;
    }
    let row = f32(texel / size.x);
    let above = turned(0.5 * row / f32(size.y)).x;
    let below = turned(0.5 * (row + 1.0) / f32(size.y)).x;
    let z = above + numbers.z * (below - above);
    let u = (f32(texel % size.x) + numbers.w) / f32(size.x);
    let turn = 0.5 - u + frame.path_sky_turn;
    let across = sqrt(max(0.0, 1.0 - z * z)) * turned(turn - floor(turn));
    return vec3(across, z);
}
